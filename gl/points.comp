// From the triangle each pixel sees to everything a method asks of its point: what Scene::surface and Scene::bsdf find, from
// the same ray. Spheres are met here, ray by ray.
layout(local_size_x = 8, local_size_y = 8) in;
#define POINT_WRITE
#include "gl/coats.glsl"
#include "gl/scene.glsl"
#include "gl/brdf.glsl"
#include "gl/material.glsl"
#include "gl/point.glsl"

layout(binding = 8) uniform usampler2D visibility;
uniform ivec2 size;
uniform vec2 inside;  // where in the pixel the ray goes; (0.5, 0.5): its centre
uniform vec3 eye;
uniform vec3 right;
uniform vec3 up;
uniform vec3 forward;
uniform float half_height;  // tangent of half the vertical angle
uniform int sphere_count;

struct Frame {
  vec3 x;
  vec3 y;
  vec3 z;
};

// Duff et al. 2017, as core/vec.h.
Frame frame_of(vec3 n) {
  float side = n.z < 0.0 ? -1.0 : 1.0;
  float a = -1.0 / (side + n.z);
  float b = n.x * n.y * a;
  return Frame(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3(b, side + n.y * n.y * a, -n.y), n);
}
Frame frame_along(vec3 n, vec3 tangent) {
  vec3 t = tangent - n * dot(n, tangent);
  float length2 = dot(t, t);
  Frame f = frame_of(n);
  if (length2 > 1e-20) {
    f.x = t / sqrt(length2);
    f.y = cross(n, f.x);
  }
  return f;
}

// Bends a shading normal until it lies on the side of the geometric one and faces the viewer.
vec3 facing(vec3 n, vec3 geometric, vec3 w_out) {
  float side = dot(n, geometric);
  if (side < 1e-3) n = normalize(n + (1e-3 - side) * geometric);
  float view = dot(n, w_out);
  return view < 1e-3 ? normalize(n + (1e-3 - view) * w_out) : n;
}

// The frame of a surface with tangents: x along u, z tilted by the normal map; `turned` is -1 where the normal was flipped.
Frame frame_with_tangents(int material, vec3 n, vec3 u, vec3 v, vec2 uv, float turned) {
  Frame frame = frame_along(n, u);
  int map = int(texelFetch(materials, 8 * material + 5).w);
  if (map < 0) return frame;
  vec3 y = dot(frame.y, v) < 0.0 ? -frame.y : frame.y;
  vec3 relief = 2.0 * texture_at(map, uv).rgb - 1.0;
  float scale = turned * texelFetch(materials, 8 * material + 6).w;
  vec3 tilted = scale * relief.x * frame.x + scale * relief.y * y + relief.z * n;
  float size = length(tilted);
  return size > 1e-6 ? frame_along(tilted / size, u) : frame;
}

vec2 sphere_uv(vec3 n) {
  return vec2(0.5 + atan(n.x, n.z) * 0.159154943, 1.0 - acos(clamp(n.y, -1.0, 1.0)) * 0.318309886);
}

