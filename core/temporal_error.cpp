#include "core/temporal_error.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace zonal {

void TemporalError::add(const Image& picture, const Image& half_a, const Image& half_b) {
  const size_t count = picture.pixels.size();
  if (half_a.pixels.size() != count || half_b.pixels.size() != count ||
      (frames_ > 0 && off_a_.pixels.size() != count))
    throw SceneError("a sequence's pictures: found different sizes, expected one");
  Image off_a = picture, off_b = picture;
  double mean = 0, error = 0, change = 0;
  for (size_t i = 0; i < count; ++i) {
    const double x = picture.pixels[i], a = half_a.pixels[i], b = half_b.pixels[i];
    off_a.pixels[i] = float(x - a), off_b.pixels[i] = float(x - b);
    mean += 0.5 * (a + b), error += (x - a) * (x - b);
    if (frames_ > 0) change += (x - a - double(off_a_.pixels[i])) * (x - b - double(off_b_.pixels[i]));
  }
  mean_ += mean / double(count), error_ += error / double(count), change_ += change / double(count);
  off_a_ = std::move(off_a), off_b_ = std::move(off_b);
  ++frames_;
}

double TemporalError::error() const {
  return mean_ > 0 ? std::sqrt(std::max(error_, 0.0) * frames_) / mean_ : 0;
}

double TemporalError::flicker() const {
  if (frames_ < 2 || !(mean_ > 0)) return 0;
  return std::sqrt(std::max(change_, 0.0) / (frames_ - 1)) * frames_ / mean_;
}

}  // namespace zonal
