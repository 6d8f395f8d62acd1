// Light on spherical harmonics at a point, for shaders and C++: what each kind of light sends, band by band, with its slope as
// the point moves, and the weights between a grid's points. Equations are numbered in README.md. Needs sh/basis.glsl and
// sh/sphere_light.glsl before it; up to 10 bands. The CPU sums by the batches of sh/ and by sh_cell.cpp, which are tested
// against this text.

// Light along w: coefficients gain_l Y_lm(w), gain_l = weight g_l of the cap, or weight alone.
struct ShdSent {
  vec3 w;           // unit, from the point
  float inverse_d;  // 1/m
  float weight;
  vec3 slope;       // of weight, for the point, 1/m
  int dirac;        // 1: no cap
  ZonalCap cap;
};

KERNEL ShdSent shd_dirac(vec3 to_light) {
  ShdSent s;
  float d2 = dot(to_light, to_light);
  s.inverse_d = d2 > 0.0f ? 1.0f / sqrt(d2) : 0.0f;
  s.w = d2 > 0.0f ? to_light * s.inverse_d : vec3(0.0f, 0.0f, 1.0f);
  s.weight = 1.0f;
  s.slope = vec3(0.0f);
  s.dirac = 1;
  s.cap.versine = 0.0f;
  s.cap.sine2 = 0.0f;
  s.cap.dt = 0.0f;
  return s;
}

// (SHD-4) A sphere, or a disk of its radius that faces the point.
KERNEL ShdSent shd_sphere(vec3 to_light, float radius, int disk) {
  ShdSent s = shd_dirac(to_light);
  float d2 = dot(to_light, to_light);
  s.dirac = 0;
  s.cap = disk == 1 ? disk_cap(d2, radius) : sphere_cap(d2, radius);
  return s;
}

// (SHD-7) Slopes within one cell h of a sphere's surface, bounded for interpolation (SeenLanes::bound of sh/seen_lanes.h): that of
// the cap's size by 3 (t(d) - t(d + h))/h, the turn of its direction by 1/h.
KERNEL ShdSent shd_bounded(ShdSent seen, float radius, int disk, float h) {
  ShdSent s = seen;
  float d = 1.0f / max(s.inverse_d, 1e-30f);
  float far = d + h;
  float ratio = radius / (disk == 1 ? sqrt(far * far + radius * radius) : far);
  float s2 = min(ratio * ratio, 1.0f);
  float rate = 3.0f / h * (s.cap.versine - s2 / (sqrt(1.0f - s2) + 1.0f));
  if (d - (disk == 1 ? 0.0f : radius) < h) {
    s.cap.dt = max(s.cap.dt, -rate);
    s.inverse_d = min(s.inverse_d, 1.0f / h);
  }
  return s;
}

// (SHD-4) 1/d^2 and 2 w/d^3 (Eq. 5.17, 5.21).
KERNEL ShdSent shd_point(vec3 to_light) {
  ShdSent s = shd_dirac(to_light);
  s.weight = s.inverse_d * s.inverse_d;
  s.slope = s.w * (2.0f * s.weight * s.inverse_d);
  return s;
}

// (SHD-4) A point in a cone with a smooth edge between two cosines. `axis`: the way the light goes.
KERNEL ShdSent shd_spot(vec3 to_light, vec3 axis, float cos_inner, float cos_outer) {
  ShdSent s = shd_point(to_light);
  float cosine = -dot(axis, s.w);
  float unit = 1.0f / (cos_inner - cos_outer);
  float u = clamp((cosine - cos_outer) * unit, 0.0f, 1.0f);
  float falloff = u * u * (3.0f - 2.0f * u);
  float turn = s.weight * s.inverse_d * 6.0f * u * (1.0f - u) * unit;
  s.slope = s.slope * falloff + (axis + s.w * cosine) * turn;
  s.weight *= falloff;
  return s;
}

// (SHD-5) A sphere in a triangle's place, weighted by the cosine towards the point (Eq. 4.9 to 4.11).
KERNEL ShdSent shd_facing_sphere(vec3 to_light, float radius, vec3 normal, int two_sided) {
  ShdSent s = shd_sphere(to_light, radius, 0);
  float cosine = -dot(normal, s.w);
  float side = cosine > 0.0f ? 1.0f : (two_sided == 1 ? -1.0f : 0.0f);
  s.weight = side * cosine;
  s.slope = (normal + s.w * cosine) * (side * s.inverse_d);
  return s;
}

// (SHD-6) One point of a rule for a plane triangle: `area` its area vector, on the side that is not seen, `share` the rule's
// weight. A.p/|p|^3 and its slope (3 (A.p) p/|p|^2 - A)/|p|^3.
KERNEL ShdSent shd_triangle_point(vec3 to_light, vec3 area, float share) {
  ShdSent s = shd_dirac(to_light);
  float cube = s.inverse_d * s.inverse_d * s.inverse_d * share;
  s.weight = dot(area, to_light) * cube;
  s.slope = s.w * (3.0f * s.weight * s.inverse_d) - area * cube;
  return s;
}

