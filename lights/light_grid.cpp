#include "lights/light_grid.h"

#include "core/sampling.h"

namespace zonal {

std::optional<VirtualLight> land(const Scene& scene, const EmissionSample& ray, uint64_t* rays) {
  ++*rays;
  const Hit hit = scene.intersect(ray.origin, ray.direction);
  if (!hit.found()) return {};
  const Surface s = scene.surface(hit, ray.direction);
  const Bsdf bsdf = scene.bsdf(s);
  const float cos_shading = glm::dot(s.shading.z, s.w_out), cos_geometric = glm::dot(s.normal, s.w_out);
  if (bsdf.kind == BsdfKind::black || !(cos_shading > 0) || !(cos_geometric > 0)) return {};

  VirtualLight v;
  v.position = s.position, v.normal = s.normal, v.frame = s.shading, v.w_in = s.w_out;
  v.power = ray.power * (cos_shading / cos_geometric);
  v.bsdf = bsdf;
  v.primary_distance = hit.t;
  v.material = s.material;
  v.shadow_point = offset_origin(s, s.normal);
  return v;
}

namespace {

/// The surface that the flux through `weight` (sr; directional: m^2) of the map falls on, m^2.
float footprint(const VirtualLight& v, float weight, bool directional) {
  const float area = directional ? weight : weight * sqr(v.primary_distance);
  return area / glm::dot(v.normal, v.w_in);
}

/// Squared distance of texel i from the middle of its block, in quarter texels.
int from_middle(int i, int block) {
  const int x = 2 * (i % block) - block + 1, y = 2 * (i / block) - block + 1;
  return x * x + y * y;
}

}  // namespace

std::optional<VirtualLight> light_of_cell(const Scene& scene, const EmissionGrid& grid, const CellJob& job,
                                          std::vector<VirtualLight>* texels, uint64_t* rays) {
  const int block = grid.block_texels();
  const bool directional = grid.fov() == 0;
  const bool centered = job.placement == VirtualLightOptions::center;
  std::optional<VirtualLight> chosen;
  vec3 power(0);
  float area = 0;
  double seen = 0;  // luminance of the flux of the texels so far
  int nearest = 0;

  for (int i = 0; i < block * block; ++i) {
    const int texel = grid.texel(job.cell, i);
    const auto key = hash32(job.seed, job.primary, static_cast<uint32_t>(texel));
    EmissionSample ray;
    if (centered) {
      ray = grid.center(texel);
    } else {
      Sampler jitter(job.seed, hash32(job.primary, 2, static_cast<uint32_t>(texel)), job.pass);
      ray = grid.sample(texel, jitter.next_2d());
    }
    if (is_black(ray.power)) continue;
    auto v = land(scene, ray, rays);
    if (!v) continue;
    v->footprint = footprint(*v, max_component(ray.power) / max_component(grid.flux(1)), directional);
    power += v->power, area += v->footprint;
    if (texels) texels->push_back(*v);

    // Keep one: each with the probability of its share of the flux so far; or the one nearest the middle.
    const double flux = luminance(v->power);
    seen += flux;
    const bool take = !chosen || (centered ? from_middle(i, block) < nearest
                                           : unit_float(hash32(key, job.pass, 0x74616b65u)) * seen < flux);
    if (take) chosen = v, nearest = from_middle(i, block);
  }
  if (chosen) chosen->power = power, chosen->footprint = area;
  return chosen;
}

}  // namespace zonal
