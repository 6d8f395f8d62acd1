#include "lights/virtual_lights.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/sampling.h"
#include "lights/light_grid.h"

namespace zonal {

namespace {

/// Keeps the numbers drawn here apart from those of the pixels, which are numbered from 0 under the same
/// seed.
constexpr uint64_t kSeedOffset = 0x9e6c63d0876a9a35u;
constexpr uint32_t kChunk = 128;  ///< paths a task follows
constexpr uint32_t kPilotPaths = 256;
constexpr uint64_t kPilotSeed = 0x70696c6f74u;

/// Which rays leave which light in this pass.
struct Plan {
  struct Grid {
    EmissionGrid cells;
    uint32_t light;
    uint32_t first;       ///< number of the first cell's path
    uint32_t first_face;  ///< index of its (first face's) VirtualLightGrid
  };
  struct Path {
    uint32_t light;
    uint32_t index;  ///< in the light's own low-discrepancy sequence, which runs on from pass to pass
    float weight;    ///< of the light's power: 1 / expected number of its paths
  };
  std::vector<Grid> grids;
  std::vector<Path> paths;
  uint32_t cells = 0, faces = 0;  ///< of all grids

  uint32_t size() const { return cells + static_cast<uint32_t>(paths.size()); }
};

/// Shares `count` paths among the lights by power, with one random offset for all (systematic sampling): a
/// light whose share is 3.4 paths gets 3 or 4 of them, 3.4 on average.
void share_paths(const Discrete& by_power, const std::vector<uint32_t>* names, uint32_t count,
                 const VirtualLightOptions& options, std::vector<Plan::Path>* paths) {
  const float offset = Sampler(options.seed + kSeedOffset, kNone, options.pass).next_1d();
  uint32_t previous = kNone, in_light = 0;
  for (uint32_t j = 0; j < count; ++j) {
    // Rounded down to a number a random float could be, for which the probabilities are exact.
    const double u = (j + static_cast<double>(offset)) / count;
    const uint32_t drawn = by_power.sample(static_cast<float>(std::floor(u * 0x1p24) * 0x1p-24));
    in_light = drawn == previous ? in_light + 1 : 0;
    previous = drawn;
    const double expected = static_cast<double>(count) * by_power.probability(drawn);
    const auto stride = static_cast<uint32_t>(std::ceil(expected));
    paths->push_back({names ? (*names)[drawn] : drawn, options.pass * stride + in_light,
                      static_cast<float>(1.0 / expected)});
  }
}

/// Begins about `count` paths.
Plan make_plan(const Scene& scene, const VirtualLightOptions& options, uint32_t count) {
  Plan plan;
  const auto& lights = scene.lights();
  const Discrete& by_power = scene.light_selector().by_power();
  if (!(by_power.total() > 0)) return plan;
  if (options.distribution == VirtualLightOptions::paths) {
    share_paths(by_power, nullptr, count, options, &plan.paths);
    return plan;
  }

  // Lights that suit a grid and whose share fills one get it; the others share the remaining paths.
  std::vector<uint32_t> others;
  std::vector<float> powers;
  double left = 0;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const float power = luminance(lights[i]->power());
    if (!(power > 0) || !std::isfinite(power)) continue;
    const double share = count * (power / by_power.total());
    if (share >= 1 && EmissionGrid::suits(*lights[i])) {
      const EmissionGrid grid(*lights[i], share, options.block_texels);
      if (grid.cells() <= 2 * share) {
        plan.grids.push_back({grid, i, plan.cells, plan.faces});
        plan.faces += static_cast<uint32_t>(grid.faces());
        plan.cells += static_cast<uint32_t>(grid.cells());
        continue;
      }
    }
    others.push_back(i), powers.push_back(power), left += share;
  }
  if (!others.empty())
    share_paths(Discrete(powers), &others, static_cast<uint32_t>(std::max(1L, std::lround(left))), options,
                &plan.paths);
  return plan;
}

/// The first ray of a path and the numbers for the rest of it. Every draw is of a fixed dimension.
EmissionSample begin_path(const Scene& scene, const Plan::Path& path, const VirtualLightOptions& options,
                          Sampler* sampler) {
  *sampler = Sampler(options.seed + kSeedOffset, hash32(path.light, 3), path.index);
  const vec2 u_position = sampler->next_2d(), u_direction = sampler->next_2d();
  EmissionSample ray = scene.lights()[path.light]->sample_emission(u_position, u_direction);
  ray.power *= path.weight;
  return ray;
}

/// Stores `light` and what its flux leaves at the surfaces it reaches after it, up to `bounces` in all.
void follow_path(const Scene& scene, const VirtualLight& light, int bounces, Sampler sampler,
                 VirtualLightSet* out) {
  out->lights.push_back(light);
  VirtualLight v = light;
  for (int bounce = 2; bounce <= bounces && !is_black(v.power); ++bounce) {
    // Reflect the flux: f cos/pdf is asked with the shading cosine, light that leaves counts by the geometric
    // one.
    const float u_lobe = sampler.next_1d();
    const vec2 u = sampler.next_2d();
    const BsdfContext view = prepare(v.bsdf, v.frame.to_local(v.w_in), PathEnd::light);
    const BsdfSample next = sample(v.bsdf, view, u_lobe, u);
    if (!(next.pdf > 0) || !(next.w_in.z > 0)) return;
    const vec3 w = v.frame.to_world(next.w_in);
    const float leaving = glm::dot(v.normal, w);
    if (!(leaving > 0)) return;
    const vec3 reflected = v.power * next.weight * (leaving / next.w_in.z);

    // Russian roulette by what the surface reflects: later lights are fewer, not weaker.
    const float survival = std::fmin(1.0f, max_component(reflected) / max_component(v.power));
    if (!(sampler.next_1d() < survival)) return;
    const EmissionSample ray{v.shadow_point, w, reflected / survival};
    const auto landed = land(scene, ray, &out->rays);
    if (!landed) return;
    v = *landed;
    v.bounce = static_cast<uint32_t>(bounce), v.primary = light.primary;
    v.primary_distance = light.primary_distance;
    out->lights.push_back(v);
  }
}

/// Follows one cell's block of rays as one path.
void follow_cell(const Scene& scene, const Plan::Grid& grid, uint32_t cell,
                 const VirtualLightOptions& options, VirtualLightSet* out) {
  const uint64_t seed = options.seed + kSeedOffset;
  const auto cells = static_cast<uint32_t>(grid.cells.cells()), per_face = cells / grid.cells.faces();
  const auto first_texel = static_cast<uint32_t>(out->texels.size());
  const CellJob job{static_cast<int>(cell), grid.light, seed, options.pass, options.placement};
  auto light =
      light_of_cell(scene, grid.cells, job, options.keep_texels ? &out->texels : nullptr, &out->rays);
  if (!light) return;
  light->primary = grid.light;
  light->grid = grid.first_face + cell / per_face;
  light->cell = cell % per_face;
  light->first_texel = first_texel;
  light->texel_count = static_cast<uint32_t>(out->texels.size()) - first_texel;
  for (size_t i = first_texel; i < out->texels.size(); ++i) {
    VirtualLight& texel = out->texels[i];
    texel.primary = grid.light, texel.grid = light->grid, texel.cell = light->cell;
  }
  // Inside a cell the passes are stratified; beyond the first surface the cells of all passes are.
  follow_path(scene, *light, options.bounces,
              Sampler(seed, hash32(grid.light, 1), options.pass * cells + cell), out);
}

/// Follows the plan's paths numbered [first, end).
void follow_paths(const Scene& scene, const Plan& plan, const VirtualLightOptions& options, uint32_t first,
                  uint32_t end, VirtualLightSet* out) {
  for (uint32_t j = first; j < end; ++j) {
    if (j < plan.cells) {
      const auto after =
          std::upper_bound(plan.grids.begin(), plan.grids.end(), j,
                           [](uint32_t number, const Plan::Grid& g) { return number < g.first; });
      const Plan::Grid& grid = *(after - 1);
      follow_cell(scene, grid, j - grid.first, options, out);
      continue;
    }
    const Plan::Path& path = plan.paths[j - plan.cells];
    Sampler sampler;
    const EmissionSample ray = begin_path(scene, path, options, &sampler);
    if (is_black(ray.power)) continue;
    if (auto light = land(scene, ray, &out->rays)) {
      light->primary = path.light;
      follow_path(scene, *light, options.bounces, sampler, out);
    }
  }
}

/// How many paths leave about `options.lights` lights: by a pilot of its own random numbers, the same
/// whatever the seed and pass, so that the set's expectation does not depend on its own outcome.
uint32_t paths_wanted(const Scene& scene, VirtualLightOptions options) {
  const auto lights = static_cast<double>(options.lights);
  options.seed = kPilotSeed, options.pass = 0;
  options.block_texels = 1, options.keep_texels = false;
  const Plan plan = make_plan(scene, options, kPilotPaths);
  VirtualLightSet pilot;
  follow_paths(scene, plan, options, 0, plan.size(), &pilot);
  // Where next to nothing is stored, not more than 64 paths are begun for each light asked for.
  const double stored = static_cast<double>(pilot.lights.size()) / std::max(1u, plan.size());
  return static_cast<uint32_t>(std::clamp(std::round(lights / std::max(stored, 1.0 / 64)), 1.0, 4e9));
}

std::string missed_warning(const Scene& scene) {
  std::string names;
  size_t listed = 0, lit = 0;
  for (size_t index = 0; index < scene.lights().size(); ++index) {
    const auto& light = scene.lights()[index];
    if (is_black(light->power())) continue;
    ++lit;
    if (listed == 3) continue;
    names += fmt::format(
        "{}{} {}", listed++ ? ", " : "", light->type(),
        light->name.empty() ? fmt::format("light {}", index) : fmt::format("\"{}\"", light->name));
  }
  if (lit == 0) return "no light of the scene emits anything: there are no virtual lights";
  if (lit > listed) names += fmt::format(" and {} more", lit - listed);
  return fmt::format("no virtual lights: what these lights emit meets no reflecting surface: {}", names);
}

}  // namespace

