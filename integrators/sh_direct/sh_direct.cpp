#include "integrators/sh_direct/sh_direct.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "integrators/sh_direct/sh_occlusion.h"
#include "materials/zonal_lobes.h"

namespace zonal {

void ShDirectParams::visit(ParamVisitor& v) {
  v.choice("at", at, {"pixel", "grid", "octree"},
           "where the lights are projected; between the points of a grid or octree they are interpolated");
  v.choice(
      "occlusion", occlusion, {"none", "ambient", "ratio"},
      "what blocks light: nothing; what is near, from all sides alike; everything, by rays to the lights");
  v.integer("rays", rays, {1, 1e6}, "rays", "of ambient and ratio, a pixel, pass and group of lights");
  v.integer("groups", groups, {1, 1024}, "groups",
            "of neighbouring lights, each with rays of its own (ratio)");
  v.number("reach", reach, {0, 1e9}, "m", "of ambient; 0: a tenth of the scene's radius");
  ShReceiverParams::visit(v);
  v.choice("polygons", polygons,
           {"exact", "main", "alternative", "compromise_radius", "compromise_angle", "factorized"},
           "triangles of area lights: integrated, spheres in their place (Eq. 4.9, 4.14, 4.17), or the "
           "literature's zonal factorisation");
  v.number("split_error", split_error, {0, 1}, "",
           "spheres for triangles: cut until their coefficients are off by less; 0: one sphere a triangle");
  v.number("split_distance", split_distance, {.low = 0, .high = 1e9, .open_low = true}, "m",
           "from which split_error is judged");
  v.number("tolerance", tolerance, {.low = 0, .high = 1, .open_low = true}, "",
           "exact triangles: relative error allowed; those so far that one direction stays below are one");
  v.number("texture_error", texture_error, {0, 1}, "",
           "pictures on lights: share of their light that cells of one radiance may move; 0: a cell a texel");
  v.integer_or_auto("grid", grid, {2, 1e6}, "points",
                    "along the longest side of the box around what is seen; auto: by grid_error");
  v.number("grid_error", grid_error, {.low = 0, .high = 1, .open_low = true}, "",
           "wanted of grid auto and octree: RMSE against at pixel over the mean");
  v.integer("octree_points", octree_points, {0, 1e8}, "points",
            "of the octree at most; 0: until grid_error is met");
  v.choice("interpolation", scheme.interpolation, {"hermite", "taylor", "linear"},
           "between the grid's points");
  v.choice(
      "mixed", scheme.mixed, {"differences", "hessian", "zero"},
      "where hermite has mixed derivatives from: gradients next to each other, the lights' Hessian, nowhere");
  v.choice("loops", loops, {"reverse", "forward"},
           "of a grid on the GPU: an order m of a point at a time, or a point with all its coefficients");
  v.choice("spheres", spheres, {"sphere", "disk"},
           "sphere lights as they are, or as disks that face the point");
}

void ShDirectIntegrator::load(const Scene& scene, const Stop& stop, PassStats& stats) {
  if (scene.lights().empty())
    throw SceneError(where_ +
                     ": found a scene without lights, expected at least one: there is nothing to project");
  scene_ = &scene;
  const auto start = std::chrono::steady_clock::now();
  receiver_ = ShReceiver(params_, scene.materials(), stop);
  ShLightOptions options;
  options.bands = receiver_.most_light_bands();
  options.polygons = params_.polygons;
  // The zonal product knows caps alone.
  const bool zonal = params_.product == ShDirectParams::Product::zonal;
  if (zonal) refuse_lobeless(scene);
  refuse_deringing();
  if (zonal && (params_.polygons == ShLightOptions::Polygons::exact ||
                params_.polygons == ShLightOptions::Polygons::factorized))
    options.polygons = ShLightOptions::Polygons::main;
  options.split_error = params_.split_error, options.split_distance = params_.split_distance;
  options.tolerance = params_.tolerance, options.texture_error = params_.texture_error;
  options.shape =
      params_.spheres == ShDirectParams::Spheres::disk ? sh::LightShape::disk : sh::LightShape::sphere;
  const bool ratio = params_.occlusion == ShDirectParams::Occlusion::ratio;
  groups_.clear();
  lights_ = 0;
  for (const auto& lights : light_groups(scene.lights(), ratio ? params_.groups : 1)) {
    Group group;
    group.lights = ShLights(lights, options);
    if (ratio) group.selector = LightSelector(lights);
    groups_.push_back(std::move(group));
    lights_ += groups_.back().lights.count();
  }
  refuse_too_large_a_grid();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  stats.numbers["projection_seconds"] = spent.count();
  stats.numbers["projected_lights"] = lights_;
  stats.numbers["light_bands"] = receiver_.most_light_bands();
}

void ShDirectIntegrator::refuse_lobeless(const Scene& scene) const {
  if (params_.at != ShDirectParams::At::pixel)
    throw SceneError(where_ +
                     ": /product: found \"zonal\" with \"at\" on a grid, expected \"at\": \"pixel\": what is "
                     "interpolated is no longer symmetric");
  for (const auto& material : scene.materials()) {
    const Bsdf bsdf = material->at(vec2(0.5f));
    const std::string reason = bsdf.kind == BsdfKind::lambert ? "" : zonal_lobe_refusal(bsdf);
    if (!reason.empty())
      throw SceneError(where_ + ": /product: found \"zonal\", but the material \"" + material->name + "\" " +
                       reason);
  }
}

void ShDirectIntegrator::refuse_deringing() const {
  if (params_.window != ShDirectParams::Window::dering) return;
  const char* beside = params_.product == ShDirectParams::Product::zonal        ? "\"product\": \"zonal\""
                       : params_.windowed == ShDirectParams::Windowed::material ? "\"windowed\": \"material\""
                                                                                : nullptr;
  if (beside)
    throw SceneError(
        fmt::format("{}: /window: found \"dering\" beside {}, expected another window: it is a point's "
                    "light as a whole that is deringed",
                    where_, beside));
}

void ShDirectIntegrator::refuse_too_large_a_grid() const {
  if (params_.at != ShDirectParams::At::grid || params_.grid == kAuto) return;
  const double bytes = ShGrid::bytes(params_.grid, params_.scheme, receiver_.most_light_bands());
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  if (bytes > memory)
    throw SceneError(
        fmt::format("{}: /grid: found {}, whose points would take up to {:.3g} bytes, expected at most the "
                    "{:.3g} bytes of this machine's memory",
                    where_, params_.grid, bytes, memory));
}

void ShDirectIntegrator::begin_pass(const Pass& pass, const Stop& stop, PassStats& stats) {
  if (scene_ != &pass.scene) load(pass.scene, stop, stats);
  if (params_.at == ShDirectParams::At::pixel) return;
  ShSeen seen = look_around(pass.scene, pass.camera, stop);
  if (searches()) thin_probes(seen);
  if (params_.at == ShDirectParams::At::octree) {
    for (Group& group : groups_) build_octree(group, seen, stop, stats);
    return;
  }
  if (params_.grid != kAuto) chosen_ = params_.grid;
  if (chosen_ == 0) choose_grid(seen, stop, stats);
  build_grids(seen, seen.positions, chosen_, !grids_left_empty_, stop);
  stats.numbers["grid"] = chosen_;
  stats.numbers["grid_points"] = groups_[0].grid.built_points();
}

/// Whether this pass has to find its grid or octree first.
bool ShDirectIntegrator::searches() const {
  if (params_.at == ShDirectParams::At::grid) return params_.grid == kAuto && chosen_ == 0;
  return params_.octree_points == 0 && groups_[0].octree_points == 0;
}

void ShDirectIntegrator::thin_probes(ShSeen& seen) const {
  std::vector<const ShLights*> lights;
  for (const Group& group : groups_) lights.push_back(&group.lights);
  constexpr int kProbes = 256;
  seen.thin(kProbes, lights);
}

/// Cells are cubes, or nearly: the shorter sides have as many points as keep them so.
void ShDirectIntegrator::build_grids(const ShSeen& seen, std::span<const vec3> wanted, int points_a_side,
                                     bool compute, const Stop& stop) {
  const Box box = Box::around(seen.positions);
  const vec3 extent = box.high - box.low;
  const float cell = max_component(extent) / float(points_a_side - 1);
  const ivec3 points = glm::max(ivec3(glm::ceil(extent / cell - 1e-3f)) + 1, 2);
  for (Group& group : groups_) {
    group.grid = ShGrid(box, points, params_.scheme, receiver_.most_light_bands());
    group.grid.need(wanted);
    if (compute) group.grid.build(group.lights, stop);
  }
}

/// What the probes reflect of the groups' lights as it is interpolated against `exact`: RMSE over mean.
double ShDirectIntegrator::probed_error(const ShSeen& seen, std::span<const vec3> exact,
                                        std::span<const Group> groups) const {
  double squares = 0, sum = 0, weights = 0;
  for (size_t i = 0; i < exact.size(); ++i) {
    const double weight = seen.probes[i].weight;
    vec3 off = -exact[i];
    for (const Group& group : groups)
      off += reflected(group, seen.probes[i].surface, seen.probes[i].bsdf, false);
    weights += weight, squares += weight * glm::dot(off, off);
    sum += weight * (double(exact[i].x) + exact[i].y + exact[i].z);
  }
  return sum > 0 ? std::sqrt(squares * 3 * weights) / sum : 0;
}

namespace {
constexpr int kMostGrid = 192, kMostOctreePoints = 1 << 20;
}

/// The coarsest grid of a series that meets `grid_error` at points spread over the picture.
void ShDirectIntegrator::choose_grid(const ShSeen& seen, const Stop& stop, PassStats& stats) {
  std::vector<vec3> exact, places;
  for (const ShSeen::Probe& p : seen.probes) {
    vec3 sum(0);
    for (const Group& group : groups_) sum += reflected(group, p.surface, p.bsdf, true);
    exact.push_back(sum), places.push_back(p.surface.position);
  }
  double error = 0;
  for (chosen_ = 4; !stop(); chosen_ = chosen_ * 4 / 3 + 1) {
    build_grids(seen, places, chosen_, true, stop);
    error = probed_error(seen, exact, groups_);
    if (error <= params_.grid_error || chosen_ > kMostGrid) break;
  }
  stats.numbers["grid_error_measured"] = error;
  if (error > params_.grid_error)
    stats.warnings.push_back(fmt::format(
        "grid: {} points a side leave an error of {:.2g}; \"at\": \"octree\" or \"pixel\" is for this scene",
        chosen_, error));
}

/// Refined until the error at points spread over the picture is `grid_error`, or up to the points wanted.
void ShDirectIntegrator::build_octree(Group& group, const ShSeen& seen, const Stop& stop, PassStats& stats) {
  group.octree = ShOctree(Box::around(seen.positions), receiver_.most_light_bands(), seen.positions);
  const int wanted = params_.octree_points > 0 ? params_.octree_points : group.octree_points;
  if (wanted > 0) {
    group.octree.build(
        group.lights, wanted, [] { return false; }, stop);
  } else {
    std::vector<vec3> exact;
    for (const ShSeen::Probe& p : seen.probes) exact.push_back(reflected(group, p.surface, p.bsdf, true));
    double error = 0;
    const auto good_enough = [&] {
      error = probed_error(seen, exact, {&group, 1});
      return error <= params_.grid_error;
    };
    group.octree.build(group.lights, kMostOctreePoints, good_enough, stop);
    group.octree_points = group.octree.points();
    stats.numbers["grid_error_measured"] = std::max(stats.numbers["grid_error_measured"], error);
  }
  stats.numbers["octree_points"] += group.octree.points(),
      stats.numbers["octree_leaves"] += group.octree.leaves();
}

vec3 ShDirectIntegrator::reflected(const Group& group, const Surface& s, const Bsdf& bsdf,
                                   bool exactly) const {
  using At = ShDirectParams::At;
  if (params_.product == ShDirectParams::Product::zonal) return receiver_.shade_zonal(s, bsdf, group.lights);
  const int bands = receiver_.light_bands(s, bsdf);
  float L[3 * kMostShBands * kMostShBands];
  const bool found =
      !exactly && ((params_.at == At::grid && group.grid.interpolate(s.position, bands, L)) ||
                   (params_.at == At::octree && group.octree.interpolate(s.position, bands, L)));
  if (!found) group.lights.coefficients(bands, s.position, L);
  return receiver_.shade(s, bsdf, bands, L);
}

vec3 ShDirectIntegrator::reflected(const Surface& s, const Bsdf& bsdf, Sampler& sampler,
                                   TileStats& stats) const {
  using Occlusion = ShDirectParams::Occlusion;
  vec3 sum(0);
  for (const Group& group : groups_) {
    vec3 some = reflected(group, s, bsdf, false);
    if (params_.occlusion == Occlusion::ratio)
      some *= shadow_ratio(*scene_, group.selector, s, bsdf, params_.rays, sampler, stats);
    sum += some;
  }
  if (params_.occlusion == Occlusion::ambient) {
    const float reach = params_.reach > 0 ? params_.reach : 0.1f * scene_->bounds().radius;
    sum *= ambient_openness(*scene_, s, params_.rays, reach, sampler, stats);
  }
  return sum;
}

void ShDirectIntegrator::shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop,
                               TileStats& stats) const {
  const Light* sky = scene_->environment();
  for (int i = 0; i < tile.count; ++i) {
    if (stop()) return;
    if (!tile.found(i)) {
      radiance[i] = sky ? sky->radiance({.normal = tile.directions[i]}, -tile.directions[i]) : vec3(0);
      continue;
    }
    const Surface& s = tile.surfaces[i];
    radiance[i] = scene_->emitted(s);
    if (tile.bsdfs[i].kind == BsdfKind::black) continue;
    const vec3 sum = reflected(s, tile.bsdfs[i], samplers[i], stats);
    stats.light_evaluations += static_cast<uint64_t>(lights_);
    // Bands ring below zero; next to a light without size the sum may leave float's range.
    for (int c = 0; c < 3; ++c) radiance[i][c] += std::isfinite(sum[c]) ? std::max(sum[c], 0.0f) : 0.0f;
  }
}

}  // namespace zonal
