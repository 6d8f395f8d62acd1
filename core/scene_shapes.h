#pragma once
/// The shapes of a scene as the builder laid them out: what a copy for another machine (a GPU) is made from.
///
///     for (const Shape& shape : shapes_of(scene)) if (shape.radius > 0) ...

#include <span>

#include "core/scene_impl.h"

namespace zonal {

std::span<const Shape> shapes_of(const Scene& scene);

}  // namespace zonal
