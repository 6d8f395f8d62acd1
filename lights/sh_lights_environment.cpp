/// The environment on spherical harmonics, projected once (Ramamoorthi and Hanrahan 2001).

#include <algorithm>
#include <cmath>

#include "lights/sh_lights.h"
#include "sh/batch.h"

namespace zonal {

/// Sum over texels of radiance times the integral of each harmonic over the texel: by its middle, cut in
/// parts where the picture is coarse against the harmonics. A part of size h is off by at most (l h)^2/24.
void ShLights::add_environment(const PictureLight& sky) {
  const int bands = options_.bands, n = sh::count(bands);
  const int width = sky.width, height = sky.height;
  if (width == 1 && height == 1) {
    const vec3 radiance = sky.texel(0, 0);
    for (int c = 0; c < 3; ++c) fixed_[size_t(c) * n] += radiance[c] * 3.5449077018110318f;  // 2 sqrt(pi)
    return;
  }
  const int rows = std::max(1, 32 * bands / height), columns = std::max(1, 64 * bands / width);
  const size_t row_size = size_t(width) * columns;
  std::vector<double> x(row_size), y(row_size), z(row_size), weight[3], sum(3 * size_t(n));
  for (auto& w : weight) w.resize(row_size);
  for (int row = 0; row < height * rows; ++row) {
    const double top = std::cos(M_PI * row / (height * rows)),
                 bottom = std::cos(M_PI * (row + 1) / (height * rows));
    const double solid_angle = 2 * M_PI / double(row_size) * (top - bottom);
    for (size_t k = 0; k < row_size; ++k) {
      const vec3 w = sky.direction((k + 0.5) / double(row_size), (row + 0.5) / (height * rows));
      x[k] = w.x, y[k] = w.y, z[k] = w.z;
      const vec3 radiance = sky.texel(row / rows, int(k) / columns);
      for (int c = 0; c < 3; ++c) weight[c][k] = radiance[c] * solid_angle;
    }
    for (int c = 0; c < 3; ++c)
      sh::project(bands, x.data(), y.data(), z.data(), weight[c].data(), int(row_size),
                  sum.data() + size_t(c) * n);
  }
  for (size_t i = 0; i < sum.size(); ++i) fixed_[i] += float(sum[i]);
}

}  // namespace zonal
