// Harmonic virtual lights (Mézières 2022, Sec. 5.2): what one light sends to one shaded point, for shaders and C++. Equations
// are numbered in README.md. Needs sh/basis.glsl, sh/angle.glsl, sh/sphere_light.glsl and materials/zonal_lobes.glsl before
// it; up to 10 bands of spherical harmonics. The CPU gathers by hvl_lanes.h, which is tested against this text.
//
//     vec3 L = hvl_radiance(power, hvl_emission(3, f, scale, w_light), facing, radius);
//     ZonalCap cap = sphere_cap(d2, radius);
//     radiance += L * hvl_product(9, receiver, cap, w_view, soft);

struct HvlColors {
  vec3 c[SH_MAX_COUNT];  // index l(l+1)+m
};

// (HVL-1) Radiance of the sphere, W/(m^2 sr): `power` its flux (W), `emission` its BRDF towards the point (1/sr), `facing` the
// cosine at its surface. The sphere's disk pi r^2 stands for the surface whose light it carries.
KERNEL vec3 hvl_radiance(vec3 power, vec3 emission, float facing, float radius) {
  return power * emission * (max(facing, 0.0f) / (3.14159265f * radius * radius));
}

// (HVL-2) The light's BRDF from the first bands of its table, continued evenly below its surface: twice the coefficients of even
// l + m, none of odd; `scale` makes what the light sends what it reflects. `w` in the light's view frame.
KERNEL vec3 hvl_emission(int bands, HvlColors f, vec3 scale, vec3 w) {
  ShCoefficients Y;
  sh_evaluate(bands, w, Y);
  vec3 sum = vec3(0.0f);
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; m += 2) sum += f.c[l * (l + 1) + m] * Y.c[l * (l + 1) + m];
  }
  return w.z > 0.0f ? sum * scale * 2.0f : vec3(0.0f);
}

// (HVL-8) What the blurred edge leaves of band l, step by step: weight and ratio start at `keep`.
KERNEL float hvl_edge(ZonalCap cap, float soft) {
  return 1.0f / (1.0f + soft * soft * 2.0f * cap.versine);
}

// (HVL-5) The receiver's F' over the cap in the direction `w` of its view frame, steradians times 1/sr. 0 where the cap lies
// below the horizon, whatever rings there. `mirrored`: f has no coefficient with m < 0, so that half the work does.
KERNEL vec3 hvl_any_product(int bands, bool mirrored, HvlColors f, ZonalCap cap, vec3 w, float soft) {
  ShCoefficients Y;
  sh_evaluate(bands, w, Y);
  float keep = hvl_edge(cap, soft);
  float ratio = 1.0f;
  float weight = 1.0f;
  CapBand band = cap_first(cap);
  vec3 sum = vec3(0.0f);
  for (int l = 0; l < bands; ++l) {
    if (l > 0) {
      band = cap_next(cap, band, l);
      ratio *= keep;
      weight *= ratio;
    }
    vec3 value = vec3(0.0f);
    for (int m = mirrored ? 0 : -l; m <= l; ++m) value += f.c[l * (l + 1) + m] * Y.c[l * (l + 1) + m];
    sum += value * (band.gain * weight);
  }
  return w.z > -sqrt(cap.sine2) ? sum : vec3(0.0f);
}
KERNEL vec3 hvl_product(int bands, HvlColors f, ZonalCap cap, vec3 w, float soft) {
  return hvl_any_product(bands, false, f, cap, w, soft);
}
KERNEL vec3 hvl_mirrored_product(int bands, HvlColors f, ZonalCap cap, vec3 w, float soft) {
  return hvl_any_product(bands, true, f, cap, w, soft);
}

// (HVL-6), (HVL-7) The same for a diffuse part and a zonal lobe: `up` the cosine at the point, `turn` that between light and
// lobe.
KERNEL vec3 hvl_zonal_product(int bands, vec3 diffuse, vec3 specular, ZonalLobe lobe, ZonalCap cap, float up, float turn) {
  return diffuse * cap_irradiance(cap, up) + specular * (max(up, 0.0f) * zonal_lobe_cap(lobe, cap, turn, bands));
}
