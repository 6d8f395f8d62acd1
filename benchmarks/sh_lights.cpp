// Time of spherical and polygonal lights, medians of interleaved runs in one process, one thread.
//
//     build/bench_sh_lights
//
// The baseline is a closed form of the kind DirectXSH uses (Sloan 2008, "Stupid Spherical Harmonics Tricks"):
// the half angle by asin, zonal coefficients as polynomials of its cosine, the basis unrolled for a fixed
// number of bands up to 6.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#include "sh/light_batch.h"
#include "sh/polygon.h"
#include "sh/sphere_light.h"
#include "sh/tables.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {
namespace {

using fvec3 = Vec3<float>;
constexpr int kLights = 512;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Nanoseconds an item of each function, which handles `items`: medians of 41 rounds, the functions taking
/// turns.
std::vector<double> measure(const std::vector<std::function<void()>>& functions, int items) {
  std::vector<std::vector<double>> times(functions.size());
  for (int round = 0; round < 41; ++round) {
    for (size_t i = 0; i < functions.size(); ++i) {
      const double start = seconds();
      functions[i]();
      times[i].push_back((seconds() - start) / items * 1e9);
    }
  }
  std::vector<double> medians;
  for (auto& t : times) {
    std::nth_element(t.begin(), t.begin() + t.size() / 2, t.end());
    medians.push_back(t[t.size() / 2]);
  }
  return medians;
}

void keep(const void* p) {
  asm volatile("" : : "r"(p) : "memory");
}

struct Constants {
  float a[36], b[36], first[6];  // X_lm = a z X_{l-1} + b X_{l-2}
  Constants() {
    double mm = 0.28209479177387814;
    for (int m = 0; m < 6; ++m) {
      if (m) mm *= -std::sqrt((2.0 * m + 1) / (2.0 * m));
      first[m] = float(m ? mm * std::sqrt(2.0) : mm);
      for (int l = m + 1; l < 6; ++l) {
        const double d = double(l * l - m * m);
        a[l * 6 + m] = float(std::sqrt((4.0 * l * l - 1) / d));
        b[l * 6 + m] =
            float(-std::sqrt((2 * l + 1) * std::max(0.0, (l - 1.0) * (l - 1) - m * m) / ((2 * l - 3) * d)));
      }
    }
  }
};
const Constants constants;

/// Zonal coefficients of a cap of half angle `angle`, the published polynomials of its cosine (Sloan 2008).
[[gnu::noinline]] void closed_cap(int bands, float angle, float* z) {
  const float c = std::cos(angle), sine = std::sin(angle), s2 = sine * sine, c2 = c * c;
  z[0] = 1.77245385f * (1 - c);
  z[1] = 1.53499006f * s2;
  if (bands > 2) z[2] = 1.98166365f * c * (1 - c2);
  if (bands > 3) z[3] = 0.58618401f * (-1 + c2 * (6 - 5 * c2));
  if (bands > 4) z[4] = 0.66467019f * c * (-3 + c2 * (10 - 7 * c2));
  if (bands > 5) z[5] = 0.36741027f * (1 + c2 * (-15 + c2 * (35 - 21 * c2)));
}

/// 2 sqrt(pi/(2l+1)): from a zonal coefficient to what multiplies the basis.
const float turn[6] = {3.54490770f, 2.04665342f, 1.58533092f, 1.33984915f, 1.18163590f, 1.06882990f};

/// The basis, unrolled.
template <int N>
[[gnu::noinline]] void closed_basis(const fvec3& dir, float* Y) {
  float re = 1, im = 0;
#pragma GCC unroll 16
  for (int m = 0; m < N; ++m) {
    float before = 0, X = constants.first[m];
#pragma GCC unroll 16
    for (int l = m; l < N; ++l) {
      if (l > m) {
        const float next = constants.a[l * 6 + m] * dir.z * X + constants.b[l * 6 + m] * before;
        before = X, X = next;
      }
      Y[l * (l + 1) + m] = X * re;
      if (m > 0) Y[l * (l + 1) - m] = X * im;
    }
    const float next = re * dir.x - im * dir.y;
    im = re * dir.y + im * dir.x, re = next;
  }
}

/// A vector over its length; zero and infinite ones are caught.
fvec3 unit(const fvec3& v) {
  const float length2 = glm::dot(v, v), inverse = 1 / std::sqrt(length2);
  if (!(length2 > 0)) return fvec3(0);
  return length2 < INFINITY ? v * inverse : fvec3(NAN);
}

/// The baseline: what the original does for a call with one colour: arguments checked, distance and direction
/// each from the vector, the cap by its angle, the basis, the product band by band for each colour wanted.
[[gnu::noinline]] bool closed_form(int bands, const fvec3& x, const fvec3& y, float r, const fvec3& colour,
                                   float* red, float* green, float* blue) {
  if (!red || r < 0) return false;
  const fvec3 w = y - x;
  const float d = std::sqrt(glm::dot(w, w));
  float z[6], Y[36];
  closed_cap(bands, d > r ? std::asin(r / d) : 1.57079633f, z);
  const fvec3 dir = unit(w);
  switch (bands) {
    case 3:
      closed_basis<3>(dir, Y);
      break;
    case 4:
      closed_basis<4>(dir, Y);
      break;
    case 5:
      closed_basis<5>(dir, Y);
      break;
    case 6:
      closed_basis<6>(dir, Y);
      break;
    default:
      return false;
  }
  float* const results[3] = {red, green, blue};
  for (int k = 0; k < 3; ++k) {
    if (!results[k]) continue;
    for (int l = 0; l < bands; ++l) {
      const float scale = z[l] * colour[k] * turn[l];
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) results[k][i] = scale * Y[i];
    }
  }
  return true;
}

