#pragma once
/// Where pictures are computed: the one list of backends that `zonal render --backend` and sweep files know.

#include <string>

namespace zonal {

/// Returns `name` where this build has that backend; else throws SceneError: `where`, found, expected.
const std::string& check_backend(const std::string& name, const std::string& where);

}  // namespace zonal
