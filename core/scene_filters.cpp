/// Embree's callbacks for triangles: cut-away surfaces, and collecting every hit along a ray.

#include "core/scene_impl.h"

namespace zonal {

void skip_masked(const RTCFilterFunctionNArguments* arguments) {
  const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (!arguments->valid[i]) continue;
    const vec2 uv = shape.uv(RTCHitN_primID(arguments->hit, n, i), RTCHitN_u(arguments->hit, n, i),
                             RTCHitN_v(arguments->hit, n, i));
    if (shape.material->masked(uv)) arguments->valid[i] = 0;
  }
}

void collect_hits(const RTCFilterFunctionNArguments* arguments) {
  const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  auto* context = reinterpret_cast<CollectingContext*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (!arguments->valid[i]) continue;
    const uint32_t primitive = RTCHitN_primID(arguments->hit, n, i);
    const float u = RTCHitN_u(arguments->hit, n, i), v = RTCHitN_v(arguments->hit, n, i);
    if (!shape.has_mask || !shape.material->masked(shape.uv(primitive, u, v))) {
      context->hits->push_back({RTCRayN_tfar(arguments->ray, n, i), shape.index, primitive, u, v});
    }
    arguments->valid[i] = 0;  // rejected, so that the ray goes on
  }
}

}  // namespace zonal