struct Scene {
  std::vector<float> x, y, z, r, red, green, blue;
  std::vector<fvec3> center;
  fvec3 point{0.1f, 0.2f, -0.3f};

  Scene() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < kLights; ++i) {
      center.emplace_back(5 * uniform(random), 5 * uniform(random), 5 * uniform(random));
      x.push_back(center[i].x), y.push_back(center[i].y), z.push_back(center[i].z);
      r.push_back(0.05f + 0.04f * uniform(random));
      red.push_back(1), green.push_back(2), blue.push_back(3);
    }
  }
  LightArrays<float> lights(int first, int n) const {
    return {n, &x[first], &y[first], &z[first], &r[first], {&red[first], &green[first], &blue[first]}};
  }
};

/// Both must compute the same thing: the largest difference over the largest coefficient, a few roundings of
/// the baseline's zonal coefficients over their size, which for small lights is much.
void compare(const Scene& s) {
  for (const float scale : {1.0f, 10.0f}) {
    double worst = 0;
    for (int i = 0; i < kLights; ++i) {
      float a[36], b[36];
      closed_form(6, s.point, s.center[i], scale * s.r[i], fvec3(1), a, nullptr, nullptr);
      sphere_light(6, s.point, s.center[i], scale * s.r[i], b);
      double size = 0, difference = 0;
      for (int k = 0; k < 36; ++k) {
        size = std::max(size, double(std::abs(b[k])));
        difference = std::max(difference, double(std::abs(a[k] - b[k])));
      }
      worst = std::max(worst, difference / size);
    }
    std::printf("closed forms against ours, radius about %g: %.1e of the largest coefficient\n", 0.05 * scale,
                worst);
  }
}

void spheres() {
  const Scene s;
  compare(s);
  std::printf(
      "Spherical light, float, ns a light (closed forms of DirectXSH itself: 54-61 ns for N = 3..6 on "
      "another machine)\n");
  std::printf("%5s %8s %8s %6s %9s %6s %9s %6s %9s %9s %9s %9s\n", "bands", "closed", "single", "ratio",
              "batch 8", "ratio", "batch512", "ratio", "RGB sum", "gradient", "RGB grad", "Hessian");
  for (const int bands : {3, 4, 5, 6, 8, 9, 10, 15, 20, 40}) {
    const int n = count(bands);
    std::vector<float> out(static_cast<size_t>(n) * kLights), sum(3 * n), slope(9 * n);
    std::vector<fvec3> G(n);
    std::vector<Hessian<float>> H(n);
    std::vector<std::function<void()>> f;
    f.push_back([&] {
      for (int i = 0; i < kLights; ++i)
        closed_form(std::min(bands, 6), s.point, s.center[i], s.r[i], fvec3(1), out.data(), nullptr, nullptr),
            keep(out.data());
    });
    f.push_back([&] {
      for (int i = 0; i < kLights; ++i)
        sphere_light(bands, s.point, s.center[i], s.r[i], out.data()), keep(out.data());
    });
    f.push_back([&] {
      for (int i = 0; i < kLights; i += 8) {
        project_lights(bands, LightShape::sphere, s.point, s.lights(i, 8), out.data()), keep(out.data());
      }
    });
    f.push_back([&] {
      project_lights(bands, LightShape::sphere, s.point, s.lights(0, kLights), out.data()), keep(out.data());
    });
    f.push_back([&] {
      accumulate_lights(bands, LightShape::sphere, s.point, s.lights(0, kLights), sum.data()),
          keep(sum.data());
    });
    f.push_back([&] {
      for (int i = 0; i < kLights; ++i) {
        sphere_light_gradient(bands, s.point, s.center[i], s.r[i], out.data(), G.data()), keep(G.data());
      }
    });
    f.push_back([&] {
      accumulate_lights_gradient(bands, LightShape::sphere, s.point, s.lights(0, kLights), sum.data(),
                                 slope.data());
      keep(sum.data());
    });
    f.push_back([&] {
      for (int i = 0; i < kLights; ++i) {
        sphere_light_hessian(bands, s.point, s.center[i], s.r[i], out.data(), G.data(), H.data()),
            keep(H.data());
      }
    });
    const std::vector<double> t = measure(f, kLights);
    if (bands <= 6) {
      std::printf("%5d %8.1f %8.1f %6.2f %9.1f %6.2f %9.1f %6.2f", bands, t[0], t[1], t[1] / t[0], t[2],
                  t[2] / t[0], t[3], t[3] / t[0]);
    } else {
      std::printf("%5d %8s %8.1f %6s %9.1f %6s %9.1f %6s", bands, "-", t[1], "", t[2], "", t[3], "");
    }
    std::printf(" %9.1f %9.1f %9.1f %9.1f\n", t[4], t[5], t[6], t[7]);
  }
}

