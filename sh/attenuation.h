#pragma once
/// How a point light fades with distance, with gradients for the moving point x (Mézières 2022,
/// Eq. 5.17-5.22, signs corrected). The same functions for shaders are in sh/attenuation.glsl; these also
/// keep within range: no NaN for any finite input, results beyond the largest number are that number.
///
///     Attenuation<float> a = sh::yuksel(light - x, 0.1f);   // a.value, a.gradient

#include <cmath>
#include <limits>

#include "sh/basis.h"

namespace zonal::sh {

template <class T>
struct Attenuation {
  T value = 0;
  Vec3<T> gradient{0};  ///< with respect to x
};

namespace detail {

/// Narrows to T's finite range.
template <class T>
T saturated(double v) {
  constexpr double limit = std::numeric_limits<T>::max();
  return T(v > limit ? limit : v < -limit ? -limit : v);
}

/// |w| in double without leaving its range.
template <class T>
double safe_length(const Vec3<T>& w) {
  return std::hypot(double(w.x), double(w.y), double(w.z));
}

}  // namespace detail

/// 1/d^2 with gradient 2w/d^4, w from x to the light. Both are 0 at d = 0: a light on the point itself is
/// left out.
template <class T>
Attenuation<T> inverse_square(const Vec3<T>& w) {
  const double d = detail::safe_length(w);
  if (!(d > 0)) return {};
  Attenuation<T> a{detail::saturated<T>(1 / d / d), {}};
  for (int k = 0; k < 3; ++k) a.gradient[k] = detail::saturated<T>(double(w[k]) / d * (2 / d / d / d));
  return a;
}

/// Yuksel's 2/(s(s+d)), s = sqrt(d^2 + r^2), with gradient 2w/(d s^3); r > 0. At d = 0, a cone's tip, the
/// gradient is 0.
template <class T>
Attenuation<T> yuksel(const Vec3<T>& w, T r) {
  const double d = detail::safe_length(w), s = std::hypot(d, double(r));
  Attenuation<T> a{detail::saturated<T>(2 / s / (s + d)), {}};
  if (!(d > 0)) return a;
  for (int k = 0; k < 3; ++k) a.gradient[k] = detail::saturated<T>(double(w[k]) / d * (2 / s / s / s));
  return a;
}

/// Batch: w as three arrays of n; value[n], gradient as three arrays of n (gradient_x may be null: value
/// alone). Vectorises; expects w^2, 1/w^4 and r^2 to stay in T's range.
template <class T>
void inverse_square_batch(int n, const T* x, const T* y, const T* z, T* value, T* gradient_x, T* gradient_y,
                          T* gradient_z) {
  for (int i = 0; i < n; ++i) {
    const T d2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
    value[i] = d2 > 0 ? 1 / d2 : 0;
  }
  if (!gradient_x) return;
  for (int i = 0; i < n; ++i) {
    const T k = 2 * value[i] * value[i];
    gradient_x[i] = x[i] * k, gradient_y[i] = y[i] * k, gradient_z[i] = z[i] * k;
  }
}

template <class T>
void yuksel_batch(int n, const T* x, const T* y, const T* z, const T* radius, T* value, T* gradient_x,
                  T* gradient_y, T* gradient_z) {
  for (int i = 0; i < n; ++i) {
    const T d2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i], d = std::sqrt(d2),
            s = std::sqrt(d2 + radius[i] * radius[i]);
    value[i] = 2 / (s * (s + d));
    if (!gradient_x) continue;
    const T k = d > 0 ? 2 / (d * s * s * s) : 0;
    gradient_x[i] = x[i] * k, gradient_y[i] = y[i] * k, gradient_z[i] = z[i] * k;
  }
}

}  // namespace zonal::sh
