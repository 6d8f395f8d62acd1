#pragma once
/// Projects a material on spherical harmonics, elevation by elevation (Mézières 2022, appendix B; Kautz et
/// al. 2002).
///
///     ShProjection projection = project_material(bsdf, {.bands = 0});          // as many bands as it needs
///     std::vector<std::byte> file = write_shmat(projection, {.half = true});

#include <functional>
#include <string>
#include <vector>

#include "core/stop.h"
#include "materials/bsdf.h"
#include "materials/sh_material.h"

namespace zonal {

/// Raise it when projections change: tables in the cache and in databases are then made anew.
inline constexpr int kProjectionVersion = 3;

struct ShProjectionOptions {
  /// 1..100 for every row; 0: each row of F' keeps the bands that hold `share` of its energy, and the row of
  /// F at most as many: what F sends or receives is weighted by a cosine, and its own energy may lie at the
  /// very horizon, where the cosine vanishes.
  int bands = 0;
  float share = 0.95f;  ///< of the integral of F'^2 (and of F^2), (0, 1)
  int most_bands =
      64;            ///< of a row when bands == 0; anisotropic materials have at most kAnisotropicBands then
  int azimuths = 0;  ///< rows around the normal; 0: 1 where the material is isotropic, else 90
  std::string window = "none";  ///< none, hann, lanczos, hamming, auto: of every row
  float window_size = 0;        ///< bands; 0: the row's
  int nodes = 0;  ///< about how many directions a row is evaluated at; 0: what its accuracy needs
};

/// Keeps both tables of 90 azimuths below 20 MB.
inline constexpr int kAnisotropicBands = 10;

/// One outgoing direction of one table.
struct ShRow {
  int bands = 0;
  std::vector<float> coefficients;  ///< [channel][sh_count(bands, mirrored)]
  double energy = 0;                ///< integral of F^2, channels summed, by quadrature
  double captured = 0;              ///< of it, by the bands stored (Parseval), share; before any window
};

struct ShProjection {
  std::string name, source;
  bool mirrored = true;
  int azimuths = 1;
  double asymmetry =
      0;  ///< norm of the m < 0 half over that of all, largest of the rows: what mirrored leaves out
  vec3 albedo{0};
  std::vector<ShRow> rows[2];  ///< [ShTable][azimuth * kElevations + elevation]
  std::vector<vec3>
      row_albedo;          ///< directional albedo at each elevation, mean of the azimuths, by quadrature
  size_t evaluations = 0;  ///< of the BRDF
  bool empty() const { return rows[0].empty(); }
};

/// Largest asymmetry at which only the half m >= 0 is kept.
inline constexpr double kMirrorTolerance = 5e-3;

/// Whether the kind depends on the difference of azimuths only.
bool is_isotropic(const Bsdf& bsdf);

/// In parallel. Returns an empty projection when stopped.
ShProjection project_material(const Bsdf& bsdf, const ShProjectionOptions& options = {},
                              const Stop& stop = {}, const std::function<void(double)>& progress = {});

/// How many bands one outgoing direction needs: share[table][l] of the energy lies in bands 0..l, both bases.
struct BandStudy {
  std::vector<double> spherical[2], hemispherical[2];
  /// The fewest bands that hold `share`; 0 where all of them do not.
  static int bands(const std::vector<double>& shares, double share);
};
BandStudy study_bands(const Bsdf& bsdf, double theta_out, int most_bands);

struct ShmatOptions {
  bool half = true;
};
/// The bytes of a .shmat file. Throws SceneError where the coefficients do not fit the format: too many in
/// all, or too large for half floats.
std::vector<std::byte> write_shmat(const ShProjection& projection, const ShmatOptions& options = {});

}  // namespace zonal
