#include "integrators/many_lights.h"

#include <algorithm>
#include <bit>

#include "core/render.h"
#include "integrators/direct.h"

namespace zonal {

void ManyLightsParams::visit(ParamVisitor& v, const Has& has) {
  v.integer("lights", lights, {1, 1e8}, "lights",
            "virtual lights stored in all, after all bounces, shared among primaries by power");
  v.integer("bounces", bounces, {1, 1000}, "bounces",
            "generations of virtual lights; direct light is bounce 0");
  v.integer("pass_lights", pass_lights, {0, 1e8}, "lights",
            "lights of one pass; 0: all, or what keeps a pass below a tenth of a given time");
  v.choice("distribution", distribution, {"grid", "paths"},
           "grid over a reflective shadow map (spot, point, directional lights), or light paths");
  v.integer("block_texels", block_texels, {1, 256}, "texels",
            "side of the block of map texels, one ray each, whose flux one light of a grid holds");
  v.choice("placement", placement, {"sampled", "center"},
           "where in its block a light stands: drawn by flux, or in the middle, the same every pass");
  v.choice("direct", direct, {"sampled", "none"}, "who renders direct light");
  v.integer("direct_samples", direct_samples, {1, 1e6}, "samples",
            "pairs of light and BRDF rays a pixel and pass");
  std::vector<std::string> names = {"none", "center", "sphere"};
  names.resize(static_cast<size_t>(has.occlusions));
  v.choice("occlusion", occlusion, names, "what blocks light on its way from a virtual light");
  if (has.split)
    v.number(
        "split", split, {0, 1e6}, "widths",
        "points nearer to a light than so many widths of its block gather the block's texels one by one; 0: "
        "none");
  if (has.skip)
    v.number(
        "skip", skip, {0, 1}, "",
        "a light that cannot bring a tile this share of what it has received before is left out; what that "
        "loses at most is in the statistics. 0: none");
}

namespace {

VirtualLightOptions tracing_options(const ManyLightsParams& params, const Pass& pass, int lights) {
  VirtualLightOptions options;
  options.lights = lights;
  options.bounces = params.bounces;
  options.distribution = params.distribution == ManyLightsParams::Distribution::grid
                             ? VirtualLightOptions::grid
                             : VirtualLightOptions::paths;
  options.seed = pass.seed;
  options.pass = static_cast<uint32_t>(pass.index);
  options.block_texels = params.block_texels;
  options.placement = params.placement == ManyLightsParams::Placement::sampled ? VirtualLightOptions::sampled
                                                                               : VirtualLightOptions::center;
  return options;
}

}  // namespace

void ManyLights::trace_lights(const Pass& pass, int count, const Stop& stop, PassStats* stats) {
  if (given_) {
    set_ = *given_;
  } else {
    VirtualLightOptions options = tracing_options(shared_, pass, count);
    options.keep_texels = shared_.split > 0;
    adjust(options);
    set_ = make_virtual_lights(pass.scene, options, stop);
  }
  if (stats) {
    stats->numbers["virtual_lights"] += static_cast<double>(set_.lights.size());
    stats->numbers["light_rays"] += static_cast<double>(set_.rays);
    if (stats->warnings.empty()) stats->warnings = set_.warnings;
  }
  take_lights(pass, stop, stats);
}

/// Lays the present set out in arrays and lets the method prepare them.
void ManyLights::take_lights(const Pass& pass, const Stop& stop, PassStats* stats) {
  PassStats ignored;
  if (!stats) stats = &ignored;
  parts_.clear();
  if (!(shared_.split > 0) || set_.texels.empty()) {
    arrays_ = LightArrays(set_, kBlockLights);
    prepare(pass, set_, arrays_, stop, *stats);
    return;
  }
  const auto whole = static_cast<int>(set_.lights.size());
  for (const VirtualLight& v : set_.lights) {
    const bool block = v.texel_count > 1 && v.footprint > 0;
    parts_.push_back({block ? shared_.split * std::sqrt(v.footprint) : 0.0f,
                      whole + static_cast<int>(v.first_texel), static_cast<int>(v.texel_count)});
  }
  set_.parts = set_.texels.size();
  set_.lights.insert(set_.lights.end(), set_.texels.begin(), set_.texels.end());
  set_.texels.clear();
  arrays_ = LightArrays(set_, kBlockLights);
  arrays_.count = whole;
  prepare(pass, set_, arrays_, stop, *stats);
}

/// A timed render whose pass would take more than a tenth of the time gathers from fewer lights a pass, but
/// not so few that gathering takes less of a pass than all the rest of it. Measured on four tiles spread over
/// the picture, once.
int ManyLights::lights_that_fit(const Pass& pass, const Stop& stop) {
  trace_lights(pass, std::min(shared_.lights, 64), stop, nullptr);
  if (set_.lights.empty()) return shared_.lights;
  const double with_lights = seconds_a_pass(pass, stop);
  const auto count = static_cast<double>(set_.lights.size());
  arrays_.count = 0;
  const double rest = seconds_a_pass(pass, stop);
  const double per_light = std::max(with_lights - rest, 1e-3 * with_lights) / count;
  const double fit = std::max(pass.budget_seconds / 10 - rest, rest) / per_light;
  return static_cast<int>(std::clamp(fit, 1.0, static_cast<double>(shared_.lights)));
}

/// How long shading the whole picture from the present lights will take.
double ManyLights::seconds_a_pass(const Pass& pass, const Stop& stop) const {
  const Camera& camera = pass.camera;
  const auto start = Clock::now();
  Tile tile;
  std::array<Sampler, kTilePixels> samplers;
  std::array<vec3, kTilePixels> radiance;
  TileStats ignored;
  double pixels = 0;
  for (int i = 0; i < 4; ++i) {
    const ivec2 corner(camera.width * (2 * (i % 2) + 1) / 4 / 8 * 8,
                       camera.height * (2 * (i / 2) + 1) / 4 / 8 * 8);
    trace_tile(pass.scene, camera, corner, pass.seed, 0, true, &tile, samplers.data());
    shade(tile, radiance.data(), samplers.data(), stop, ignored);
    pixels += tile.count;
  }
  return seconds_since(start) / pixels * camera.width * camera.height / pass.threads;
}

void ManyLights::begin_pass(const Pass& pass, const Stop& stop, PassStats& stats) {
  scene_ = &pass.scene;
  pass_key_ = hash32(pass.seed, 0x6c696768u, static_cast<uint32_t>(pass.index));
  if (pass.index == 0) {
    pass_lights_ = shared_.pass_lights > 0 ? std::min(shared_.pass_lights, shared_.lights) : shared_.lights;
    if (shared_.pass_lights == 0 && pass.budget_seconds > 0 && !given_)
      pass_lights_ = lights_that_fit(pass, stop);
    stats.numbers["pass_lights"] = pass_lights_;
  }
  trace_lights(pass, pass_lights_, stop, &stats);
}

void ManyLights::shade_direct(const Tile& tile, vec3* radiance, Sampler* samplers, TileStats& stats) const {
  for (int i = 0; i < tile.count; ++i) {
    radiance[i] = vec3(0);
    if (shared_.direct == ManyLightsParams::Direct::none) continue;
    if (!tile.found(i)) {
      if (const Light* sky = scene_->environment())
        radiance[i] = sky->radiance({.normal = tile.directions[i]}, -tile.directions[i]);
      continue;
    }
    radiance[i] = scene_->emitted(tile.surfaces[i]);
    if (tile.bsdfs[i].kind == BsdfKind::black) continue;
    const ShadingPoint point(tile.surfaces[i], tile.bsdfs[i]);
    radiance[i] += sample_direct(*scene_, point, samplers[i], shared_.direct_samples, stats);
  }
}

namespace {

/// A point of the light's sphere on the side of `from`, above the light's surface, uniform in solid angle
/// about the centre; the centre's `target` where that point lies under the shaded point's own surface.
vec3 sphere_target(vec3 center, float radius, vec3 normal, vec3 target, const Surface& from, uint32_t u,
                   uint32_t v) {
  const vec3 to = from.position - center;
  const float d2 = glm::dot(to, to);
  const Frame frame(d2 > 0 ? to / std::sqrt(d2) : normal);
  vec3 s = frame.to_world(uniform_cone({unit_float(u), unit_float(v)}, 1.0f));
  const float height = glm::dot(s, normal);
  if (height < 0) s -= 2.0f * height * normal;
  const vec3 point = target + radius * s;
  return glm::dot(from.normal, point - from.position) > 0 ? point : target;
}

}  // namespace

uint64_t ManyLights::visible(const TilePoints& points, int light, uint64_t wanted, int* rays) const {
  if (shared_.occlusion == Occlusion::none) return wanted;
  const bool sphere = shared_.occlusion == Occlusion::sphere;
  const vec3 center = arrays_.target[light];
  uint64_t seen = 0;
  std::array<int, 8> packet;
  std::array<vec3, 8> origins, targets;
  for (uint64_t left = wanted; left != 0;) {
    int n = 0;
    for (; n < 8 && left != 0; ++n, left &= left - 1) {
      const int k = packet[n] = std::countr_zero(left);
      const Surface& s = points.surface(k);
      targets[n] = center;
      if (sphere) {
        // Over the lights each point walks along a low-discrepancy sequence (Roberts 2018, R2).
        const auto number = static_cast<uint32_t>(light);
        targets[n] = sphere_target(arrays_.position(light), arrays_.radius[light], arrays_.normal(light),
                                   center, s, hash32(points.seed[k], 5) + number * 0xc13fa9a9u,
                                   hash32(points.seed[k], 6) + number * 0x91e10da6u);
      }
      const vec3 to = targets[n] - s.position;
      origins[n] = glm::dot(to, s.normal) > 0 ? points.above[k] : offset_origin(s, to);
    }
    *rays += n;
    const uint32_t blocked = scene_->occluded8(origins.data(), (1u << n) - 1u, targets.data());
    for (int m = 0; m < n; ++m)
      if (!(blocked >> m & 1u)) seen |= uint64_t{1} << packet[m];
  }
  return seen;
}

/// Zeroes what the lights' shadow rays find blocked, light by light in packets of 8 points.
void ManyLights::remove_shadowed(const TilePoints& points, int first, int count, Contributions& c) const {
  for (int j = 0; j < count; ++j) {
    uint64_t lit = 0;
    for (int k = 0; k < points.count; ++k) {
      const int i = c.at(j, k);
      lit |= uint64_t{c.r[i] != 0 || c.g[i] != 0 || c.b[i] != 0} << k;
    }
    uint64_t hidden = lit & ~visible(points, first + j, lit, &c.shadow_rays);
    for (; hidden != 0; hidden &= hidden - 1) {
      const int i = c.at(j, std::countr_zero(hidden));
      c.r[i] = c.g[i] = c.b[i] = 0;
    }
  }
}

namespace {

/// Adds a block up light by light.
void add(const TilePoints& points, int count, const Contributions& c, PointSums& sums) {
  if (c.order == Contributions::Order::by_light) {
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < points.padded; ++k) {
        const int i = j * kTilePixels + k;
        sums.r[k] += c.r[i], sums.g[k] += c.g[i], sums.b[k] += c.b[i];
      }
    return;
  }
  for (int k = 0; k < points.count; ++k) {
    const int row = k * kBlockLights;
    for (int j = 0; j < count; ++j)
      sums.r[k] += c.r[row + j], sums.g[k] += c.g[row + j], sums.b[k] += c.b[row + j];
  }
}

}  // namespace

