#pragma once
/// `sh_direct`: direct light from many area lights on spherical harmonics, without noise (Mézières 2022,
/// chapters 3 and 4). The lights' coefficients at a point are a sum over them, which costs the same whatever
/// the material. Equations, parameters and failures: README.md beside this file.

#include "core/integrator.h"
#include "integrators/sh_direct/sh_grid.h"
#include "integrators/sh_direct/sh_octree.h"
#include "integrators/sh_direct/sh_receiver.h"
#include "integrators/sh_direct/sh_seen.h"
#include "lights/sh_lights.h"

namespace zonal {

struct ShDirectParams : ShReceiverParams {
  enum class At { pixel, grid, octree };
  enum class Occlusion { none, ambient, ratio };
  enum class Spheres { sphere, disk };
  enum class Loops { reverse, forward };

  At at = At::pixel;
  Occlusion occlusion = Occlusion::none;
  int rays = 4, groups = 1;
  float reach = 0;  ///< metres; 0: a tenth of the scene's radius
  ShLightOptions::Polygons polygons = ShLightOptions::Polygons::exact;
  float split_error = 0, split_distance = 1, tolerance = 1e-3f, texture_error = 0.05f;
  Spheres spheres = Spheres::sphere;
  int grid = 8;  ///< points along the longest side, or kAuto
  float grid_error = 0.01f;
  int octree_points = 0;  ///< 0: by grid_error
  Loops loops = Loops::reverse;
  ShScheme scheme;

  void visit(ParamVisitor& v);
};

class ShDirectIntegrator : public Integrator {
 public:
  /// `where` names the settings in errors.
  explicit ShDirectIntegrator(const ShDirectParams& params,
                              const std::string& where = "integrator \"sh_direct\"")
      : params_(params), where_(where) {}

  /// Projects materials and environment. Throws SceneError where there is no light, or no memory for the
  /// grid.
  void load(const Scene&, const Stop&, PassStats&) override;
  void begin_pass(const Pass&, const Stop&, PassStats&) override;
  void shade(const Tile&, vec3* radiance, Sampler*, const Stop&, TileStats&) const override;

  /// For a twin on a GPU, after `begin_pass`; without occlusion there is one group of lights.
  const ShDirectParams& params() const { return params_; }
  const ShReceiver& receiver() const { return receiver_; }
  const ShLights& lights() const { return groups_[0].lights; }
  const ShGrid& grid() const { return groups_[0].grid; }
  /// From now on begin_pass lays a grid out and leaves its points to the twin; `shade` is not to be called.
  void leave_grids_empty() { grids_left_empty_ = true; }

 private:
  /// Lights that share rays, and what they light.
  struct Group {
    ShLights lights;
    ShGrid grid;
    ShOctree octree;
    int octree_points = 0;   ///< once they have been found
    LightSelector selector;  ///< occlusion ratio
  };
  vec3 reflected(const Group&, const Surface&, const Bsdf&, bool exactly) const;
  vec3 reflected(const Surface&, const Bsdf&, Sampler&, TileStats&) const;
  void refuse_too_large_a_grid() const;
  void refuse_lobeless(const Scene&) const;
  void refuse_deringing() const;
  bool searches() const;
  void thin_probes(ShSeen&) const;
  void build_grids(const ShSeen&, std::span<const vec3> wanted, int points_a_side, bool compute,
                   const Stop&);
  void choose_grid(const ShSeen&, const Stop&, PassStats&);
  void build_octree(Group&, const ShSeen&, const Stop&, PassStats&);
  double probed_error(const ShSeen&, std::span<const vec3> exact, std::span<const Group> groups) const;

  ShDirectParams params_;
  std::string where_;
  const Scene* scene_ = nullptr;
  ShReceiver receiver_;
  std::vector<Group> groups_;
  int lights_ = 0;  ///< in all groups
  bool grids_left_empty_ = false;
  int chosen_ = 0;  ///< points along the grid's longest side, once `auto` has found them
};

}  // namespace zonal
