// Speed of sh_direct's parts, one thread: the radiance field on a grid, triangles against spheres, the
// product with the clamped cosine. Medians of interleaved rounds.
//
//     build/bench_sh_direct [field | orders | triangles | products]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "integrators/sh_direct/sh_grid.h"
#include "sh/clamped_cosine.h"
#include "sh/light_batch_reversed.h"
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

/// 500 RGB spheres on 8^3 points with the loops forward and reversed (Sec. 3.3.3).
template <int N>
void orders() {
  constexpr auto kSphere = sh::LightShape::sphere;
  const Lights lights = spheres(500);
  std::vector<float> x, y, z, radius(500, 0.1f), colour[3];
  for (const auto& light : lights) {
    const auto& ball = dynamic_cast<const SphereLight&>(*light);
    x.push_back(ball.center.x), y.push_back(ball.center.y), z.push_back(ball.center.z);
    for (int c = 0; c < 3; ++c) colour[c].push_back(ball.emission[c]);
  }
  const sh::LightArrays<float> arrays{.count = 500,
                                      .x = x.data(),
                                      .y = y.data(),
                                      .z = z.data(),
                                      .radius = radius.data(),
                                      .radiance = {colour[0].data(), colour[1].data(), colour[2].data()}};
  std::vector<float> L[4], slope[2];
  for (auto& v : L) v.resize(3 * N * N);
  for (auto& v : slope) v.resize(9 * N * N);
  const auto over_grid = [](const auto& one) {
    return [one] {
      for (int i = 0; i < 512; ++i) one(vec3(i % 8, i / 8 % 8, i / 64) * (2 / 7.0f) - 1.0f);
    };
  };
  std::vector<Row> rows{
      {"coefficients, forward", over_grid([&](vec3 p) {
         sh::accumulate_lights(N, kSphere, p, arrays, L[0].data(), sh::LoopOrder::forward);
       })},
      {"coefficients, reverse",
       over_grid([&](vec3 p) { sh::accumulate_lights(N, kSphere, p, arrays, L[1].data()); })},
      {"gradients too, forward", over_grid([&](vec3 p) {
         sh::accumulate_lights_gradient(N, kSphere, p, arrays, L[2].data(), slope[0].data());
       })},
      {"gradients too, reverse", over_grid([&](vec3 p) {
         sh::accumulate_reversed<float, N, true>(kSphere, p, arrays, L[3].data(), slope[1].data());
       })}};
  measure(rows);
  std::printf("500 RGB spheres, %d bands, 8^3 points\n", N);
  for (size_t r = 0; r < rows.size(); ++r)
    std::printf("  %-28s %8.2f ms  %5.2f x\n", rows[r].name.c_str(), rows[r].seconds * 1e3,
                rows[r].seconds / rows[r / 2 * 2].seconds);
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

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what.empty() || what == "field") zonal::fields();
  if (what.empty() || what == "orders") zonal::orders<5>(), zonal::orders<9>();
  if (what.empty() || what == "triangles") zonal::triangles();
  if (what.empty() || what == "products") zonal::products();
}
