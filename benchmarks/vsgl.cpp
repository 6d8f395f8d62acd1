// Time of gathering from virtual spherical Gaussian lights: nanoseconds a shaded point and light (both its
// lobes), no occlusion, RGB, one thread, medians over rounds.
//
//     build/bench_vsgl
//
// One tile, 64 points of one surface, against 1,024 blocks of 4 x 4 texels on walls of one material. `vpl`
// gathers from the same lights by its own loop. The second table is the fitting of the blocks, nanoseconds a
// texel.
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/render.h"
#include "integrators/vpl/vpl.h"
#include "integrators/vsgl/vsgl.h"

namespace zonal {
namespace {

constexpr int kLights = 1024, kTexels = 16, kRounds = 41;

/// Of this thread on a processor: other programs' turns do not count.
double seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double median_ns(double count, const std::function<void()>& run) {
  std::vector<double> ns(kRounds);
  for (double& value : ns) {
    const double start = seconds();
    run();
    value = (seconds() - start) * 1e9 / count;
  }
  std::nth_element(ns.begin(), ns.begin() + kRounds / 2, ns.end());
  return ns[kRounds / 2];
}

/// What `shade` does with a tile where nothing occludes, without the direct light.
template <class Method>
struct Gathering : Method {
  using Method::Method;
  PointSums sums;
  void run(const Tile& tile) {
    TilePoints points(tile);
    const auto state = this->prepare_tile(points);
    points.state = state.get();
    for (int first = 0; first < kLights; first += kBlockLights)
      this->gather_sums(points, first, kBlockLights, sums);
    asm volatile("" : : "r"(&sums) : "memory");
  }
};

VirtualLightSet walls(const Material& material) {
  VirtualLightSet set;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(0, 1);
  for (int j = 0; j < kLights; ++j) {
    vec3 n(0), p(u(random), u(random), u(random));
    const int axis = j % 3, side = j / 3 % 2;
    n[axis] = side ? -1.0f : 1.0f, p[axis] = float(side);
    VirtualLight light;
    light.first_texel = static_cast<uint32_t>(set.texels.size()), light.texel_count = kTexels;
    for (int t = 0; t < kTexels; ++t) {
      VirtualLight v;
      v.frame = Frame(n), v.normal = n, v.bsdf = material.at(vec2(0));
      v.position = p + v.frame.x * (0.01f * float(t % 4)) + v.frame.y * (0.01f * float(t / 4));
      v.w_in = normalize(n + 0.5f * v.frame.x), v.power = vec3(u(random), u(random), u(random));
      set.texels.push_back(v);
      light = v;
      light.first_texel = static_cast<uint32_t>(set.texels.size()) - 1 - static_cast<uint32_t>(t);
      light.texel_count = kTexels;
    }
    set.lights.push_back(light);
  }
  return set;
}

/// A floor of the material, seen from above at an angle.
Scene floor_scene(std::unique_ptr<Material> material) {
  SceneParts parts;
  parts.materials.push_back(std::move(material));
  ShapeData shape;
  shape.mesh.positions = {{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}};
  shape.mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  shape.material = 0;
  parts.shapes.push_back(std::move(shape));
  parts.camera.position = vec3(0.5f, 0.7f, 2);
  parts.camera.forward = normalize(vec3(0, -0.5f, -1)), parts.camera.up = normalize(vec3(0, 1, -0.5f));
  parts.camera.vertical_fov = 0.1f;
  return Scene(std::move(parts));
}

template <class Method, class Params>
double time_of(const Scene& scene, const VirtualLightSet& set, Params params) {
  params.direct = ManyLightsParams::Direct::none, params.occlusion = Occlusion::none;
  Gathering<Method> method(params);
  method.gather_from(set);
  Film film(8, 8);
  render(scene, method, film, {.passes = 1}, {.threads = 1});
  Tile tile;
  std::array<Sampler, kTilePixels> samplers;
  Camera camera = scene.camera();
  camera.width = camera.height = 8;
  trace_tile(scene, camera, ivec2(0), 0, 0, false, &tile, samplers.data());
  return median_ns(double(kLights) * tile.count, [&] { method.run(tile); });
}

void row(const char* name, std::unique_ptr<Material> material) {
  const VirtualLightSet set = walls(*material);
  const Scene scene = floor_scene(std::move(material));
  VsglParams first, second;
  first.generation = VsglGeneration::y2015;
  std::printf("%-20s %10.2f %10.2f %10.2f %12.1f\n", name, time_of<VplIntegrator>(scene, set, VplParams{}),
              time_of<VsglIntegrator>(scene, set, first), time_of<VsglIntegrator>(scene, set, second),
              median_ns(double(kLights) * kTexels, [&] {
                tbb::task_arena(1).execute([&] { fit_blocks(set, VsglGeneration::y2024, 1); });
              }));
}

void run() {
  std::printf("%-20s %10s %10s %10s %12s\n", "", "vpl ns", "2015 ns", "2024 ns", "fit ns/texel");
  row("lambert", std::make_unique<LambertMaterial>());
  auto blend = std::make_unique<MetallicRoughnessMaterial>();
  row("metallic_roughness", std::move(blend));
  row("coated", std::make_unique<CoatedMaterial>());
  row("conductor", std::make_unique<ConductorMaterial>());
}

}  // namespace
}  // namespace zonal

int main() {
  zonal::run();
}
