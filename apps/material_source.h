#pragma once
/// What the commands on materials take: a measured file, or a projection of one.

#include <memory>
#include <string>

#include "materials/measured_brdf.h"
#include "materials/sh_material.h"

namespace zonal {

struct MaterialSource {
  std::string name;
  std::unique_ptr<MeasuredBrdf> brdf;
  Bsdf bsdf;  ///< of kind measured, on top of `brdf`
};

/// Throws SceneError for what is no measured material.
MaterialSource read_material_source(const std::string& file);

}  // namespace zonal
