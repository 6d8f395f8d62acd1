// What a shaded point does with one spherical light when its BRDF is a diffuse part and a zonal lobe (Mézières 2022, Sec.
// 5.2.7): pure functions for shaders and C++. Needs sh/angle.glsl and sh/sphere_light.glsl before it. Nothing branches on data, and loops run
// over bands alone, so that a loop over lights vectorises.
//
//     ZonalCap cap = sphere_cap(d2, r);                            // the light, seen from the point
//     diffuse part:   albedo/pi * cap_irradiance(cap, dot(n, w))
//     specular part:  specular * max(dot(n, w), 0) * zonal_lobe_cap(lobe, cap, dot(w, axis), bands), clamped after all lights

const int ZONAL_LOBE_BANDS = 64;

// F_l sqrt((2l+1)/4pi): zonal coefficients of a lobe times the root that turns the gains of sphere_light.glsl into zonal
// coefficients, so that neither root is taken again for each light.
struct ZonalLobe {
  float weight[ZONAL_LOBE_BANDS];
};

// P_l(x), band after band.
struct LegendreBand {
  float p;
  float before;
};
KERNEL LegendreBand legendre_first() {
  LegendreBand band;
  band.p = 1.0f;
  band.before = 0.0f;
  return band;
}
// Band l >= 1 from band l - 1: l P_l = (2l-1) x P_{l-1} - (l-1) P_{l-2}.
KERNEL LegendreBand legendre_next(LegendreBand band, float x, int l) {
  float inverse = 1.0f / float(l);
  LegendreBand next;
  next.p = (2.0f - inverse) * x * band.p - (1.0f - inverse) * band.before;
  next.before = band.p;
  return next;
}

// Integral over the cap of the lobe: sum over l of F_l L_l P_l(x), x = dot(w, axis) (Eq. 5.14: its Y_l^0 times
// sqrt(4pi/(2l+1)) is P_l of the cosine). 1 <= bands <= ZONAL_LOBE_BANDS. May be below 0, where
// the bands left out ring: clamp the sum over all lights, not each one, which would add to what the lobe reflects.
KERNEL float zonal_lobe_cap(ZonalLobe lobe, ZonalCap cap, float x, int bands) {
  CapBand light = cap_first(cap);
  LegendreBand turn = legendre_first();
  float sum = lobe.weight[0] * light.gain;
  for (int l = 1; l < bands; ++l) {
    light = cap_next(cap, light, l);
    turn = legendre_next(turn, x, l);
    sum += lobe.weight[l] * light.gain * turn.p;
  }
  return sum;
}

// Irradiance by three bands of light and of cosine, the quadratic form of Sec. 5.2.7: E(z) = c3 L2 z^2 + 2 c2 L1 z + c4 L0 -
// c5 L2, from zonal coefficients of the light and z = dot(n, w). A small light's is off by up to 9.4 %
// of what it gives overhead, most at the horizon (the bands left out), and below 0 behind the surface.
KERNEL float zonal_diffuse(float L0, float L1, float L2, float z) {
  float c2 = 0.511663354f;  // sqrt(pi/12)
  float c3 = 0.743124718f;  // 3/16 sqrt(5 pi)
  float c4 = 0.886226925f;  // sqrt(pi)/2
  float c5 = 0.247708239f;  // 1/16 sqrt(5 pi)
  return c3 * L2 * z * z + 2.0f * c2 * L1 * z + c4 * L0 - c5 * L2;
}

// Irradiance from a cap of radiance 1, exact: the integral of max(0, cos) over it; `z` is the cosine between its axis and the
// normal, half angle a <= pi/2. Above the horizon pi sin^2 a z (so an HVL lights a diffuse surface as a VPL does). Cut by the
// horizon, sin^2 a (z acos(y) - cot a sin(theta) sqrt(1-y^2)) + atan(sin(theta) sqrt(1-y^2) tan a), y = -cot a cot(theta)
// (Snyder 1996; Lagarde and de Rousiers 2014), here in t = z / sin a and r = sqrt(1-t^2),
//     sin^3 a t angle(r, -t cos a) + atan(k) - k cos^2 a,   k = r tan a,
// whose last two terms cancel for small caps and are taken together there.
KERNEL float cap_irradiance(ZonalCap cap, float z) {
  float s = sqrt(cap.sine2);
  float c = max(1.0f - cap.versine, 1e-10f);
  float t = clamp(z / max(s, 1e-20f), -1.0f, 1.0f);
  float r = sqrt(max(1.0f - t * t, 0.0f));
  float s3 = cap.sine2 * s;

  float rs = r * s;
  float inside = min(rs, c);
  float k = inside / max(rs, c);
  float tail = atan_tail(k * k);
  // k <= 1: k - atan k = k^3 tail, and 1 - cos^2 a = sin^2 a, so sin^3 a comes out of everything.
  float rc = r / c;
  float shallow = s3 * (rc - rc * rc * rc * tail);
  float steep = 1.57079633f - (k - k * k * k * tail) - rs * c;
  float edge = rs <= c ? shallow : steep;

  float cut = s3 * t * upper_angle(r, -t * c) + edge;
  // The part of z beyond sin a is the uncut law; at t = 1 both join.
  return max(cut, 0.0f) + 3.14159265f * cap.sine2 * max(z - s, 0.0f);
}
