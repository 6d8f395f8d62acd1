/// From a hit to everything known of its point, and the way off a surface for the next ray.

#include <algorithm>

#include "core/scene_impl.h"
#include "core/sphere_geometry.h"

namespace zonal {

namespace {

using glm::dvec3;

constexpr float kUlp = 0x1p-24f;  ///< half the distance of neighbouring floats, relative

float max_abs(vec3 v) {
  return max_component(glm::abs(v));
}

/// Smallest cosine between the shading normal and the viewer, where interpolation or a normal map could make
/// it negative.
constexpr float kLeastCosine = 1e-3f;

/// Bends a shading normal until it lies on the side of the geometric one and faces the viewer.
vec3 facing(vec3 n, vec3 geometric, vec3 w_out) {
  const float side = glm::dot(n, geometric);
  if (side < kLeastCosine) n = glm::normalize(n + (kLeastCosine - side) * geometric);
  // dot(n + k w_out, w_out) = dot(n, w_out) + k, and w_out is on the geometric side, so the first condition
  // survives.
  const float view = glm::dot(n, w_out);
  return view < kLeastCosine ? glm::normalize(n + (kLeastCosine - view) * w_out) : n;
}

/// Directions of growing u and v on a surface.
struct Tangents {
  vec3 u{0}, v{0};
};

/// Solves edge = du dP/du + dv dP/dv for both edges of a triangle. Lengths are not kept; mirrored maps keep
/// their sense.
Tangents triangle_tangents(vec3 e1, vec3 e2, vec2 d1, vec2 d2) {
  const float sign = d1.x * d2.y - d2.x * d1.y < 0 ? -1.0f : 1.0f;
  return {sign * (e1 * d2.y - e2 * d1.y), sign * (e2 * d1.x - e1 * d2.x)};
}

/// The shading frame of a surface with tangents: x along u, z tilted by the normal map. `turned` is -1 where
/// the normal was flipped to the viewer: the relief seen from behind tilts the other way.
Frame frame_with_tangents(const Shape& shape, vec3 n, const Tangents& tangents, vec2 uv, float turned) {
  Frame frame(n, tangents.u);
  if (!shape.normal_map) return frame;
  const vec3 y = glm::dot(frame.y, tangents.v) < 0 ? -frame.y : frame.y;
  const vec3 map = 2.0f * shape.normal_map->rgb(uv) - 1.0f;
  const float scale = turned * shape.normal_scale;
  const vec3 tilted = scale * map.x * frame.x + scale * map.y * y + map.z * n;
  const float length = glm::length(tilted);
  return length > 1e-6f ? Frame(tilted / length, tangents.u) : frame;
}

void sphere_surface(const Shape& shape, const Hit& hit, Surface& s) {
  const dvec3 outward = octahedral_decode({hit.u, hit.v});
  s.position = vec3(dvec3(shape.center) + double(shape.radius) * outward);
  // The intersection is in double, so rounding the point to float is the only error.
  s.error = 2 * kUlp * max_abs(s.position);
  const vec3 n(outward);
  s.front = glm::dot(n, s.w_out) >= 0;
  s.normal = s.front ? n : -n;
  s.uv = sphere_uv(n);
  if (!shape.has_tangents) {
    s.shading = Frame(s.normal);
    return;
  }
  const vec3 east(n.z, 0, -n.x);
  const Tangents tangents{east, glm::cross(n, east)};
  s.shading = frame_with_tangents(shape, s.normal, tangents, s.uv, s.front ? 1.0f : -1.0f);
  const vec3 bent = facing(s.shading.z, s.normal, s.w_out);
  if (bent != s.shading.z) s.shading = Frame(bent, tangents.u);
}

void triangle_surface(const Shape& shape, const Hit& hit, Surface& s) {
  const uvec3 t = shape.triangles[hit.primitive];
  const Vertex &a = shape.vertices[t.x], &b = shape.vertices[t.y], &c = shape.vertices[t.z];
  // In double, so that the point lies in the triangle's plane to within its own rounding and a tiny or
  // distant triangle still has a normal.
  const dvec3 pa(a.position), e1 = dvec3(b.position) - pa, e2 = dvec3(c.position) - pa;
  s.position = vec3(pa + double(hit.u) * e1 + double(hit.v) * e2);
  const dvec3 cross = glm::cross(e1, e2);
  const double area2 = std::sqrt(glm::dot(cross, cross));  // twice the area
  const vec3 n(cross / area2);
  s.front = glm::dot(n, s.w_out) >= 0;
  s.normal = s.front ? n : -n;

  // How far off its plane the next ray can meet this triangle: Embree rounds the corners as seen from the
  // ray's origin (longest side x 2^-24), and a thin triangle turns that into a tilt (x longest side /
  // height).
  const vec3 f1(e1), f2(e2), f3(e2 - e1);
  const float longest2 = std::max(glm::dot(f1, f1), std::max(glm::dot(f2, f2), glm::dot(f3, f3)));
  const float longest = std::sqrt(longest2);
  const float tilt = longest2 / float(area2);  // longest side / height on it
  s.error = kUlp * (2 * max_abs(s.position) + 4 * longest * std::min(tilt, 1e3f));

  const float u = hit.u, v = hit.v, w = 1 - u - v;
  if (shape.has_uvs) s.uv = w * a.uv + u * b.uv + v * c.uv;
  vec3 shading = s.normal;
  float turned = s.front ? 1.0f : -1.0f;
  if (shape.has_normals) {
    const vec3 sum = w * a.normal + u * b.normal + v * c.normal;
    const float length2 = glm::dot(sum, sum);
    // The interpolated normal goes to the viewer's side, however the file winds its triangles.
    if (length2 > 1e-6f) {
      turned = glm::dot(sum, s.normal) < 0 ? -1.0f : 1.0f;
      shading = sum * (turned / std::sqrt(length2));
    }
  }
  if (shape.has_tangents && shape.has_uvs) {
    const Tangents tangents = triangle_tangents(f1, f2, b.uv - a.uv, c.uv - a.uv);
    s.shading = frame_with_tangents(shape, shading, tangents, s.uv, turned);
    const vec3 bent = facing(s.shading.z, s.normal, s.w_out);
    if (bent != s.shading.z) s.shading = Frame(bent, tangents.u);
  } else {
    s.shading = Frame(shape.has_normals ? facing(shading, s.normal, s.w_out) : shading);
  }
}

vec3 move_off(vec3 position, vec3 normal, vec3 w, float distance) {
  return position + (glm::dot(normal, w) < 0 ? -distance : distance) * normal;
}

}  // namespace

Surface Scene::surface(const Hit& hit, vec3 direction) const {
  const Shape& shape = impl_->shapes[hit.shape];
  Surface s;
  s.w_out = -direction;
  s.shape = hit.shape;
  s.primitive = shape.original ? shape.original[hit.primitive] : hit.primitive;
  s.material = shape.material_index;
  s.light = shape.light;
  if (shape.radius > 0) {
    sphere_surface(shape, hit, s);
  } else {
    triangle_surface(shape, hit, s);
  }
  return s;
}

void Scene::look_up(const Hit* hits, const vec3* directions, int count, Surface* surfaces, Bsdf* bsdfs) const {
  // A miss of the cache costs as much as a ray: three rounds of asking ahead hide most of them.
  const Shape* shapes = impl_->shapes.data();
  for (int i = 0; i < count; ++i) {
    if (hits[i].found() && !(shapes[hits[i].shape].radius > 0))
      __builtin_prefetch(&shapes[hits[i].shape].triangles[hits[i].primitive]);
  }
  for (int i = 0; i < count; ++i) {
    if (!hits[i].found() || shapes[hits[i].shape].radius > 0) continue;
    const Shape& shape = shapes[hits[i].shape];
    const uvec3 t = shape.triangles[hits[i].primitive];
    for (int corner = 0; corner < 3; ++corner) __builtin_prefetch(&shape.vertices[t[corner]]);
  }
  for (int i = 0; i < count; ++i) {
    if (!hits[i].found()) continue;
    surfaces[i] = surface(hits[i], directions[i]);
    if (const Texture* texture = shapes[hits[i].shape].first_texture) texture->prefetch(surfaces[i].uv);
  }
  for (int i = 0; i < count; ++i) {
    if (hits[i].found()) bsdfs[i] = bsdf(surfaces[i]);
  }
}

vec3 offset_origin(const Surface& s, vec3 w) {
  return move_off(s.position, s.normal, w, 4 * s.error);
}

vec3 offset_origin(vec3 position, vec3 normal, vec3 w) {
  // Without the triangle its size is guessed: as large as its distance from the world's origin, and a few
  // millimetres at least. 64 roundings of that; a metre from the origin this is 4 micrometres.
  return move_off(position, normal, w, 64 * kUlp * std::max(max_abs(position), 1e-3f));
}

}  // namespace zonal
