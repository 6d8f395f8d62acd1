#pragma once
/// Projects a material on spherical harmonics, elevation by elevation (Mézières 2022, appendix B; Kautz et al. 2002).
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

struct ShProjectionOptions {
  int bands = 0;            ///< 1..100 for every row; 0: each row keeps the bands that hold `share` of its energy
  float share = 0.95f;      ///< of the integral of F^2 (of F'^2 for F'), (0, 1)
  int most_bands = 64;      ///< of a row when bands == 0
  int azimuths = 0;         ///< rows around the normal; 0: 1 where the material is isotropic, else 90
  std::string window = "none";  ///< none, hann, lanczos, hamming, auto: of every row
  float window_size = 0;    ///< bands; 0: the row's
};

/// One outgoing direction of one table.
struct ShRow {
  int bands = 0;
  std::vector<float> coefficients;  ///< [channel][sh_count(bands, mirrored)]
  double energy = 0;                ///< integral of F^2, channels summed, by quadrature
  double captured = 0;              ///< of it, by the bands stored (Parseval), share
};

struct ShProjection {
  std::string name, source;
  bool mirrored = true;
  int azimuths = 1;
  double asymmetry = 0;   ///< L2 share of the m < 0 half, largest over the rows: what mirrored = true leaves out
  vec3 albedo{0};
  std::vector<ShRow> rows[2];          ///< [ShTable][azimuth * kElevations + elevation]
  std::vector<vec3> row_albedo;        ///< directional albedo at each elevation, by quadrature
};

/// Whether the kind depends on the difference of azimuths only.
bool is_isotropic(const Bsdf& bsdf);

/// In parallel. Returns an empty projection when stopped.
ShProjection project_material(const Bsdf& bsdf, const ShProjectionOptions& options = {}, const Stop& stop = {},
                              const std::function<void(double)>& progress = {});

struct ShmatOptions {
  bool half = true;
};
std::vector<std::byte> write_shmat(const ShProjection& projection, const ShmatOptions& options = {});

}  // namespace zonal
