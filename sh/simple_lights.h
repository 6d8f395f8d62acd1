#pragma once
/// Lights without size: their radiance is a Dirac, so their SH coefficients are the basis in its direction
/// times what arrives from there (Mézières 2022, section 3.1.1 and Eq. 5.16-5.20).
///
///     sh::point_light(5, x, light, 1.0f, L);                   // 1/d^2
///     sh::point_light_yuksel(5, x, light, 1.0f, 0.1f, L);      // no singularity

#include <algorithm>

#include "sh/attenuation.h"

namespace zonal::sh {

/// Irradiance-like weight of a Dirac and its gradient for x, towards the unit axis at a distance.
template <class T>
struct Dirac {
  Vec3<T> axis{0, 0, 1};
  T distance = 1;
  T weight = 0;
  Vec3<T> grad_weight{0};  ///< with respect to x
};

/// weight Y_lm(axis); gradient weight grad_x Y + Y grad_x weight, grad_x Y = -grad_w Y (Eq. 5.20). gradient
/// may be null.
template <class T>
void dirac_light(int bands, const Dirac<T>& dirac, T* L, Vec3<T>* gradient = nullptr) {
  if (gradient) {
    evaluate_gradient(bands, dirac.axis, L, gradient);
    // In double and narrowed: next to a light the gradient leaves float's range.
    const double turn = -double(dirac.weight) / double(dirac.distance);
    for (int i = 0; i < count(bands); ++i) {
      for (int k = 0; k < 3; ++k) {
        gradient[i][k] =
            detail::saturated<T>(double(gradient[i][k]) * turn + double(dirac.grad_weight[k]) * double(L[i]));
      }
    }
  } else {
    evaluate(bands, dirac.axis, L);
  }
  for (int i = 0; i < count(bands); ++i) L[i] *= dirac.weight;
}

/// What a point light of intensity `intensity` (W/sr) at y sends to x.
template <class T>
Dirac<T> see_point(const Vec3<T>& x, const Vec3<T>& y, T intensity, const Attenuation<T>& attenuation) {
  const Vec3<double> w = Vec3<double>(y) - Vec3<double>(x);
  const double d = detail::safe_length(w);
  Dirac<T> dirac;
  if (!(d > 0)) {
    dirac.weight = intensity * attenuation.value;
    return dirac;
  }
  dirac.axis = Vec3<T>(w / d);
  dirac.distance = T(d);
  dirac.weight = intensity * attenuation.value;
  dirac.grad_weight = attenuation.gradient * intensity;
  return dirac;
}

/// 1/d^2 (Eq. 5.17, 5.21); black at d = 0. gradient with respect to x, may be null.
template <class T>
void point_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T intensity, T* L,
                 Vec3<T>* gradient = nullptr) {
  dirac_light(bands, see_point(x, y, intensity, inverse_square(y - x)), L, gradient);
}

/// Yuksel's attenuation with radius r > 0 (Eq. 5.18, 5.22).
template <class T>
void point_light_yuksel(int bands, const Vec3<T>& x, const Vec3<T>& y, T intensity, T r, T* L,
                        Vec3<T>* gradient = nullptr) {
  dirac_light(bands, see_point(x, y, intensity, yuksel(y - x, r)), L, gradient);
}

/// A cone around the unit `axis`: full intensity within cos_inner, none beyond cos_outer < cos_inner, between
/// them the smooth step 3u^2 - 2u^3.
template <class T>
struct SpotCone {
  Vec3<T> axis{0, 0, -1};
  T cos_inner = T(0.95), cos_outer = T(0.9);
};

template <class T>
void spot_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T intensity, const SpotCone<T>& cone, T* L,
                Vec3<T>* gradient = nullptr) {
  Dirac<T> dirac = see_point(x, y, intensity, inverse_square(y - x));
  const T cosine = -glm::dot(cone.axis, dirac.axis), width = cone.cos_inner - cone.cos_outer;
  const T u = std::clamp((cosine - cone.cos_outer) / width, T(0), T(1));
  const T falloff = u * u * (3 - 2 * u), slope = 6 * u * (1 - u) / width;
  // The cosine's gradient for x: w = y - x turns, d(-axis.w/|w|)/dx = (axis + cosine w/|w|)/d.
  const Vec3<T> grad_cosine = (cone.axis + dirac.axis * cosine) / dirac.distance;
  dirac.grad_weight = dirac.grad_weight * falloff + grad_cosine * (dirac.weight * slope);
  dirac.weight *= falloff;
  dirac_light(bands, dirac, L, gradient);
}

/// Parallel light of perpendicular irradiance 1 travelling along the unit `direction`: Y(-direction). Does
/// not depend on x.
template <class T>
void directional_light(int bands, const Vec3<T>& direction, T irradiance, T* L) {
  Dirac<T> dirac;
  dirac.axis = -direction, dirac.weight = irradiance;
  dirac_light(bands, dirac, L);
}

}  // namespace zonal::sh
