#include "lights/virtual_lights.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/sampling.h"
#include "lights/emission_grid.h"

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
    uint32_t first;  ///< number of the first cell's path
  };
  struct Path {
    uint32_t light;
    uint32_t index;  ///< in the light's own low-discrepancy sequence, which runs on from pass to pass
    float weight;    ///< of the light's power: 1 / expected number of its paths
  };
  std::vector<Grid> grids;
  std::vector<Path> paths;
  uint32_t cells = 0;  ///< of all grids

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
      const EmissionGrid grid(*lights[i], share);
      if (grid.cells() <= 2 * share) {
        plan.grids.push_back({grid, i, plan.cells});
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

/// The first ray of path number `j` and the numbers for the rest of it. Every draw is of a fixed dimension.
EmissionSample begin_path(const Scene& scene, const Plan& plan, const VirtualLightOptions& options,
                          uint32_t j, uint32_t* light, Sampler* sampler) {
  const uint64_t seed = options.seed + kSeedOffset;
  if (j < plan.cells) {
    const auto after =
        std::upper_bound(plan.grids.begin(), plan.grids.end(), j,
                         [](uint32_t number, const Plan::Grid& g) { return number < g.first; });
    const Plan::Grid& grid = *(after - 1);
    const uint32_t cell = j - grid.first;
    // Inside a cell the passes are stratified; beyond the first surface the cells of all passes are.
    *light = grid.light;
    *sampler =
        Sampler(seed, hash32(grid.light, 1), options.pass * static_cast<uint32_t>(grid.cells.cells()) + cell);
    Sampler jitter(seed, hash32(grid.light, 2, cell), options.pass);
    return grid.cells.sample(static_cast<int>(cell), jitter.next_2d());
  }
  const Plan::Path& path = plan.paths[j - plan.cells];
  *light = path.light;
  *sampler = Sampler(seed, hash32(path.light, 3), path.index);
  const vec2 u_position = sampler->next_2d(), u_direction = sampler->next_2d();
  EmissionSample ray = scene.lights()[path.light]->sample_emission(u_position, u_direction);
  ray.power *= path.weight;
  return ray;
}

/// Stores a virtual light where the path meets a surface, up to `bounces` times.
void follow_path(const Scene& scene, EmissionSample ray, uint32_t primary, int bounces, Sampler sampler,
                 VirtualLightSet* out) {
  float primary_distance = 0;
  for (int bounce = 1; bounce <= bounces && !is_black(ray.power); ++bounce) {
    const Hit hit = scene.intersect(ray.origin, ray.direction);
    ++out->rays;
    if (!hit.found()) return;
    if (bounce == 1) primary_distance = hit.t;

    const Surface s = scene.surface(hit, ray.direction);
    const Bsdf bsdf = scene.bsdf(s);
    const float cos_shading = glm::dot(s.shading.z, s.w_out), cos_geometric = glm::dot(s.normal, s.w_out);
    if (bsdf.kind == BsdfKind::black || !(cos_shading > 0) || !(cos_geometric > 0)) return;
    const vec3 power = ray.power * (cos_shading / cos_geometric);
    out->lights.push_back({s.position, s.normal, s.shading, s.w_out, power, bsdf,
                           static_cast<uint32_t>(bounce), primary, primary_distance, s.material,
                           offset_origin(s, s.normal)});
    if (bounce == bounces) return;

    // Reflect the flux: f cos/pdf is asked with the shading cosine, light that leaves counts by the geometric
    // one.
    const float u_lobe = sampler.next_1d();
    const vec2 u = sampler.next_2d();
    const BsdfSample next =
        sample(bsdf, prepare(bsdf, s.shading.to_local(s.w_out), PathEnd::light), u_lobe, u);
    if (!(next.pdf > 0) || !(next.w_in.z > 0)) return;
    const vec3 w = s.shading.to_world(next.w_in);
    const float leaving = glm::dot(s.normal, w);
    if (!(leaving > 0)) return;
    const vec3 reflected = power * next.weight * (leaving / next.w_in.z);

    // Russian roulette by what the surface reflects: later lights are fewer, not weaker.
    const float survival = std::fmin(1.0f, max_component(reflected) / max_component(power));
    if (!(sampler.next_1d() < survival)) return;
    ray = {offset_origin(s, w), w, reflected / survival};
  }
}

/// Follows the plan's paths numbered [first, end).
void follow_paths(const Scene& scene, const Plan& plan, const VirtualLightOptions& options, uint32_t first,
                  uint32_t end, VirtualLightSet* out) {
  for (uint32_t j = first; j < end; ++j) {
    uint32_t light = 0;
    Sampler sampler;
    const EmissionSample ray = begin_path(scene, plan, options, j, &light, &sampler);
    follow_path(scene, ray, light, options.bounces, sampler, out);
  }
}

/// How many paths leave about `options.lights` lights: by a pilot of its own random numbers, the same
/// whatever the seed and pass, so that the set's expectation does not depend on its own outcome.
uint32_t paths_wanted(const Scene& scene, VirtualLightOptions options) {
  const auto lights = static_cast<double>(options.lights);
  options.seed = kPilotSeed, options.pass = 0;
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
  for (const auto& light : scene.lights()) {
    if (is_black(light->power())) continue;
    ++lit;
    if (listed == 3) continue;
    names += fmt::format("{}{} \"{}\"", listed++ ? ", " : "", light->type(), light->name);
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

  // Each task fills its own part; joined in order they are the same on any number of threads.
  std::vector<VirtualLightSet> parts((plan.size() + kChunk - 1) / kChunk);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    if (stop()) return;
    const auto first = static_cast<uint32_t>(part) * kChunk, end = std::min(plan.size(), first + kChunk);
    follow_paths(scene, plan, options, first, end, &parts[part]);
  });
  size_t count = 0;
  for (const VirtualLightSet& part : parts) count += part.lights.size();
  set.lights.reserve(count);
  for (const VirtualLightSet& part : parts) {
    set.lights.insert(set.lights.end(), part.lights.begin(), part.lights.end());
    set.rays += part.rays;
  }
  if (set.lights.empty() && !stop()) set.warnings.push_back(missed_warning(scene));
  return set;
}

}  // namespace zonal