std::array<uint32_t, 8> VirtualLightSet::neighbours(uint32_t light) const {
  std::array<uint32_t, 8> found;
  found.fill(kNone);
  const VirtualLight& v = lights[light];
  if (v.grid == kNone) return found;
  const VirtualLightGrid& grid = grids[v.grid];
  const int column = static_cast<int>(v.cell) % grid.columns, row = static_cast<int>(v.cell) / grid.columns;
  int slot = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int c = column + dx, r = row + dy;
      if (c >= 0 && r >= 0 && c < grid.columns && r < grid.rows) found[slot] = grid.at[r * grid.columns + c];
      ++slot;
    }
  }
  return found;
}

namespace {

void join(const std::vector<VirtualLightSet>& parts, VirtualLightSet* set) {
  size_t lights = 0, texels = 0;
  for (const VirtualLightSet& part : parts) lights += part.lights.size(), texels += part.texels.size();
  set->lights.reserve(lights), set->texels.reserve(texels);
  for (const VirtualLightSet& part : parts) {
    const auto first_texel = static_cast<uint32_t>(set->texels.size());
    set->texels.insert(set->texels.end(), part.texels.begin(), part.texels.end());
    for (VirtualLight light : part.lights) {
      if (light.grid != kNone) {
        set->grids[light.grid].at[light.cell] = static_cast<uint32_t>(set->lights.size());
        light.first_texel += first_texel;
      }
      set->lights.push_back(light);
    }
    set->rays += part.rays;
  }
}

}  // namespace

