#include "core/backend.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/json_fields.h"

namespace zonal {

const std::string& check_backend(const std::string& name, const std::string& where) {
  if (name == "cpu") return name;
#ifdef ZONAL_HAS_GL
  if (name == "gl") return name;
#else
  if (name == "gl")
    throw SceneError(where + ": found \"gl\", expected \"cpu\": this build has no GPU backend (it needs libepoxy and EGL)");
#endif
  throw SceneError(fmt::format("{}: found {}, expected \"cpu\" or \"gl\"", where, in_quotes(name)));
}

}  // namespace zonal
