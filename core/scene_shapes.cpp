#include "core/scene_shapes.h"

namespace zonal {
namespace {

/// Names Scene's private member for this file alone (an explicit instantiation may): scene.h, which every
/// method includes, stays without the inside of a scene.
template <auto member>
struct Inside {
  friend auto& inside(const Scene& scene) { return *(scene.*member); }
};
template struct Inside<&Scene::impl_>;

auto& inside(const Scene& scene);

}  // namespace

std::span<const Shape> shapes_of(const Scene& scene) {
  return inside(scene).shapes;
}

}  // namespace zonal