void ManyLights::gather_sums(const TilePoints& points, int first, int count, PointSums& sums) const {
  Contributions c;
  gather(points, first, count, c);
  add(points, count, c, sums);
}

/// Marks the lights of a block that are worth gathering. A light is skipped whose bound stays below `skip`
/// times what the tile's points have received so far on average; returns how many are.
int ManyLights::choose_lights(const TilePoints& points, const TileBounds& bounds, int first, int count,
                              const PointSums& sums, double* lost, uint8_t* wanted) const {
  const bool hides = horizons_hide();
  for (int j = 0; j < count; ++j) {
    const int l = first + j;
    wanted[j] = !hides || bounds.sees(arrays_.position(l), arrays_.normal(l), arrays_.radius[l]);
  }
  if (!(shared_.skip > 0)) return 0;
  double received = 0;
  for (int k = 0; k < points.count; ++k) received += luminance({sums.r[k], sums.g[k], sums.b[k]});
  const double allowed = shared_.skip * received / points.count;
  int skipped = 0;
  for (int j = 0; j < count; ++j) {
    if (!wanted[j]) continue;
    const double bound = most(points, bounds, first + j);
    if (!(bound <= allowed)) continue;
    *lost += bound;
    wanted[j] = 0;
    ++skipped;
  }
  return skipped;
}

