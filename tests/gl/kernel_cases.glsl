// One case a kernel function, for C++ and GLSL alike: random numbers in, everything the function returns out. Nothing is
// computed on the way in that could round differently: numbers are scaled, directions come ready made. A shader takes one
// SUBJECT, the kernels of the others cost it seconds; C++ takes all (0).

#if SUBJECT == 0 || SUBJECT == 1
#include "integrators/vpl/vpl.glsl"
#include "integrators/vsl/vsl.glsl"
#include "sh/attenuation.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 2 || SUBJECT == 3 || SUBJECT == 8
#include "sh/basis.glsl"
#include "sh/sphere_light.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 2
#include "sh/clamped_cosine.glsl"
#include "sh/rotation.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 3 || SUBJECT == 6
#include "sh/angle.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 3
#include "materials/zonal_lobes.glsl"
#include "integrators/hvl/hvl.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 8
#include "integrators/sh_direct/sh_direct.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 4 || SUBJECT == 5
#include "integrators/vsgl/spherical_gaussian.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 5
#include "integrators/vsgl/vsgl.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 6
#include "materials/sh_material.glsl"
#include "materials/sh_layers.glsl"
#endif
#if SUBJECT == 0 || SUBJECT == 7
#include "materials/brdf.glsl"
#endif

struct CaseInput {
  float u[16];  // [0, 1)
  vec3 d[6];    // unit; the last three with z > 0
};
struct CaseOutput {
  float v[144];  // the first RESULTS of them are written: a compiler pays for each
};

KERNEL void put3(INOUT(CaseOutput) r, int at, vec3 v) {
  r.v[at] = v.x;
  r.v[at + 1] = v.y;
  r.v[at + 2] = v.z;
}
KERNEL vec3 three(CaseInput c, int at) {
  return vec3(c.u[at], c.u[at + 1], c.u[at + 2]);
}

#if SUBJECT == 0 || SUBJECT == 2 || SUBJECT == 3
// A cap from outside and, sometimes, inside the sphere.
KERNEL ZonalCap case_cap(CaseInput c) {
  return sphere_cap(4.0f * c.u[0] + 0.04f, 0.1f + 0.4f * c.u[1]);
}
#endif

#if SUBJECT == 0 || SUBJECT == 1
#include "tests/gl/cases/points.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 2
#include "tests/gl/cases/harmonics.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 3
#include "tests/gl/cases/zonal.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 4
#include "tests/gl/cases/gaussians.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 5
#include "tests/gl/cases/vsgl.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 7
#include "tests/gl/cases/brdf.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 6
#include "tests/gl/cases/shmat.glsl"
#endif

#if SUBJECT == 0 || SUBJECT == 8
#include "tests/gl/cases/sh_direct.glsl"
#endif
