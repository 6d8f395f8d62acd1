#pragma once
/// HDR-FLIP: the worst that FLIP says of two radiance pictures over all exposures they may be shown at
/// (Andersson, Nilsson, Shirley and Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range
/// Images", Eurographics Short Papers, 2021).
///
///     const FlipHdr flip(reference);             // prepares the reference once
///     const double a = mean_of_map(flip.map(first)), b = mean_of_map(flip.map(second));

#include <optional>
#include <vector>

#include "core/flip.h"

namespace zonal {

/// Exposures in stops (a factor of 2^stop) that show all of a picture, from its brightest pixel to its
/// median.
struct FlipExposures {
  float start = 0, stop = 0;
  int count = 2;
  float factor(int i) const;  ///< of the i-th, 2^stop
};
FlipExposures flip_exposures(const Image& reference);

class FlipHdr {
 public:
  /// Linear radiance. Keeps its views of the reference where they take less than 256 MB, else makes them anew
  /// for each picture.
  explicit FlipHdr(const Image& reference);
  const FlipExposures& exposures() const { return exposures_; }
  /// One channel, 0 to 1; NaN where either picture has a NaN. `image` has the reference's size. In parallel.
  Image map(const Image& image) const;

 private:
  Image reference_;  ///< not-finite pixels black
  std::vector<bool> usable_;
  FlipExposures exposures_;
  std::vector<FlipView> views_;  ///< one an exposure, or none
};

}  // namespace zonal
