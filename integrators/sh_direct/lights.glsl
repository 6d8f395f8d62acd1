// A scene's lights as integrators/sh_direct/sh_direct_gl.cpp packs them, gone through for one point. The including shader
// defines what is done with each: `take` with a light along one direction, `take_edge` and `take_solid_angle` with a triangle
// too near for a rule of points.

layout(binding = 10) uniform samplerBuffer lights;  // four texels each
layout(binding = 13) uniform samplerBuffer rules;   // points of triangle rules (shares of both edges, weight), then nodes
uniform int disks;         // 1: spheres are disks
uniform float cell;        // metres, > 0: slopes beside spheres are bounded for interpolation over so much
uniform float reach[6];    // largest extent over distance each rule serves
uniform float starts[8];   // of the rules' points, one past the last, and one past the nodes of edges

const int LIGHT_TEXELS = 4;
const float LIGHT_SPHERE = 0.0;
const float LIGHT_POINT = 1.0;
const float LIGHT_SPOT = 2.0;
const float LIGHT_FACING = 3.0;
const float LIGHT_TRIANGLE = 4.0;

void take(ShdSent s, vec3 colour);
// L_lm += colour dt grad Y_lm(w).n / (l(l+1)), l > 0; its slope += colour n dt over_rho Y_lm(w) (sh/polygon.h).
void take_edge(vec3 w, vec3 n, float dt, float over_rho, vec3 colour);
void take_solid_angle(float omega, vec3 colour);

#if TRIANGLES == 1
// Van Oosterom and Strackee; positive for corners counter-clockwise as seen.
float triangle_solid_angle(vec3 a, vec3 b, vec3 c) {
  float la = length(a);
  float lb = length(b);
  float lc = length(c);
  return 2.0 * atan(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
}

// A near triangle by integrals along its edges' great circles. One place calls take_edge: compilers put functions in line.
void triangle_edges(vec3 a, vec3 b, vec3 c, vec3 colour) {
  take_solid_angle(triangle_solid_angle(a, b, c), colour);
  int nodes = int(starts[7]) - int(starts[6]);
  for (int k = 0; k < 3 * nodes; ++k) {
    vec3 from = k < nodes ? a : (k < 2 * nodes ? b : c);
    vec3 to = k < nodes ? b : (k < 2 * nodes ? c : a);
    float inverse_from = 1.0 / length(from);
    float inverse_to = 1.0 / length(to);
    vec3 u = from * inverse_from;
    vec3 v = to * inverse_to;
    vec3 normal = cross(u, v);
    float sine = length(normal);
    if (sine < 1e-7) continue;
    normal /= sine;
    float angle = atan(sine, dot(u, v));
    vec2 node = texelFetch(rules, int(starts[6]) + k % nodes).xy;
    float t = node.x * angle;
    float over_rho = (sin(angle - t) * inverse_from + sin(t) * inverse_to) / sine;
    take_edge(cos(t) * u + sin(t) * cross(normal, u), normal, node.y * angle, over_rho, colour);
  }
}
#endif

void all_lights(vec3 x, int first, int end) {
  for (int j = first; j < end; ++j) {
    vec4 t0 = texelFetch(lights, LIGHT_TEXELS * j);
    vec4 t1 = texelFetch(lights, LIGHT_TEXELS * j + 1);
    vec4 t2 = texelFetch(lights, LIGHT_TEXELS * j + 2);
    vec4 t3 = texelFetch(lights, LIGHT_TEXELS * j + 3);
    vec3 to_light = t0.xyz - x;
    int start = 0;
    int count = 1;
#if TRIANGLES == 1
    // t0, t2, t3: a corner and two edges; the rule's points, or none and the edges.
    vec3 area = 0.5 * cross(t2.xyz, t3.xyz);
    if (t1.w == LIGHT_TRIANGLE) {
      vec3 middle = to_light + (t2.xyz + t3.xyz) / 3.0;
      float d2 = dot(middle, middle);
      float facing = dot(area, middle);
      // Within rounding of its plane a triangle is black, like from behind.
      float level = 1e-6 * sqrt(dot(area, area) * d2);
      if (t3.w == 1.0 ? abs(facing) <= level : facing >= -level) continue;
      float side = facing > 0.0 ? 1.0 : -1.0;
      area *= side;
      int rule = 0;
      while (rule < 6 && !(t0.w * t0.w < reach[rule] * reach[rule] * d2)) ++rule;
      if (rule == 6) {
        // Counter-clockwise seen from the lit side is negative here.
        triangle_edges(to_light, to_light + t2.xyz, to_light + t3.xyz, side * t1.rgb);
        continue;
      }
      start = int(starts[rule]);
      count = int(starts[rule + 1]) - start;
    }
#endif
    // One place calls take.
    for (int k = start; k < start + count; ++k) {
      ShdSent s;
      if (t1.w == LIGHT_SPHERE) {
        s = shd_sphere(to_light, t0.w, disks);
        if (cell > 0.0) s = shd_bounded(s, t0.w, disks, cell);
      } else if (t1.w == LIGHT_POINT) {
        s = shd_point(to_light);
      } else if (t1.w == LIGHT_SPOT) {
        s = shd_spot(to_light, t2.xyz, t2.w, t3.w);
      } else if (t1.w == LIGHT_FACING) {
        s = shd_facing_sphere(to_light, t0.w, t2.xyz, int(t3.w));
        if (cell > 0.0) s = shd_bounded(s, t0.w, 0, cell);
      }
#if TRIANGLES == 1
      else {
        vec3 share = texelFetch(rules, k).xyz;
        s = shd_triangle_point(to_light + share.x * t2.xyz + share.y * t3.xyz, area, share.z);
      }
#endif
      take(s, t1.rgb);
    }
  }
}
