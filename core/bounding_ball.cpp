#include "core/bounding_ball.h"

#include <vector>

namespace zonal {

namespace {

double reach(const glm::dvec3& center, const BoundingSphere& member) {
  return glm::length(glm::dvec3(member.center) - center) + member.radius;
}

/// Smallest ball around a few members: walk towards the farthest by 1/(i+1) (Badoiu and Clarkson 2003,
/// "Smaller core-sets for balls", section 3). The radius is then within about 1/steps of the smallest.
glm::dvec3 center_of_few(const std::vector<BoundingSphere>& members, glm::dvec3 center) {
  constexpr int kSteps = 4096;
  for (int i = 1; i <= kSteps; ++i) {
    const BoundingSphere* farthest = &members[0];
    double most = -1;
    for (const BoundingSphere& m : members) {
      if (const double r = reach(center, m); r > most) most = r, farthest = &m;
    }
    // The farthest point of a ball lies behind its centre.
    glm::dvec3 point = farthest->center;
    const glm::dvec3 away = point - center;
    if (const double length = glm::length(away); length > 0) point += away * (farthest->radius / length);
    center += (point - center) / double(i + 1);
  }
  return center;
}

}  // namespace

BoundingSphere enclosing_ball(const std::function<BoundingSphere(vec3 center)>& farthest) {
  constexpr double kTolerance = 1e-3;
  constexpr int kRounds = 64;
  // Collect the few members that matter (a core-set): solve for those, add the one that sticks out farthest,
  // repeat.
  std::vector<BoundingSphere> core{farthest(vec3(0))};
  glm::dvec3 center = core[0].center;
  double radius = 0;
  for (int round = 0; round < kRounds; ++round) {
    const BoundingSphere outermost = farthest(vec3(center));
    center = glm::dvec3(vec3(center));
    radius = reach(center, outermost);
    double of_core = 0;
    for (const BoundingSphere& m : core) of_core = std::fmax(of_core, reach(center, m));
    if (radius <= of_core * (1 + kTolerance)) break;
    core.push_back(outermost);
    center = center_of_few(core, center);
  }
  return {vec3(center), float(radius * (1 + 1e-6))};
}

}  // namespace zonal
