#pragma once
/// Area lights and skies that keep what they are made of, for methods that integrate them rather than sample
/// them. The loader makes these; to everyone else they are a MeshLight and an EnvironmentLight.
///
///     if (const auto* mesh = dynamic_cast<const TriangleLight*>(light)) for (const auto& t :
///     mesh->triangles) ...

#include <utility>

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
