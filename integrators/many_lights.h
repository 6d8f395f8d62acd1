#pragma once
/// What vpl, vsl, hvl and vsgl share, written once: tracing the virtual lights, fitting their number to the
/// time, direct light, and the loop over blocks of lights and a tile's points with its shadow rays. A method
/// fills in two functions:
///
///     class Flat : public ManyLights {
///       void gather(const TilePoints& points, int first, int count, Contributions& out) const override {
///         for (int j = 0; j < count; ++j)
///           for (int k = 0; k < points.padded; ++k)
///             out.r[out.at(j, k)] = out.g[out.at(j, k)] = out.b[out.at(j, k)] = lights().power_r[first + j];
///       }
///     };
///
/// Sums run over the lights in their order, light 0 first, whatever the threads.

#include <limits>
#include <memory>
#include <optional>

#include "core/integrator.h"
#include "core/params.h"
#include "integrators/light_arrays.h"
#include "integrators/tile_bounds.h"
#include "integrators/tile_points.h"
#include "lights/virtual_lights.h"

namespace zonal {

/// What may stand between a shaded point and a virtual light. Each method lists those it has, in this order.
enum class Occlusion {
  none,    ///< light passes through everything
  center,  ///< one shadow ray to the light's position
  sphere,  ///< one shadow ray to a point of the light's sphere, drawn anew for each light, pixel and pass
};

struct ManyLightsParams {
  enum class Distribution { grid, paths };
  enum class Direct { sampled, none };
  enum class Placement { sampled, center };

  int lights = 400, bounces = 1;
  int pass_lights = 0;
  Distribution distribution = Distribution::grid;
  int block_texels = 1;
  Placement placement = Placement::sampled;
  Direct direct = Direct::sampled;
  int direct_samples = 1;
  Occlusion occlusion = Occlusion::center;
  float skip = 0;   ///< share of a tile's light
  float split = 0;  ///< widths of a light's block

  /// What parameters a method has beyond those of all.
  struct Has {
    int occlusions = 2;  ///< how many of the names none, center, sphere
    bool skip = false;   ///< it bounds what a light brings (ManyLights::most)
    bool split = true;   ///< a texel of a light's block is a light for it
  };
  void visit(ParamVisitor& v, const Has& has);
};

/// Lights handled together: their contributions to a tile's points stay in the cache.
inline constexpr int kBlockLights = 32;

/// Radiance that each light of a block sends to the camera by way of each point, W m^-2 sr^-1, before
/// shadows. Both orders of the loops vectorise: `by_light` holds the points of one light side by side,
/// `by_point` the lights of one point. Entries of padding points (TilePoints::padded) are never read.
struct Contributions {
  enum class Order { by_light, by_point };
  Order order = Order::by_light;
  int shadow_rays = 0;  ///< that `gather` traced itself
  alignas(64) std::array<float, kBlockLights * kTilePixels> r, g, b;

  /// Place of light `j` of the block (0 based) and point `k`.
  int at(int j, int k) const { return order == Order::by_light ? j * kTilePixels + k : k * kBlockLights + j; }
};

/// Sums over lights for each of a tile's points.
struct PointSums {
  alignas(64) std::array<float, kTilePixels> r{}, g{}, b{};
};

class ManyLights : public Integrator {
 public:
  explicit ManyLights(const ManyLightsParams& shared) : shared_(shared) {}
  void begin_pass(const Pass&, const Stop&, PassStats&) final;
  void shade(const Tile&, vec3* radiance, Sampler*, const Stop&, TileStats&) const final;

  /// From now on every pass gathers from these lights instead of tracing its own: for tests, and for showing
  /// one method the lights of another.
  void gather_from(VirtualLightSet set) { given_ = std::make_shared<VirtualLightSet>(std::move(set)); }
  /// The lights of the current pass: what a GPU twin gathers from. With `split` they end with the texels
  /// (VirtualLightSet::parts).
  const VirtualLightSet& light_set() const { return set_; }
  /// The same as arrays, with the radii the method has given them.
  const LightArrays& lights() const { return arrays_; }
  const ManyLightsParams& shared() const { return shared_; }
  /// A number that differs from pass to pass and seed to seed: what `gather` hashes its own random numbers
  /// from, with TilePoints::seed and the light's index.
  uint32_t pass_key() const { return pass_key_; }

