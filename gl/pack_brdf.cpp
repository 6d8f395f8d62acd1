#include "gl/pack_brdf.h"

#include <algorithm>
#include <cmath>

#include "core/glsl.h"
#include "materials/blinn_phong.h"
#include "materials/microfacet.h"

namespace zonal::gl {
namespace {
using namespace zonal;
#include "materials/brdf.glsl"

/// A direction whose place between the nodes of a coat's table is node `azimuth`
/// (SpecularAlbedo::azimuth_coordinate inverted) and whose cosine is `z`.
vec3 node_direction(float aspect, int azimuth, float z) {
  const float sine = safe_sqrt(1.0f - z * z);
  if (aspect == 1.0f) return {sine, 0, z};
  const float root = std::sqrt(aspect);
  const float width = root + float(azimuth) / (CoatTables::kAzimuths - 1) * (1.0f - root);
  const float w4 = sqr(sqr(width)), a2 = sqr(aspect);
  const float x2 = std::clamp((w4 - a2) / (1.0f - a2), 0.0f, 1.0f);
  return {sine * std::sqrt(x2), sine * std::sqrt(1.0f - x2), z};
}

}  // namespace

int CoatTables::place(const SpecularAlbedo& coat) {
  const auto known = places_.find(&coat);
  if (known != places_.end()) return known->second;
  const int azimuths = coat.aspect() == 1.0f ? 1 : kAzimuths;
  std::vector<float> averages, values;
  for (int i = 0; i < kAlphas; ++i) {
    // Nodes are even in the fourth root, from that of the narrowest width on.
    const float first = std::sqrt(std::sqrt(kMinAlpha));
    const SpecularAlbedo::Row row = coat.row(sqr(sqr(first + (1.0f - first) * float(i) / (kAlphas - 1))));
    averages.push_back(row.average());
    for (int a = 0; a < azimuths; ++a)
      for (int k = 0; k < kCosines; ++k)
        values.push_back(row.at(node_direction(coat.aspect(), a, sqr(sqr(float(k) / (kCosines - 1))))));
  }
  averages.insert(averages.end(), values.begin(), values.end());
  averages.resize((averages.size() + 3) / 4 * 4);
  const int start = static_cast<int>(texels_.size());
  for (size_t i = 0; i < averages.size(); i += 4)
    texels_.emplace_back(averages[i], averages[i + 1], averages[i + 2], averages[i + 3]);
  places_[&coat] = start;
  return start;
}

bool is_constant(const Bsdf& b, Lobes lobes) {
  switch (b.kind) {
    case BsdfKind::black:
    case BsdfKind::lambert:
    case BsdfKind::measured:
      return true;
    case BsdfKind::conductor:
    case BsdfKind::blinn_phong:
      return !has(lobes, Lobes::specular);
    default:
      return !has(lobes, Lobes::specular) && is_black(b.diffuse);
  }
}

void pack_brdf(const Bsdf& b, const BsdfContext& view, Lobes lobes, CoatTables& coats, vec4* t) {
  const bool seen = view.w_out.z > kMinCosine && b.kind != BsdfKind::black && b.kind != BsdfKind::measured;
  const bool diffuse = seen && has(lobes, Lobes::diffuse), specular = seen && has(lobes, Lobes::specular);
  int kind = BRDF_CONSTANT;
  vec3 f(0), k(0), tint(1), base(0);
  float coat = -1;
  if (seen) {
    switch (b.kind) {
      case BsdfKind::lambert:
        base = b.diffuse * kInvPi;
        break;
      case BsdfKind::blinn_phong:
        kind = BRDF_BLINN_PHONG, f = b.specular * view.normalization, base = b.diffuse * kInvPi;
        break;
      case BsdfKind::conductor:
        kind = BRDF_CONDUCTOR, f = b.eta, k = b.k, tint = b.specular;
        break;
      case BsdfKind::coated:
        kind = BRDF_DIELECTRIC, f = b.eta, tint = b.specular;
        break;
      default:
        kind = BRDF_SCHLICK, f = b.specular;
        break;
    }
    if (diffuse && b.coat && !is_black(b.diffuse) && view.normalization > 0) {
      base = b.diffuse * view.normalization;
      coat = static_cast<float>(coats.place(*b.coat));
    }
  }
  if (!diffuse) base = vec3(0);
  t[0] = vec4(view.w_out.x, view.w_out.y, std::fmax(view.w_out.z, kMinCosine), static_cast<float>(kind));
  t[1] = vec4(b.alpha_x, b.alpha_y, view.stretch_out, coat);
  t[2] = vec4(f, b.exponent);
  t[3] = vec4(k, b.coat ? b.coat->aspect() : 1.0f);
  t[4] = vec4(tint, specular ? 1.0f : 0.0f);
  t[5] = vec4(base, 0.0f);
}

}  // namespace zonal::gl
