#pragma once
/// A picture of where the error is: dark is right, bright is wrong, with a scale bar on the right edge.
///
///     write_image("error.png", error_map(relative_error(image, reference)), 1);

#include "core/image.h"

namespace zonal {

/// `error` has one channel. The scale runs from 0 to the first of 1, 2, 5 x 10^n that 99 % of the pixels stay
/// below; metadata "error_map_low" and "error_map_high" name its ends (bottom and top of the bar). NaN pixels
/// are green, a colour the scale does not have. Display-referred, for a PNG.
ImageFile error_map(const Image& error);

}  // namespace zonal
