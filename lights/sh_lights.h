#pragma once
/// Every light of a scene on spherical harmonics: the coefficients of the light that arrives at a point from
/// all of them, visibility left out, with their gradient as the point moves (Mézières 2022, Sec. 3
/// and 4.2). Lights of a kind are kept as arrays and run several at once.
///
///     const ShLights lights(scene.lights(), {.bands = 5});
///     float L[3 * 25];
///     lights.coefficients(5, x, L);            // L[c * sh::count(5) + l(l+1)+m], colour c, world frame
///
/// Spheres are caps; triangles of quads, disks, polygons and meshes are integrated exactly or stand for
/// spheres, and so do the cells of a quadtree that pictures are cut in (Sec. 3.4); points and spots are
/// Diracs; parallel light and the environment do not depend on the point and are projected once. Lights that
/// shine on one side are black seen from the other; a sphere seen from inside is a hemisphere.

#include <memory>
#include <string>
#include <vector>

#include "lights/shaped_lights.h"
#include "sh/light_batch.h"
#include "sh/simple_light_batch.h"
#include "sh/triangle_batch.h"
#include "sh/triangle_spheres.h"

namespace zonal {

struct ShLightOptions {
  enum class Polygons { exact, main, alternative, compromise_radius, compromise_angle, factorized };

  int bands = 5;  ///< most bands that will be asked for: of the environment's projection
  sh::LightShape shape = sh::LightShape::sphere;  ///< disk: spheres as disks that face the point (Eq. 3.29)
  Polygons polygons = Polygons::exact;
  /// Spheres for triangles: a triangle is cut in two until its spheres are off by less than this share, seen
  /// from `split_distance` metres; 0: one sphere a triangle.
  float split_error = 0, split_distance = 1;
  /// Pictures become cells of one radiance each, as few as keep the light that is moved below this share of
  /// all of it; 0: one cell a texel.
  float texture_error = 0.05f;
  /// Relative error allowed to an exact triangle by the bound of sh/triangle_batch.h: far ones are one
  /// direction, near ones take more.
  float tolerance = 1e-3f;
};

/// A reflection in the terms of the zonal product: weights of the Legendre sums.
struct ShZonalLobe {
  vec3 normal{0, 0, 1}, axis{0, 0, 1};  ///< unit, world
  int bands = 1;
  const float *cosine = nullptr,
              *lobe = nullptr;  ///< (2l+1)/4pi times the integral of P_l times cosine or lobe
};

class ShLights {
 public:
  ShLights() = default;
  explicit ShLights(const std::vector<std::unique_ptr<Light>>& lights, const ShLightOptions& options = {});
  explicit ShLights(const std::vector<const Light*>& lights, const ShLightOptions& options = {});

  /// Caps, triangles, points and spots: what is summed for a point.
  int count() const;
  /// Written, not added: L[c * sh::count(bands) + i].
  void coefficients(int bands, vec3 x, float* L) const;
  /// Also gradient[(c * 3 + axis) * sh::count(bands) + i], with respect to x. `cell` > 0, metres: that of
  /// spheres is bounded beside them, for interpolation over so much (sh/light_batch.h).
  void gradient(int bands, vec3 x, float* L, float* gradient, float cell = 0) const;
  /// Also hessian[(c * 6 + k) * sh::count(bands) + i], second derivatives xx, xy, xz, yy, yz, zz: of spheres
  /// in closed form, of all others by differences of gradients over `step` metres.
  void hessian(int bands, vec3 x, float step, float* L, float* gradient, float* hessian,
               float cell = 0) const;

  /// What cubic Hermite interpolation over `cell` metres may miss at x of the spheres beside it, as the norm
  /// of the coefficients of all colours: where a sphere lies within a cell its corners know nothing of it.
  float missed(int bands, vec3 x, float cell) const;

  /// The zonal product (Eq. 5.14, Sec. 5.2.7) with all lights that have a place: their irradiance, and their
  /// light times lobe times the cosine towards their middle. Triangles are spheres: not for Polygons::exact.
  void zonal(vec3 x, const ShZonalLobe& lobe, vec3* diffuse, vec3* specular) const;
  /// The coefficients of all others: parallel light and environment.
  void fixed(int bands, float* L) const;

  /// A structure of arrays; `radiance` of spheres and triangles, intensity of points and spots.
  struct Arrays {
    std::vector<float> x, y, z, radius, colour[3], axis_x, axis_y, axis_z, cos_inner, cos_outer;
    int count() const { return static_cast<int>(x.size()); }
    void add(vec3 position, vec3 value);
    sh::LightArrays<float> caps(float cell = 0) const;
    sh::DiracArrays<float> diracs() const;
  };
  /// Triangles as spheres (Sec. 4.2).
  struct Triangles {
    Arrays spheres;  ///< of equal area at the centroids; axis: the lit side's normal
    std::vector<sh::TriangleSphere<float>> shapes;
    std::vector<float> back;  ///< what the cosine is multiplied with behind: -1, or 0 for lights of one side
  };

  /// What is summed, for a copy elsewhere (a GPU).
  const Arrays& spheres() const { return spheres_; }
  const Arrays& points() const { return points_; }
  const Arrays& spots() const { return spots_; }
  const sh::TriangleBatch<float>& exact_triangles() const { return exact_; }
  const Triangles& triangles() const { return triangles_; }
  const ShLightOptions& options() const { return options_; }

 private:
  void add_mesh(const TriangleLight&);
  void add_picture(const TexturedLight&);
  void add_flat(vec3 center, vec3 area, vec3 radiance, bool two_sided);
  void add_triangle(vec3 a, vec3 b, vec3 c, vec3 radiance, bool two_sided, int depth);
  float split_error_of(const sh::TriangleSphere<float>&) const;
  void add_environment(const PictureLight&);
  void all(int bands, vec3 x, float* L, float* gradient, float cell, bool spheres = true) const;
  sh::LightArrays<float> facing_spheres(vec3 x, float* weighted, float cell = 0) const;
  void triangles_as_spheres(int bands, vec3 x, float* L, float* gradient, float cell) const;
  void triangles_factorized(int bands, vec3 x, float* L, float* gradient) const;
  void triangles_one_by_one(int bands, vec3 x, float* L, float* gradient) const;

  ShLightOptions options_;
  Arrays spheres_, points_, spots_;
  sh::TriangleBatch<float> exact_;
  Triangles triangles_;
  std::vector<float> fixed_;  ///< [c * sh::count(options_.bands) + i]: parallel light and environment
};

}  // namespace zonal
