// Time of harmonic virtual lights beside virtual point lights: nanoseconds a shaded point and light, no
// occlusion, RGB, one thread, medians of interleaved runs in one process.
//
//     build/bench_hvl
//
// 64 shaded points (a tile) against 1,024 lights. Emission at the lights is the same GGX with a diffuse part
// for all methods; the receiver is the same GGX with a diffuse part, evaluated (vpl), as one zonal lobe (hvl,
// product zonal), or as full spherical harmonics (hvl, product sh). The baseline is written twice on plain
// arrays, once with the lights as SIMD lanes and once with the points; the faster one counts.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "integrators/hvl/hvl_kernels.h"

namespace zonal {
namespace {

constexpr int kLights = 1024, kPoints = hvl::kPoints, kRounds = 41, kBlock = 32;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Row {
  std::string name;
  std::function<void()> run;
  std::vector<double> ns = {};
  double median = 0;
};

void measure(std::vector<Row>& rows) {
  for (int round = 0; round < kRounds; ++round) {
    for (Row& row : rows) {
      const double start = seconds();
      row.run();
      row.ns.push_back((seconds() - start) * 1e9 / (double(kLights) * kPoints));
    }
  }
  for (Row& row : rows) {
    std::nth_element(row.ns.begin(), row.ns.begin() + kRounds / 2, row.ns.end());
    row.median = row.ns[kRounds / 2];
  }
}

void keep(const void* p) {
  asm volatile("" : : "r"(p) : "memory");
}

/// A GGX surface of both ends: Schlick's Fresnel over a diffuse part.
struct Material {
  float alpha = 0.25f;
  vec3 f0{0.04f, 0.05f, 0.06f};
  vec3 diffuse{0.5f, 0.4f, 0.3f};
};
const Material kMaterial;

/// Its BRDF for a fixed direction v and a varying one w, T a float or lanes of it: out[channel]. `n_v` =
/// dot(n, v) and `stretch_v` (below) are what the fixed end keeps.
template <class T, class Fixed, class Root>
[[gnu::always_inline]] inline void ggx(const Fixed& n_v, const Fixed& stretch_v, const T& n_w, const T& v_w,
                                       const Root& root, T* out) {
  const float a2 = kMaterial.alpha * kMaterial.alpha;
  // With h = (v + w)/|v + w|: |v + w|^2 = 2 + 2 v.w, n.h = (n.v + n.w)/|v + w|, v.h = |v + w|/2.
  const T size2 = 2.0f + 2.0f * v_w, n_h = n_v + n_w;
  const T s = (a2 - 1.0f) * (n_h * n_h) + size2;
  const T smith = n_v * root(a2 + (1.0f - a2) * (n_w * n_w)) + n_w * stretch_v;
  const T lobe = (0.5f * a2 * kInvPi) * (size2 * size2) / (s * s * smith);
  const T below = 1.0f - 0.5f * root(size2), below2 = below * below, fresnel = below2 * below2 * below;
  for (int c = 0; c < 3; ++c)
    out[c] = (kMaterial.f0[c] + (1.0f - kMaterial.f0[c]) * fresnel) * lobe + kMaterial.diffuse[c] * kInvPi;
}
float stretch(float n_v) {
  const float a2 = kMaterial.alpha * kMaterial.alpha;
  return std::sqrt(a2 + (1.0f - a2) * n_v * n_v);
}

struct Lights {
  alignas(64) std::array<float, kLights> x, y, z, nx, ny, nz, ix, iy, iz, n_i, stretch_i, r, g, b;
};
struct Points {
  alignas(64) std::array<float, kPoints> x, y, z, nx, ny, nz, ox, oy, oz, n_o, stretch_o;
};

/// Baseline, lanes are lights: sums a point.
void vpl_lights(const Points& p, const Lights& l, float* sums) {
  const auto root = [](float v) { return std::sqrt(v); };
  for (int k = 0; k < kPoints; ++k) {
    const float px = p.x[k], py = p.y[k], pz = p.z[k], nx = p.nx[k], ny = p.ny[k], nz = p.nz[k];
    const float ox = p.ox[k], oy = p.oy[k], oz = p.oz[k], n_o = p.n_o[k], stretch_o = p.stretch_o[k];
    float r = 0, g = 0, b = 0;
#pragma omp simd reduction(+ : r, g, b)
    for (int j = 0; j < kLights; ++j) {
      const float dx = l.x[j] - px, dy = l.y[j] - py, dz = l.z[j] - pz, d2 = dx * dx + dy * dy + dz * dz;
      const float inverse = 1.0f / std::sqrt(d2), wx = dx * inverse, wy = dy * inverse, wz = dz * inverse;
      const float up = nx * wx + ny * wy + nz * wz, facing = -(l.nx[j] * wx + l.ny[j] * wy + l.nz[j] * wz);
      float sent[3], received[3];
      ggx<float>(l.n_i[j], l.stretch_i[j], std::max(facing, 1e-4f),
                 -(l.ix[j] * wx + l.iy[j] * wy + l.iz[j] * wz), root, sent);
      ggx<float>(n_o, stretch_o, std::max(up, 1e-4f), ox * wx + oy * wy + oz * wz, root, received);
      const float geometry = std::max(up, 0.0f) * std::max(facing, 0.0f) * inverse * inverse;
      r += l.r[j] * sent[0] * received[0] * geometry;
      g += l.g[j] * sent[1] * received[1] * geometry;
      b += l.b[j] * sent[2] * received[2] * geometry;
    }
    sums[3 * k] = r, sums[3 * k + 1] = g, sums[3 * k + 2] = b;
  }
}

/// Baseline, lanes are points: adds what each light sends.
void vpl_points(const Points& p, const Lights& l, int first, int count, const hvl::Sums& sums) {
  const auto root = [](float v) { return std::sqrt(v); };
  for (int i = 0; i < count; ++i) {
    const int j = first + i;
    const float lx = l.x[j], ly = l.y[j], lz = l.z[j], mx = l.nx[j], my = l.ny[j], mz = l.nz[j];
    const float ix = l.ix[j], iy = l.iy[j], iz = l.iz[j], n_i = l.n_i[j], stretch_i = l.stretch_i[j];
    const float lr = l.r[j], lg = l.g[j], lb = l.b[j];
    float *r = sums.r, *g = sums.g, *b = sums.b;
#pragma omp simd
    for (int k = 0; k < kPoints; ++k) {
      const float dx = lx - p.x[k], dy = ly - p.y[k], dz = lz - p.z[k], d2 = dx * dx + dy * dy + dz * dz;
      const float inverse = 1.0f / std::sqrt(d2), wx = dx * inverse, wy = dy * inverse, wz = dz * inverse;
      const float up = p.nx[k] * wx + p.ny[k] * wy + p.nz[k] * wz, facing = -(mx * wx + my * wy + mz * wz);
      float sent[3], received[3];
      ggx<float>(n_i, stretch_i, std::max(facing, 1e-4f), -(ix * wx + iy * wy + iz * wz), root, sent);
      ggx<float>(p.n_o[k], p.stretch_o[k], std::max(up, 1e-4f), p.ox[k] * wx + p.oy[k] * wy + p.oz[k] * wz,
                 root, received);
      const float geometry = std::max(up, 0.0f) * std::max(facing, 0.0f) * inverse * inverse;
      r[k] += lr * sent[0] * received[0] * geometry;
      g[k] += lg * sent[1] * received[1] * geometry;
      b[k] += lb * sent[2] * received[2] * geometry;
    }
  }
}

struct Scene {
  Lights lights;
  Points points;
  std::vector<hvl::Light> records;
  std::vector<float> emission;  ///< coefficients of the lights' emission, 3 bands, mirrored
  std::vector<std::array<vec3, 3>> frames;
};

/// Lights over the walls of a unit room, points on a patch of its floor; a tenth of the lights lies below the
/// points.
Scene make_scene() {
  Scene s;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> u(0, 1);
  const auto direction = [&](vec3 n) {
    vec3 w;
    do w = vec3(2 * u(random) - 1, 2 * u(random) - 1, 2 * u(random) - 1);
    while (dot(w, w) > 1 || dot(w, n) < 0.1f * std::sqrt(dot(w, w)));
    return normalize(w);
  };
  s.records.resize(kLights), s.frames.resize(kLights);
  for (int j = 0; j < kLights; ++j) {
    vec3 p(u(random), u(random), u(random)), n(0);
    const int axis = j % 3, side = j / 3 % 2;
    p[axis] = float(side), n[axis] = side ? -1.0f : 1.0f;
    const vec3 w = direction(n), power(u(random), u(random), u(random));
    s.lights.x[j] = p.x, s.lights.y[j] = p.y, s.lights.z[j] = p.z;
    s.lights.nx[j] = n.x, s.lights.ny[j] = n.y, s.lights.nz[j] = n.z;
    s.lights.ix[j] = w.x, s.lights.iy[j] = w.y, s.lights.iz[j] = w.z;
    s.lights.n_i[j] = dot(n, w), s.lights.stretch_i[j] = stretch(dot(n, w));
    s.lights.r[j] = power.x, s.lights.g[j] = power.y, s.lights.b[j] = power.z;
    s.records[j] = {p, n, 0.05f, power};
    const vec3 x = normalize(w - n * dot(n, w));
    s.frames[j] = {x, cross(n, x), n};
  }
  s.emission.resize(size_t(kLights) * 3 * hvl::even_count(3, true));
  for (float& c : s.emission) c = u(random);
  for (int k = 0; k < kPoints; ++k) {
    s.points.x[k] = 0.4f + 0.2f * u(random), s.points.y[k] = 0.1f, s.points.z[k] = 0.4f + 0.2f * u(random);
    const vec3 n = normalize(vec3(0.2f * u(random), 1, 0.2f * u(random))), o = direction(n);
    s.points.nx[k] = n.x, s.points.ny[k] = n.y, s.points.nz[k] = n.z;
    s.points.ox[k] = o.x, s.points.oy[k] = o.y, s.points.oz[k] = o.z;
    s.points.n_o[k] = dot(n, o), s.points.stretch_o[k] = stretch(dot(n, o));
  }
  return s;
}

/// What the points do with light. Numbers do not change the time: any coefficients will do.
hvl::Receivers receivers(const Scene& s, hvl::Product product, int bands, bool mirrored) {
  hvl::Receivers r;
  r.product = product;
  const Points& p = s.points;
  std::copy(p.x.begin(), p.x.end(), r.x.begin()), std::copy(p.y.begin(), p.y.end(), r.y.begin());
  std::copy(p.z.begin(), p.z.end(), r.z.begin()), std::copy(p.nx.begin(), p.nx.end(), r.nx.begin());
  std::copy(p.ny.begin(), p.ny.end(), r.ny.begin()), std::copy(p.nz.begin(), p.nz.end(), r.nz.begin());
  r.gx = r.nx, r.gy = r.ny, r.gz = r.nz;
  for (int g = 0; g < hvl::kGroups; ++g) r.open(g, bands, mirrored);
  const std::vector<float> ones(size_t(bands), 1.0f);
  std::vector<float> table(size_t(3) * bands * bands);
  for (size_t i = 0; i < table.size(); ++i) table[i] = 1.0f / float(1 + i % size_t(bands * bands));
  for (int k = 0; k < kPoints; ++k) {
    const vec3 n(p.nx[k], p.ny[k], p.nz[k]), o(p.ox[k], p.oy[k], p.oz[k]);
    const vec3 x = normalize(o - n * dot(n, o)), y = cross(n, x), mirror = 2.0f * dot(n, o) * n - o;
    const vec3 a = product == hvl::Product::sh ? x : mirror;
    r.ax[k] = a.x, r.ay[k] = a.y, r.az[k] = a.z, r.bx[k] = y.x, r.by[k] = y.y, r.bz[k] = y.z;
    for (int c = 0; c < 3; ++c)
      r.diffuse[c][k] = kMaterial.diffuse[c] * kInvPi, r.specular[c][k] = kMaterial.f0[c];
    if (product == hvl::Product::sh)
      r.set_sh(k, bands, mirrored, bands * bands, table.data(), ones.data());
    else
      r.set_zonal(k, bands, table.data(), ones.data());
  }
  return r;
}

/// The lights' GGX by lanes.
struct EmitGgx {
  const Lights& l;
  int first;
  void operator()(int i, const hvl::V& x, const hvl::V& y, const hvl::V& z, hvl::V* out) const {
    const int j = first + i;
    const hvl::V zero = {};
    const hvl::V facing = -(l.nx[j] * x + l.ny[j] * y + l.nz[j] * z);
    const hvl::V i_dot_o = -(l.ix[j] * x + l.iy[j] * y + l.iz[j] * z);
    ggx<hvl::V, float>(
        l.n_i[j], l.stretch_i[j], hvl::larger(facing, zero + 1e-4f), i_dot_o,
        [](const hvl::V& v) { return sh::sqrt_lanes(v); }, out);
  }
};

/// Three bands of spherical harmonics.
struct EmitSh {
  const Scene& s;
  int first;
  void operator()(int i, const hvl::V& x, const hvl::V& y, const hvl::V& z, hvl::V* out) const {
    const auto& f = s.frames[size_t(first + i)];
    const hvl::V lx = -(f[0].x * x + f[0].y * y + f[0].z * z), ly = -(f[1].x * x + f[1].y * y + f[1].z * z);
    const hvl::V lz = -(f[2].x * x + f[2].y * y + f[2].z * z);
    const float* c = s.emission.data() + size_t(first + i) * 3 * hvl::even_count(3, true);
    hvl::emission<3, true>(hvl::Bands::table(), 3, c, lx, ly, lz, out);
  }
};

void run() {
  static const Scene s = make_scene();
  alignas(64) static std::array<float, kPoints> r, g, b;
  const hvl::Sums sums{r.data(), g.data(), b.data()};
  // In blocks, as ManyLights has them where nothing occludes.
  const auto blocks = [&](auto&& gather) {
    r.fill(0), g.fill(0), b.fill(0);
    for (int first = 0; first < kLights; first += kBlock) gather(first);
    keep(&r), keep(&g), keep(&b);
  };

  std::vector<Row> rows;
  rows.push_back({"vpl, lanes are lights", [] {
                    static float result[3 * kPoints];
                    vpl_lights(s.points, s.lights, result);
                    keep(result);
                  }});
  rows.push_back({"vpl, lanes are points",
                  [&] { blocks([&](int first) { vpl_points(s.points, s.lights, first, kBlock, sums); }); }});
  const auto add = [&](const std::string& name, hvl::Product product, int bands, bool mirrored,
                       bool ggx_emission, float soft) {
    const auto points = std::make_shared<hvl::Receivers>(receivers(s, product, bands, mirrored));
    rows.push_back(
        {name, [&, points, ggx_emission, soft] {
           blocks([&](int first) {
             if (ggx_emission)
               hvl::gather(*points, &s.records[size_t(first)], kBlock, soft, EmitGgx{s.lights, first}, sums);
             else
               hvl::gather(*points, &s.records[size_t(first)], kBlock, soft, EmitSh{s, first}, sums);
           });
         }});
  };
  for (int bands : {5, 10, 15, 20})
    add("hvl zonal " + std::to_string(bands), hvl::Product::zonal, bands, true, true, 0);
  for (int bands : {3, 5, 7, 9, 15, 20})
    add("hvl sh " + std::to_string(bands), hvl::Product::sh, bands, true, true, 0);
  for (int bands : {5, 9})
    add("hvl sh " + std::to_string(bands) + ", emission sh 3", hvl::Product::sh, bands, true, false, 0);
  for (int bands : {5, 9})
    add("hvl sh " + std::to_string(bands) + ", soft edge", hvl::Product::sh, bands, true, true, 0.5f);
  for (int bands : {5, 9})
    add("hvl sh " + std::to_string(bands) + ", not mirrored", hvl::Product::sh, bands, false, true, 0);
  measure(rows);

  const double baseline = std::min(rows[0].median, rows[1].median);
  std::printf("%-28s %10s %10s\n", "", "ns", "of vpl");
  for (const Row& row : rows)
    std::printf("%-28s %10.2f %10.2f\n", row.name.c_str(), row.median, row.median / baseline);
}

}  // namespace
}  // namespace zonal

int main() {
  zonal::run();
}