// What meets a reflection R of all three colours, both in one frame.
KERNEL vec3 shd_reflect(int bands, ShdSent s, ShColors R) {
  ShCoefficients Y;
  sh_evaluate(bands, s.w, Y);
  CapBand band = cap_first(s.cap);
  vec3 sum = vec3(0.0f);
  for (int l = 0; l < bands; ++l) {
    if (l > 0) band = cap_next(s.cap, band, l);
    vec3 part = vec3(0.0f);
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) part += R.c[i] * Y.c[i];
    sum += part * (s.dirac == 1 ? 1.0f : band.gain);
  }
  return sum * s.weight;
}

// (SHD-9) The irradiance of the series, and the lobe's sum: weights of Legendre sums about two axes, the cosines to which are
// `up` and `along`.
struct ShdWeights {
  float c[SH_MAX_BANDS];
};
KERNEL vec2 shd_zonal(int bands, ShdSent s, float up, float along, ShdWeights cosine, ShdWeights lobe) {
  CapBand band = cap_first(s.cap);
  vec2 before = vec2(0.0f);
  vec2 p = vec2(1.0f);
  vec2 x = vec2(up, along);
  vec2 sum = vec2(0.0f);
  for (int l = 0; l < bands; ++l) {
    if (l > 0) {
      band = cap_next(s.cap, band, l);
      float inverse = 1.0f / float(l);
      vec2 next = x * p * (2.0f - inverse) - before * (1.0f - inverse);
      before = p;
      p = next;
    }
    sum += p * vec2(cosine.c[l], lobe.c[l]) * (s.dirac == 1 ? 1.0f : band.gain);
  }
  return vec2(sum.x, sum.y * max(up, 0.0f)) * s.weight;
}

// (SHD-7) Weights of what a cell's corners hold: [4 corner + part], part 0 the value, then the derivatives for x, y, z.
struct ShdCell {
  float w[32];
};

// Trilinear; `taylor`: of first-order expansions.
KERNEL void shd_linear_cell(int taylor, vec3 t, vec3 size, INOUT(ShdCell) cell) {
  for (int k = 0; k < 8; ++k) {
    vec3 corner = vec3(float(k % 2), float(k / 2 % 2), float(k / 4));
    vec3 near = corner * t + (vec3(1.0f) - corner) * (vec3(1.0f) - t);
    float w = near.x * near.y * near.z;
    vec3 step = float(taylor) * w * (t - corner) * size;
    cell.w[4 * k] = w;
    cell.w[4 * k + 1] = step.x;
    cell.w[4 * k + 2] = step.y;
    cell.w[4 * k + 3] = step.z;
  }
}

// Weights of the derivative d = dx + 2 dy + 4 dz at every corner: [8 corner + d].
struct ShdDerivatives {
  float w[64];
};

// A derivative of order two or three as differences of those of one order less along each of its axes, averaged.
KERNEL void shd_difference(int d, vec3 size, INOUT(ShdDerivatives) all) {
  int axes = d % 2 + d / 2 % 2 + d / 4;
  for (int k = 0; k < 8; ++k) {
    int bit = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (d / bit % 2 == 1) {
        int low = k / bit % 2 == 1 ? k - bit : k;
        float share = all.w[8 * k + d] / (float(axes) * size[axis]);
        all.w[8 * (low + bit) + d - bit] += share;
        all.w[8 * low + d - bit] -= share;
      }
      bit *= 2;
    }
  }
}

// Tricubic Hermite; `differences`: mixed derivatives from the gradients at the corners, else 0.
KERNEL void shd_hermite_cell(int differences, vec3 t, vec3 size, INOUT(ShdCell) cell) {
  vec3 one = vec3(1.0f);
  vec3 v = one - t;
  vec3 low = v * v * (one + 2.0f * t);
  vec3 low_slope = size * t * v * v;
  vec3 high = t * t * (one + 2.0f * v);
  vec3 high_slope = -size * t * t * v;
  ShdDerivatives all;
  for (int k = 0; k < 8; ++k) {
    for (int d = 0; d < 8; ++d) {
      float w = 1.0f;
      int bit = 1;
      for (int axis = 0; axis < 3; ++axis) {
        bool up = k / bit % 2 == 1;
        bool slope = d / bit % 2 == 1;
        w *= up ? (slope ? high_slope[axis] : high[axis]) : (slope ? low_slope[axis] : low[axis]);
        bit *= 2;
      }
      all.w[8 * k + d] = w;
    }
  }
  if (differences == 1) {
    shd_difference(7, size, all);
    shd_difference(3, size, all);
    shd_difference(5, size, all);
    shd_difference(6, size, all);
  }
  for (int k = 0; k < 8; ++k) {
    cell.w[4 * k] = all.w[8 * k];
    cell.w[4 * k + 1] = all.w[8 * k + 1];
    cell.w[4 * k + 2] = all.w[8 * k + 2];
    cell.w[4 * k + 3] = all.w[8 * k + 4];
  }
}
