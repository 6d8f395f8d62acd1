#include "gl/fly_camera.h"

#include <algorithm>

namespace zonal::gl {

FlyCamera::FlyCamera(const Camera& start, float speed) : camera(start), speed_(speed) {
  yaw_ = std::atan2(start.forward.x, -start.forward.z);
  pitch_ = std::asin(std::clamp(start.forward.y, -1.0f, 1.0f));
}

void FlyCamera::move(vec3 way, float seconds, bool fast) {
  camera.position += (way.x * camera.right + way.y * camera.up + way.z * camera.forward) *
                     (speed_ * seconds * (fast ? 4.0f : 1.0f));
}

void FlyCamera::turn(float right, float up) {
  yaw_ = std::remainder(yaw_ + right, 2 * kPi);
  pitch_ = std::clamp(pitch_ + up, -1.55f, 1.55f);
  camera.forward = {std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_), -std::cos(pitch_) * std::cos(yaw_)};
  camera.right = {std::cos(yaw_), 0, std::sin(yaw_)};
  camera.up = glm::cross(camera.right, camera.forward);
}

}  // namespace zonal::gl
