#pragma once
/// The smallest sphere around a scene. It is unique, so it turns with the scene and does not depend on how
/// the surfaces are cut into triangles: the length to scale everything by that must scale with the scene.

#include <functional>

#include "core/vec.h"

namespace zonal {

/// `farthest(center)` answers with the member (a point when its radius is 0) that reaches farthest from
/// `center`. Radius at most 0.1 % above the smallest, and every member is inside.
BoundingSphere enclosing_ball(const std::function<BoundingSphere(vec3 center)>& farthest);

}  // namespace zonal
