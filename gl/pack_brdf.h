#pragma once
/// A BRDF seen from one side as shaders read it: the texels of gl/brdf.glsl.
///
///     vec4 texels[kBrdfTexels];
///     pack_brdf(light.bsdf, prepare(light.bsdf, w_in, PathEnd::light), Lobes::all, coats, texels);

#include <map>
#include <vector>

#include "materials/bsdf.h"

namespace zonal::gl {

/// The tables of what coats keep, one behind the other, each index of refraction and aspect once.
class CoatTables {
 public:
  static constexpr int kAlphas = 48, kCosines = 97, kAzimuths = 9;
  /// Where this coat's table starts, in texels of four floats: kAlphas averages, then
  /// [alpha][azimuth][cosine].
  int place(const SpecularAlbedo& coat);
  const std::vector<vec4>& texels() const { return texels_; }

 private:
  std::map<const SpecularAlbedo*, int> places_;
  std::vector<vec4> texels_;
};

inline constexpr int kBrdfTexels = 6;

/// `view` is of prepare(bsdf, w_out, end). A measured BRDF has no such form: it is black.
void pack_brdf(const Bsdf& bsdf, const BsdfContext& view, Lobes lobes, CoatTables& coats, vec4* texels);

/// Whether the packed form is the same for all directions above the horizon.
bool is_constant(const Bsdf& bsdf, Lobes lobes);

}  // namespace zonal::gl
