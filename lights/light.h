#pragma once
/// What every light can do: light a point, be hit by a ray, and send out flux for virtual lights.
///
///     LightSample s = light.sample(x, u);     // direction and incident radiance for next-event estimation
///     radiance_out += f * cos * s.radiance / s.pdf;

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace zonal {

struct LightSample {
  vec3 w_in{0};            ///< unit, from the point towards the light, world
  float distance = 0;      ///< metres to the sampled point; infinity for directional and environment
  vec3 radiance{0};        ///< W m^-2 sr^-1 arriving along w_in; for delta lights irradiance (W m^-2) facing w_in
  float pdf = 0;           ///< 1/sr; 1 for delta lights; 0: nothing arrives here
  bool delta = false;      ///< cannot be hit by a ray
};

/// A point of a light that a ray has hit.
struct LightHit {
  vec3 position{0};
  vec3 normal{0, 0, 1};  ///< geometric, unit, as the light's winding or centre gives it (not flipped to the ray)
  vec2 uv{0};
  uint32_t primitive = 0;  ///< triangle of a mesh light
};

/// A ray of flux leaving a light.
struct EmissionSample {
  vec3 origin{0}, direction{0, 0, 1};
  vec3 power{0};  ///< W: the flux one such ray carries when it stands for the whole light (emitted / density)
};

class Light {
 public:
  virtual ~Light() = default;
  virtual const char* type() const = 0;
  /// Total emitted flux, W per channel. For directional and environment lights: what crosses the scene's bounding
  /// sphere. Used to share samples among lights.
  virtual vec3 power() const = 0;
  /// Chooses a direction from x towards the light.
  virtual LightSample sample(vec3 x, vec2 u) const = 0;
  /// Emission of the point `hit` towards `w` (unit, away from the light).
  virtual vec3 radiance(const LightHit& hit, vec3 w) const = 0;
  /// Density with which `sample(x)` would have found `hit` (1/sr). 0 for delta lights.
  virtual float pdf(vec3 x, const LightHit& hit) const = 0;
  virtual bool is_delta() const { return false; }
  /// A ray of flux; u_position picks where, u_direction which way.
  virtual EmissionSample sample_emission(vec2 u_position, vec2 u_direction) const = 0;
  /// An upper bound, up to a constant factor, of the irradiance the light can bring to x (W m^-2), visibility and the
  /// receiver's cosine ignored: how lights are chosen. 0 only where the light is certainly dark.
  virtual float importance(vec3 x) const = 0;
  /// Called once when the scene is complete: for lights without a place, whose flux depends on the scene's size.
  virtual void set_scene_bounds(const BoundingSphere&) {}

  std::string name;
};

struct PointLight : Light {
  vec3 position{0};
  vec3 intensity{1};  ///< W sr^-1
  const char* type() const override { return "point"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override { return vec3(0); }
  float pdf(vec3, const LightHit&) const override { return 0; }
  bool is_delta() const override { return true; }
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
};

/// A spot's cone: full inside `inner`, nothing outside `outer`, smoothstep of the cosine between. Angles become
/// v = 1 - cos once, here: lights are asked at every bounce.
struct SpotCone {
  float inner, outer;              ///< half angles, radians, 0 <= inner <= outer < pi/2
  float v_inner, v_outer, v_edge;  ///< 1 - cos of them; v_edge = v_outer - v_inner
  SpotCone(float inner, float outer);
  float falloff(float v) const;  ///< [0,1]
  float solid_angle() const;     ///< integral of the falloff, sr
};

/// Cone of light with a smooth edge.
struct SpotLight : Light {
  vec3 position{0};
  vec3 direction{0, -1, 0};  ///< unit
  vec3 intensity{1};         ///< W sr^-1 on the axis
  SpotCone cone{0.3f, 0.5f};
  /// Share of the axis intensity that leaves at the angle whose cosine is given, [0,1].
  float falloff(float cos_angle) const;
  /// The same from 1 - cos, for cones so narrow that their cosine is 1 in float.
  float falloff_versine(float one_minus_cos) const;
  const char* type() const override { return "spot"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override { return vec3(0); }
  float pdf(vec3, const LightHit&) const override { return 0; }
  bool is_delta() const override { return true; }
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
};

/// The sun: parallel light from far away.
struct DirectionalLight : Light {
  vec3 direction{0, -1, 0};  ///< unit, the way the light travels
  vec3 irradiance{1};        ///< W m^-2 on a surface facing the light
  const char* type() const override { return "directional"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override { return vec3(0); }
  float pdf(vec3, const LightHit&) const override { return 0; }
  bool is_delta() const override { return true; }
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
  void set_scene_bounds(const BoundingSphere& b) override { bounds = b; }
  BoundingSphere bounds;
};

/// A glowing ball; sampled by the cone it subtends. From inside (d <= r) every direction meets it: sampled uniformly.
struct SphereLight : Light {
  vec3 center{0};
  float radius = 1;    ///< metres, > 0
  vec3 emission{1};    ///< radiance, W m^-2 sr^-1
  bool two_sided = false;  ///< also emits inwards
  const char* type() const override { return "sphere"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override;
  float pdf(vec3, const LightHit&) const override;
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
};

/// Any number of glowing triangles: quads, single triangles and mesh emitters. Sampled uniformly by area.
class MeshLight : public Light {
 public:
  struct Triangle {
    vec3 a, b, c;
  };
  /// Zero-area triangles may be present: they are never sampled.
  MeshLight(std::vector<Triangle> triangles, vec3 emission, bool two_sided);
  const char* type() const override { return "mesh"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3) const override;
  float pdf(vec3, const LightHit&) const override;
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
  float area() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Light from everywhere: a constant, or a latitude-longitude picture (row 0 is straight up; u = 0.5 looks along -z).
/// Sampled by the picture's luminance.
class EnvironmentLight : public Light {
 public:
  /// `texels` row-major from the top, radiance. 1x1 is the constant environment. `rotation` (radians) turns the picture
  /// about +y.
  EnvironmentLight(int width, int height, std::vector<vec3> texels, float rotation);
  const char* type() const override { return "environment"; }
  vec3 power() const override;
  LightSample sample(vec3 x, vec2 u) const override;
  vec3 radiance(const LightHit&, vec3 w) const override;  ///< w: towards the viewer, so the sky's point lies at -w
  float pdf(vec3 x, const LightHit& hit) const override;  ///< hit.normal = direction towards the sky
  EmissionSample sample_emission(vec2, vec2) const override;
  float importance(vec3 x) const override;
  void set_scene_bounds(const BoundingSphere& b) override;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

/// Chooses one of many lights for a shading point.
class LightSelector {
 public:
  LightSelector() = default;
  explicit LightSelector(std::vector<const Light*> lights);
  struct Choice {
    const Light* light = nullptr;  ///< null: no light can reach x
    uint32_t index = 0;
    float probability = 0;
  };
  /// u is consumed; `u_left` is a fresh uniform number made of what is left of it.
  Choice choose(vec3 x, float u, float* u_left) const;
  float probability(vec3 x, uint32_t index) const;
  /// Sharing by emitted power, whatever the point: how virtual lights are shared among primaries.
  const class Discrete& by_power() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Name and one-line meaning of each kind, for `zonal list lights` and error messages.
struct LightKind {
  std::string name, summary;
};
const std::vector<LightKind>& light_kinds();

}  // namespace zonal
