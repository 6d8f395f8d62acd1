// A frame as the display wants it: exposure, clamped, sRGB (IEC 61966-2-1). Rows go down in the frame, up in the window.
#include "gl/coats.glsl"
#include "gl/brdf.glsl"
#include "gl/point.glsl"

layout(binding = 11) uniform sampler2D gathered;
layout(binding = 12) uniform sampler2D direct;
uniform ivec2 window;
uniform float exposure;
uniform int with_glow;
layout(location = 0) out vec4 color;

void main() {
  ivec2 size = textureSize(gathered, 0);
  vec2 place = gl_FragCoord.xy / vec2(window);
  ivec2 at = min(ivec2(vec2(place.x, 1.0 - place.y) * vec2(size)), size - 1);
  vec3 radiance = texelFetch(direct, at, 0).rgb + max(texelFetch(gathered, at, 0).rgb, 0.0);
  if (with_glow == 1) radiance += point_get(at, 4).rgb;
  vec3 x = clamp(radiance * exposure, 0.0, 1.0);
  vec3 encoded = mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
  color = vec4(encoded, 1.0);
}
