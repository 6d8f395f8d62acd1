// Speed of sh_direct's parts, one thread: the radiance field on a grid, triangles against spheres, the
// product with the clamped cosine. Medians of interleaved rounds.
//
//     build/bench_sh_direct [field | triangles | products]
//     build/bench_sh_direct grids | searches SCENE.json...
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/sh_direct/sh_direct.h"
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
          {"triangles, exact", field(of(walls, Polygons::exact), scheme, bands)},
          {"triangles, factorized", field(of(walls, Polygons::factorized), scheme, bands)}};
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

/// What a scene's camera sees at 320 x 180, and what it reflects with at: pixel, not clamped.
struct View {
  Scene scene;
  ShReceiver receiver;
  int bands;
  ShLights lights;
  ShSeen seen;
  Box box;
  std::vector<ShSeen::Probe> pixels;  ///< of every fourth tile
  std::vector<vec3> exact;
  double mean = 0;

  explicit View(const std::string& file)
      : scene(load_scene(file, {.width = 320, .height = 180})),
        receiver({}, scene.materials(), {}),
        bands(receiver.most_light_bands()),
        lights(scene.lights(), {.bands = bands}),
        seen(look_around(scene, scene.camera(), {})),
        box(Box::around(seen.positions)) {
    for (int row = 0; row < 22; ++row)
      for (int column = row % 2; column < 40; column += 2) {
        Tile tile;
        std::array<Sampler, kTilePixels> samplers;
        trace_tile(scene, scene.camera(), ivec2(column, row) * 8, 0, 0, false, &tile, samplers.data());
        for (int i = 0; i < tile.count; ++i)
          if (tile.found(i) && tile.bsdfs[i].kind != BsdfKind::black)
            pixels.push_back({tile.surfaces[i], tile.bsdfs[i]});
      }
    std::vector<float> L(3 * size_t(sh::count(bands)));
    for (const auto& p : pixels) {
      lights.coefficients(bands, p.surface.position, L.data());
      exact.push_back(receiver.shade(p.surface, p.bsdf, bands, L.data()));
      mean += (exact.back().x + exact.back().y + exact.back().z) / 3 / double(pixels.size());
    }
  }

  /// RMSE of the radiance over its mean.
  template <class Field>
  double error(const Field& field) const {
    std::vector<float> L(3 * size_t(sh::count(bands)));
    double squares = 0;
    for (size_t i = 0; i < pixels.size(); ++i) {
      const vec3 x = pixels[i].surface.position;
      if (!field.interpolate(x, bands, L.data())) lights.coefficients(bands, x, L.data());
      const vec3 off = receiver.shade(pixels[i].surface, pixels[i].bsdf, bands, L.data()) - exact[i];
      squares += glm::dot(off, off) / 3;
    }
    return std::sqrt(squares / double(pixels.size())) / mean;
  }
};

double median_of_three(const std::function<void()>& build) {
  std::vector<double> times;
  for (int i = 0; i < 3; ++i) {
    const double start = now();
    build();
    times.push_back(now() - start);
  }
  std::sort(times.begin(), times.end());
  return times[1];
}

struct Built {
  double seconds, error;
  std::string size;
};

constexpr double kLongest = 0.5;  ///< seconds to build: larger ones are of no use here

std::vector<Built> grids(const View& view, const ShScheme& scheme) {
  std::vector<Built> built;
  for (const int side : {6, 8, 11, 14, 18, 23, 29, 37, 47, 59, 74, 93, 117, 147, 160}) {
    ShGrid grid;
    const double seconds = median_of_three([&] {
      const vec3 extent = view.box.high - view.box.low;
      const float cell = max_component(extent) / float(side - 1);
      grid = ShGrid(view.box, glm::max(ivec3(glm::ceil(extent / cell - 1e-3f)) + 1, 2), scheme, view.bands);
      grid.need(view.seen.positions);
      grid.build(view.lights, {});
    });
    built.push_back({seconds, view.error(grid), std::to_string(side)});
    if (seconds > kLongest) break;
  }
  return built;
}

std::vector<Built> octrees(const View& view) {
  std::vector<Built> built;
  for (int points = 200; points <= 40000; points = points * 7 / 5) {
    ShOctree tree;
    const double seconds = median_of_three([&] {
      tree = ShOctree(view.box, view.bands, view.seen.positions);
      tree.build(view.lights, points, [] { return false; }, {});
    });
    built.push_back({seconds, view.error(tree), std::to_string(tree.points())});
    if (seconds > kLongest) break;
  }
  return built;
}

