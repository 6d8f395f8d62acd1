#pragma once
/// A camera that flies: keys move it along its own axes, the mouse turns it about the world's up.

#include "core/scene.h"

namespace zonal::gl {

class FlyCamera {
 public:
  FlyCamera() = default;
  /// `speed`: metres a second.
  FlyCamera(const Camera& start, float speed);
  /// Each component of `way` (right, up, forward) in [-1, 1], for `seconds`.
  void move(vec3 way, float seconds, bool fast = false);
  /// Radians to the right and up; stops short of straight up and down.
  void turn(float right, float up);
  Camera camera;

 private:
  float yaw_ = 0, pitch_ = 0, speed_ = 1;
};

}  // namespace zonal::gl