/// Gathers from the lights [first, first + count), all of one block.
void ManyLights::gather_run(const TilePoints& points, int first, int count, PointSums& sums,
                            TileStats& stats) const {
  stats.light_evaluations += static_cast<uint64_t>(points.count) * count;
  if (shared_.occlusion == Occlusion::none && !accounts()) return gather_sums(points, first, count, sums);
  Contributions c;
  gather(points, first, count, c);
  if (shared_.occlusion != Occlusion::none && !gather_traces()) remove_shadowed(points, first, count, c);
  stats.shadow_rays += c.shadow_rays;
  if (accounts()) account(points, first, count, c, stats);
  add(points, count, c, sums);
}

/// Whether a point of the tile is nearer to the light than its texels reach.
bool ManyLights::is_near(const TilePoints& points, const TileBounds& bounds, int light) const {
  const float reach = parts_[light].reach;
  const vec3 p = arrays_.position(light);
  const vec3 off = p - bounds.center;
  if (!(glm::dot(off, off) < sqr(reach + bounds.radius))) return false;
  float near = 0;
#pragma omp simd reduction(+ : near)
  for (int k = 0; k < points.padded; ++k) {
    const float d2 = sqr(p.x - points.x[k]) + sqr(p.y - points.y[k]) + sqr(p.z - points.z[k]);
    near += d2 < sqr(reach) ? 1.0f : 0.0f;
  }
  return near > 0;
}

