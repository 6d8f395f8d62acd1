#pragma once
/// A tile's points made ready to receive spherical Gaussian lights: what of their reflection depends on the
/// camera alone, as arrays over the points.

#include <vector>

#include "integrators/tile_points.h"
#include "integrators/vsgl/vsgl_blocks.h"

namespace zonal {

struct VsglReceivers : TileState {
  using Floats = TilePoints::Floats;

  alignas(64) Floats dr, dg, db;  ///< albedo of the diffuse part
  /// (VSGL-19) What a coat leaves of light that comes in at the cosine c: base + square s^2 + fifth s^5, s =
  /// 1 - c. Without a coat: 1.
  alignas(64) Floats base, square, fifth;
  alignas(64) Floats f0r, f0g, f0b, f1r, f1g,
      f1b;  ///< Fresnel by Schlick: f0 + f1 (1 - cosine)^5; 0 where exact
  alignas(64) Floats er, eg, eb, kr, kg, kb, tr, tg,
      tb;  ///< exact Fresnel: complex index, tint; tint 0 elsewhere

  /// 2015: VsglAsgReceiver in the order of its members. 2024: width, spread, determinant, mirror.
  static constexpr int kFields = 9;
  alignas(64) std::array<Floats, kFields> lobe;

  /// Points [begin, end), multiples of 8, of one kind.
  struct Run {
    int begin = 0, end = 0;
    bool specular = false;  ///< some reflect about the mirrored direction
    bool exact = false;     ///< of these some with exact Fresnel
  };
  std::vector<Run> runs;

  VsglReceivers(const TilePoints& points, VsglGeneration generation);
};

/// (VSGL-19) fitted to a coat's table: what of light coming in at cosine c reaches the base and returns to
/// the camera, relative to Lambert's base of the same albedo.
struct VsglCoat {
  float base = 1, square = 0, fifth = 0;
  float at(float cosine) const {
    const float s = 1.0f - cosine, s2 = s * s;
    return base + square * s2 + fifth * (s2 * s2 * s);
  }
};
VsglCoat fit_coat(const Bsdf& bsdf, const BsdfContext& view);

}  // namespace zonal
