// Speed of sh_direct's parts, one thread: the radiance field on a grid, triangles against spheres, the
// product with the clamped cosine. Medians of interleaved rounds.
//
//     build/bench_sh_direct [field | triangles | products]
//     build/bench_sh_direct octree SCENE.json
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/sh_direct/sh_octree.h"
#include "integrators/sh_direct/sh_receiver.h"
#include "integrators/sh_direct/sh_seen.h"
#include "sh/clamped_cosine.h"
#include "sh/products.h"
#include "sh/rotation.h"

namespace zonal {
namespace {

struct Row {
  std::string name;
  std::function<void()> call;
  double seconds = 0;  ///< median
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The rows take turns; each round repeats a row until it has taken about 2 ms.
void measure(std::vector<Row>& rows, int rounds = 9) {
  std::vector<std::vector<double>> times(rows.size());
  std::vector<int> calls;
  for (Row& row : rows) {
    row.call();
    const double start = now();
    row.call();
    calls.push_back(std::max(1, int(2e-3 / (now() - start + 1e-9))));
  }
  for (int round = 0; round < rounds; ++round)
    for (size_t r = 0; r < rows.size(); ++r) {
      const double start = now();
      for (int i = 0; i < calls[r]; ++i) rows[r].call();
      times[r].push_back((now() - start) / calls[r]);
    }
  for (size_t r = 0; r < rows.size(); ++r) {
    std::nth_element(times[r].begin(), times[r].begin() + rounds / 2, times[r].end());
    rows[r].seconds = times[r][rounds / 2];
  }
}

using Lights = std::vector<std::unique_ptr<Light>>;

Lights spheres(int count) {
  std::mt19937 bits(1);
  std::uniform_real_distribution<float> number(-1, 1);
  Lights lights;
  while (int(lights.size()) < count) {
    const vec3 p(number(bits), number(bits), number(bits));
    if (max_component(glm::abs(p)) < 0.5f) continue;
    auto light = std::make_unique<SphereLight>();
    light->center = 4.0f * p, light->radius = 0.1f;
    light->emission = glm::abs(vec3(number(bits), number(bits), number(bits)));
    lights.push_back(std::move(light));
  }
  return lights;
}

/// A square of 2 x 2 m cut in 2 side^2 triangles, at z = -1.5 (the thesis' figure 4.8).
Lights square(int side) {
  Lights lights;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const float h = 2.0f / float(side), x = -1 + h * float(column), y = -1 + h * float(row);
      const vec3 a(x, y, -1.5f), b(x + h, y, -1.5f), c(x + h, y + h, -1.5f), d(x, y + h, -1.5f);
      lights.push_back(std::make_unique<TriangleLight>(std::vector<MeshLight::Triangle>{{a, b, c}, {a, c, d}},
                                                       vec3(float(row), float(column), 1), true));
    }
  return lights;
}

/// What the points of an 8^3 grid over the cube [-1,1]^3 hold.
std::function<void()> field(std::shared_ptr<ShLights> lights, ShScheme scheme, int bands) {
  auto out = std::make_shared<std::vector<float>>(size_t(scheme.parts()) * 3 * sh::count(bands));
  return [=] {
    for (int i = 0; i < 512; ++i) {
      const vec3 x = vec3(i % 8, i / 8 % 8, i / 64) * (2 / 7.0f) - 1.0f;
      compute_grid_point(*lights, scheme, bands, x, 0.01f, 2 / 7.0f, out->data());
    }
  };
}

constexpr ShScheme kValues{ShScheme::Interpolation::linear}, kGradients{},
    kMixed{ShScheme::Interpolation::hermite, ShScheme::Mixed::hessian};

void fields() {
  for (const int bands : {5, 9})
    for (const int count : {500, 2500}) {
      const auto lights = std::make_shared<ShLights>(spheres(count), ShLightOptions{.bands = bands});
      std::vector<Row> rows{{"coefficients", field(lights, kValues, bands)},
                            {"with gradients", field(lights, kGradients, bands)},
                            {"with mixed derivatives too", field(lights, kMixed, bands)}};
      measure(rows);
      std::printf("%d RGB spheres, %d bands, 8^3 points\n", count, bands);
      for (const Row& row : rows)
        std::printf("  %-28s %8.2f ms  %5.2f x\n", row.name.c_str(), row.seconds * 1e3,
                    row.seconds / rows[0].seconds);
    }
}

void triangles() {
  using Polygons = ShLightOptions::Polygons;
  const Lights walls = square(18), balls = spheres(648);
  for (const int bands : {5, 9}) {
    const auto of = [&](const Lights& lights, Polygons polygons) {
      return std::make_shared<ShLights>(lights, ShLightOptions{.bands = bands, .polygons = polygons});
    };
    for (const ShScheme& scheme : {kValues, kGradients}) {
      std::vector<Row> rows{
          {"spheres", field(of(balls, Polygons::exact), scheme, bands)},
          {"triangles, main", field(of(walls, Polygons::main), scheme, bands)},
          {"triangles, alternative", field(of(walls, Polygons::alternative), scheme, bands)},
          {"triangles, exact", field(of(walls, Polygons::exact), scheme, bands)}};
      measure(rows);
      std::printf("648 lights, %d bands, 8^3 points, %s\n", bands,
                  scheme.parts() > 1 ? "coefficients and gradients" : "coefficients");
      for (const Row& row : rows)
        std::printf("  %-28s %8.2f ms  %5.2f x\n", row.name.c_str(), row.seconds * 1e3,
                    row.seconds / rows[0].seconds);
    }
  }
}

void products() {
  for (const int bands : {3, 5, 7, 9}) {
    std::vector<float> light(size_t(sh::count(bands)), 0.3f), cosine(light.size()), out(light.size());
    sh::clamped_cosine_zonal(bands, cosine.data());
    const vec3 normal = glm::normalize(vec3(1, 2, 3));
    std::vector<float> turned(light.size());
    std::vector<float> zonal(cosine.begin(), cosine.begin() + bands);
    sh::rotate_zonal(bands, normal, zonal.data(), turned.data());
    std::vector<Row> rows{
        {"general (Eq. 2.48)", [&] { sh::product(bands, light.data(), turned.data(), out.data()); }},
        {"turned cosine (Eq. 4.5)",
         [&] { sh::clamped_cosine_product_low_order(bands, bands, normal, light.data(), out.data()); }},
        {"turned, 3 bands",
         [&] {
           sh::clamped_cosine_product_low_order(bands, std::min(3, bands), normal, light.data(), out.data());
         }},
        {"in world (Eq. 4.6 turned)",
         [&] { sh::clamped_cosine_product_in_world(bands, normal, light.data(), out.data()); }},
        {"local (Eq. 4.6)", [&] { sh::clamped_cosine_product(bands, light.data(), out.data()); }}};
    measure(rows);
    std::printf("product with the clamped cosine, %d bands\n", bands);
    for (const Row& row : rows)
      std::printf("  %-28s %8.1f ns  %6.1f times faster\n", row.name.c_str(), row.seconds * 1e9,
                  rows[0].seconds / row.seconds);
  }
}

/// Uniform Hermite grids and octrees of a scene, at what the camera sees at 320 x 180: time to build, and the
/// radiance's RMSE against at: pixel, not clamped. Both cover the same box and skip what is not seen.
void trees(const std::string& file) {
  const Scene scene = load_scene(file, {.width = 320, .height = 180});
  const ShReceiver receiver({}, scene.materials(), {});
  const int bands = receiver.most_light_bands();
  const ShLights lights(scene.lights(), {.bands = bands});
  const ShSeen seen = look_around(scene, scene.camera(), {});
  const Box box = Box::around(seen.positions);
  // Every fourth tile's pixels.
  std::vector<ShSeen::Probe> pixels;
  for (int row = 0; row < 22; ++row)
    for (int column = row % 2; column < 40; column += 2) {
      Tile tile;
      std::array<Sampler, kTilePixels> samplers;
      trace_tile(scene, scene.camera(), ivec2(column, row) * 8, 0, 0, false, &tile, samplers.data());
      for (int i = 0; i < tile.count; ++i)
        if (tile.found(i) && tile.bsdfs[i].kind != BsdfKind::black)
          pixels.push_back({tile.surfaces[i], tile.bsdfs[i]});
    }
  std::vector<vec3> exact;
  std::vector<float> L(3 * size_t(sh::count(bands)));
  double mean = 0;
  for (const auto& p : pixels) {
    lights.coefficients(bands, p.surface.position, L.data());
    exact.push_back(receiver.shade(p.surface, p.bsdf, bands, L.data()));
    mean += (exact.back().x + exact.back().y + exact.back().z) / 3 / double(pixels.size());
  }
  const auto error = [&](const auto& field) {
    double squares = 0;
    for (size_t i = 0; i < pixels.size(); ++i) {
      field.interpolate(pixels[i].surface.position, bands, L.data());
      const vec3 off = receiver.shade(pixels[i].surface, pixels[i].bsdf, bands, L.data()) - exact[i];
      squares += glm::dot(off, off) / 3;
    }
    return std::sqrt(squares / double(pixels.size())) / mean;
  };
  struct Built {
    std::string name;
    double seconds, error;
  };
  std::vector<Built> uniform, adaptive;
  const auto median_of_three = [](const std::function<void()>& build) {
    std::vector<double> times;
    for (int i = 0; i < 3; ++i) {
      const double start = now();
      build();
      times.push_back(now() - start);
    }
    std::sort(times.begin(), times.end());
    return times[1];
  };
  for (const ShScheme& scheme : {kGradients, kMixed})
    for (int side = 8; side <= 160; side = side * 5 / 4 + 1) {
      ShGrid grid;
      const double seconds = median_of_three([&] {
        const vec3 extent = box.high - box.low;
        const float cell = max_component(extent) / float(side - 1);
        grid = ShGrid(box, glm::max(ivec3(glm::ceil(extent / cell - 1e-3f)) + 1, 2), scheme, bands);
        grid.need(seen.positions);
        grid.build(lights, {});
      });
      uniform.push_back({std::to_string(side) + (scheme.parts() > 4 ? " hessian, " : " differences, ") +
                             std::to_string(grid.built_points()) + " points",
                         seconds, error(grid)});
    }
  for (int points = 200; points <= 12800; points = points * 7 / 5) {
    ShOctree tree;
    const double seconds = median_of_three([&] {
      tree = ShOctree(box, bands, seen.positions);
      tree.build(lights, points, [] { return false; }, {});
    });
    adaptive.push_back({std::to_string(tree.points()) + " points", seconds, error(tree)});
  }
  std::printf("%s: error of the radiance over its mean\n", file.c_str());
  for (const auto* list : {&uniform, &adaptive})
    for (const Built& b : *list)
      std::printf("  %-8s %-32s %8.2f ms  %.2e\n", list == &uniform ? "uniform" : "octree", b.name.c_str(),
                  b.seconds * 1e3, b.error);
  for (const double limit : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    const auto best = [&](const std::vector<Built>& list) {
      const Built* found = nullptr;
      for (const Built& b : list)
        if (b.seconds <= limit && (!found || b.error < found->error)) found = &b;
      return found;
    };
    const Built *a = best(uniform), *b = best(adaptive);
    if (a && b)
      std::printf("  within %3.0f ms: octree %+.1f dB\n", limit * 1e3, 20 * std::log10(a->error / b->error));
  }
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what.empty() || what == "field") zonal::fields();
  if (what.empty() || what == "triangles") zonal::triangles();
  if (what.empty() || what == "products") zonal::products();
  if (what == "octree" && argc > 2) zonal::trees(argv[2]);
}
