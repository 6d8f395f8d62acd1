/// Pictures on lights as the cells of a quadtree (Mézières 2022, Sec. 3.4: left for future work there).

#include <array>
#include <queue>

#include "lights/sh_lights.h"

namespace zonal {

namespace {

/// A rectangle of texels, rows from the top.
struct Cell {
  ivec2 low, high;  ///< columns and rows; the upper ones are outside
  vec3 mean{0};
  /// Sum over texels of what their radiance differs from the mean, all colours: light that is moved.
  double moved = 0;

  Cell(const TexturedLight& light, ivec2 from, ivec2 to) : low(from), high(to) {
    const auto texel = [&](int x, int y) {
      return light.texels[size_t(y) * size_t(light.width) + size_t(x)];
    };
    glm::dvec3 sum(0);
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) sum += texel(x, y);
    mean = vec3(sum / (double(high.x - low.x) * (high.y - low.y)));
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) {
        const vec3 off = glm::abs(texel(x, y) - mean);
        moved += double(off.x) + off.y + off.z;
      }
  }
  bool operator<(const Cell& other) const { return moved < other.moved; }
};

/// The cell that moves most light is cut in four, or in two where it is one texel wide, until all move less
/// than `error` of the picture's light. Whatever point is lit, no coefficient is then off by more than
/// `error` of what all that light could bring from the place of the picture that brings most.
std::vector<Cell> cells_of(const TexturedLight& light, float error) {
  std::priority_queue<Cell> cells;
  cells.emplace(light, ivec2(0), ivec2(light.width, light.height));
  const vec3 mean = light.mean();
  const double allowed = double(error) * (double(mean.x) + mean.y + mean.z) * light.width * light.height;
  double moved = cells.top().moved;
  while (moved > allowed && cells.top().moved > 0) {
    const Cell cell = cells.top();
    cells.pop();
    moved -= cell.moved;
    const ivec2 middle = (cell.low + cell.high) / 2;
    for (int k = 0; k < 4; ++k) {
      const ivec2 from(k & 1 ? middle.x : cell.low.x, k & 2 ? middle.y : cell.low.y),
          to(k & 1 ? cell.high.x : middle.x, k & 2 ? cell.high.y : middle.y);
      if (from.x == to.x || from.y == to.y) continue;
      const Cell part(light, from, to);
      moved += part.moved;
      cells.push(part);
    }
  }
  std::vector<Cell> result;
  for (; !cells.empty(); cells.pop()) result.push_back(cells.top());
  return result;
}

}  // namespace

void ShLights::add_picture(const TexturedLight& light) {
  for (const Cell& cell : cells_of(light, options_.texture_error)) {
    if (is_black(cell.mean)) continue;
    const vec2 scale = 1.0f / vec2(light.width, light.height);
    const vec2 from = vec2(cell.low.x, light.height - cell.high.y) * scale,
               to = vec2(cell.high.x, light.height - cell.low.y) * scale;
    const auto at = [&](float x, float y) { return light.corner + light.u * x + light.v * y; };
    const vec3 a = at(from.x, from.y), b = at(to.x, from.y), c = at(to.x, to.y), d = at(from.x, to.y);
    const bool exact = options_.polygons == ShLightOptions::Polygons::exact;
    if (!exact && options_.polygons != ShLightOptions::Polygons::factorized && options_.split_error == 0) {
      add_flat(0.5f * (a + c), glm::cross(b - a, d - a), cell.mean, light.two_sided);
      continue;
    }
    for (const auto& [p, q, r] : {std::array{a, b, c}, {a, c, d}})
      if (exact)
        exact_.add(p, q, r, cell.mean, light.two_sided);
      else
        add_triangle(p, q, r, cell.mean, light.two_sided, 0);
  }
}

}  // namespace zonal
