// The angle of a point, alike on every machine: a shader's own atan may be off by 1e-5 of a turn.

// (x - atan x)/x^3 as a polynomial in x^2, for x in [0, 1]: Chebyshev interpolation, error 1e-7.
KERNEL float atan_tail(float x2) {
  float a = 0.0200267476f - 0.00386673891f * x2;
  a = -0.0489143215f + a * x2;
  a = 0.0800968172f + a * x2;
  a = -0.108657591f + a * x2;
  a = 0.142570449f + a * x2;
  a = -0.199986812f + a * x2;
  return 0.333333231f + a * x2;
}
// Angle of the point (x, y), y >= 0, in [0, pi].
KERNEL float upper_angle(float y, float x) {
  float low = min(y, abs(x));
  float high = max(max(y, abs(x)), 1e-30f);
  float k = low / high;
  float angle = k - k * k * k * atan_tail(k * k);
  angle = y > abs(x) ? 1.57079633f - angle : angle;
  return x < 0.0f ? 3.14159265f - angle : angle;
}
