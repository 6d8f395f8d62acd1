// Gathering from virtual point lights: the part both compilers share. Equations are numbered in README.md.

// (VPL-2) 1/d^2, no nearer than `shortest` metres; a light on the point itself stays finite.
KERNEL float vpl_inverse_square(float d2, float shortest) {
  return 1.0f / max(max(d2, shortest * shortest), 1e-18f);
}

// (VPL-3) Yuksel 2020, "Point Light Attenuation Without Singularity": the irradiance on the axis of a disk of radius r
// that emits what the point would, 2/(d^2 + r^2 + d sqrt(d^2 + r^2)), written as 2/(s(s+d)), s = sqrt(d^2 + r^2).
KERNEL float vpl_yuksel(float d2, float r) {
  float d = sqrt(d2);
  float s = sqrt(d2 + r * r);
  return 2.0f / max(s * (s + d), 1e-18f);
}

// (VPL-1) cos_x cos_y / d^2 between a shaded point and a light, both cosines from below cut off at 0. `to_light` is not
// normalised; `w` receives its direction. A light on the point itself gives 0.
KERNEL float vpl_geometry(vec3 to_light, vec3 normal_x, vec3 normal_y, float attenuation, OUT(vec3) w) {
  float d2 = dot(to_light, to_light);
  float inverse_d = d2 > 0.0f ? 1.0f / sqrt(d2) : 0.0f;
  w = to_light * inverse_d;
  return max(dot(normal_x, w), 0.0f) * max(-dot(normal_y, w), 0.0f) * attenuation;
}
