#pragma once
/// Finds out that a PNG file ends early before libpng does, which would print to stderr of its own accord.

#include <istream>
#include <string>

namespace zonal {

/// Throws SceneError starting with `name` when `in` is a PNG whose chunks do not lead to IEND. Other formats
/// pass.
void refuse_cut_png(std::istream& in, const std::string& name);

}  // namespace zonal
