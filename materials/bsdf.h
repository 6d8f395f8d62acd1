#pragma once
/// The reflection of one surface point, textures already looked up: a small value that inner loops can hold.
///
///     Bsdf bsdf = material.at(uv);
///     BsdfContext view = prepare(bsdf, w_out);               // once a point: everything that depends on w_out alone
///     vec3 f = evaluate(bsdf, view, w_in);                    // 1/sr, without the cosine
///
/// All directions are unit vectors in the shading frame (z = normal), pointing away from the surface. Surfaces reflect
/// only: f = 0 when either direction has z <= 1e-8. All models but `measured` are reciprocal and reflect at most what
/// they receive; measurements are what they are.
/// docs/materials.md has the equations.

#include "core/vec.h"
#include "materials/specular_albedo.h"

namespace zonal {

class MeasuredBrdf;  // a material read from a file

enum class BsdfKind : uint8_t { black, lambert, blinn_phong, conductor, coated, metallic_roughness, measured };

/// Which part of a decomposable BRDF is asked for.
enum class Lobes : uint8_t { diffuse = 1, specular = 2, all = 3 };
constexpr bool has(Lobes set, Lobes part) { return (static_cast<int>(set) & static_cast<int>(part)) != 0; }

struct Bsdf {
  BsdfKind kind = BsdfKind::black;
  vec3 diffuse{0};      ///< albedo of the diffuse part, [0,1]
  vec3 specular{0};     ///< blinn_phong: ks; metallic_roughness: F0; conductor, coated: tint (1 = physical)
  vec3 eta{1}, k{0};    ///< conductor: complex index of refraction, per channel. coated: eta.x = index of the coat
  float alpha_x = 1, alpha_y = 1;  ///< GGX widths, >= 1e-4, along the frame's x and y
  float exponent = 1;   ///< Blinn-Phong
  const SpecularAlbedo* coat = nullptr;  ///< coated, metallic_roughness: what the coat keeps from the diffuse base
  const MeasuredBrdf* measured = nullptr;  ///< measured: the data, owned by the material
};

/// Which end of a path the direction given to `prepare` is. Only measurements, which are not exactly reciprocal, tell the
/// two apart: their data are indexed by the camera's side.
enum class PathEnd : uint8_t { camera, light };

/// What an evaluation can reuse while w_out stays the same. With PathEnd::light, w_out is where light comes from, and
/// the directions evaluated or sampled are those it leaves in: a virtual light, a path from a light.
struct BsdfContext {
  vec3 w_out{0, 0, 1};
  PathEnd end = PathEnd::camera;
  float specular_albedo_out = 0;  ///< coated, metallic_roughness: directional albedo of the coat seen from w_out
  float specular_share = 0;       ///< probability that sampling takes the specular lobe
  float stretch_out = 1;          ///< GGX: |(alpha_x x, alpha_y y, z)| of w_out
  float normalization = 0;        ///< blinn_phong: the lobe's; coated, metallic_roughness: (1-E(o)) / (pi (1-E_avg))
  SpecularAlbedo::Row coat;       ///< coated, metallic_roughness: E at this roughness
};

struct BsdfSample {
  vec3 w_in{0};
  vec3 weight{0};  ///< f cos / pdf
  float pdf = 0;   ///< 1/sr; 0: no direction was found, the path ends
};

BsdfContext prepare(const Bsdf& bsdf, vec3 w_out, PathEnd end = PathEnd::camera);
vec3 evaluate(const Bsdf& bsdf, const BsdfContext& view, vec3 w_in, Lobes lobes = Lobes::all);
float pdf(const Bsdf& bsdf, const BsdfContext& view, vec3 w_in);
/// Value and density in one go: what next-event estimation with MIS needs.
void evaluate_with_pdf(const Bsdf& bsdf, const BsdfContext& view, vec3 w_in, vec3* f, float* pdf);
BsdfSample sample(const Bsdf& bsdf, const BsdfContext& view, float u_lobe, vec2 u);

/// Approximate hemispherical albedo, [0,1]: for the albedo layer and for choosing lights. Not exact.
vec3 albedo(const Bsdf& bsdf);

}  // namespace zonal
