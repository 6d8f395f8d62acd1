#include "materials/bsdf.h"

#include <cassert>

#include "core/sampling.h"
#include "materials/blinn_phong.h"
#include "materials/fresnel.h"
#include "materials/measured_brdf.h"
#include "materials/microfacet.h"

namespace zonal {
namespace {

bool above_horizon(vec3 w) {
  return w.z > kMinCosine;
}

vec3 reflect(vec3 w, vec3 h, float cosine) {
  return 2.0f * cosine * h - w;
}

/// Fresnel factor of the GGX kinds at the half vector.
inline vec3 fresnel(const Bsdf& b, float cosine) {
  switch (b.kind) {
    case BsdfKind::conductor:
      return b.specular * fresnel_conductor(cosine, b.eta, b.k);
    case BsdfKind::coated:
      return b.specular * fresnel_dielectric(cosine, b.eta.x);
    default:
      return fresnel_schlick(cosine, b.specular);
  }
}

/// About the specular albedo for another F0 than the 0.04 that the table E holds. Schlick's Fresnel is linear
/// in F0, and so is its albedo; at F0 = 1 it is nearly 1, and it is no less than in proportion to F0.
float schlick_albedo(float f0, float E) {
  return f0 < 0.04f ? E * f0 / 0.04f : E + (f0 - 0.04f) / 0.96f * (1.0f - E);
}

/// Value and density at once; a caller that drops one of them pays for half of it only, since both need D(h).
/// Both stay untouched (zero) below the horizon.
inline void evaluate_both(const Bsdf& b, const BsdfContext& view, vec3 w_in, Lobes lobes, vec3* f,
                          float* pdf) {
  *f = vec3(0.0f), *pdf = 0.0f;
  const vec3 w_out = view.w_out;
  if (!above_horizon(w_out) || !above_horizon(w_in)) return;
  const float share = view.specular_share;

  switch (b.kind) {
    case BsdfKind::black:
      return;

    case BsdfKind::lambert:
      if (has(lobes, Lobes::diffuse)) *f = b.diffuse * kInvPi;
      *pdf = w_in.z * kInvPi;
      return;

    case BsdfKind::blinn_phong: {
      const HalfVector half = half_vector(w_out, w_in);
      const float lobe = blinn_phong_lobe(half.h, b.exponent);
      if (has(lobes, Lobes::diffuse)) *f += b.diffuse * kInvPi;
      if (has(lobes, Lobes::specular)) *f += b.specular * (view.normalization * lobe);
      *pdf = share * blinn_phong_pdf(b.exponent, lobe, half.cosine) + (1.0f - share) * w_in.z * kInvPi;
      return;
    }

    case BsdfKind::measured:
      // Not divided into lobes: all of it counts as specular. Value and density share a search where the ends allow it.
      if (!has(lobes, Lobes::specular)) {
        *pdf = b.measured->pdf(w_out, w_in);
      } else if (view.end == PathEnd::camera) {
        b.measured->evaluate_with_pdf(w_out, w_in, f, pdf);
      } else {
        *f = b.measured->evaluate(w_in, w_out);
        *pdf = b.measured->pdf(w_out, w_in);
      }
      return;

    case BsdfKind::conductor:
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness: {
      const HalfVector half = half_vector(w_out, w_in);
      const float D = ggx_distribution(half.h, b.alpha_x, b.alpha_y);
      *pdf = ggx_reflection_pdf(D, w_out.z, view.stretch_out);
      if (has(lobes, Lobes::specular)) {
        const float stretch_in = ggx_stretch(w_in, b.alpha_x, b.alpha_y);
        *f = fresnel(b, half.cosine) * (D * ggx_visibility(w_out.z, view.stretch_out, w_in.z, stretch_in));
      }
      if (b.kind == BsdfKind::conductor) return;
      *pdf = share * *pdf + (1.0f - share) * w_in.z * kInvPi;
      if (has(lobes, Lobes::diffuse) && view.normalization > 0.0f) {
        *f += b.diffuse * (view.normalization * (1.0f - view.coat.at(w_in)));
      }
      return;
    }
  }
}

}  // namespace

BsdfContext prepare(const Bsdf& b, vec3 w_out, PathEnd end) {
  BsdfContext view;
  view.w_out = w_out;
  view.end = end;
  if (!above_horizon(w_out)) return view;
  switch (b.kind) {
    case BsdfKind::black:
    case BsdfKind::lambert:
    case BsdfKind::measured:
      break;
    case BsdfKind::blinn_phong: {
      view.normalization = blinn_phong_normalization(b.exponent);
      const float diffuse = luminance(b.diffuse), specular = luminance(b.specular);
      view.specular_share = specular > 0.0f ? specular / (specular + diffuse) : 0.0f;
      break;
    }
    case BsdfKind::conductor:
      view.stretch_out = ggx_stretch(w_out, b.alpha_x, b.alpha_y);
      view.specular_share = 1.0f;
      break;
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness: {
      assert(b.coat && "a coated Bsdf needs the table of its coat");
      view.stretch_out = ggx_stretch(w_out, b.alpha_x, b.alpha_y);
      view.specular_share = 1.0f;
      if (is_black(b.diffuse)) break;
      view.coat = b.coat->row(std::sqrt(b.alpha_x * b.alpha_y));
      const float E = view.coat.at(w_out);
      const float below = 1.0f - view.coat.average();
      view.specular_albedo_out = E;
      view.normalization = below > 1e-6f ? (1.0f - E) / (kPi * below) : 0.0f;
      // Lobes are sampled in proportion to what they reflect. A black F0 still shines at grazing angles.
      const float specular = b.kind == BsdfKind::coated
                                 ? luminance(b.specular) * E
                                 : schlick_albedo(std::fmax(luminance(b.specular), 0.01f), E);
      const float diffuse = luminance(b.diffuse) * (1.0f - E);
      view.specular_share = specular > 0.0f ? specular / (specular + diffuse) : 0.0f;
      break;
    }
  }
  return view;
}

vec3 evaluate(const Bsdf& b, const BsdfContext& view, vec3 w_in, Lobes lobes) {
  if (b.kind == BsdfKind::measured) {  // its density is another search, which the compiler cannot drop
    if (!has(lobes, Lobes::specular) || !above_horizon(view.w_out) || !above_horizon(w_in)) return vec3(0.0f);
    return view.end == PathEnd::camera ? b.measured->evaluate(view.w_out, w_in) : b.measured->evaluate(w_in, view.w_out);
  }
  vec3 f;
  float unused;
  evaluate_both(b, view, w_in, lobes, &f, &unused);
  return f;
}

float pdf(const Bsdf& b, const BsdfContext& view, vec3 w_in) {
  vec3 unused;
  float density;
  evaluate_both(b, view, w_in, Lobes{}, &unused, &density);
  return density;
}

void evaluate_with_pdf(const Bsdf& b, const BsdfContext& view, vec3 w_in, vec3* f, float* pdf) {
  evaluate_both(b, view, w_in, Lobes::all, f, pdf);
}

BsdfSample sample(const Bsdf& b, const BsdfContext& view, float u_lobe, vec2 u) {
  BsdfSample s;
  const vec3 w_out = view.w_out;
  if (b.kind == BsdfKind::black || !above_horizon(w_out)) return s;

  if (b.kind == BsdfKind::measured) {
    s.w_in = b.measured->sample_direction(w_out, u_lobe, u);
  } else if (u_lobe < view.specular_share) {
    const vec3 h = b.kind == BsdfKind::blinn_phong ? sample_blinn_phong(b.exponent, u)
                                                   : sample_visible_normal(w_out, b.alpha_x, b.alpha_y, u);
    const float cosine = glm::dot(w_out, h);
    if (cosine <= 0.0f) return s;
    s.w_in = reflect(w_out, h, std::fmin(cosine, 1.0f));
  } else {
    s.w_in = cosine_hemisphere(u);
  }
  // Reflected into the surface: the path ends. Shadowing has removed this light from f.
  if (!above_horizon(s.w_in)) return s;

  vec3 f;
  evaluate_both(b, view, s.w_in, Lobes::all, &f, &s.pdf);
  if (s.pdf > 0.0f) s.weight = f * (s.w_in.z / s.pdf);
  return s;
}

vec3 albedo(const Bsdf& b) {
  switch (b.kind) {
    case BsdfKind::black:
      return vec3(0.0f);
    case BsdfKind::lambert:
      return b.diffuse;
    case BsdfKind::measured:
      return b.measured->albedo;
    case BsdfKind::blinn_phong:
      return b.diffuse + b.specular;
    case BsdfKind::conductor: {
      // Mean of Schlick's curve over the hemisphere, 2 int c (1-c)^5 dc = 1/21; shadowing is left out.
      const vec3 f0 = fresnel_conductor(1.0f, b.eta, b.k);
      return b.specular * (f0 + (vec3(1.0f) - f0) / 21.0f);
    }
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness: {
      const float E = b.coat->row(std::sqrt(b.alpha_x * b.alpha_y)).average();
      const vec3 base = b.diffuse * (1.0f - E);
      if (b.kind == BsdfKind::coated) return base + b.specular * E;
      return base + vec3(schlick_albedo(b.specular.x, E), schlick_albedo(b.specular.y, E),
                         schlick_albedo(b.specular.z, E));
    }
  }
  return vec3(0.0f);
}

}  // namespace zonal
