// How a point light fades with distance, and the gradient of it for the shaded point. `w` is the vector from the shaded
// point x to the light y, in metres; gradients are with respect to x, so they point towards the light.

// 1/d^2 (Mézières 2022, Eq. 5.17) and 2 w/d^4 (Eq. 5.21 with its sign corrected). Both are 0 at d = 0.
KERNEL float inverse_square_attenuation(vec3 w, OUT(vec3) gradient) {
  float d2 = dot(w, w);
  float a = d2 > 0.0f ? 1.0f / d2 : 0.0f;
  gradient = w * (2.0f * a * a);
  return a;
}

// Yuksel 2020, "Point Light Attenuation Without Singularity": (2/r^2)(1 - d/s), s = sqrt(d^2 + r^2), written 2/(s(s+d)),
// which keeps its digits far away (Eq. 5.18), and 2 w/(d s^3) (Eq. 5.22 with its sign corrected). At d = 0 the function has a
// cone's tip; the gradient there is 0.
KERNEL float yuksel_attenuation(vec3 w, float r, OUT(vec3) gradient) {
  float d2 = dot(w, w);
  float d = sqrt(d2);
  float s = sqrt(d2 + r * r);
  gradient = d > 0.0f ? w * (2.0f / (d * s * s * s)) : w * 0.0f;
  return 2.0f / (s * (s + d));
}
