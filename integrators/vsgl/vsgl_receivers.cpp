#include "integrators/vsgl/vsgl_receivers.h"

namespace zonal {
#include "integrators/vsgl/spherical_gaussian.glsl"
#include "integrators/vsgl/vsgl.glsl"

VsglCoat fit_coat(const Bsdf& b, const BsdfContext& view) {
  if (b.kind != BsdfKind::coated && b.kind != BsdfKind::metallic_roughness) return {};
  if (is_black(b.diffuse) || !(view.normalization > 0)) return {0, 0, 0};
  // Through the table's values at three cosines. Where the coat is anisotropic, half way between its axes.
  const auto share = [&](float c) {
    const float side = std::sqrt(0.5f * (1.0f - c * c));
    return kPi * view.normalization * (1.0f - view.coat.at(vec3(side, side, c)));
  };
  const vec3 coat = vsgl_coat(share(1.0f), share(0.4f), share(0.1f));
  return {coat.x, coat.y, coat.z};
}

namespace {

/// Fresnel's factor as arrays: Schlick's form, or the index of refraction. The other one contributes 0.
void set_fresnel(VsglReceivers& r, int k, const Bsdf& b) {
  vec3 f0(0), f1(0), eta(1), absorption(0), tint(0);
  switch (b.kind) {
    case BsdfKind::conductor:
      eta = b.eta, absorption = b.k, tint = b.specular;
      break;
    case BsdfKind::coated:  // a conductor that absorbs nothing
      eta = vec3(b.eta.x), tint = b.specular;
      break;
    case BsdfKind::metallic_roughness:
      f0 = b.specular, f1 = vec3(1) - b.specular;
      break;
    case BsdfKind::blinn_phong:
      f0 = b.specular;
      break;
    default:
      break;
  }
  r.f0r[k] = f0.x, r.f0g[k] = f0.y, r.f0b[k] = f0.z;
  r.f1r[k] = f1.x, r.f1g[k] = f1.y, r.f1b[k] = f1.z;
  r.er[k] = eta.x, r.eg[k] = eta.y, r.eb[k] = eta.z;
  r.kr[k] = absorption.x, r.kg[k] = absorption.y, r.kb[k] = absorption.z;
  r.tr[k] = tint.x, r.tg[k] = tint.y, r.tb[k] = tint.z;
}

void set_lobe(VsglReceivers& r, int k, VsglGeneration generation, vec3 v, vec2 alpha2) {
  std::array<float, VsglReceivers::kFields> fields{};
  if (generation == VsglGeneration::y2015) {
    const VsglAsgReceiver a = vsgl_asg_receiver(v, alpha2);
    fields = {a.heading.x, a.heading.y, a.sine, a.cosine, a.a2, a.stretch};
  } else {
    const VsglFilteredReceiver f = vsgl_filtered_receiver(v, alpha2);
    fields = {f.width.x,     f.width.y,  f.spread.x, f.spread.y, f.spread.z,
              f.determinant, f.mirror.x, f.mirror.y, f.mirror.z};
  }
  for (int i = 0; i < VsglReceivers::kFields; ++i) r.lobe[i][k] = fields[i];
}

bool exact_fresnel(const Bsdf& b) {
  return b.kind == BsdfKind::conductor || b.kind == BsdfKind::coated;
}

}  // namespace

VsglReceivers::VsglReceivers(const TilePoints& points, VsglGeneration generation) {
  for (int k = 0; k < points.padded; ++k) {
    const Bsdf& b = points.bsdf(k);
    dr[k] = b.diffuse.x, dg[k] = b.diffuse.y, db[k] = b.diffuse.z;
    const VsglCoat coat = fit_coat(b, points.view[k]);
    base[k] = coat.base, square[k] = coat.square, fifth[k] = coat.fifth;
    set_fresnel(*this, k, b);
    set_lobe(*this, k, generation, vec3(points.ox[k], points.oy[k], points.oz[k]), vsgl_squared_widths(b));
  }
  for (int begin = 0; begin < points.padded; begin += 8) {
    Run run{begin, begin + 8};
    for (int k = begin; k < begin + 8; ++k) {
      run.specular |= vsgl_has_specular(points.bsdf(k));
      run.exact |= exact_fresnel(points.bsdf(k));
    }
    if (!runs.empty() && runs.back().specular == run.specular && runs.back().exact == run.exact)
      runs.back().end = run.end;
    else
      runs.push_back(run);
  }
}

}  // namespace zonal
