#pragma once
/// Entry points that look at what they are given: the lights of sh/, for programs that pass on what users
/// wrote. Each throws std::invalid_argument with the value found and the range wanted, then calls the
/// function of the same name.
///
///     sh::checked::sphere_light(9, x, y, -1.0f, L);   // throws: "radius is -1; it must be finite and above
///     0"

#include <stdexcept>
#include <string>

#include "sh/disk_light.h"
#include "sh/ggx_lobe.h"
#include "sh/polygon.h"
#include "sh/simple_lights.h"
#include "sh/sphere_light.h"
#include "sh/triangle_spheres.h"

namespace zonal::sh::checked {

namespace lights_detail {

[[noreturn]] inline void refuse(const std::string& what, double value, const std::string& wanted) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  throw std::invalid_argument(what + " is " + number + "; it must be " + wanted);
}

inline void bands(int n) {
  if (n < 1 || n > kMaxBands) refuse("the number of bands", n, "1 to " + std::to_string(kMaxBands));
}
template <class T>
void positive(const char* what, T v) {
  if (!(v > 0) || !std::isfinite(v)) refuse(what, double(v), "finite and above 0");
}
template <class T>
void number(const char* what, T v) {
  if (!std::isfinite(v)) refuse(what, double(v), "finite");
}
template <class T>
void finite(const char* what, const Vec3<T>& v) {
  for (int k = 0; k < 3; ++k) number((std::string(what) + "." + "xyz"[k]).c_str(), v[k]);
}

}  // namespace lights_detail

template <class T>
void sphere_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient = nullptr) {
  lights_detail::bands(bands), lights_detail::finite("the point", x), lights_detail::finite("the centre", y);
  lights_detail::positive("radius", r);
  gradient ? sh::sphere_light_gradient(bands, x, y, r, L, gradient) : sh::sphere_light(bands, x, y, r, L);
}

template <class T>
void disk_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T r, T* L, Vec3<T>* gradient = nullptr) {
  lights_detail::bands(bands), lights_detail::finite("the point", x), lights_detail::finite("the centre", y);
  lights_detail::positive("radius", r);
  gradient ? sh::disk_light_gradient(bands, x, y, r, L, gradient) : sh::disk_light(bands, x, y, r, L);
}

template <class T>
void point_light(int bands, const Vec3<T>& x, const Vec3<T>& y, T intensity, T* L,
                 Vec3<T>* gradient = nullptr) {
  lights_detail::bands(bands), lights_detail::finite("the point", x), lights_detail::finite("the light", y);
  lights_detail::number("the intensity", intensity);
  if (x == y) throw std::invalid_argument("the point is the light's own position; it must lie elsewhere");
  sh::point_light(bands, x, y, intensity, L, gradient);
}

/// Normalises the direction, of any length but 0.
template <class T>
void directional_light(int bands, const Vec3<T>& direction, T irradiance, T* L) {
  lights_detail::bands(bands), lights_detail::finite("the direction", direction);
  lights_detail::number("the irradiance", irradiance);
  if (direction == Vec3<T>(0))
    throw std::invalid_argument("the direction is (0, 0, 0); it must have a length above 0");
  sh::directional_light(bands, normalized(direction), irradiance, L);
}

/// Half angle in radians, 0 to pi.
template <class T>
void cap_zonal(int bands, T half_angle, T* z) {
  lights_detail::bands(bands);
  if (!(half_angle >= 0 && half_angle <= T(3.14159274))) {
    lights_detail::refuse("the half angle", double(half_angle), "0 to pi");
  }
  sh::cap_zonal(bands, cap_from_half_angle(half_angle), z);
}

template <class T>
void ggx_zonal(int bands, GgxLobe lobe, T alpha, T* z, T* dz_dalpha = nullptr) {
  lights_detail::bands(bands);
  if (!(alpha >= T(1e-6) && alpha <= 1))
    lights_detail::refuse("the GGX width alpha", double(alpha), "1e-6 to 1");
  sh::ggx_zonal(bands, lobe, alpha, z, dz_dalpha);
}

namespace lights_detail {

/// Refuses vertices that are not finite, lie at x, or span no area.
template <class T>
void polygon(int n, const Vec3<T>* v, const Vec3<T>& x) {
  if (n < 3) refuse("the number of vertices", n, "3 or more");
  finite("the point", x);
  Vec3<double> area(0);
  double longest = 0;
  for (int i = 0; i < n; ++i) {
    const std::string name = "vertex " + std::to_string(i);
    finite(name.c_str(), v[i]);
    if (v[i] == x) throw std::invalid_argument(name + " is the point itself; it must lie elsewhere");
    const Vec3<double> e = Vec3<double>(v[i]) - Vec3<double>(v[0]);
    for (int k = 0; k < 3; ++k) longest = std::max(longest, std::fabs(e[k]));
  }
  for (int i = 2; longest > 0 && i < n; ++i) {
    area += glm::cross((Vec3<double>(v[i - 1]) - Vec3<double>(v[0])) / longest,
                       (Vec3<double>(v[i]) - Vec3<double>(v[0])) / longest);
  }
  const double twice = glm::length(area);
  if (!(twice > 0))
    throw std::invalid_argument("the polygon is degenerate: its area is 0; it must be above 0");
}

}  // namespace lights_detail

template <class T>
void polygon_light(int bands, int n, const Vec3<T>* vertices, const Vec3<T>& x, T* L,
                   Vec3<T>* gradient = nullptr) {
  lights_detail::bands(bands), lights_detail::polygon(n, vertices, x);
  sh::polygon_light(bands, n, vertices, x, L, gradient);
}

template <class T>
TriangleSphere<T> triangle_sphere(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
  const Vec3<T> v[3] = {a, b, c};
  const Vec3<T> nowhere((a + b + c) / T(3));
  lights_detail::polygon(3, v, nowhere);
  return sh::triangle_sphere(a, b, c);
}

}  // namespace zonal::sh::checked
