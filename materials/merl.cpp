#include "materials/merl.h"

#include "core/error.h"

namespace zonal {

std::unique_ptr<MeasuredBrdf> load_merl(const std::string& file) {
  throw SceneError(file + ": MERL files cannot be read yet");
}

}  // namespace zonal