/// Gathers the texels of those lights of a block that are near, and has their lights left out.
void ManyLights::gather_near(const TilePoints& points, const TileBounds& bounds, int first, int count,
                             uint8_t* wanted, PointSums& sums, TileStats& stats) const {
  if (parts_.empty()) return;
  for (int j = 0; j < count; ++j) {
    if (!wanted[j] || !is_near(points, bounds, first + j)) continue;
    wanted[j] = 0;
    const Parts& parts = parts_[first + j];
    for (int from = 0; from < parts.count; from += kBlockLights)
      gather_run(points, parts.first + from, std::min(kBlockLights, parts.count - from), sums, stats);
  }
}

void ManyLights::shade(const Tile& tile, vec3* radiance, Sampler* samplers, const Stop& stop,
                       TileStats& stats) const {
  shade_direct(tile, radiance, samplers, stats);
  if (arrays_.count == 0) return;
  std::array<uint32_t, kTilePixels> seeds;
  for (int i = 0; i < tile.count; ++i)
    seeds[i] =
        hash32(pass_key_, static_cast<uint32_t>(tile.pixels[i].x), static_cast<uint32_t>(tile.pixels[i].y));
  TilePoints points(tile, seeds.data());
  if (points.count == 0) return;
  const std::unique_ptr<TileState> state = prepare_tile(points);
  points.state = state.get();

  const TileBounds bounds(points);
  PointSums sums;
  double lost = 0;
  for (int first = 0; first < arrays_.count; first += kBlockLights) {
    if (stop()) return;
    const int count = std::min(kBlockLights, arrays_.count - first);
    std::array<uint8_t, kBlockLights> wanted;
    stats.skipped_pairs += static_cast<uint64_t>(points.count) *
                           choose_lights(points, bounds, first, count, sums, &lost, wanted.data());
    gather_near(points, bounds, first, count, wanted.data(), sums, stats);
    // Neighbours that are wanted go together.
    for (int begin = 0; begin < count;) {
      if (!wanted[begin]) {
        ++begin;
        continue;
      }
      int end = begin + 1;
      while (end < count && wanted[end]) ++end;
      gather_run(points, first + begin, end - begin, sums, stats);
      begin = end;
    }
  }
  if (shared_.skip > 0) {
    stats.skipped_bound += lost * points.count;
    for (int k = 0; k < points.count; ++k)
      stats.skipped_total += luminance({sums.r[k], sums.g[k], sums.b[k]});
  }
  for (int k = 0; k < points.count; ++k)
    radiance[points.pixel[k]] += glm::max(vec3(sums.r[k], sums.g[k], sums.b[k]), vec3(0));
}

}  // namespace zonal
