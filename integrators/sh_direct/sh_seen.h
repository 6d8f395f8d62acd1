#pragma once
/// What the camera sees and will shade: where a grid is wanted, and points to try it on.
///
///     const ShSeen seen = look_around(scene, camera, stop);

#include <vector>

#include "core/scene.h"
#include "core/stop.h"

namespace zonal {

struct ShSeen {
  struct Probe {
    Surface surface;
    Bsdf bsdf;
  };
  std::vector<vec3>
      positions;  ///< of the surfaces through all pixels' centres that reflect, in the picture's order
  std::vector<Probe> probes;  ///< of some 256 of them, spread over the picture
};

/// In parallel; the same whatever the number of threads.
ShSeen look_around(const Scene& scene, const Camera& camera, const Stop& stop);

}  // namespace zonal
