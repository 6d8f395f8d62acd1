#include "materials/measured_brdf.h"

#include "core/error.h"

namespace zonal {

std::unique_ptr<MeasuredBrdf> load_measured(const std::string& file) { throw SceneError(file + ": not a MERL or RGL file"); }

}  // namespace zonal
