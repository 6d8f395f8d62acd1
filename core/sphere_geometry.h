#pragma once
/// Spheres as an Embree user geometry, intersected in double precision: Embree's own sphere points lose the
/// surface by the radius times 1e-7, so that a large ball shadows itself. The hit's u and v hold the normal
/// (octahedral map).

#include "core/scene_impl.h"

namespace zonal {

/// Attaches `shape` (a sphere) under its index. A collecting geometry adds each hit to the CollectingContext
/// and lets the ray go on.
void attach_sphere(RTCDevice device, RTCScene scene, const Shape& shape, bool collecting);

/// Unit vector to two numbers in [-1,1] and back (Meyer et al. 2010, "On Floating-Point Normal Vectors").
vec2 octahedral_encode(const glm::dvec3& n);
glm::dvec3 octahedral_decode(vec2 e);

/// Latitude-longitude coordinates of the outward normal: v = 1 on top (+y), u = 0.5 towards +z, growing
/// towards +x, so that a picture reads the right way round from outside.
vec2 sphere_uv(vec3 normal);

}  // namespace zonal
