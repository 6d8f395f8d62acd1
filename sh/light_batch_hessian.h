#pragma once
/// The Hessian of many spherical lights or oriented disks at once: the sum in three colours.
///
///     std::vector<float> sum(3 * n), gradient(9 * n), hessian(18 * n);   // n = sh::count(bands), zeroed by
///     the caller sh::accumulate_lights_hessian(bands, sh::LightShape::sphere, x, lights, sum.data(),
///     gradient.data(), hessian.data());

#include <algorithm>
#include <vector>

#include "sh/seen_lanes.h"

namespace zonal::sh {
namespace detail {

/// Adds a block to 30 lane sums a coefficient: values, gradients, Hessians (xx, xy, xz, yy, yz, zz) by
/// colour.
template <class T, int W>
void add_hessians(int bands, LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first,
                  Lanes<T, W>* lanes) {
  using V = Lanes<T, W>;
  const int filled = std::min(W, lights.count - first);
  const SeenLanes<T, W> seen(shape, p, lights, first, filled);
  const DirectionLanes<T, V> d = seen.direction();
  const V zero = d.x * 0, inv = seen.inverse_d, x = d.x, y = d.y, z = d.z;
  V colour[3], gain[kMaxBands], slope[kMaxBands], curve[kMaxBands];
  for (int k = 0; k < 3; ++k) colour[k] = load_lanes<T, W>(lights.radiance[k] + first, filled);
  // g, dg/dd, d2g/dd2, each times sign^l.
  CapRecurrence<T, V> r(seen.versine);
  V parity = zero + T(1);
  for (int l = 0; l < bands; ++l, parity *= d.sign) {
    if (l > 0) r.step(l);
    gain[l] = parity * (l > 0 ? T(kSeenPi) * seen.sine2 * r.q : T(2 * kSeenPi) * seen.versine);
    const V p2 = T(2 * kSeenPi) * parity * r.p;
    slope[l] = p2 * seen.dt;
    curve[l] = p2 * seen.d2t - T(kSeenPi * l * (l + 1)) * parity * r.q * seen.dt * seen.dt;
  }
  const V sx = x * d.sign, sy = y * d.sign;
  V c[kMaxBands], s[kMaxBands], above[kMaxBands], above2[kMaxBands];
  c[0] = zero + T(1), s[0] = zero;
  for (int m = 1; m < bands; ++m) c[m] = sx * c[m - 1] - sy * s[m - 1], s[m] = sx * s[m - 1] + sy * c[m - 1];
  for (int l = 0; l < bands; ++l) above[l] = above2[l] = zero;

  // One coefficient Y = X C, C(x, y) harmonic with derivatives cx, cy, cxx, cxy; q, q1, q2: X and its
  // derivatives for z.
  const auto add = [&](int l, int m, int i, V q, V q1, V q2, V C, V cx, V cy, V cxx, V cxy) {
    const V Y = q * C, fz = q1 * C, fx = q * cx, fy = q * cy;
    // Along the direction: w.grad f and H w, with x cx + y cy = m C and x cxx + y cxy = (m-1) cx.
    const V radial = T(m) * Y + z * fz;
    const V gx = fx - x * radial, gy = fy - y * radial, gz = fz - z * radial;  // tangent
    const V hxx = q * cxx, hxy = q * cxy, hxz = q1 * cx, hyz = q1 * cy, hzz = q2 * C;
    const V ux = T(m - 1) * fx + z * hxz, uy = T(m - 1) * fy + z * hyz, uz = T(m) * fz + z * hzz;
    const V uu = x * ux + y * uy + z * uz;
    // Hessian of g(d) Y(w/d): g/d^2 (P H P - radial P - w(x)g - g(x)w) + g'/d (w(x)g + g(x)w) + Y (g'' w(x)w
    // + g'/d P), P = 1 - w(x)w, as k H + w(x)v + v(x)w + n w(x)w + e 1.
    const V k = gain[l] * inv * inv, cross = slope[l] * inv;
    const V e = Y * cross - k * radial, n = k * uu + Y * curve[l] - e, t = cross - k;
    const V vx = t * gx - k * ux, vy = t * gy - k * uy, vz = t * gz - k * uz;
    const V turn = -gain[l] * inv, grow = -slope[l] * Y;
    const V out[10] = {gain[l] * Y,
                       turn * gx + grow * x,
                       turn * gy + grow * y,
                       turn * gz + grow * z,
                       k * hxx + T(2) * x * vx + n * x * x + e,
                       k * hxy + x * vy + y * vx + n * x * y,
                       k * hxz + x * vz + z * vx + n * x * z,
                       T(2) * y * vy - k * hxx + n * y * y + e,
                       k * hyz + y * vz + z * vy + n * y * z,
                       k * hzz + T(2) * z * vz + n * z * z + e};
    V* sum = lanes + static_cast<size_t>(i) * 30;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 10; ++b) sum[a * 10 + b] += colour[a] * out[b];
    }
  };
  for (int m = bands - 1; m >= 0; --m) {
    const Step<T>* step = tables<T>().column(m) - m;
    const V c1 = m > 0 ? T(m) * d.sign * c[m - 1] : zero, s1 = m > 0 ? T(m) * d.sign * s[m - 1] : zero;
    const V c2 = m > 1 ? T(m * (m - 1)) * c[m - 2] : zero, s2 = m > 1 ? T(m * (m - 1)) * s[m - 2] : zero;
    V p_ = zero + T(1), e = zero;
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        e = step[l].fall * e - step[l].rise * p_;
        p_ += d.u * e;
      }
      const V q = step[l].norm * p_, q1 = step[l].slope * (d.sign * above[l]), q2 = step[l].curve * above2[l];
      above2[l] = above[l], above[l] = p_;
      add(l, m, index(l, m), q, q1, q2, c[m], c1, -s1, c2, -s2);
      if (m > 0) add(l, m, index(l, -m), q, q1, q2, s[m], s1, c1, s2, c2);
    }
  }
}

}  // namespace detail

/// sum and gradient as accumulate_lights_gradient; hessian[(c * 6 + k) * count(bands) + i] += second
/// derivatives with respect to x, k in the order xx, xy, xz, yy, yz, zz.
template <class T>
void accumulate_lights_hessian(int bands, LightShape shape, const Vec3<T>& x, const LightArrays<T>& lights,
                               T* sum, T* gradient, T* hessian) {
  constexpr int kWidth = lane_count<T>;
  using V = Lanes<T, kWidth>;
  thread_local std::vector<V> lanes;
  const int n = count(bands);
  lanes.assign(static_cast<size_t>(n) * 30, V{});
  for (int first = 0; first < lights.count; first += kWidth) {
    detail::add_hessians<T, kWidth>(bands, shape, x, lights, first, lanes.data());
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 30; ++k) {
      const V& v = lanes[static_cast<size_t>(i) * 30 + k];
      T total = 0;
      for (int lane = 0; lane < kWidth; ++lane) total += v[lane];
      const int colour = k / 10, part = k % 10;
      T* out = part == 0  ? sum + colour * n
               : part < 4 ? gradient + (colour * 3 + part - 1) * n
                          : hessian + (colour * 6 + part - 4) * n;
      out[i] += total;
    }
  }
}

}  // namespace zonal::sh
