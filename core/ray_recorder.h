#pragma once
/// One ray as Embree got it, for benchmarks that ask how fast the same rays go with nothing around them.

#include <vector>

#include "core/vec.h"

namespace zonal {

struct RayRecord {
  vec3 origin;
  float t_min;
  vec3 direction;
  float t_max;
  bool shadow;
};

/// Where this thread's rays are recorded; null, as it always is in use, records nothing.
extern constinit thread_local std::vector<RayRecord>* ray_recorder;

}  // namespace zonal
