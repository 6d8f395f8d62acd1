// Rotation about z by an angle, band by band: what a shader needs to turn coefficients into a tangent frame's azimuth.
// Mézières 2022, Eq. 2.74 in the active sense (Y_1^1 turned by +90 degrees becomes Y_1^-1, x becomes y).

// The cosine and sine of m times the angle from those of m - 1: one complex multiplication, no trigonometry (Eq. 2.75
// without its growth of rounding at small angles). Start with (1, 0).
KERNEL vec2 sh_next_multiple(vec2 multiple, float cos_angle, float sin_angle) {
  return vec2(cos_angle * multiple.x - sin_angle * multiple.y, sin_angle * multiple.x + cos_angle * multiple.y);
}

// Turns the pair of coefficients (l, m), (l, -m); m > 0. `multiple` holds cos and sin of m times the angle. m = 0 stays.
KERNEL void sh_rotate_pair(vec2 multiple, INOUT(float) plus, INOUT(float) minus) {
  float turned = plus * multiple.x - minus * multiple.y;
  minus = plus * multiple.y + minus * multiple.x;
  plus = turned;
}
