#pragma once
/// A picture as the report's page reads it: a script that hands over RGB9E5 pixels in base64
/// (sweep/report/images.js), since a page from the file system may not fetch.

#include <string>

#include "core/image.h"

namespace zonal {

std::string picture_script(const std::string& id, const Image& image, float exposure);

/// OpenGL's EXT_texture_shared_exponent: three 9-bit mantissas and a 5-bit exponent, bias 15. Negative and
/// not-finite values become 0, too bright ones the largest.
uint32_t pack_rgb9e5(vec3 color);

}  // namespace zonal
