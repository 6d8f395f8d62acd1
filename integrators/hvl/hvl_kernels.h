#pragma once
/// Gathering by lanes: a tile's points against a block of harmonic virtual lights, some points at a time.
///
///     Receivers receivers;                                          // positions, normals; then set_sh, ...
///     gather(receivers, lights, count, soft, emit, Out{r, g, b});   // r[64 j + k]: light j, point k
///     gather(receivers, lights, count, soft, emit, Sums{r, g, b});  // r[k]: plus all of the lights
///
/// `emit(j, x, y, z, out)` gives what light j's surface reflects of a unit flux along (x, y, z), the world
/// directions from the points to the light: 1/sr, three channels.

#include <vector>

#include "core/vec.h"
#include "integrators/hvl/hvl_lanes.h"

namespace zonal::hvl {

inline constexpr int kPoints = 64, kGroups = kPoints / kLanes;

/// A light as `gather` reads it.
struct Light {
  vec3 position{0};      ///< metres, world
  vec3 normal{0, 0, 1};  ///< geometric, unit, on the lit side
  float radius = 1;      ///< metres, > 0
  vec3 power{0};         ///< incident flux, W
};

enum class Product { sh, zonal };

/// A tile's points: where they are and what they do with light.
struct Receivers {
  using Floats = std::array<float, kPoints>;
  alignas(64) Floats x{}, y{}, z{};     ///< metres, world
  alignas(64) Floats gx{}, gy{}, gz{};  ///< geometric normal on the camera's side
  alignas(64) Floats nx{}, ny{}, nz{};  ///< shading normal
  /// product sh: x and y of the view frame (materials/sh_material.h), world. zonal: the lobe's axis in a.
  alignas(64) Floats ax{}, ay{}, az{}, bx{}, by{}, bz{};
  alignas(64) std::array<Floats, 3> diffuse{}, specular{};  ///< product zonal
  Product product = Product::sh;

  struct Group {
    int bands = 0;  ///< 0: nothing is received
    Product product = Product::sh;
    bool mirrored = true;       ///< product sh: no coefficient with m < 0 in any lane
    bool lobe = true;           ///< product zonal: some lane has a specular part
    std::vector<float> values;  ///< as `product` and `zonal_product` read them
  };
  std::array<Group, kGroups> groups;

  /// Makes room: zeros in all lanes.
  void open(int group, int bands, bool mirrored) {
    Group& g = groups[group];
    g.bands = bands, g.mirrored = mirrored, g.product = product, g.lobe = true;
    const int count = product == Product::zonal ? bands : 3 * sh_count(bands, mirrored);
    g.values.assign(size_t(count) * kLanes, 0.0f);
  }
  /// A group of matt points: (HVL-6) alone, by `diffuse`.
  void open_matt(int group) {
    Group& g = groups[group];
    g.bands = 1, g.product = Product::zonal, g.lobe = false;
  }
  /// Point k's coefficients of F', channel c's at table[c * stride + i] as in materials/sh_material.h, each
  /// band times window[l].
  void set_sh(int k, int bands, bool mirrored, int stride, const float* table, const float* window);
  /// Point k's lobe: zonal coefficients F_l, each times window[l].
  void set_zonal(int k, int bands, const float* lobe, const float* window);
};

/// Where `gather` writes: entry [kPoints * j + k] of light j and point k.
struct Out {
  float *r, *g, *b;

  struct Group {
    float *r, *g, *b;
    ZONAL_HVL_INLINE void put(int j, const V* received) const {
      store(r + j * kPoints, received[0]), store(g + j * kPoints, received[1]);
      store(b + j * kPoints, received[2]);
    }
    static constexpr bool kKeepsZeros = true;
    void close() const {}
  };
  Group group(int at) const { return {r + at, g + at, b + at}; }
};

/// Or adds: entry [k] of point k.
struct Sums {
  float *r, *g, *b;

