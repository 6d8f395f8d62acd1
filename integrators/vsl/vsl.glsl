// Virtual spherical lights: the part both compilers share. Equations are numbered in README.md.

// (VSL-2) 1 - cos of the half angle under which a sphere of radius r is seen at distance d > r; 1, a hemisphere, from
// inside. `per_radius2` receives it divided by r^2, which stays 1/(2 d^2) as r goes to 0.
KERNEL float vsl_cone(float d2, float r, OUT(float) per_radius2) {
  float r2 = r * r;
  float outside2 = max(d2, r2);
  float cos_a = sqrt(max(1.0f - r2 / outside2, 0.0f));
  per_radius2 = 1.0f / (outside2 * (1.0f + cos_a));
  return r2 * per_radius2;
}

// Two unit vectors that with the unit vector w form a right-handed frame, the first one towards `side`: so the frame
// turns with the scene. Where side is along w, any.
KERNEL void vsl_frame(vec3 w, vec3 side, OUT(vec3) x, OUT(vec3) y) {
  vec3 t = side - w * dot(w, side);
  float t2 = dot(t, t);
  float a = 1.0f / (1.0f + abs(w.z));
  float s = w.z >= 0.0f ? 1.0f : -1.0f;
  vec3 any = vec3(1.0f - w.x * w.x * a, -w.x * w.y * a, -s * w.x);
  float enough = t2 > 1e-10f ? 1.0f : 0.0f;
  x = t * (enough / sqrt(max(t2, 1e-10f))) + any * (1.0f - enough);
  y = cross(w, x);
}

// (VSL-3) A direction of the cone around w, uniform in solid angle: u in [0,1), (c, s) on the unit circle.
KERNEL vec3 vsl_direction(vec3 w, vec3 x, vec3 y, float one_minus_cos, float u, float c, float s) {
  float v = u * one_minus_cos;
  float sine = sqrt(max(v * (2.0f - v), 0.0f));
  return w * (1.0f - v) + x * (c * sine) + y * (s * sine);
}

// cos and sin of 2 pi u for u in [-1/2, 1/2]: from those of the quarter angle by polynomials, doubled twice. To 1e-6.
KERNEL void vsl_turn(float u, OUT(float) c, OUT(float) s) {
  float q = 1.57079633f * u;  // a quarter of the angle, within pi/4
  float q2 = q * q;
  float sq = q * (1.0f + q2 * (-0.166666667f + q2 * (8.33333333e-3f + q2 * (-1.98412698e-4f + q2 * 2.75573192e-6f))));
  float cq = 1.0f + q2 * (-0.5f + q2 * (4.16666667e-2f + q2 * (-1.38888889e-3f + q2 * 2.48015873e-5f)));
  float sh = 2.0f * sq * cq;
  float ch = 1.0f - 2.0f * sq * sq;
  s = 2.0f * sh * ch;
  c = 1.0f - 2.0f * sh * sh;
}
