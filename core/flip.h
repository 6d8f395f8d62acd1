#pragma once
/// FLIP: how different two pictures look when one flips between them (Andersson, Nilsson, Akenine-Möller,
/// Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM Comput.
/// Graph. Interact. Tech. 3(2), 2020). Constants in flip.cpp go by that paper's names.
///
///     const Image map = flip_map(to_display(image, exposure), to_display(reference, exposure));
///     const double flip = mean_of_map(map);

#include <vector>

#include "core/image.h"

namespace zonal {

/// Pixels in one degree of the viewer's eye: 0.7 m before a screen 0.7 m and 3840 pixels wide.
inline constexpr float kFlipPixelsPerDegree = 67.0206433f;  // 0.7 (3840 / 0.7) pi / 180

/// What the eye makes of one picture, row-major, a float a pixel each.
struct FlipView {
  int width = 0, height = 0;
  std::vector<float> lightness, a, b;  ///< L*a*b* of the blurred picture, a and b by Hunt's effect
  std::vector<float> edges, points;    ///< strength of first and second derivatives of its luminance
};

/// Linear RGB in [0,1], three finite channels.
FlipView flip_view(const Image& linear_rgb, float pixels_per_degree = kFlipPixelsPerDegree);

/// Difference of two views of equal size: one channel, 0 (none seen) to 1.
Image flip_difference(const FlipView& x, const FlipView& r);

/// A display-encoded reference, looked at once for many pictures.
class FlipReference {
 public:
  explicit FlipReference(const Image& reference, float pixels_per_degree = kFlipPixelsPerDegree);
  /// FLIP of a display-encoded picture of the same size. NaN where either has a NaN; its neighbours see no
  /// difference there.
  Image map(const Image& image) const;

 private:
  float pixels_per_degree_;
  Image linear_;  ///< black where the reference is no number
  std::vector<bool> usable_;
  FlipView view_;
};

/// FLIP of one pair.
Image flip_map(const Image& image, const Image& reference, float pixels_per_degree = kFlipPixelsPerDegree);

/// Mean of the pixels that are numbers; NaN when none is.
double mean_of_map(const Image& map);

}  // namespace zonal
