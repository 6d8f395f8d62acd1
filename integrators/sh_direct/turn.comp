// Turns each pixel's reflection from its view frame into the world, where the light is: about z, x by 90 degrees, z, x by -90
// degrees, z (Mézières 2022, Eq. 2.76). In place, layer l(l+1)+m.
layout(local_size_x = 8, local_size_y = 8) in;
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"
#include "sh/basis.glsl"
#include "sh/rotation.glsl"

layout(binding = 2, rgba32f) uniform image2DArray receivers;
layout(binding = 12) uniform samplerBuffer quarter;  // about x by 90 degrees: band after band (2l+1)^2, column by column
uniform ivec2 size;
uniform int bands;

ShColors f;

void about_z(float c, float s) {
  vec2 multiple = vec2(1.0, 0.0);
  for (int m = 1; m < bands; ++m) {
    multiple = sh_next_multiple(multiple, c, s);
    for (int l = m; l < bands; ++l) {
      int i = l * (l + 1);
      vec3 plus = f.c[i + m];
      vec3 minus = f.c[i - m];
      for (int k = 0; k < 3; ++k) {
        float a = plus[k];
        float b = minus[k];
        sh_rotate_pair(multiple, a, b);
        plus[k] = a;
        minus[k] = b;
      }
      f.c[i + m] = plus;
      f.c[i - m] = minus;
    }
  }
}

void quarter_about_x() {
  int start = 0;
  for (int l = 0; l < bands; ++l) {
    int n = 2 * l + 1;
    vec3 turned[19];
    for (int row = 0; row < n; ++row) turned[row] = vec3(0.0);
    for (int column = 0; column < n; ++column) {
      vec3 value = f.c[l * l + column];
      for (int row = 0; row < n; ++row) {
        int at = start + column * n + row;
        turned[row] += value * texelFetch(quarter, at / 4)[at & 3];
      }
    }
    for (int row = 0; row < n; ++row) f.c[l * l + row] = turned[row];
    start += n * n;
  }
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, size))) return;
  Point p = point_read(at);
  if (!point_gathers(p)) return;
  for (int i = 0; i < bands * bands; ++i) f.c[i] = imageLoad(receivers, ivec3(at, i)).rgb;
  // The view frame: z is the normal, x the camera's azimuth.
  vec2 o = p.brdf.o.xy;
  float r2 = dot(o, o);
  vec2 azimuth = r2 > 1e-12 ? o / sqrt(r2) : vec2(1.0, 0.0);
  vec3 x = azimuth.x * p.x + azimuth.y * p.y;
  vec3 y = azimuth.x * p.y - azimuth.y * p.x;
  vec3 z = p.z;
  float sine = length(z.xy);
  vec2 alpha = sine > 0.0 ? z.xy / sine : vec2(1.0, 0.0);
  vec2 beta = normalize(vec2(z.z, sine));
  vec2 gamma = normalize(vec2(alpha.x * y.y - alpha.y * y.x, alpha.x * x.y - alpha.y * x.x));
  about_z(gamma.x, gamma.y);
  quarter_about_x();
  about_z(-beta.x, -beta.y);
  quarter_about_x();
  about_z(-alpha.x, -alpha.y);
  for (int i = 0; i < bands * bands; ++i) imageStore(receivers, ivec3(at, i), vec4(f.c[i], 0.0));
}
