#pragma once
/// The small vocabulary of geometry everything shares: GLM's vectors, constants, an orthonormal frame.
///
///     Frame frame(normal);
///     vec3 local = frame.to_local(direction);   // z = normal

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace zonal {

using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr uint32_t kNone = 0xffffffffu;  ///< "no such index"

/// Relative luminance of a linear Rec. 709 colour.
inline float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float max_component(vec3 c) { return std::fmax(c.x, std::fmax(c.y, c.z)); }
inline bool is_black(vec3 c) { return c.x == 0.0f && c.y == 0.0f && c.z == 0.0f; }
inline bool is_finite(vec3 c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }
inline float sqr(float x) { return x * x; }
inline float safe_sqrt(float x) { return std::sqrt(std::fmax(0.0f, x)); }

/// Right-handed orthonormal frame; z is the normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Frame {
  vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  Frame() = default;
  explicit Frame(vec3 normal) : z(normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    x = vec3(1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    y = vec3(b, sign + normal.y * normal.y * a, -normal.y);
  }
  /// Frame whose x lies as near to `tangent` as the normal allows; falls back to the one above.
  Frame(vec3 normal, vec3 tangent) : Frame(normal) {
    const vec3 t = tangent - normal * glm::dot(normal, tangent);
    const float length2 = glm::dot(t, t);
    if (!(length2 > 1e-20f)) return;
    x = t / std::sqrt(length2);
    y = glm::cross(z, x);
  }

  vec3 to_local(vec3 w) const { return {glm::dot(x, w), glm::dot(y, w), glm::dot(z, w)}; }
  vec3 to_world(vec3 w) const { return x * w.x + y * w.y + z * w.z; }
};

/// Axis-aligned box in metres; empty until grown.
struct Bounds {
  vec3 low{kInfinity}, high{-kInfinity};

  void grow(vec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
  void grow(const Bounds& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
  bool empty() const { return !(low.x <= high.x); }
  vec3 center() const { return 0.5f * (low + high); }
};

/// Sphere in metres. The scene's one is used wherever a length must scale with the scene and not turn with it.
struct BoundingSphere {
  vec3 center{0};
  float radius = 1;
};

}  // namespace zonal
