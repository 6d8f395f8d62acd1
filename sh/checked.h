#pragma once
/// The functions of basis.h for input that nobody has looked at: directions are normalised, and what cannot
/// be answered is a std::invalid_argument that holds the value and the valid range.
///
///     sh::checked::evaluate(bands, user_direction, Y);

#include <cmath>
#include <stdexcept>
#include <string>

#include "sh/basis.h"

namespace zonal::sh::checked {

/// Throws unless 1 <= bands <= kMaxBands.
inline void require_bands(int bands, int largest = kMaxBands) {
  if (bands < 1 || bands > largest) {
    throw std::invalid_argument("bands is " + std::to_string(bands) + ", must be 1 to " +
                                std::to_string(largest));
  }
}

/// Throws unless v is finite and not zero.
template <class T>
void require_direction(const Vec3<T>& v, const char* name = "direction") {
  const bool finite = std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  if (finite && (v.x != 0 || v.y != 0 || v.z != 0)) return;
  throw std::invalid_argument(std::string(name) + " is (" + std::to_string(v.x) + ", " + std::to_string(v.y) +
                              ", " + std::to_string(v.z) + "), must be finite and not zero");
}

template <class T>
Vec3<T> normalized(const Vec3<T>& v) {
  require_direction(v);
  return sh::normalized(v);
}

/// Y(v/|v|).
template <class T>
void evaluate(int bands, const Vec3<T>& v, T* Y) {
  require_bands(bands);
  sh::evaluate(bands, normalized(v), Y);
}

template <class T>
void evaluate_gradient(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient) {
  require_bands(bands);
  require_direction(v);
  sh::evaluate_gradient(bands, v, Y, gradient);
}

template <class T>
void evaluate_hessian(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient, Hessian<T>* hessian) {
  require_bands(bands);
  require_direction(v);
  sh::evaluate_hessian(bands, v, Y, gradient, hessian);
}

}  // namespace zonal::sh::checked
