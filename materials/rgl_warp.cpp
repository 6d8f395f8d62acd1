#include "materials/rgl_warp.h"

#include <algorithm>
#include <cassert>

namespace zonal {
namespace {

float lerp(float a, float b, float t) {
  return a + t * (b - a);
}

/// Where the integral of the line from a (at 0) to b (at 1) reaches `mass`: a t + (b - a) t^2 / 2 = mass,
/// solved in the form that divides by a sum and so loses no digits where a and b are alike.
float solve_line(float mass, float a, float b) {
  const float root = a + std::sqrt(std::max(0.0f, a * a + 2.0f * mass * (b - a)));
  return root > 0.0f ? std::min(std::max(2.0f * mass / root, 0.0f), 1.0f) : 0.0f;
}

/// Last i in [0, size - 2] with sum(i) < mass; sums grow.
template <class Sum>
int last_below(int size, float mass, Sum&& sum) {
  int low = 0, high = size - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (sum(middle) < mass ? low : high) = middle;
  }
  return low;
}

}  // namespace

struct WarpGrid::Corners {
  float d00 = 0, d10 = 0, d01 = 0, d11 = 0;  ///< densities; first digit along x
  float before0 = 0, before1 = 0;            ///< integrals of the two rows up to the cell
  float total0 = 0, total1 = 0;              ///< integrals of the two rows
  float above = 0;                           ///< integral of all rows before
};

WarpGrid::WarpGrid(int width, int height, const std::vector<float>& samples)
    : width_(width), height_(height), scale_(static_cast<float>(width - 1) * static_cast<float>(height - 1)) {
  assert(width >= 2 && height >= 2);
  const size_t cells = static_cast<size_t>(width) * static_cast<size_t>(height);
  const size_t columns = static_cast<size_t>(width), lines = static_cast<size_t>(height);
  slices_ = samples.size() / cells;
  assert(slices_ >= 1 && samples.size() == slices_ * cells);
  vertices_.resize(samples.size());
  rows_.resize(slices_ * lines);
  empty_.resize(slices_);

  std::vector<double> before(cells), above(lines);
  for (size_t slice = 0; slice < slices_; ++slice) {
    const float* d = &samples[slice * cells];
    empty_[slice] = std::all_of(d, d + cells, [](float x) { return x <= 0.0f; });
    const auto at = [&](size_t i) { return empty_[slice] ? 1.0 : std::max(0.0, double(d[i])); };

    for (size_t y = 0; y < lines; ++y) {
      before[y * columns] = 0;
      for (size_t x = 1; x < columns; ++x) {
        const size_t i = y * columns + x;
        before[i] = before[i - 1] + 0.5 * (at(i - 1) + at(i));
      }
      const double total = before[y * columns + columns - 1];
      above[y] = y == 0 ? 0.0 : above[y - 1] + 0.5 * (before[y * columns - 1] + total);
    }
    const double norm = 1.0 / above[lines - 1];
    for (size_t i = 0; i < cells; ++i)
      vertices_[slice * cells + i] = {static_cast<float>(at(i) * norm), static_cast<float>(before[i] * norm)};
    for (size_t y = 0; y < lines; ++y)
      rows_[slice * lines + y] = {static_cast<float>(before[(y + 1) * columns - 1] * norm),
                                  static_cast<float>(above[y] * norm)};
  }
}

inline WarpGrid::Corners WarpGrid::corners(const SliceMix& mix, int x, int y) const {
  Corners c;
  for (int i = 0; i < mix.count; ++i) {
    const size_t slice = mix.index[static_cast<size_t>(i)];
    const float w = mix.weight[static_cast<size_t>(i)];
    const size_t line = slice * static_cast<size_t>(height_) + static_cast<size_t>(y);
    const Vertex* v0 = &vertices_[line * static_cast<size_t>(width_) + static_cast<size_t>(x)];
    const Vertex* v1 = v0 + width_;
    const Row *r0 = &rows_[line], *r1 = r0 + 1;
    c.d00 += w * v0[0].density, c.d10 += w * v0[1].density;
    c.d01 += w * v1[0].density, c.d11 += w * v1[1].density;
    c.before0 += w * v0[0].before, c.before1 += w * v1[0].before;
    c.total0 += w * r0->total, c.total1 += w * r1->total;
    c.above += w * r0->before;
  }
  return c;
}

