#pragma once
/// What the tests of `hvl` share: two walls that face each other, a matt box, pictures by hvl and vpl.

#include "integrators/hvl/hvl.h"
#include "integrators/vpl/vpl.h"
#include "tests/support.h"

namespace zonal::hvl_test {

inline HvlParams params(const std::string& text) {
  return read_params<HvlParams>(nlohmann::json::parse(text), "hvl");
}

inline Image rendered(const Scene& scene, Integrator& method, int width, int height, int threads = 2,
                      uint64_t seed = 3) {
  Film film(width, height);
  render(scene, method, film, {.passes = 1}, {.seed = seed, .threads = threads});
  return film.radiance();
}
inline Image hvl_image(const Scene& scene, const std::string& settings, int width = 8, int height = 8,
                       int threads = 2) {
  HvlIntegrator method(params(settings));
  return rendered(scene, method, width, height, threads);
}
inline Image vpl_image(const Scene& scene, const std::string& settings, int width = 8, int height = 8) {
  VplIntegrator method(read_params<VplParams>(nlohmann::json::parse(settings), "vpl"));
  return rendered(scene, method, width, height);
}
inline double mean(const Image& image) {
  double sum = 0;
  for (const float v : image.pixels) sum += v;
  return sum / double(image.pixels.size());
}
/// Largest difference of any value, as a share of the largest value.
inline double largest_difference(const Image& a, const Image& b) {
  double most = 0, size = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    most = std::max(most, std::abs(double(a.pixels[i]) - b.pixels[i]));
    size = std::max(size, std::abs(double(b.pixels[i])));
  }
  return most / size;
}

/// Two walls that face each other, two metres apart. A spot lights the left one; the camera sees the right
/// one, up to `half_height` metres off the axis.
inline std::string facing_walls(const std::string& left, const std::string& right, double half_height,
                                double spot_angle) {
  const double fov = 2 * std::atan(half_height / 1.5) * 180 / 3.14159265358979323846;
  return R"({"camera": {"position": [-0.5, 0, 0], "look_at": [1, 0, 0], "vertical_fov": )" +
         std::to_string(fov) +
         R"(, "resolution": [8, 8]},
    "materials": [{"name": "left", )" +
         left + R"(}, {"name": "right", )" + right + R"(}],
    "objects": [
      {"name": "l", "type": "quad", "corner": [-1, -9, 9], "edges": [[0, 0, -18], [0, 18, 0]], "material": "left"},
      {"name": "r", "type": "quad", "corner": [1, -9, -9], "edges": [[0, 0, 18], [0, 18, 0]], "material": "right"}],
    "lights": [{"type": "spot", "position": [0.9, 0, 0], "look_at": [-1, 0, 0], "power": 100, "inner": 0, "outer": )" +
         std::to_string(spot_angle) + "}]}";
}
inline const char* const kMatt = R"("type": "lambert", "albedo": [0.8, 0.5, 0.3])";
inline const char* const kGlossy =
    R"("type": "metallic_roughness", "base_color": [0.8, 0.5, 0.3], "metallic": 0.3, "roughness": 0.6)";

inline const char* const kBox = R"({
    "camera": {"position": [0, 1, 1.9], "look_at": [0, 0.9, -2], "vertical_fov": 60, "resolution": [16, 16]},
    "materials": [{"name": "wall", "type": "lambert", "albedo": 0.6}],
    "objects": [{"name": "room", "type": "box", "low": [-1, 0, -2], "high": [1, 2, 2], "material": "wall"}],
    "lights": [{"type": "point", "position": [0.3, 1.2, 0.2], "intensity": 2}]})";

}  // namespace zonal::hvl_test
