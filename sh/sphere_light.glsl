// Spherical lights and oriented disks for shaders: the gains g_l with which band l of the basis in the light's direction
// becomes the light's SH coefficients, L_lm = g_l Y_lm(w), streamed band by band so that any number of bands needs no array:
//
//     ZonalCap cap = sphere_cap(d2, r);
//     CapBand band = cap_first(cap);
//     for (int l = 0; l < N; ++l) { use band.gain, band.slope; band = cap_next(cap, band, l + 1); }
//
// The cancellation-free forms of sh/zonal.h (Mézières 2022, Eq. 3.10, 3.30).

struct ZonalCap {
  float versine;  // t = 1 - cos a of the half angle a, in [0, 1]
  float sine2;    // sin^2 a
  float dt;       // dt/dd, d the distance in metres
};

struct CapBand {
  float gain;   // g_l
  float slope;  // dg_l/dt; times cap.dt it is the gain's change with distance
  float p;      // P_l(1 - t), and its difference to the band before
  float dp;
  float q;  // 2 P_l'(1 - t)/(l(l+1)), and its difference to the band before
  float dq;
};

// A sphere of radius r > 0 whose centre is sqrt(d2) metres away. On it or inside (d <= r): the hemisphere, whose size stands
// still. In float the coefficients are within 2e-6 of the largest up to r/d = 0.9; nearer, d2 itself should come from double.
KERNEL ZonalCap sphere_cap(float d2, float r) {
  ZonalCap cap;
  float d = sqrt(d2);
  if (d <= r) {
    cap.versine = 1.0f;
    cap.sine2 = 1.0f;
    cap.dt = 0.0f;
    return cap;
  }
  float ratio = r / d;
  float h = sqrt((d - r) * (d + r));
  cap.sine2 = ratio * ratio;
  cap.versine = cap.sine2 / (1.0f + h / d);
  cap.dt = -cap.sine2 / h;
  return cap;
}

// A disk of radius r > 0 that faces the shaded point (Eq. 3.29).
KERNEL ZonalCap disk_cap(float d2, float r) {
  ZonalCap cap;
  float s = sqrt(d2 + r * r);
  float ratio = r / s;
  cap.sine2 = ratio * ratio;
  cap.versine = ratio * (r / (s + sqrt(d2)));
  cap.dt = -cap.sine2 / s;
  return cap;
}

// Band 0.
KERNEL CapBand cap_first(ZonalCap cap) {
  CapBand band;
  band.gain = 6.28318531f * cap.versine;  // 2 pi t
  band.slope = 6.28318531f;
  band.p = 1.0f;
  band.dp = 0.0f;
  band.q = 1.0f;
  band.dq = 0.0f;
  return band;
}

// Band l >= 1 from band l - 1.
KERNEL CapBand cap_next(ZonalCap cap, CapBand band, int l) {
  float n = float(l);
  band.dp = ((n - 1.0f) * band.dp - (2.0f * n - 1.0f) * cap.versine * band.p) / n;
  band.p += band.dp;
  if (l > 1) {
    band.dq = ((n - 2.0f) * band.dq - (2.0f * n - 1.0f) * cap.versine * band.q) / (n + 1.0f);
    band.q += band.dq;
  }
  band.gain = 3.14159265f * cap.sine2 * band.q;  // pi sin^2 a q_l
  band.slope = 6.28318531f * band.p;             // 2 pi P_l
  return band;
}