VirtualLightSet make_virtual_lights(const Scene& scene, const VirtualLightOptions& options,
                                    const Stop& stop) {
  VirtualLightSet set;
  for (const auto& light : scene.lights()) set.emitted_power += light->power();
  const Plan plan = make_plan(scene, options, paths_wanted(scene, options));
  const auto strongest =
      std::max_element(plan.grids.begin(), plan.grids.end(),
                       [](const auto& a, const auto& b) { return a.cells.cells() < b.cells.cells(); });
  if (strongest != plan.grids.end())
    set.columns = strongest->cells.columns(), set.rows = strongest->cells.rows();

  for (const Plan::Grid& grid : plan.grids) {
    VirtualLightGrid map;
    map.primary = grid.light, map.columns = grid.cells.columns(), map.rows = grid.cells.rows();
    map.fov = grid.cells.fov();
    map.spot = dynamic_cast<const SpotLight*>(scene.lights()[grid.light].get()) != nullptr;
    map.at.assign(static_cast<size_t>(map.columns) * map.rows, kNone);
    for (int face = 0; face < grid.cells.faces(); ++face) set.grids.push_back(map);
  }

  // Each task fills its own part; joined in order they are the same on any number of threads.
  const uint32_t chunk = std::max(1u, kChunk / static_cast<uint32_t>(sqr(options.block_texels)));
  std::vector<VirtualLightSet> parts((plan.size() + chunk - 1) / chunk);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    if (stop()) return;
    const auto first = static_cast<uint32_t>(part) * chunk, end = std::min(plan.size(), first + chunk);
    follow_paths(scene, plan, options, first, end, &parts[part]);
  });
  join(parts, &set);
  if (set.lights.empty() && !stop()) set.warnings.push_back(missed_warning(scene));
  return set;
}

}  // namespace zonal
