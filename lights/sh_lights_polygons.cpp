/// Triangles of area lights: exact, or as spheres (Mézières 2022, Sec. 4.2).

#include <algorithm>
#include <map>

#include "lights/sh_lights.h"
#include "sh/factorized_polygon.h"
#include "sh/polygon.h"

namespace zonal {

namespace {

constexpr int kMostCuts = 12;  ///< of a triangle, one after another: 4096 spheres

sh::TriangleMethod method_of(ShLightOptions::Polygons polygons) {
  switch (polygons) {
    case ShLightOptions::Polygons::alternative:
      return sh::TriangleMethod::alternative;
    case ShLightOptions::Polygons::compromise_radius:
      return sh::TriangleMethod::compromise_radius;
    case ShLightOptions::Polygons::compromise_angle:
      return sh::TriangleMethod::compromise_angle;
    default:
      return sh::TriangleMethod::main;
  }
}

bool as_they_are(ShLightOptions::Polygons polygons) {
  return polygons == ShLightOptions::Polygons::exact || polygons == ShLightOptions::Polygons::factorized;
}

}  // namespace

void ShLights::add_mesh(const TriangleLight& light) {
  const auto* disk = dynamic_cast<const DiskLight*>(&light);
  if (disk && !as_they_are(options_.polygons))
    return add_flat(disk->center, disk->normal * (kPi * sqr(disk->radius)), light.emission, light.two_sided);
  for (const MeshLight::Triangle& t : light.triangles)
    if (options_.polygons == ShLightOptions::Polygons::exact)
      exact_.add(t.a, t.b, t.c, light.emission, light.two_sided);
    else
      add_triangle(t.a, t.b, t.c, light.emission, light.two_sided, 0);
}

/// One sphere for a flat shape with this middle and area vector, m^2: that of an equilateral triangle,
/// whatever `split_error`.
void ShLights::add_flat(vec3 center, vec3 area, vec3 radiance, bool two_sided) {
  const float size = glm::length(area);
  const Frame frame(area / size);
  // A side of an equilateral triangle is 2 sqrt(area / sqrt(3)); its corners lie side / sqrt(3) from the
  // middle.
  const float reach = 2 * std::sqrt(size / std::sqrt(27.0f));
  const vec3 up = frame.y * (reach * 0.5f), side = frame.x * (reach * std::sqrt(0.75f));
  add_triangle(center - up - side, center - up + side, center + 2.0f * up, radiance, two_sided, kMostCuts);
}

void ShLights::add_triangle(vec3 a, vec3 b, vec3 c, vec3 radiance, bool two_sided, int depth) {
  const sh::TriangleSphere<float> shape = sh::triangle_sphere<float>(a, b, c);
  if (!(shape.radius > 0)) return;
  if (options_.split_error > 0 && depth < kMostCuts && !as_they_are(options_.polygons) &&
      split_error_of(shape) > options_.split_error) {
    // Cut the longest side.
    const float ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    if (bc >= ab && bc >= ca) return add_triangle(b, c, a, radiance, two_sided, depth);
    if (ca >= ab && ca >= bc && ca > ab) return add_triangle(c, a, b, radiance, two_sided, depth);
    const vec3 middle = 0.5f * (a + b);
    add_triangle(a, middle, c, radiance, two_sided, depth + 1);
    add_triangle(middle, b, c, radiance, two_sided, depth + 1);
    return;
  }
  Triangles& t = triangles_;
  t.spheres.add(shape.center, radiance);
  t.spheres.radius.push_back(shape.radius);
  t.spheres.axis_x.push_back(shape.normal.x), t.spheres.axis_y.push_back(shape.normal.y);
  t.spheres.axis_z.push_back(shape.normal.z);
  t.back.push_back(two_sided ? -1.0f : 0.0f), t.shapes.push_back(shape);
}

/// Relative L2 error of a triangle's sphere, the largest of three places `split_distance` away: over it, and
/// aslant by 45 degrees along its plane's axes.
float ShLights::split_error_of(const sh::TriangleSphere<float>& shape) const {
  const Frame frame(shape.normal);
  const float d = options_.split_distance, slant = std::sqrt(0.5f);
  const int bands = options_.bands, n = sh::count(bands);
  std::vector<float> exact(n), sphere(n);
  float worst = 0;
  for (const vec3 w : {frame.z, slant * (frame.z + frame.x), slant * (frame.z + frame.y)}) {
    const vec3 x = shape.center + d * w;
    sh::polygon_light<float>(bands, 3, shape.vertices, x, exact.data());
    sh::triangle_sphere_light(bands, method_of(options_.polygons), shape, x, sphere.data());
    double error = 0, size = 0;
    for (int i = 0; i < n; ++i) error += sqr(double(sphere[i]) - exact[i]), size += sqr(double(exact[i]));
    worst = std::max(worst, float(std::sqrt(error / std::max(size, 1e-300))));
  }
  return worst;
}

/// (Eq. 4.9, 4.10): spheres whose radiance is weighted by the cosine towards x, so that the kernel of spheres
/// does the work; it takes the cosine's gradient (Eq. 4.11) over the cosine. `weighted`: 6 numbers a
/// triangle.
sh::LightArrays<float> ShLights::facing_spheres(vec3 x, float* weighted, float cell) const {
  const Arrays& s = triangles_.spheres;
  const int count = s.count();
  const auto row = [&](int i) { return weighted + size_t(i) * size_t(count); };
  // Their slope is as bounded as that of directions (sh/seen_lanes.h).
  const float most = cell > 0 ? 1 / cell : kInfinity;
  const float *px = s.x.data(), *py = s.y.data(), *pz = s.z.data(), *nx = s.axis_x.data(),
              *ny = s.axis_y.data(), *nz = s.axis_z.data(), *back = triangles_.back.data();
  const float *red = s.colour[0].data(), *green = s.colour[1].data(), *blue = s.colour[2].data();
  float* __restrict__ r = row(0), * __restrict__ g = row(1), * __restrict__ b = row(2);
  float* __restrict__ tx = row(3), * __restrict__ ty = row(4), * __restrict__ tz = row(5);
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const float wx = x.x - px[k], wy = x.y - py[k], wz = x.z - pz[k];
    const float d2 = wx * wx + wy * wy + wz * wz, inverse = d2 > 0 ? 1 / std::sqrt(d2) : 0.0f;
    const float cosine = (nx[k] * wx + ny[k] * wy + nz[k] * wz) * inverse;
    const float side = cosine > 0 ? 1.0f : back[k];
    // In its plane a triangle is black, but its slope is not: the smallest cosine whose inverse is a number.
    const float facing = std::max(side * cosine, side == 0 ? 0.0f : 1e-15f);
    r[k] = red[k] * facing, g[k] = green[k] * facing, b[k] = blue[k] * facing;
    const float turn = side == 0 ? 0.0f : side * std::min(inverse, most) / facing, along = cosine * inverse;
    tx[k] = turn * (nx[k] - wx * along), ty[k] = turn * (ny[k] - wy * along),
    tz[k] = turn * (nz[k] - wz * along);
  }
  sh::LightArrays<float> caps = s.caps(cell);
  for (int i = 0; i < 3; ++i) caps.radiance[i] = row(i), caps.slope[i] = row(3 + i);
  return caps;
}

