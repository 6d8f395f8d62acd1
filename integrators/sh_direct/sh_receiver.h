#pragma once
/// What a surface point sends to the camera of the light given by SH coefficients: the shading of `sh_direct`
/// and its alternatives (Mézières 2022, Sec. 4.1). README.md beside this file has the equations.
///
///     const ShReceiver receiver(params, scene.materials(), stop);
///     const int bands = receiver.light_bands(surface, bsdf);     // worth having of the light
///     vec3 radiance = receiver.shade(surface, bsdf, bands, L);   // L[c * sh::count(bands) + i], world frame

#include <array>
#include <memory>
#include <vector>

#include "core/params.h"
#include "core/scene.h"
#include "core/stop.h"
#include "lights/sh_lights.h"
#include "materials/sh_materials.h"
#include "sh/quick_dering.h"

namespace zonal {

struct ShReceiverParams {
  enum class Shading { table, cosine, general, turned };
  enum class Diffuse { same, irradiance };
  enum class Window { none, hann, lanczos, hamming, automatic, dering };
  enum class Windowed { light, material };
  enum class Product { sh, zonal };

  int bands = 9, light_bands = 5;  ///< or kAuto
  Product product = Product::sh;
  Shading shading = Shading::table;
  int cosine_bands = 0;
  Diffuse diffuse = Diffuse::same;
  Window window = Window::none;
  float window_size = 0;
  Windowed windowed = Windowed::light;

  void visit(ParamVisitor& v);
};

/// Most bands of lights and receivers.
inline constexpr int kMostShBands = 20;

class ShReceiver {
 public:
  ShReceiver() = default;
  ShReceiver(const ShReceiverParams& params, const std::vector<std::unique_ptr<Material>>& materials,
             const Stop& stop);

  /// Bands of light that change what the point reflects, 1 .. most_light_bands().
  int light_bands(const Surface&, const Bsdf&) const;
  int most_light_bands() const { return most_light_bands_; }
  /// What it shades with, for a copy elsewhere (a GPU): materials and the window of so many bands.
  const ShMaterials& materials() const { return materials_; }
  const float* window_of(int bands) const { return windows_[bands].data(); }
  /// Radiance towards the camera, W m^-2 sr^-1; negative where the bands ring. `L` has `bands` bands.
  vec3 shade(const Surface&, const Bsdf&, int bands, const float* L) const;
  /// The same by the zonal product, straight from the lights.
  vec3 shade_zonal(const Surface&, const Bsdf&, const ShLights& lights) const;

 private:
  int bands_of(const Surface&, const Bsdf&, vec3 w_out) const;
  void window(int count, float* weights) const;
  vec3 shade_as_is(const Surface&, const Bsdf&, int bands, const float* L) const;
  vec3 by_irradiance(vec3 normal, int bands, const float* L) const;
  vec3 by_table(const Surface&, const Bsdf&, int bands, const float* L) const;
  vec3 by_product(const Surface&, const Bsdf&, int bands, const float* L) const;

  ShReceiverParams params_;
  ShMaterials materials_;
  int most_light_bands_ = 1;
  std::array<std::array<float, kMostShBands>, kMostShBands + 1> windows_{};  ///< by number of bands
  std::vector<sh::QuickDering> dering_;                                      ///< by number of bands less one
  std::array<float, kMostShBands>
      cosine_{};  ///< of the clamped cosine: sqrt(4pi/(2l+1)) times its zonal coefficient
};

}  // namespace zonal
