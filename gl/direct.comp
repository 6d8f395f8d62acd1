// Direct light of one point, spot or directional light, with its shadow maps filtered over three by three texels.
layout(local_size_x = 8, local_size_y = 8) in;
#include "gl/coats.glsl"
#include "gl/scene.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"

layout(binding = 1, rgba32f) uniform image2D sum;
layout(binding = 11) uniform sampler2DArrayShadow maps;
uniform ivec2 size;
uniform int sphere_count;
uniform int kind;        // 0 point, 1 spot, 2 directional
uniform int faces;
uniform mat4 to_clip[6];
uniform vec3 source;     // metres
uniform vec3 axis;       // the way the light goes
uniform vec3 intensity;  // W/sr; directional: W/m^2
uniform vec3 cone;       // of a spot: 1 - cos of the inner and the outer angle, and their difference
uniform float texel;     // radians, or metres of a directional light's

// Whether a sphere stands between a point and what is `far` metres away in the direction w.
bool sphere_blocks(vec3 from, vec3 w, float far) {
  for (int i = 0; i < sphere_count; ++i) {
    Shape shape = shape_at(int(texelFetch(spheres, i).x));
    vec3 to = shape.center - from;
    float middle = dot(to, w);
    vec3 nearest = middle * w - to;
    float discriminant = shape.radius * shape.radius - dot(nearest, nearest);
    if (discriminant <= 0.0) continue;
    float chord = sqrt(discriminant);
    // A point on the sphere itself: the ray leaves from it.
    float least = 1e-4 * shape.radius;
    float first = middle - chord;
    float second = middle + chord;
    if ((first > least && first < far) || (second > least && second < far)) return true;
  }
  return false;
}

// Share of the light that arrives, by the maps.
float seen(Point p, vec3 w, float d) {
  // Off the surface by what a texel covers there, more where it is slanted.
  float width = texel * (kind == 2 ? 1.0 : d);
  float cosine = clamp(dot(p.normal, w), 0.1, 1.0);
  vec3 from = p.position + p.normal * (1.5 * width / cosine * sqrt(1.0 - cosine * cosine) + 0.5 * width);
  int face = 0;
  if (faces == 6) {
    vec3 v = from - source;
    vec3 a = abs(v);
    face = a.x >= a.y && a.x >= a.z ? (v.x > 0.0 ? 0 : 1) : a.y >= a.z ? (v.y > 0.0 ? 2 : 3) : (v.z > 0.0 ? 4 : 5);
  }
  vec4 clip = to_clip[face] * vec4(from, 1.0);
  if (clip.w <= 0.0) return 1.0;
  vec3 place = clip.xyz / clip.w;
  // Nearer by a thousandth than the surface that the map holds counts as that surface.
  float reference = kind == 2 ? place.z + 1e-4 : place.z * 1.001;
  float total = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      total += texture(maps, vec4(0.5 * place.xy + 0.5 + vec2(x, y) / 1024.0, float(face), reference));
  return total / 9.0;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  vec3 w = -axis;
  float d = 3.4e38;
  vec3 irradiance = intensity;
  if (kind < 2) {
    vec3 to_light = source - p.position;
    float d2 = dot(to_light, to_light);
    if (d2 <= 0.0) return;
    d = sqrt(d2);
    w = to_light / d;
    irradiance = intensity / d2;
    if (kind == 1) {
      // 1 - cos of the angle to the axis, from the difference of unit vectors: (SPOT-1).
      vec3 off = -w - axis;
      float v = 0.5 * dot(off, off);
      float t = cone.z > 0.0 ? clamp((cone.y - v) / cone.z, 0.0, 1.0) : (v < cone.y ? 1.0 : 0.0);
      irradiance *= v <= cone.x ? 1.0 : t * t * (3.0 - 2.0 * t);
    }
  }
  float up = dot(w, p.z);
  if (dot(w, p.normal) <= 0.0 || up <= 0.0 || irradiance == vec3(0.0)) return;
  vec3 radiance = brdf_value(p.brdf, vec3(dot(w, p.x), dot(w, p.y), up)) * irradiance * up;
  if (radiance == vec3(0.0) || sphere_blocks(p.position, w, d)) return;
  imageStore(sum, at, imageLoad(sum, at) + vec4(radiance * seen(p, w, d), 0.0));
}