void ShLights::triangles_as_spheres(int bands, vec3 x, float* L, float* gradient, float cell) const {
  thread_local std::vector<float> weighted;
  weighted.resize(6 * triangles_.spheres.x.size());
  const sh::LightArrays<float> caps = facing_spheres(x, weighted.data(), cell);
  if (gradient)
    sh::accumulate_lights_gradient(bands, sh::LightShape::sphere, x, caps, L, gradient);
  else
    sh::accumulate_lights(bands, sh::LightShape::sphere, x, caps, L);
}

void ShLights::triangles_one_by_one(int bands, vec3 x, float* L, float* gradient) const {
  const int n = sh::count(bands);
  float one[sh::kMaxBands * sh::kMaxBands];
  thread_local std::vector<vec3> slope;
  if (gradient) slope.resize(n);
  for (size_t k = 0; k < triangles_.shapes.size(); ++k) {
    const sh::TriangleSphere<float>& t = triangles_.shapes[k];
    if (triangles_.back[k] == 0 && !(glm::dot(t.normal, x - t.center) > 0)) continue;
    sh::triangle_sphere_light<float>(bands, method_of(options_.polygons), t, x, one,
                                     gradient ? slope.data() : nullptr);
    for (int c = 0; c < 3; ++c) {
      const float radiance = triangles_.spheres.colour[c][k];
      for (int i = 0; i < n; ++i) L[c * n + i] += radiance * one[i];
      if (!gradient) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < n; ++i) gradient[(c * 3 + axis) * n + i] += radiance * slope[i][axis];
    }
  }
}

/// The literature's way, for comparison: all triangles on the lobes of a zonal factorisation, made
/// coefficients once.
void ShLights::triangles_factorized(int bands, vec3 x, float* L, float* gradient) const {
  thread_local std::map<int, sh::FactorizedPolygons> of_bands;
  sh::FactorizedPolygons& sums = of_bands.try_emplace(bands, bands).first->second;
  sums.start(gradient != nullptr);
  const Triangles& t = triangles_;
  for (size_t k = 0; k < t.shapes.size(); ++k) {
    if (t.back[k] == 0 && !(glm::dot(t.shapes[k].normal, x - t.shapes[k].center) > 0)) continue;
    glm::dvec3 corners[3];
    for (int i = 0; i < 3; ++i) corners[i] = glm::dvec3(t.shapes[k].vertices[i]) - glm::dvec3(x);
    sums.add(3, corners, {t.spheres.colour[0][k], t.spheres.colour[1][k], t.spheres.colour[2][k]});
  }
  sums.finish(L, gradient);
}

}  // namespace zonal
