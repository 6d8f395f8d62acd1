#pragma once
/// A small picture to draw curves and captions on, for the PNGs that commands write.
///
///     Canvas canvas(640, 480);
///     canvas.line({10, 10}, {200, 100}, kBlue);
///     canvas.text({10, 460}, "elevation 40 deg", kBlack);
///     canvas.write("lobes.png");

#include <string>

#include "core/image.h"

namespace zonal {

/// Display values (sRGB-encoded), [0, 1].
inline constexpr vec3 kBlack{0.1f, 0.1f, 0.12f}, kGrey{0.62f, 0.62f, 0.64f}, kBlue{0.0f, 0.447f, 0.698f},
    kOrange{0.835f, 0.369f, 0.0f};

class Canvas {
 public:
  Canvas(int width, int height, vec3 paper = vec3(1));
  /// Blends `color` over the pixel; outside nothing happens.
  void dot(int x, int y, vec3 color, float cover = 1);
  /// About two pixels wide, smooth.
  void line(vec2 from, vec2 to, vec3 color);
  /// Capitals and digits, 10 x 14 pixels a letter; the corner is the top left.
  void text(vec2 corner, const std::string& what, vec3 color);
  void write(const std::string& file) const;

 private:
  Image image_;  ///< display values
};

}  // namespace zonal
