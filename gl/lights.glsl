// Virtual lights as gl/light_buffer.cpp packs them. Needs gl/brdf.glsl before it.

layout(binding = 10) uniform samplerBuffer lights;
const int LIGHT_TEXELS = 12;

// Radiance beyond which a product of two narrow lobes is cut off, so that sums stay finite.
const float MOST = 1e30;

struct Light {
  vec3 position;  // metres, world
  float radius;   // metres; 0 where the method has none
  vec3 normal;    // geometric, on the lit side
  bool even;      // its BRDF is the same for all directions above its horizon
  vec3 power;     // incident flux, W
};

Light light_at(int j) {
  vec4 a = texelFetch(lights, LIGHT_TEXELS * j);
  vec4 b = texelFetch(lights, LIGHT_TEXELS * j + 1);
  return Light(a.xyz, a.w, b.xyz, b.w != 0.0, texelFetch(lights, LIGHT_TEXELS * j + 2).rgb);
}

// What light j reflects towards w (unit, world, away from it), 1/sr.
vec3 light_reflects(int j, bool even, vec3 w) {
  int at = LIGHT_TEXELS * j;
  float up = dot(w, texelFetch(lights, at + 5).xyz);
  if (even) return up > BRDF_MIN_COSINE ? texelFetch(lights, at + 11).rgb : vec3(0.0);
  vec3 local = vec3(dot(w, texelFetch(lights, at + 3).xyz), dot(w, texelFetch(lights, at + 4).xyz), up);
  return brdf_value(brdf_unpack(texelFetch(lights, at + 6), texelFetch(lights, at + 7), texelFetch(lights, at + 8),
                                texelFetch(lights, at + 9), texelFetch(lights, at + 10), texelFetch(lights, at + 11)),
                    local);
}
