#pragma once
/// What the camera sees and will shade: where a grid is wanted, and points to try it on.
///
///     const ShSeen seen = look_around(scene, camera, stop);

#include <span>
#include <vector>

#include "core/scene.h"
#include "core/stop.h"
#include "lights/sh_lights.h"

namespace zonal {

struct ShSeen {
  struct Probe {
    Surface surface;
    Bsdf bsdf;
    double weight = 1;  ///< in means over the picture
  };
  std::vector<vec3>
      positions;  ///< of the surfaces through all pixels' centres that reflect, in the picture's order
  std::vector<Probe> probes;  ///< of some 2048 of them, spread over the picture

  /// Keeps some `count` probes, half of them chosen by the square of the light that reaches them and weighted
  /// the less: the few pixels beside a lamp make most of a grid's error. In parallel.
  void thin(int count, std::span<const ShLights* const> lights);
};

/// In parallel; the same whatever the number of threads.
ShSeen look_around(const Scene& scene, const Camera& camera, const Stop& stop);

}  // namespace zonal