/// Uniform grids by all schemes and octrees, each of its best size within the same time to build. All cover
/// the same box and skip what is not seen.
void fields_of(const std::string& file) {
  const View view(file);
  const ShScheme taylor{ShScheme::Interpolation::taylor};
  const std::vector<std::pair<const char*, std::vector<Built>>> columns{{"linear", grids(view, kValues)},
                                                                        {"taylor", grids(view, taylor)},
                                                                        {"hermite", grids(view, kGradients)},
                                                                        {"hessian", grids(view, kMixed)},
                                                                        {"octree", octrees(view)}};
  std::printf(
      "%s, %zu lights: error of the radiance over its mean (points a side; octree: points)\n  within   ",
      file.c_str(), view.scene.lights().size());
  for (const auto& [name, built] : columns) std::printf("%18s", name);
  std::printf("  hermite over linear  octree over hermite\n");
  for (const double limit : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    std::printf("  %4.0f ms  ", limit * 1e3);
    std::vector<double> best;
    for (const auto& [name, built] : columns) {
      const Built* found = nullptr;
      for (const Built& b : built)
        if (b.seconds <= limit && (!found || b.error < found->error)) found = &b;
      best.push_back(found ? found->error : 0);
      std::printf("%18s", found ? fmt::format("{:.4f} ({})", found->error, found->size).c_str() : "-");
    }
    const auto gain = [&](double from, double to) {
      return from > 0 && to > 0 ? fmt::format("{:+.1f} dB", 20 * std::log10(from / to)) : std::string("-");
    };
    const double hermite = best[2] > 0 && best[3] > 0 ? std::min(best[2], best[3]) : best[2];
    std::printf("%21s%21s\n", gain(best[0], best[2]).c_str(), gain(hermite, best[4]).c_str());
  }
}

/// The first pass of `grid: auto` and of the octree until an error is met, the search for it included; what
/// it measured, and the error of the picture.
void searches(const std::string& file) {
  const Scene scene = load_scene(file, {.width = 320, .height = 180});
  std::printf("%s: first pass with its search\n", file.c_str());
  const auto picture = [&](Integrator& method) {
    Film film(320, 180);
    render(scene, method, film, {.passes = 1}, {.pixels = RenderOptions::Pixels::center});
    return film.radiance();
  };
  ShDirectIntegrator at_pixel{ShDirectParams{}};
  const Image exact = picture(at_pixel);
  for (const float wanted : {0.05f, 0.02f, 0.01f, 0.005f})
    for (const auto at : {ShDirectParams::At::grid, ShDirectParams::At::octree}) {
      ShDirectParams params;
      params.at = at, params.grid = kAuto, params.grid_error = wanted;
      PassStats stats;
      std::unique_ptr<ShDirectIntegrator> method;
      std::vector<double> times;
      for (int i = 0; i < 3; ++i) {
        method = std::make_unique<ShDirectIntegrator>(params);
        method->load(scene, {}, stats);
        const double start = now();
        stats = {};
        method->begin_pass({.scene = scene, .camera = scene.camera()}, {}, stats);
        times.push_back(now() - start);
      }
      std::sort(times.begin(), times.end());
      const Image image = picture(*method);
      double squares = 0, sum = 0;
      for (size_t i = 0; i < image.pixels.size(); ++i)
        squares += sqr(double(image.pixels[i]) - exact.pixels[i]), sum += exact.pixels[i];
      const double error = std::sqrt(squares * double(image.pixels.size())) / sum;
      std::printf(
          "  error %.3f  %-7s %8.1f ms, %6.0f points, measured %.4f, is %.4f\n", wanted,
          at == ShDirectParams::At::grid ? "grid" : "octree", times[1] * 1e3,
          at == ShDirectParams::At::grid ? stats.numbers["grid_points"] : stats.numbers["octree_points"],
          stats.numbers["grid_error_measured"], error);
    }
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what.empty() || what == "field") zonal::fields();
  if (what.empty() || what == "triangles") zonal::triangles();
  if (what.empty() || what == "products") zonal::products();
  for (int i = 2; i < argc; ++i) {
    if (what == "grids") zonal::fields_of(argv[i]);
    if (what == "searches") zonal::searches(argv[i]);
  }
}
