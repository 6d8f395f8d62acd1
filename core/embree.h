#pragma once
/// Embree 3.13 and 4.3 behind one spelling: a query context that travels with a ray, and the ray calls that
/// take it.
///
///     embree::Context context = embree::context();
///     embree::intersect1(scene, context, rayhit);
///
/// Embree 4 moved the flags from the context into an arguments struct; nothing else we use has changed.

#if !defined(ZONAL_EMBREE_MAJOR)
#if __has_include(<embree4/rtcore.h>)
#define ZONAL_EMBREE_MAJOR 4
#else
#define ZONAL_EMBREE_MAJOR 3
#endif
#endif

#if ZONAL_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace zonal::embree {

#if ZONAL_EMBREE_MAJOR >= 4

using Context = RTCRayQueryContext;

inline Context context() {
  Context c;
  rtcInitRayQueryContext(&c);
  return c;
}
inline void intersect1(RTCScene scene, Context& c, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &c;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded1(RTCScene scene, Context& c, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &c;
  rtcOccluded1(scene, &ray, &arguments);
}
/// `valid`: -1 for the rays that are wanted, 0 for the others; 32-byte aligned.
inline void occluded8_coherent(const int* valid, RTCScene scene, Context& c, RTCRay8& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &c;
  rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

using Context = RTCIntersectContext;

inline Context context() {
  Context c;
  rtcInitIntersectContext(&c);
  return c;
}
inline void intersect1(RTCScene scene, Context& c, RTCRayHit& ray) {
  rtcIntersect1(scene, &c, &ray);
}
inline void occluded1(RTCScene scene, Context& c, RTCRay& ray) {
  rtcOccluded1(scene, &c, &ray);
}
/// `valid`: -1 for the rays that are wanted, 0 for the others; 32-byte aligned.
inline void occluded8_coherent(const int* valid, RTCScene scene, Context& c, RTCRay8& rays) {
  c.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &c, &rays);
}

#endif

}  // namespace zonal::embree
