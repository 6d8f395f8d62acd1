#pragma once
/// One material on spherical harmonics: for each outgoing direction the SH coefficients, over incoming
/// directions, of its BRDF F and of F' = F max(0, cos) (Kautz et al. 2002; Mézières 2022, appendix B). A
/// `.shmat` file in memory: mapped, or made by the projector. docs/shmat.md has the format byte by byte.
///
///     ShMaterial paper = ShMaterial::open("paper_white.shmat");
///     int bands = paper.look_up(ShTable::brdf_cosine, w_out, 9, stride, rgb);
///
/// Coefficients are in the *view frame*: z = normal, x = the azimuth of w_out (w_out has y = 0, x >= 0), y =
/// z cross x. So isotropic materials need no azimuth, and interpolation between elevations never turns a
/// lobe. `view_frame` turns a shading-frame direction into it.
///
/// A material that is mirror-symmetric about the plane of w_out has no coefficient with m < 0; then only m >=
/// 0 is stored, coefficient (l, m) at l(l+1)/2 + m; else all, at l(l+1) + m.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace zonal {

enum class ShTable : uint8_t { brdf, brdf_cosine };  ///< F, F'

/// Coefficients of `bands` bands, one half (m >= 0) or all.
constexpr int sh_count(int bands, bool mirrored) {
  return mirrored ? bands * (bands + 1) / 2 : bands * bands;
}

/// Where coefficient (l, m) lies; m >= 0 when mirrored.
constexpr int sh_index(int l, int m, bool mirrored) {
  return (mirrored ? l * (l + 1) / 2 : l * (l + 1)) + m;
}

/// cos and sin of the azimuth of w_out: (x, y) -> (c x + s y, c y - s x) turns into the view frame. Along z:
/// 1, 0.
struct ViewFrame {
  float c = 1, s = 0;
  explicit ViewFrame(vec3 w_out) {
    const float r2 = w_out.x * w_out.x + w_out.y * w_out.y;
    if (r2 > 1e-12f) {
      const float inverse = 1.0f / std::sqrt(r2);
      c = w_out.x * inverse, s = w_out.y * inverse;
    }
  }
  vec3 to_view(vec3 w) const { return {c * w.x + s * w.y, c * w.y - s * w.x, w.z}; }
};

class ShMaterial {
 public:
  static constexpr int kElevations = 91;  ///< 0, 1, ... 89, 89.5 degrees from the normal
  static constexpr double degrees(int elevation) { return elevation < 90 ? elevation : 89.5; }
  static constexpr int kMaxBands = 100;  ///< of a row

  ShMaterial() = default;
  /// Maps the file. Throws SceneError: file, field, found, expected (magic, version, sizes, checksum).
  static ShMaterial open(const std::string& file);
  /// Takes a file's bytes from memory; `name` stands for the file in errors.
  static ShMaterial from_bytes(std::vector<std::byte> bytes, const std::string& name);

  const std::string& name() const;
  const std::string& source() const;  ///< what was projected
  bool mirrored() const;
  bool half() const;        ///< coefficients are stored as half floats
  int azimuths() const;     ///< 1: isotropic; else rows for azimuths of w_out k 2pi / azimuths
  vec3 albedo() const;      ///< hemispherical, [0, 1] and a little more where measurements say so
  float asymmetry() const;  ///< norm of the m < 0 half over the norm of all, largest of the rows
  int max_bands() const;    ///< of all rows of both tables
  /// Bands of one row, and the share of the energy they hold, [0, 1] in steps of 1/65535.
  int row_bands(ShTable table, int azimuth, int elevation) const;
  float row_share(ShTable table, int azimuth, int elevation) const;
  /// One row as stored: channel c's coefficient i at out[c * sh_count(row_bands, mirrored) + i].
  std::vector<float> row(ShTable table, int azimuth, int elevation) const;
  /// Bands stored at this elevation (the larger of the two rows around it): what holds the wanted share of
  /// the energy.
  int bands(ShTable table, vec3 w_out) const;

  /// Coefficients at w_out (shading frame, z > 0), linear between elevations (and azimuths): channel c's
  /// coefficient i at out[c * stride + i], as many bands as `bands` and the rows allow; the rest of the
  /// `bands` asked for is zero. Returns the bands that hold anything. stride >= sh_count(bands, mirrored()).
  int look_up(ShTable table, vec3 w_out, int bands, int stride, float* out) const;

  /// The whole file as it is on disk and goes to the GPU.
  std::span<const std::byte> bytes() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace zonal
