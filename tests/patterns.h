#pragma once
/// The pictures of tests/golden/patterns.py: whole numbers over 256, the same floats there and here.

#include <algorithm>

#include "core/image.h"
#include "core/sampling.h"

namespace zonal {

inline int pattern(int x, int y, int c) {
  const int wave = (x * x * (c + 1) / 16 + 3 * y * (c + 2)) % 128;
  const int edge = (x + 2 * y) % 50 < 25 ? 96 : 0;
  return wave + edge + int(hash32(uint32_t(x + 1000 * y)) & 31);
}
inline int noisy(int x, int y, int c) {
  const int noise = int(hash32(uint32_t(7777 + x + 1000 * y + 1000000 * c)) & 63) - 32;
  return std::clamp(pattern(x, y, c) + noise, 0, 255);
}
inline int blurred(int x, int y, int c) {
  int sum = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) sum += pattern(std::max(0, x + i), std::max(0, y + j), c);
  }
  return sum / 9;
}
inline int shifted(int x, int y, int c) {
  return pattern(x + 1, y + 2, c);
}

template <class Formula>
Image picture(int width, int height, Formula formula) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = formula(x, y, c) / 256.0f;
    }
  }
  return image;
}

}  // namespace zonal
