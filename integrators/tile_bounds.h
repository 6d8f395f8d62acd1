#pragma once
/// A ball around a tile's points and a cone around their normals: tells for a whole tile which lights cannot
/// reach it, and how much another could bring at most.
///
///     TileBounds bounds(points);
///     if (!bounds.sees(light_position, light_normal, radius)) continue;     // exactly nothing arrives

#include "integrators/tile_points.h"

namespace zonal {

struct TileBounds {
  vec3 center{0};
  float radius = 0;            ///< metres: all points lie within
  vec3 axis{0, 0, 1};          ///< unit; all geometric normals lie within the angle below of it
  float cosine = 1, sine = 0;  ///< of that angle; -1, 0 when it is no cone

  explicit TileBounds(const TilePoints& points);

  /// False only when every point lies behind the light's surface or has the light behind its own, each by
  /// more than the light's radius.
  bool sees(vec3 position, vec3 normal, float light_radius) const;
  /// Bounds for all points and the light's sphere.
  struct Reach {
    float distance;  ///< metres no point is nearer to the light's position than
    float
        cos_light;  ///< no direction from the sphere to a point makes a larger cosine with the light's normal
    float cos_point;  ///< nor with the point's
  };
  Reach reach(vec3 position, vec3 normal, float light_radius) const;

 private:
  /// The largest dot(n, to) over the cone of normals.
  float highest(vec3 to, float length) const;
};

/// Bounds f cos of a BRDF for all directions of a given cosine, 1/sr, any channel: flat * cosine + peak.
struct Reflection {
  float flat = 0, peak = 0;
  float most(float cosine) const { return flat * cosine + peak; }
};
/// Infinite where none is known (measurements).
Reflection largest_reflection(const Bsdf& bsdf, const BsdfContext& view, Lobes lobes = Lobes::all);

}  // namespace zonal