/// Section 3.1.3: zonal coefficients from a table over cos a (1024 rows, linear) against the formula.
void tabulated() {
  constexpr int kRows = 1024;
  std::printf(
      "\nZonal coefficients of a sphere, float: formula against a table of %d rows, linear (section 3.1.3)\n",
      kRows);
  std::printf("%5s %10s %10s %14s %10s\n", "bands", "formula ns", "table ns", "table rel err", "table kB");
  const Scene s;
  for (const int bands : {5, 8, 10, 20}) {
    std::vector<float> table(static_cast<size_t>(kRows + 1) * bands), z(bands), exact(bands), cosine(kLights);
    for (int i = 0; i <= kRows; ++i) {
      const float t = float(i) / kRows;
      cap_zonal(bands, Cap<float>{t, t * (2 - t)}, &table[i * bands]);
    }
    double worst = 0;
    std::vector<Cap<float>> caps(kLights);
    for (int i = 0; i < kLights; ++i) caps[i] = see_sphere(s.point, s.center[i], s.r[i]).cap;
    const auto look_up = [&](const Cap<float>& cap) {
      const float at = cap.versine * kRows;
      const int row = std::min(int(at), kRows - 1);
      const float f = at - float(row), *a = &table[row * bands], *b = a + bands;
      for (int l = 0; l < bands; ++l) z[l] = a[l] + f * (b[l] - a[l]);
    };
    for (const Cap<float>& cap : caps) {
      cap_zonal(bands, cap, exact.data());
      look_up(cap);
      for (int l = 0; l < bands; ++l) worst = std::max(worst, std::abs(double(z[l]) - exact[l]) / exact[0]);
    }
    const std::vector<double> t = measure({[&] {
                                             for (const auto& c : caps)
                                               cap_zonal(bands, c, z.data()), keep(z.data());
                                           },
                                           [&] {
                                             for (const auto& c : caps) look_up(c), keep(z.data());
                                           }},
                                          kLights);
    std::printf("%5d %10.1f %10.1f %14.1e %10.1f\n", bands, t[0], t[1], worst,
                double(table.size()) * 4 / 1024);
  }
}

void polygons() {
  std::printf("\nTriangular light, float interface, microseconds a triangle: exact, and with gradient\n");
  std::printf("%5s %12s %12s %12s %12s\n", "bands", "near", "near+grad", "far", "far+grad");
  const fvec3 near[3] = {{0.5f, -0.3f, 1.0f}, {0.4f, 0.6f, 1.2f}, {-0.5f, 0.1f, 0.9f}};
  const fvec3 far[3] = {{5.0f, -0.03f, 10.0f}, {5.04f, 0.06f, 10.2f}, {4.95f, 0.01f, 9.9f}};
  for (const int bands : {3, 5, 6, 7, 8, 9, 15, 20}) {
    std::vector<float> L(count(bands));
    std::vector<fvec3> G(count(bands));
    std::vector<std::function<void()>> f;
    for (const fvec3* v : {near, far}) {
      for (const bool gradient : {false, true}) {
        f.push_back([&, v, gradient] {
          for (int i = 0; i < 16; ++i) {
            polygon_light(bands, 3, v, fvec3(0.01f * float(i)), L.data(), gradient ? G.data() : nullptr),
                keep(L.data());
          }
        });
      }
    }
    const std::vector<double> t = measure(f, 16);
    std::printf("%5d %12.2f %12.2f %12.2f %12.2f\n", bands, t[0] / 1e3, t[1] / 1e3, t[2] / 1e3, t[3] / 1e3);
  }
}

}  // namespace
}  // namespace zonal::sh

int main() {
  zonal::sh::spheres();
  zonal::sh::tabulated();
  zonal::sh::polygons();
}