 protected:
  /// Called when a pass has its lights, before any `gather`: radii, coefficients, whatever a light keeps. May
  /// run in parallel inside. `set.lights[i]` is element i of `arrays`, where the method may set the radii.
  /// With `split` the set ends with texels (VirtualLightSet::parts), which are gathered like any light.
  virtual void prepare(const Pass&, const VirtualLightSet& set, LightArrays& arrays, const Stop&,
                       PassStats&) {
    (void)set, (void)arrays;
  }
  /// What a method's options ask of the tracing beyond the shared parameters (texels kept, ...).
  virtual void adjust(VirtualLightOptions&) const {}

  /// What `gather` finds in points.state: anything it would otherwise compute again for each block. Called
  /// once a tile, from many threads.
  virtual std::unique_ptr<TileState> prepare_tile(const TilePoints&) const { return nullptr; }
  /// Contributions of lights [first, first + count) to all points, in the order of loops `out.order` says
  /// when it comes back; everything finite. Exact zeros save their shadow rays. Negative ones, which
  /// band-limited methods have, count against the positive ones: it is the sum over all lights that is cut
  /// off at 0. Called from many threads.
  virtual void gather(const TilePoints& points, int first, int count, Contributions& out) const = 0;
  /// The same, summed over the lights into `sums` (added to what is there), where nothing occludes. Override
  /// it where a method sums faster than by way of the block.
  virtual void gather_sums(const TilePoints& points, int first, int count, PointSums& sums) const;
  /// Whether `gather` leaves out what shadow rays find blocked, by asking `visible`: worth it where
  /// evaluating costs more than the rays.
  virtual bool gather_traces() const { return false; }
  /// Whether lights behind a tile's points, and points behind a light, bring exactly nothing: they are then
  /// left out before `gather`, with what their `radius` reaches around.
  virtual bool horizons_hide() const { return false; }
  /// At most the radiance (luminance, W m^-2 sr^-1) that the light brings by way of any of the tile's points,
  /// shadows left out.
  virtual float most(const TilePoints&, const TileBounds&, int light) const {
    (void)light;
    return kInfinity;
  }
  /// Sees the block once shadows have zeroed what they hide: for statistics.
  virtual void account(const TilePoints&, int first, int count, const Contributions& visible,
                       TileStats&) const {
    (void)first, (void)count, (void)visible;
  }
  /// Whether `account` wants to be called.
  virtual bool accounts() const { return false; }

  /// Of the points whose bits are set in `wanted` those that a shadow ray to the light finds unblocked; all
  /// of them where nothing occludes. Counts the rays in `rays`.
  uint64_t visible(const TilePoints&, int light, uint64_t wanted, int* rays) const;

  const Scene& scene() const { return *scene_; }

 private:
  void trace_lights(const Pass&, int count, const Stop&, PassStats*);
  void take_lights(const Pass&, const Stop&, PassStats*);
  int lights_that_fit(const Pass&, const Stop&);
  double seconds_a_pass(const Pass&, const Stop&) const;
  void shade_direct(const Tile&, vec3* radiance, Sampler*, TileStats&) const;
  bool is_near(const TilePoints&, const TileBounds&, int light) const;
  int choose_lights(const TilePoints&, const TileBounds&, int first, int count, const PointSums&,
                    double* lost, uint8_t* wanted) const;
  void gather_run(const TilePoints&, int first, int count, PointSums&, TileStats&) const;
  void gather_near(const TilePoints&, const TileBounds&, int first, int count, uint8_t* wanted, PointSums&,
                   TileStats&) const;
  void remove_shadowed(const TilePoints&, int first, int count, Contributions&) const;

  ManyLightsParams shared_;
  const Scene* scene_ = nullptr;
  int pass_lights_ = 0;
  uint32_t pass_key_ = 0;
  /// Texels of a light's block, as lights of their own in arrays_.
  struct Parts {
    float reach = 0;  ///< metres: nearer points gather them in the light's place
    int first = 0, count = 0;
  };
  VirtualLightSet set_;
  LightArrays arrays_;
  std::vector<Parts> parts_;  ///< of every light; empty: nothing is split
  std::shared_ptr<const VirtualLightSet> given_;
};

}  // namespace zonal
