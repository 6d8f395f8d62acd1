#pragma once
/// Spherical lights and oriented disks seen from a point, one a SIMD lane: what their coefficients and
/// derivatives need, with distances in double.

#include "sh/light_batch.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {

inline constexpr double kSeenPi = 3.14159265358979323846;

/// Lights seen from x, one a lane.
template <class T, int W>
struct SeenLanes {
  using V = Lanes<T, W>;
  using D = Lanes<double, W>;
  V x, y, z, u;                     ///< axis and 1 - |z|
  V versine, sine2, dt, inverse_d;  ///< of the cap; dt/dd; 1/d
  V d2t;                            ///< d2t/dd2

  SeenLanes(LightShape shape, const Vec3<T>& p, const LightArrays<T>& lights, int first, int filled) {
    const D wx = wide(lights.x + first, filled) - double(p.x),
            wy = wide(lights.y + first, filled) - double(p.y),
            wz = wide(lights.z + first, filled) - double(p.z);
    D r = wide(lights.radius + first, filled);
    for (int k = filled; k < W; ++k) r[k] = 1;  // lanes without a light: finite, and black
    const D d2 = wx * wx + wy * wy + wz * wz, r2 = r * r;
    const D safe = d2 > 0 ? d2 : d2 * 0 + 1.0;
    const D inverse = 1.0 / sqrt_lanes(safe);
    const D ax = wx * inverse, ay = wy * inverse, az = d2 > 0 ? wz * inverse : d2 * 0 + 1.0;
    x = narrow(ax), y = narrow(ay), z = narrow(az);
    u = narrow((ax * ax + ay * ay) / ((az < 0 ? -az : az) + 1.0));
    inverse_d = narrow(inverse);
    const V zero = x * 0;
    if (shape == LightShape::sphere) {
      const D h2 = d2 - r2;
      // On or inside the sphere: the hemisphere, standing still.
      const D cosine2 = h2 > 0 ? h2 * (inverse * inverse) : h2 * 0;
      const V cosine = sqrt_lanes(narrow(cosine2));
      sine2 = narrow(h2 > 0 ? r2 * (inverse * inverse) : d2 * 0 + 1.0);
      versine = sine2 / (cosine + T(1));
      const V safe_cosine = cosine > 0 ? cosine : zero + T(1), k = inverse_d / safe_cosine;
      dt = cosine > 0 ? -sine2 * k : zero;
      // r^2 (3d^2 - 2r^2)/(d h)^3 with 3d^2 - 2r^2 = d^2 (1 + 2 cos^2)
      d2t = cosine > 0 ? sine2 * (T(1) + T(2) * cosine * cosine) * (k * k) / safe_cosine : zero;
    } else {
      const D inverse_s2 = 1.0 / (d2 + r2);
      sine2 = narrow(r2 * inverse_s2);
      const D s2d2 = d2 * inverse_s2;
      const V cosine = sqrt_lanes(narrow(s2d2));
      versine = sine2 / (cosine + T(1));
      dt = -sine2 * sqrt_lanes(narrow(inverse_s2));
      d2t = T(3) * sine2 * cosine * narrow(inverse_s2);
    }
    if (lights.cell > 0) bound(shape, lights.cell, narrow(r));
  }

  /// Within one cell h of the surface. A cubic between two ends of a monotone function is monotone where its
  /// slopes are at most thrice the secant's (Fritsch and Carlson 1980), and t falls with the distance: dt is
  /// at most 3 (t(d) - t(d + h))/h, d2t, the slope of dt, at most 3 dt/h. Sideways the light turns by 1/d a
  /// metre, but only over some d: at most 1/h.
  void bound(LightShape shape, T h, V r) {
    const auto near = inverse_d * (shape == LightShape::sphere ? r + h : r * 0 + h) > 1;
    bool any = false;
    for (int k = 0; k < W; ++k) any |= near[k] != 0;
    if (!any) return;
    const V zero = x * 0, far = T(1) / inverse_d + h, most = zero + T(1) / h;
    const V ratio = r / (shape == LightShape::sphere ? far : sqrt_lanes(far * far + r * r));
    const V s2 = ratio < 1 ? ratio * ratio : zero + T(1);
    const V rate = T(3) * most * (versine - s2 / (sqrt_lanes(T(1) - s2) + T(1)));
    dt = near && dt < -rate ? -rate : dt;
    const V curve = T(-3) * most * dt;
    d2t = near && d2t > curve ? curve : d2t;
    inverse_d = near && inverse_d > most ? most : inverse_d;
  }

  static V narrow(D v) { return __builtin_convertvector(v, V); }
  static D wide(const T* p, int filled) { return __builtin_convertvector(load_lanes<T, W>(p, filled), D); }
  DirectionLanes<T, V> direction() const { return {x, y, z, u}; }

  /// gain[l] sign^l, and 2 pi P_l sign^l times dt if wanted.
  void gains(int bands, V sign, V* gain, V* growth) const {
    CapRecurrence<T, V> r(versine);
    gain[0] = versine * T(2 * kSeenPi);
    if (growth) growth[0] = dt * T(2 * kSeenPi);
    V parity = sign, scale = sine2 * T(kSeenPi);
    for (int l = 1; l < bands; ++l) {
      r.step_q(l);
      gain[l] = scale * parity * r.q;
      if (growth) {
        r.step_p(l);
        growth[l] = T(2 * kSeenPi) * dt * parity * r.p;
      }
      parity *= sign;
    }
  }
};

}  // namespace zonal::sh