// The nearest sphere before t along the ray, if any: its shape, and the normal there.
int nearest_sphere(vec3 d, inout float t, out vec3 outward) {
  int found = -1;
  for (int i = 0; i < sphere_count; ++i) {
    int number = int(texelFetch(spheres, i).x);
    Shape shape = shape_at(number);
    vec3 to = shape.center - eye;
    float middle = dot(to, d);
    vec3 nearest = middle * d - to;  // from the centre, where the ray passes it
    float discriminant = shape.radius * shape.radius - dot(nearest, nearest);
    if (discriminant < 0.0) continue;
    float half_chord = sqrt(discriminant);
    for (int root = 0; root < 2; ++root) {
      float at = root == 0 ? middle - half_chord : middle + half_chord;
      if (at <= 0.0 || at >= t) continue;
      vec3 n = normalize(nearest + (root == 0 ? -half_chord : half_chord) * d);
      if ((shape.flags & SHAPE_MASK) != 0u && masked(shape.material, sphere_uv(n))) continue;
      t = at;
      found = number;
      outward = n;
    }
  }
  return found;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  vec2 film = vec2(at) + inside;
  vec2 plane = vec2(2.0 * film.x - float(size.x), float(size.y) - 2.0 * film.y) / float(size.y) * half_height;
  vec3 d = normalize(forward + plane.x * right + plane.y * up);

  // The triangle the pixel sees, met by its ray.
  float t = 3.4e38;
  float u = 0.0;
  float v = 0.0;
  int triangle = int(texelFetch(visibility, at, 0).x) - 1;
  Vertex a;
  Vertex b;
  Vertex c;
  int number = -1;
  if (triangle >= 0) {
    uvec4 corners = triangle_at(triangle);
    a = vertex_at(corners.x);
    b = vertex_at(corners.y);
    c = vertex_at(corners.z);
    number = int(corners.w);
    vec3 e1 = b.position - a.position;
    vec3 e2 = c.position - a.position;
    vec3 p = cross(d, e2);
    float determinant = dot(e1, p);
    vec3 s = eye - a.position;
    vec3 q = cross(s, e1);
    float inverse = determinant == 0.0 ? 0.0 : 1.0 / determinant;
    // A pixel on an edge may see a triangle that its ray just misses.
    u = clamp(dot(s, p) * inverse, 0.0, 1.0);
    v = clamp(dot(d, q) * inverse, 0.0, 1.0 - u);
    t = dot(e2, q) * inverse;
  }
  vec3 outward;
  int sphere = nearest_sphere(d, t, outward);

  Point point;
  point.depth = 0.0;
  point.kind = KIND_BLACK;
  point.shape = -1;
  point.primitive = -1;
  point.position = point.normal = point.x = point.y = point.z = vec3(0.0);
  point.emitted = point.albedo = point.specular = vec3(0.0);
  point.kept = 0.0;
  point.material = 0;
  float kept = 0.0;
  if (sphere < 0 && triangle < 0) {
    point.brdf = brdf_unpack(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    point_write(at, point);
    return;
  }

  Shape shape = shape_at(sphere >= 0 ? sphere : number);
  bool tangents = (shape.flags & SHAPE_TANGENTS) != 0u;
  Frame frame;
  vec3 n;
  vec2 uv = vec2(0.0);
  bool front;
  if (sphere >= 0) {
    point.position = shape.center + shape.radius * outward;
    front = dot(outward, d) <= 0.0;
    n = front ? outward : -outward;
    uv = sphere_uv(n);
    frame = frame_of(n);
    if (tangents) {
      vec3 east = vec3(n.z, 0.0, -n.x);
      frame = frame_with_tangents(shape.material, n, east, cross(n, east), uv, front ? 1.0 : -1.0);
      vec3 bent = facing(frame.z, n, -d);
      if (bent != frame.z) frame = frame_along(bent, east);
    }
  } else {
    float w = 1.0 - u - v;
    vec3 e1 = b.position - a.position;
    vec3 e2 = c.position - a.position;
    point.position = a.position + u * e1 + v * e2;
    n = normalize(cross(e1, e2));
    front = dot(n, d) <= 0.0;
    if (!front) n = -n;
    if ((shape.flags & SHAPE_UVS) != 0u) uv = w * a.uv + u * b.uv + v * c.uv;
    vec3 shading = n;
    float turned = front ? 1.0 : -1.0;
    if ((shape.flags & SHAPE_NORMALS) != 0u) {
      vec3 sum = w * a.normal + u * b.normal + v * c.normal;
      float length2 = dot(sum, sum);
      if (length2 > 1e-6) {
        turned = dot(sum, n) < 0.0 ? -1.0 : 1.0;
        shading = sum * (turned / sqrt(length2));
      }
    }
    if (tangents && (shape.flags & SHAPE_UVS) != 0u) {
      vec2 d1 = b.uv - a.uv;
      vec2 d2 = c.uv - a.uv;
      float side = d1.x * d2.y - d2.x * d1.y < 0.0 ? -1.0 : 1.0;
      vec3 along = side * (e1 * d2.y - e2 * d1.y);
      frame = frame_with_tangents(shape.material, shading, along, side * (e2 * d1.x - e1 * d2.x), uv, turned);
      vec3 bent = facing(frame.z, n, -d);
      if (bent != frame.z) frame = frame_along(bent, along);
    } else {
      frame = frame_of((shape.flags & SHAPE_NORMALS) != 0u ? facing(shading, n, -d) : shading);
    }
  }

  Bsdf bsdf = material_at(shape.material, uv);
  vec3 o = -vec3(dot(frame.x, d), dot(frame.y, d), dot(frame.z, d));
  point.brdf = brdf_of(bsdf, o, kept);
  point.brdf.o.z = o.z;
  point.depth = t;
  point.normal = n;
  point.x = frame.x;
  point.y = frame.y;
  point.z = frame.z;
  int glow = 4 * (sphere >= 0 ? sphere : number) + (front ? 2 : 3);
  point.emitted = texelFetch(shapes, glow).rgb;
  point.kind = bsdf.kind;
  point.albedo = bsdf.diffuse;
  point.kept = kept;
  point.specular = bsdf.specular;
  point.material = shape.material;
  point.shape = sphere >= 0 ? sphere : number;
  point.primitive = sphere >= 0 ? 0 : triangle - shape.first_triangle;
  point_write(at, point);
}
