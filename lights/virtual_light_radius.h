#pragma once
/// How large the sphere of a virtual light is, in vsl and hvl: about as far as its next light diagonally, so
/// that together the spheres cover the surfaces that are lit.
///
///     RadiusParams params{.rule = RadiusRule::density, .factor = 1.5f};
///     std::vector<float> r = virtual_light_radii(set, params, scene.bounds().radius);
///
/// All lengths come from distances between lights and from the scene's bounding sphere: turning or scaling
/// the scene turns and scales the spheres with it.

#include <vector>

#include "core/params.h"
#include "lights/virtual_lights.h"

namespace zonal {

enum class RadiusRule {
  automatic,      ///< field_of_view for the lights of a spot's grid, density for all others
  field_of_view,  ///< (RADIUS-1), grids of spot and point lights; others as density
  density,        ///< (RADIUS-2)
  neighbours,     ///< (RADIUS-3), grids; others as density
  metres,         ///< as given
};

struct RadiusParams {
  RadiusRule rule = RadiusRule::automatic;
  float metres = 0.1f;  ///< > 0, with RadiusRule::metres
  float factor = 1;     ///< > 0; multiplies what a rule finds, not metres

  void visit(ParamVisitor& v);
};

/// Radius of every light, metres, > 0 and finite. `scene_radius`: of the scene's bounding sphere; no rule
/// gives more than it, or less than its millionth part (lights in one place).
///
/// (RADIUS-1) r = d (g + g^3/3), g = sqrt(2) fov / sqrt(cells)    Mézières 2022, Eq. 5.10-5.12 as printed: d
/// the distance
///            to the primary, fov the map's full width. On a flat map the lights near the axis are up to 1.3
///            times farther apart, those at the corners of 90 degrees half as far.
/// (RADIUS-2) r = d_k sqrt(2 pi / k), d_k the distance to the k-th nearest light, k = 10, or all there are: k
/// lights on
///            the area pi d_k^2 lie sqrt(pi/k) d_k apart, and the diagonal is sqrt(2) times that. After
///            Hasan, Krivanek, Walter and Bala 2009, who size VSLs by the same distance.
/// (RADIUS-3) r = sum w_n |p - p_n| / sum w_n over the 8 neighbours in the grid, w_n = 1/(|d - d_n| + e), e
/// half the
///            distance to the nearest of them. Mézières 2022, Eq. 5.9, where e is a length without a scale: a
///            single neighbour at equal depth would take all the weight.
/// A light without any other takes half its distance to the primary. Texels (VirtualLightSet::parts) have
/// their block's radius in the proportion of the roots of their footprints.
std::vector<float> virtual_light_radii(const VirtualLightSet& set, const RadiusParams& params,
                                       float scene_radius);

/// Distance of every point to its k-th nearest other one; the farthest one where there are fewer, 0 for a
/// lone one. O(n log n).
std::vector<float> nearest_distances(const std::vector<vec3>& points, int k);

}  // namespace zonal
