#pragma once
/// Published fits to the hundred MERL materials: parameters of two analytic models, and small networks.
///
///     MerlFit fit = read_merl_fit("merl_sgd_params.csv", "alum-bronze");
///     glm::dvec3 f = fit.brdf(w_out, w_in);   // 1/sr
///
/// - `abc`: Low, Kronander, Ynnerman, Unger 2012, "BRDF Models for Accurate and Efficient Rendering of Glossy
/// Surfaces".
/// - `sgd`: Bagher, Soler, Holzschuch 2012, "Accurate Fitting of Measured Reflectances Using a Shifted Gamma
///   Micro-facet Distribution".
/// - `network`: Sztrajman, Rainer, Ritschel, Weyrich 2021, "Neural BRDF Representation and Importance
/// Sampling". A fit is not the measurement: docs/materials.md says how far three fits of one material lie
/// apart.

#include <string>
#include <vector>

#include "materials/merl_writer.h"

namespace zonal {

struct MerlFit {
  std::string name;   ///< of the material
  std::string model;  ///< "abc", "sgd" or "network"
  MerlFunction brdf;  ///< finite and >= 0
};

/// Reads a parameter table (CSV with a header, a material a row) or a network (text), told apart by their
/// first line. `material` picks the table's row and must be empty for a network. Throws SceneError naming
/// file, line, what was found, what was expected, and the nearest material.
MerlFit read_merl_fit(const std::string& file, const std::string& material);

/// Materials of a table, in its order; of a network, its own name.
std::vector<std::string> merl_fit_names(const std::string& file);

/// (FIT-1) and (FIT-2) of docs/materials.md.
struct AbcParameters {
  glm::dvec3 diffuse{0}, A{0};
  double B = 0, C = 0, ior = 1.5;
};
glm::dvec3 evaluate_abc(const AbcParameters& p, const glm::dvec3& w_out, const glm::dvec3& w_in);

/// One number per colour each; names are the paper's, f1 included.
struct SgdParameters {
  glm::dvec3 diffuse{0}, specular{0}, alpha{1}, p{1}, f0{0}, f1{0}, kap{0}, lambda{0}, c{0}, k{1}, theta0{0};
};
glm::dvec3 evaluate_sgd(const SgdParameters& p, const glm::dvec3& w_out, const glm::dvec3& w_in);

/// Layers of a network file: rows x columns weights, row-major by input, then the columns' biases. Throws
/// SceneError.
MerlFunction read_merl_network(const std::string& file, const std::string& text);

}  // namespace zonal
