#include "core/sphere_geometry.h"

namespace zonal {

namespace {

using glm::dvec3;

struct Roots {
  int count = 0;
  double t[2] = {0, 0};  ///< ascending
};

/// Where origin + t direction meets the sphere. The discriminant comes from the point of the line nearest to
/// the centre, which stays accurate far away (Haines, Guenther and Akenine-Moeller 2019, Ray Tracing Gems,
/// chapter 7).
Roots intersect_sphere(dvec3 center, double radius, dvec3 origin, dvec3 direction) {
  const double dd = glm::dot(direction, direction);
  const double middle = glm::dot(center - origin, direction) / dd;
  const dvec3 nearest = origin + middle * direction - center;
  const double discriminant = radius * radius - glm::dot(nearest, nearest);
  if (!(discriminant >= 0)) return {};
  const double half = std::sqrt(discriminant / dd);
  return {2, {middle - half, middle + half}};
}

dvec3 normal_at(const Shape& shape, dvec3 origin, dvec3 direction, double t) {
  return glm::normalize(origin + t * direction - dvec3(shape.center));
}

void bounds(const RTCBoundsFunctionArguments* arguments) {
  const Shape& s = *static_cast<const Shape*>(arguments->geometryUserPtr);
  // One float step outwards: centre +- radius was rounded.
  const auto down = [](float x) { return std::nextafter(x, -kInfinity); };
  const auto up = [](float x) { return std::nextafter(x, kInfinity); };
  const vec3 low = s.center - s.radius, high = s.center + s.radius;
  RTCBounds& b = *arguments->bounds_o;
  b.lower_x = down(low.x), b.lower_y = down(low.y), b.lower_z = down(low.z);
  b.upper_x = up(high.x), b.upper_y = up(high.y), b.upper_z = up(high.z);
}

/// Calls `found(t, normal, lane)` for every root in the lane's interval, nearest first, until it returns
/// true.
template <class Found>
void for_each_hit(const Shape& shape, const int* valid, RTCRayN* ray, unsigned n, Found found) {
  for (unsigned i = 0; i < n; ++i) {
    if (!valid[i]) continue;
    const dvec3 origin(RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i));
    const dvec3 direction(RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i));
    const Roots roots = intersect_sphere(shape.center, shape.radius, origin, direction);
    for (int k = 0; k < roots.count; ++k) {
      const double t = roots.t[k];
      if (!(t > RTCRayN_tnear(ray, n, i) && t < RTCRayN_tfar(ray, n, i))) continue;
      const dvec3 normal = normal_at(shape, origin, direction, t);
      if (shape.has_mask && shape.material->masked(sphere_uv(vec3(normal)))) continue;
      if (found(float(t), normal, i)) break;
    }
  }
}

void intersect(const RTCIntersectFunctionNArguments* a) {
  const Shape& shape = *static_cast<const Shape*>(a->geometryUserPtr);
  RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hit = RTCRayHitN_HitN(a->rayhit, a->N);
  for_each_hit(shape, a->valid, ray, a->N, [&](float t, const dvec3& normal, unsigned i) {
    const vec2 e = octahedral_encode(normal);
    RTCRayN_tfar(ray, a->N, i) = t;
    RTCHitN_u(hit, a->N, i) = e.x, RTCHitN_v(hit, a->N, i) = e.y;
    RTCHitN_Ng_x(hit, a->N, i) = float(normal.x);
    RTCHitN_Ng_y(hit, a->N, i) = float(normal.y);
    RTCHitN_Ng_z(hit, a->N, i) = float(normal.z);
    RTCHitN_primID(hit, a->N, i) = a->primID;
    RTCHitN_geomID(hit, a->N, i) = a->geomID;
    RTCHitN_instID(hit, a->N, i, 0) = RTC_INVALID_GEOMETRY_ID;
    return true;
  });
}

void occluded(const RTCOccludedFunctionNArguments* a) {
  const Shape& shape = *static_cast<const Shape*>(a->geometryUserPtr);
  for_each_hit(shape, a->valid, a->ray, a->N, [&](float, const dvec3&, unsigned i) {
    RTCRayN_tfar(a->ray, a->N, i) = -kInfinity;
    return true;
  });
}

void collect(const RTCIntersectFunctionNArguments* a) {
  const Shape& shape = *static_cast<const Shape*>(a->geometryUserPtr);
  auto* context = reinterpret_cast<CollectingContext*>(a->context);
  RTCRayN* ray = RTCRayHitN_RayN(a->rayhit, a->N);
  for_each_hit(shape, a->valid, ray, a->N, [&](float t, const dvec3& normal, unsigned) {
    const vec2 e = octahedral_encode(normal);
    context->hits->push_back({t, shape.index, 0, e.x, e.y});
    return false;
  });
}

}  // namespace

void attach_sphere(RTCDevice device, RTCScene scene, const Shape& shape, bool collecting) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, collecting ? collect : intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, shape.index);
  rtcReleaseGeometry(geometry);
}

vec2 octahedral_encode(const dvec3& n) {
  const double scale = 1 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  const double x = n.x * scale, y = n.y * scale;
  if (n.z >= 0) return {float(x), float(y)};
  return {float(std::copysign(1 - std::abs(y), x)), float(std::copysign(1 - std::abs(x), y))};
}

dvec3 octahedral_decode(vec2 e) {
  double x = e.x, y = e.y;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double folded_x = std::copysign(1 - std::abs(y), x);
    y = std::copysign(1 - std::abs(x), y), x = folded_x;
  }
  return glm::normalize(dvec3(x, y, z));
}

vec2 sphere_uv(vec3 n) {
  const float y = std::fmin(1.0f, std::fmax(-1.0f, n.y));
  return {0.5f + std::atan2(n.x, n.z) * (0.5f * kInvPi), 1 - std::acos(y) * kInvPi};
}

}  // namespace zonal
