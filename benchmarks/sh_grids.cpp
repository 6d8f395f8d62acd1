// The grids and octrees of sh_direct on whole scenes, all threads: error at equal time to build, and their
// searches.
//
//     build/bench_sh_grids [searches] SCENE.json...
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/sh_direct/sh_direct.h"

namespace zonal {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr ShScheme kLinear{ShScheme::Interpolation::linear}, kTaylor{ShScheme::Interpolation::taylor},
    kHermite{}, kHessian{ShScheme::Interpolation::hermite, ShScheme::Mixed::hessian};

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
  const std::vector<std::pair<const char*, std::vector<Built>>> columns{{"linear", grids(view, kLinear)},
                                                                        {"taylor", grids(view, kTaylor)},
                                                                        {"hermite", grids(view, kHermite)},
                                                                        {"hessian", grids(view, kHessian)},
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
  const bool searches = argc > 1 && std::string(argv[1]) == "searches";
  for (int i = searches ? 2 : 1; i < argc; ++i) (searches ? zonal::searches : zonal::fields_of)(argv[i]);
}
