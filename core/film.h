#pragma once
/// Accumulates radiance estimates per pixel and divides by their number when resolved.
/// Passes add whole images; each pixel belongs to one tile, so threads never share one.

#include "core/image.h"

namespace zonal {

class Film {
 public:
  Film(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }

  /// Estimates added from now on are kept apart until `commit_pass`.
  void begin_pass();
  /// One estimate of a pixel and, for the layers, what its primary ray met. Threads may add distinct pixels
  /// at once. A second estimate of the same pixel in the same pass replaces the first.
  void add(int x, int y, vec3 radiance, vec3 albedo, vec3 normal, float depth);
  /// Takes the pass into the means. Not-finite or negative radiance is counted and replaced by 0 (so is a
  /// not-finite layer), so that one bad number cannot spoil a picture; `bad_samples` makes it visible.
  void commit_pass();
  /// Forgets what the uncommitted pass added.
  void discard_pass();

  int passes() const { return passes_; }
  size_t bad_samples() const { return bad_samples_; }  ///< pixels, summed over the committed passes
  /// Mean radiance of the committed passes (W m^-2 sr^-1).
  Image radiance() const;
  /// Variance of that mean, per channel, from the scatter of the passes; 0 with fewer than two.
  Image variance_of_mean() const;
  /// radiance, albedo, normal, depth (metres; 0 where nothing was met).
  ImageFile resolve() const;

 private:
  int width_, height_, passes_ = 0;
  size_t bad_samples_ = 0;
  std::vector<double> sum_, sum_squares_;  ///< 3 a pixel
  std::vector<double> layers_;             ///< albedo 3, normal 3, depth 1
  std::vector<float> pending_;             ///< the current pass: 3 + 7 a pixel
};

}  // namespace zonal