  struct Group {
    float *r, *g, *b;
    V sum[3];
    ZONAL_HVL_INLINE void put(int, const V* received) {
      for (int c = 0; c < 3; ++c) sum[c] += received[c];
    }
    static constexpr bool kKeepsZeros = false;
    void close() const { store(r, sum[0]), store(g, sum[1]), store(b, sum[2]); }
  };
  Group group(int at) const {
    Group open{r + at, g + at, b + at, {}};
    load(open.r, open.sum[0]), load(open.g, open.sum[1]), load(open.b, open.sum[2]);
    return open;
  }
};

/// The lanes of one group against all lights. kBands = 0: any number of bands.
template <Product kProduct, int kBands, bool kMirrored, class Emit, class Sink>
void gather_group(const Receivers& receivers, int group, const Light* lights, int count, float soft,
                  const Emit& emit, const Sink& out) {
  const Bands& table = Bands::table();
  const int at = group * kLanes;
  const Receivers::Group& g = receivers.groups[group];
  V px, py, pz, gx, gy, gz, nx, ny, nz, ax, ay, az, bx, by, bz;
  load(&receivers.x[at], px), load(&receivers.y[at], py), load(&receivers.z[at], pz);
  load(&receivers.gx[at], gx), load(&receivers.gy[at], gy), load(&receivers.gz[at], gz);
  load(&receivers.nx[at], nx), load(&receivers.ny[at], ny), load(&receivers.nz[at], nz);
  load(&receivers.ax[at], ax), load(&receivers.ay[at], ay), load(&receivers.az[at], az);
  load(&receivers.bx[at], bx), load(&receivers.by[at], by), load(&receivers.bz[at], bz);
  const V zero = {};
  auto sink = out.group(at);

  for (int j = 0; j < count; ++j) {
    const Light& light = lights[j];
    Sight s;
    look(px, py, pz, &light.position.x, &light.normal.x, light.radius, s);
    const V up = nx * s.x + ny * s.y + nz * s.z;
    const V over = gx * s.x + gy * s.y + gz * s.z;
    // What lies wholly below either horizon sends nothing, whatever rings there.
    const Mask reached = (s.emitted > 0.0f) & (up > -s.sine) & (over > -s.sine);
    V received[3] = {zero, zero, zero};
    if (!any(reached)) {
      if (Sink::Group::kKeepsZeros) sink.put(j, received);
      continue;
    }
    V sent[3];
    emit(j, s.x, s.y, s.z, sent);
    if constexpr (kProduct == Product::sh) {
      const V x = ax * s.x + ay * s.y + az * s.z, y = bx * s.x + by * s.y + bz * s.z;
      V gain[kBands > 0 ? kBands : kMaxBands];
      cap_gains<kBands>(table, g.bands, s.sine, s.cosine, soft, gain);
      product<kBands, kMirrored>(table, g.bands, g.values.data(), x, y, up, gain, received);
    } else {
      V E, k;
      cap_irradiance(up, s, E);
      for (int c = 0; c < 3; ++c) load(&receivers.diffuse[c][at], k), received[c] = k * E;
      if (g.lobe) {
        const V turn = ax * s.x + ay * s.y + az * s.z;
        const V lobe = zonal_product<kBands>(table, g.bands, g.values.data(), turn, s.sine, s.cosine, soft) *
                       larger(up, zero);
        for (int c = 0; c < 3; ++c) load(&receivers.specular[c][at], k), received[c] = k * lobe + received[c];
      }
    }
    const V scale = reached ? s.emitted : zero;
    for (int c = 0; c < 3; ++c) received[c] *= sent[c] * (scale * (light.power[c] * kInvPi));
    sink.put(j, received);
  }
  sink.close();
}

/// Calls f with the number of bands as a constant where there is a kernel for it, with 0 elsewhere.
template <class F>
void with_bands(int bands, F&& f) {
  switch (bands) {
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 5:
      return f(std::integral_constant<int, 5>{});
    case 7:
      return f(std::integral_constant<int, 7>{});
    case 9:
      return f(std::integral_constant<int, 9>{});
    default:
      return f(std::integral_constant<int, 0>{});
  }
}

/// All points of the tile against `count` lights.
template <class Emit, class Sink>
void gather(const Receivers& receivers, const Light* lights, int count, float soft, const Emit& emit,
            const Sink& out) {
  for (int group = 0; group < kGroups; ++group) {
    const Receivers::Group& g = receivers.groups[group];
    if (g.bands == 0) continue;
    if (g.product == Product::zonal) {
      gather_group<Product::zonal, 0, true>(receivers, group, lights, count, soft, emit, out);
    } else if (!g.mirrored) {
      gather_group<Product::sh, 0, false>(receivers, group, lights, count, soft, emit, out);
    } else {
      with_bands(g.bands, [&](auto bands) {
        gather_group<Product::sh, decltype(bands)::value, true>(receivers, group, lights, count, soft, emit,
                                                                out);
      });
    }
  }
}

}  // namespace zonal::hvl
