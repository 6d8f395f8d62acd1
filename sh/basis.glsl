// Spherical harmonics for shaders: up to 10 bands (l = 0..9), basis, gradient and dot product. Conventions of
// sh/basis.h: index l(l+1)+m, Condon-Shortley phase inside. The recurrence is that of sh/tables.h, in differences
// from the pole, so that float loses nothing near it; q_m^m(1) starts at sqrt(1/4pi) and takes -sqrt((2m+1)/(2m)),
// with sqrt(2) once. Equation numbers: Mezieres 2022.

const int SH_MAX_BANDS = 10;
const int SH_MAX_COUNT = 100;

struct ShCoefficients {
  float c[SH_MAX_COUNT];
};

struct ShGradient {
  vec3 g[SH_MAX_COUNT];
};

// Of three colours.
struct ShColors {
  vec3 c[SH_MAX_COUNT];
};

// The unit direction nearest to d in first order, and 1 - |z|: exact differences near the pole.
KERNEL vec3 sh_direction(vec3 d, OUT(float) u) {
  float excess = (d.z - 1.0f) * (d.z + 1.0f) + (d.x * d.x + d.y * d.y);
  float scale = excess * (0.375f * excess - 0.5f);
  float up = abs(d.z);
  u = (1.0f - up) - up * scale;
  return d + d * scale;
}

// Y[bands^2] at the unit direction d, 1 <= bands <= 10. Entries beyond are left alone.
KERNEL void sh_evaluate(int bands, vec3 d, INOUT(ShCoefficients) Y) {
  float u;
  vec3 w = sh_direction(d, u);
  float side = w.z < 0.0f ? -1.0f : 1.0f;
  float c = 1.0f;  // (x+iy)^m
  float s = 0.0f;
  float start = 0.282094792f;
  for (int m = 0; m < bands; m++) {
    float order = float(m);
    float p = 1.0f;
    float change = 0.0f;
    float norm = start;
    float parity = 1.0f;
    for (int l = m; l < bands; l++) {
      float degree = float(l);
      if (l > m) {
        float inverse = 1.0f / (degree + order);
        change = (degree - order - 1.0f) * inverse * change - (2.0f * degree - 1.0f) * inverse * p;
        p += u * change;
        norm *= sqrt((2.0f * degree + 1.0f) * (degree + order) / ((2.0f * degree - 1.0f) * (degree - order)));
        parity *= side;
      }
      float q = norm * p * parity;
      Y.c[l * (l + 1) - m] = q * s;
      Y.c[l * (l + 1) + m] = q * c;
    }
    float next = w.x * c - w.y * s;
    s = w.x * s + w.y * c;
    c = next;
    start *= -sqrt((m == 0 ? 2.0f : 1.0f) * (2.0f * order + 3.0f) / (2.0f * order + 2.0f));
  }
}

// Order m of the basis and its gradient, for l = m .. bands - 1: index l. Those of -m are 0 for m = 0.
struct ShOrder {
  float plus[SH_MAX_BANDS];
  float minus[SH_MAX_BANDS];
  vec3 plus_gradient[SH_MAX_BANDS];
  vec3 minus_gradient[SH_MAX_BANDS];
};

// The gradient is that of Y(v/|v|) with respect to v at unit v = d: tangent to the sphere, the limit at the poles.
KERNEL void sh_evaluate_order(int bands, int m, vec3 d, INOUT(ShOrder) row) {
  float u;
  vec3 w = sh_direction(d, u);
  float side = w.z < 0.0f ? -1.0f : 1.0f;
  float rho2 = w.x * w.x + w.y * w.y;
  float c = 1.0f;  // (x+iy)^m and (x+iy)^(m-1)
  float s = 0.0f;
  float c1 = 0.0f;
  float s1 = 0.0f;
  float norm = 0.282094792f;
  for (int k = 0; k < m; k++) {
    c1 = c;
    s1 = s;
    c = w.x * c1 - w.y * s1;
    s = w.x * s1 + w.y * c1;
    norm *= -sqrt((k == 0 ? 2.0f : 1.0f) * (2.0f * float(k) + 3.0f) / (2.0f * float(k) + 2.0f));
  }
  float order = float(m);
  float p = 1.0f;
  float change = 0.0f;
  float p1 = 0.0f;  // of order m+1: the derivative
  float change1 = 0.0f;
  float parity = 1.0f;
  for (int l = m; l < bands; l++) {
    float degree = float(l);
    if (l > m) {
      float inverse = 1.0f / (degree + order);
      change = (degree - order - 1.0f) * inverse * change - (2.0f * degree - 1.0f) * inverse * p;
      p += u * change;
      inverse = 1.0f / (degree + order + 1.0f);
      if (l > m + 1) {
        change1 = (degree - order - 2.0f) * inverse * change1 - (2.0f * degree - 1.0f) * inverse * p1;
      }
      p1 = l == m + 1 ? 1.0f : p1 + u * change1;
      norm *= sqrt((2.0f * degree + 1.0f) * (degree + order) / ((2.0f * degree - 1.0f) * (degree - order)));
      parity *= side;
    }
    float slope = norm * (degree - order) * (degree + order + 1.0f) / (2.0f * (order + 1.0f));
    float f = norm * p * parity;
    float df = slope * p1 * parity * side;
    float radial = order * f + w.z * df;
    float up = rho2 * df - order * w.z * f;
    float mf = order * f;
    row.minus[l] = f * s;
    row.minus_gradient[l] = vec3(mf * s1 - radial * w.x * s, mf * c1 - radial * w.y * s, up * s);
    row.plus[l] = f * c;
    row.plus_gradient[l] = vec3(mf * c1 - radial * w.x * c, -mf * s1 - radial * w.y * c, up * c);
  }
}

// Y and its gradient, order by order.
KERNEL void sh_evaluate_gradient(int bands, vec3 d, INOUT(ShCoefficients) Y, INOUT(ShGradient) gradient) {
  ShOrder row;
  for (int m = 0; m < bands; m++) {
    sh_evaluate_order(bands, m, d, row);
    for (int l = m; l < bands; l++) {
      int i = l * (l + 1);
      Y.c[i - m] = row.minus[l];
      gradient.g[i - m] = row.minus_gradient[l];
      Y.c[i + m] = row.plus[l];
      gradient.g[i + m] = row.plus_gradient[l];
    }
  }
}

// Sum of products over the first `bands` bands: the integral of the product of two functions (2.46).
KERNEL float sh_dot(int bands, ShCoefficients a, ShCoefficients b) {
  float sum = 0.0f;
  for (int i = 0; i < bands * bands; i++) sum += a.c[i] * b.c[i];
  return sum;
}
