#pragma once
/// `hvl`: harmonic virtual lights (Mézières 2022, Sec. 5.2). A virtual light is a sphere; what it sends a
/// point fills the cap the sphere subtends, and meets the point's BRDF on spherical harmonics. Equations,
/// parameters and failures: README.md beside this file.

#include "integrators/bsdf_arrays.h"
#include "integrators/hvl/hvl_kernels.h"
#include "integrators/many_lights.h"
#include "lights/virtual_light_radius.h"
#include "materials/sh_materials.h"

namespace zonal {

struct HvlParams : ManyLightsParams {
  enum class Emission { sh, brdf };
  enum class Product { sh, zonal };
  enum class Window { none, hann, lanczos, hamming, automatic };

  int bands = 9, emission_bands = 3;  ///< or kAuto
  Emission emission = Emission::sh;
  Product product = Product::sh;
  RadiusParams radius;
  float soft_edge = 0;
  Window window = Window::none;
  float window_size = 0;  ///< bands; 0: as many as the receiver has

  void visit(ParamVisitor& v);
};

class HvlIntegrator : public ManyLights {
 public:
  /// Throws SceneError where two settings do not go together; `where` names the settings.
  explicit HvlIntegrator(const HvlParams& params, const std::string& where = "integrator \"hvl\"");

  /// Projects the scene's materials. Throws SceneError where `product: zonal` meets one without a symmetric
  /// lobe.
  void load(const Scene&, const Stop&, PassStats&) override;
  /// Position, radius and power of every light of the pass.
  const std::vector<hvl::Light>& records() const { return records_; }
  /// A light's BRDF: one number, 1/sr, or a place among those that depend on the direction.
  struct Brdf {
    int at = -1;
    vec3 flat{0};
  };
  /// What light `j` reflects of a unit flux towards w (unit, world), 1/sr: (HVL-2), or the BRDF.
  vec3 emission(int j, vec3 w) const;

  // What a GPU twin takes over.
  const HvlParams& params() const { return params_; }
  const ShMaterials& materials() const { return materials_; }
  /// Weights of `count` bands.
  void window(int count, float* weights) const;
  int emission_bands() const { return emission_bands_; }
  /// (HVL-2) of light `j`, emission sh: its view frame (world) and, band by band, the scaled coefficients of
  /// even l + m, m rising; hvl_emission takes them with a scale of 1.
  struct ShEmission {
    vec3 x, y, z;
    std::vector<vec3> coefficients;
  };
  ShEmission sh_emission(int j) const;

 protected:
  void prepare(const Pass&, const VirtualLightSet&, LightArrays&, const Stop&, PassStats&) override;
  std::unique_ptr<TileState> prepare_tile(const TilePoints&) const override;
  void gather(const TilePoints&, int first, int count, Contributions&) const override;
  void gather_sums(const TilePoints&, int first, int count, PointSums&) const override;
  bool horizons_hide() const override { return true; }

 private:
  /// A light's emission on spherical harmonics: view frame in world, coefficients for hvl::emission.
  struct Emitter {
    vec3 x, y, z;
    const float* coefficients;
    bool flat;  ///< Lambert: the first coefficient says all
  };
  void refuse_lobeless(const Scene&) const;
  void prepare_emission(const VirtualLightSet&, const Stop&);
  template <class F>
  void with_emission(int first, F&& f) const;
  void receive_sh(const TilePoints&, hvl::Receivers&) const;
  void receive_zonal(const TilePoints&, hvl::Receivers&) const;

  HvlParams params_;
  std::string where_;
  const Scene* loaded_ = nullptr;
  ShMaterials materials_;
  std::vector<hvl::Light> records_;
  BsdfArrays brdfs_;           ///< emission brdf: of the lights that are not matt
  std::vector<Brdf> brdf_of_;  ///< emission brdf: of every light
  std::vector<Emitter> emitters_;
  std::vector<float> emission_;
  int emission_bands_ = 1;
  bool emission_mirrored_ = true;
};

}  // namespace zonal
