#pragma once
/// The kinds of golden-vector file, one function each. `file` is the whole file.

#include <algorithm>
#include <cmath>

#include "apps/golden.h"
#include "apps/verify_report.h"
#include "sh/basis.h"

namespace zonal {

void verify_basis(const Golden& file, Report& report);
void verify_gradient(const Golden& file, Report& report);
void verify_sphere_and_disk(const Golden& file, Report& report);
void verify_polygons(const Golden& file, Report& report);
void verify_rotations(const Golden& file, Report& report);
void verify_products(const Golden& file, Report& report);
void verify_ggx(const Golden& file, Report& report);
void verify_attenuation(const Golden& file, Report& report);

/// `case 13 "random"`, from the case's `tag` or `kind`.
std::string label_of(const Golden& golden_case, size_t index, const char* list = "case");

inline constexpr Precision kPrecisions[] = {Precision::kFloat, Precision::kDouble};

inline dvec3 seen(Precision p, const dvec3& v) {
  return {seen(p, v.x), seen(p, v.y), seen(p, v.z)};
}

inline std::vector<double> seen(Precision p, std::vector<double> values) {
  for (double& x : values) x = seen(p, x);
  return values;
}

/// Whether rounding left what the functions ask for: finite numbers (float ends at 3.4e38), a length other
/// than 0.
inline bool held(double positive) {
  return positive > 0 && std::isfinite(positive);
}
inline bool held(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}
inline bool held(const dvec3& v) {
  return held(std::vector{v.x, v.y, v.z}) && v != dvec3(0);
}

/// Numbers already rounded, as the type they were rounded to.
template <class T>
std::vector<T> as(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

template <class T>
std::vector<T> components(const sh::Vec3<T>& v) {
  return {v.x, v.y, v.z};
}

/// Vectors one after the other, as golden files hold them.
template <class T>
std::vector<T> flat(const std::vector<sh::Vec3<T>>& vectors) {
  std::vector<T> all;
  for (const sh::Vec3<T>& v : vectors) all.insert(all.end(), {v.x, v.y, v.z});
  return all;
}

}  // namespace zonal
