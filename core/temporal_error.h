#pragma once
/// How far a sequence of pictures is from a reference sequence, and how much that error flickers: an error
/// that stands still is a look, one that changes from frame to frame is seen.
///
///     TemporalError temporal;
///     for (...) temporal.add(picture, half_a, half_b);      // in the sequence's order, all of one size
///     temporal.flicker();
///
/// The reference comes as two independent halves A and B, so that its own noise does not count: with
/// e = x - r, frame by frame, error^2 is the mean of (x-A)(x-B) and flicker^2 that of
/// (dx-dA)(dx-dB), d the difference to the frame before; both over pixels, channels and frames, and over the
/// reference's mean.

#include "core/image.h"

namespace zonal {

class TemporalError {
 public:
  /// Throws SceneError where sizes differ.
  void add(const Image& picture, const Image& half_a, const Image& half_b);
  double error() const;    ///< RMS of the error over the mean; 0 where noise leaves no positive square
  double flicker() const;  ///< RMS of its change from frame to frame over the mean
  int frames() const { return frames_; }

 private:
  int frames_ = 0;
  double mean_ = 0, error_ = 0, change_ = 0;  ///< sums over frames of means over pixels
  Image off_a_, off_b_;                       ///< x - A and x - B of the frame before
};

}  // namespace zonal
