#pragma once
/// Area lights and skies that keep what they are made of, for methods that integrate them rather than sample
/// them. The loader makes these; to everyone else they are a MeshLight and an EnvironmentLight.
///
///     if (const auto* mesh = dynamic_cast<const TriangleLight*>(light)) for (const auto& t :
///     mesh->triangles) ...

#include <utility>

#include "core/sampling.h"
#include "lights/light.h"

namespace zonal {

struct TriangleLight : MeshLight {
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from the lit side
  vec3 emission;                    ///< radiance, W m^-2 sr^-1
  bool two_sided;

  TriangleLight(std::vector<Triangle> some, vec3 radiance, bool both_sides)
      : MeshLight(some, radiance, both_sides),
        triangles(std::move(some)),
        emission(radiance),
        two_sided(both_sides) {}
};

/// A disk as the mesh of core/flat_shapes.h; methods that approximate take the circle.
struct DiskLight : TriangleLight {
  vec3 center, normal;  ///< unit, to the lit side
  float radius;         ///< metres

  DiskLight(std::vector<Triangle> some, vec3 radiance, bool both_sides, vec3 middle, vec3 front, float size)
      : TriangleLight(std::move(some), radiance, both_sides), center(middle), normal(front), radius(size) {}
};

/// A glowing parallelogram with a picture on it: one radiance a texel, no blending, so that sampling by
/// luminance follows it exactly.
struct TexturedLight : Light {
  vec3 corner, u,
      v;  ///< the picture's lower left, metres; its lower and left edge. The front shows along u x v
  int width, height;         ///< texels
  std::vector<vec3> texels;  ///< radiance, W m^-2 sr^-1, row-major from the top
  bool two_sided;

  TexturedLight(vec3 lower_left, vec3 right, vec3 up, int columns, int rows, std::vector<vec3> picture,
                bool both_sides);
  /// x right and y down, both in [0,1].
  vec3 texel(vec2 p) const;
  vec3 mean() const { return mean_; }
  float area() const { return area_; }

  const char* type() const override { return "textured"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override;
  float pdf(vec3, const LightHit&) const override;
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;

 private:
  vec3 normal_, mean_;
  float area_, brightest_ = 0;  ///< m^2; luminance
  Piecewise2D distribution_;    ///< by luminance, over the unit square
};

struct PictureLight : EnvironmentLight {
  int width, height;  ///< texels
  float rotation;     ///< radians, about +y

  PictureLight(int columns, int rows, std::vector<vec3> texels, float turn)
      : EnvironmentLight(columns, rows, std::move(texels), turn),
        width(columns),
        height(rows),
        rotation(turn) {}

  /// Unit, towards the picture's point; x runs right and y down, both in [0,1].
  vec3 direction(double x, double y) const {
    const double theta = M_PI * y, azimuth = 2 * M_PI * (x - 0.5) - double(rotation);
    return vec3(std::sin(theta) * std::sin(azimuth), std::cos(theta), -std::sin(theta) * std::cos(azimuth));
  }
  vec3 texel(int row, int column) const {
    return radiance({}, -direction((column + 0.5) / width, (row + 0.5) / height));
  }
};

}  // namespace zonal