float WarpGrid::density(const SliceMix& mix, vec2 p) const {
  const GridCell cell(p, width_, height_);
  const Corners c = corners(mix, cell.x, cell.y);
  const float left = lerp(c.d00, c.d01, cell.down), right = lerp(c.d10, c.d11, cell.down);
  return std::max(lerp(left, right, cell.along) * scale_, 0.0f);
}

vec2 WarpGrid::invert(const SliceMix& mix, vec2 p, float* density) const {
  const GridCell cell(p, width_, height_);
  const Corners c = corners(mix, cell.x, cell.y);
  const float t = cell.down, x = cell.along;
  const float left = lerp(c.d00, c.d01, t), right = lerp(c.d10, c.d11, t);
  if (density) *density = std::max(lerp(left, right, x) * scale_, 0.0f);

  // Share of the line at p that lies before p, and share of the square above it.
  const float total = lerp(c.total0, c.total1, t);
  const float before = lerp(c.before0, c.before1, t) + x * (left + 0.5f * x * (right - left));
  const float across = total > 0.0f ? before / total : p.x;
  const float above = c.above + t * (c.total0 + 0.5f * t * (c.total1 - c.total0));
  return {std::min(std::max(across, 0.0f), 1.0f), std::min(std::max(above, 0.0f), 1.0f)};
}

vec2 WarpGrid::sample(const SliceMix& mix, vec2 u) const {
  constexpr float kMargin = 0x1p-24f;
  const auto count = static_cast<size_t>(mix.count);
  const size_t lines = static_cast<size_t>(height_), columns = static_cast<size_t>(width_);

  const float mass = std::min(std::max(u.y, kMargin), 1.0f - kMargin);
  const auto above = [&](int y) {
    float sum = 0;
    for (size_t i = 0; i < count; ++i)
      sum += mix.weight[i] * rows_[mix.index[i] * lines + static_cast<size_t>(y)].before;
    return sum;
  };
  const int y = last_below(height_, mass, above);
  Corners c = corners(mix, 0, y);
  const float t = solve_line(mass - c.above, c.total0, c.total1);

  const float part = std::min(std::max(u.x, kMargin), 1.0f - kMargin) * lerp(c.total0, c.total1, t);
  const auto before = [&](int x) {
    float sum = 0;
    for (size_t i = 0; i < count; ++i) {
      const Vertex* v =
          &vertices_[(mix.index[i] * lines + static_cast<size_t>(y)) * columns + static_cast<size_t>(x)];
      sum += mix.weight[i] * lerp(v[0].before, v[columns].before, t);
    }
    return sum;
  };
  const int x = last_below(width_, part, before);
  c = corners(mix, x, y);
  const float s =
      solve_line(part - lerp(c.before0, c.before1, t), lerp(c.d00, c.d01, t), lerp(c.d10, c.d11, t));
  return {(static_cast<float>(x) + s) / static_cast<float>(width_ - 1),
          (static_cast<float>(y) + t) / static_cast<float>(height_ - 1)};
}

WarpGrid WarpGrid::blended(const SliceMix& mix) const {
  WarpGrid one;
  one.width_ = width_, one.height_ = height_, one.slices_ = 1, one.scale_ = scale_;
  one.empty_ = {false};
  const size_t cells = vertices_.size() / slices_, lines = rows_.size() / slices_;
  one.vertices_.assign(cells, {0, 0});
  one.rows_.assign(lines, {0, 0});
  for (size_t i = 0; i < static_cast<size_t>(mix.count); ++i) {
    const float w = mix.weight[i];
    const Vertex* v = &vertices_[mix.index[i] * cells];
    for (size_t j = 0; j < cells; ++j)
      one.vertices_[j].density += w * v[j].density, one.vertices_[j].before += w * v[j].before;
    const Row* r = &rows_[mix.index[i] * lines];
    for (size_t j = 0; j < lines; ++j)
      one.rows_[j].total += w * r[j].total, one.rows_[j].before += w * r[j].before;
  }
  return one;
}

}  // namespace zonal
