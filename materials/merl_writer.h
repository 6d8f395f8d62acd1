#pragma once
/// Samples any BRDF into a full-size MERL file: analytic ones, to test readers with; published fits, to stand
/// in for measurements.
///
///     write_merl("gold.fit-sgd.binary", read_merl_fit("merl_sgd_params.csv", "gold-metallic-paint").brdf);
///
/// Each cell holds the BRDF at its centre, which is where `MerlBrdf` reads it. Cells wholly below the horizon
/// hold -1, as measurements do; those that the horizon crosses below their centre hold the BRDF just above
/// it, at the same half vector, so that a reader without interpolation finds something there.

#include <functional>
#include <string>
#include <vector>

#include "materials/bsdf.h"

namespace zonal {

/// BRDF in 1/sr of two unit directions above the horizon, w_out towards the viewer. Called from several
/// threads.
using MerlFunction = std::function<glm::dvec3(const glm::dvec3& w_out, const glm::dvec3& w_in)>;

/// `bsdf` as such a function. What it points to must live as long.
MerlFunction merl_function(const Bsdf& bsdf);

/// 3 kMerlCells numbers, colours interleaved, by merl_index: what MerlBrdf takes. Throws SceneError, prefixed
/// by `what`, when the BRDF is not finite or negative somewhere.
std::vector<float> tabulate_merl(const MerlFunction& brdf, const std::string& what);

/// Writes them, 35 MB, whole or not at all.
void write_merl(const std::string& file, const MerlFunction& brdf);

}  // namespace zonal
