#include "apps/canvas.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace zonal {
namespace {

/// Letters of 5 x 7 cells, one row after the other: '#' is ink. In the order of kLetters.
constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.%'>:-/=_";
constexpr std::string_view kCells[] = {
    ".###.#...##...#######...##...##...#", "####.#...##...#####.#...##...#####.",
    ".#####....#....#....#....#.....####", "####.#...##...##...##...##...#####.",
    "######....#....####.#....#....#####", "######....#....####.#....#....#....",
    ".#####....#....#..###...##...#.####", "#...##...##...#######...##...##...#",
    ".###...#....#....#....#....#...###.", "..###...#....#....#....#.#..#..##..",
    "#...##..#.#.#..##...#.#..#..#.#...#", "#....#....#....#....#....#....#####",
    "#...###.###.#.##.#.##...##...##...#", "#...###..##.#.##..###...##...##...#",
    ".###.#...##...##...##...##...#.###.", "####.#...##...#####.#....#....#....",
    ".###.#...##...##...##.#.##..#..##.#", "####.#...##...#####.#.#..#..#.#...#",
    ".#####....#.....###.....#....#####.", "#####..#....#....#....#....#....#..",
    "#...##...##...##...##...##...#.###.", "#...##...##...##...##...#.#.#...#..",
    "#...##...##...##.#.##.#.###.###...#", "#...##...#.#.#...#...#.#.#...##...#",
    "#...##...#.#.#...#....#....#....#..", "#####....#...#...#...#...#....#####",
    ".###.#...##..###.#.###..##...#.###.", "..#...##....#....#....#....#...###.",
    ".###.#...#....#..##..#...#....#####", "####.....#....#.###.....#....#####.",
    "...#...##..#.#.#..#.#####...#....#.", "######....####.....#....#....#####.",
    "..##..#...#....####.#...##...#.###.", "#####....#...#...#....#....#....#..",
    ".###.#...##...#.###.#...##...#.###.", ".###.#...##...#.####....#...#..##..",
    "...........................##...##.", "##..###..#...#...#...#...#..###..##",
    "..#....#....#......................", "#.....#.....#.....#...#...#...#....",
    "......##...##........##...##.......", "...............#####...............",
    "....#....#...#...#...#...#....#....", "..........#####.....#####..........",
    "..............................#####",
};

}  // namespace

Canvas::Canvas(int width, int height, vec3 paper) : image_(width, height) {
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) image_.pixels[3 * i + c] = paper[c];
}

void Canvas::dot(int x, int y, vec3 color, float cover) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  float* p = image_.at(x, y);
  for (int c = 0; c < 3; ++c) p[c] += std::clamp(cover, 0.0f, 1.0f) * (color[c] - p[c]);
}

void Canvas::line(vec2 from, vec2 to, vec3 color) {
  const vec2 along = to - from;
  const float length2 = std::max(glm::dot(along, along), 1e-6f);
  for (int y = int(std::min(from.y, to.y)) - 2; y <= std::max(from.y, to.y) + 2; ++y) {
    for (int x = int(std::min(from.x, to.x)) - 2; x <= std::max(from.x, to.x) + 2; ++x) {
      const vec2 p(x + 0.5f, y + 0.5f);
      const float t = std::clamp(glm::dot(p - from, along) / length2, 0.0f, 1.0f);
      dot(x, y, color, 1.4f - glm::length(p - from - t * along));
    }
  }
}

void Canvas::text(vec2 corner, const std::string& what, vec3 color) {
  float left = corner.x;
  for (const char letter : what) {
    const size_t index = kLetters.find(static_cast<char>(std::toupper(static_cast<unsigned char>(letter))));
    for (int i = 0; index != std::string_view::npos && i < 35; ++i) {
      if (kCells[index][i] != '#') continue;
      for (int k = 0; k < 4; ++k)
        dot(int(left) + i % 5 * 2 + k % 2, int(corner.y) + i / 5 * 2 + k / 2, color);
    }
    left += 12;
  }
}

void Canvas::write(const std::string& file) const {
  // The writer encodes: hand it linear values.
  Image linear = image_;
  for (float& value : linear.pixels) value = srgb_decode(value);
  write_image(file, {.layers = {{"", linear}}}, 1);
}

}  // namespace zonal
