// Runs one case of tests/gl/kernel_cases.glsl (CASE) on many inputs.
layout(local_size_x = 64) in;
layout(binding = 0, std430) readonly buffer Inputs { float inputs[]; };
layout(binding = 1, std430) writeonly buffer Outputs { float outputs[]; };
layout(binding = 0) uniform usamplerBuffer shmat;
#define SHMAT_WORD(i) texelFetch(shmat, int(i)).x

#include "tests/gl/kernel_cases.glsl"

uniform int count;

void main() {
  int at = int(gl_GlobalInvocationID.x);
  if (at >= count) return;
  CaseInput c;
  for (int i = 0; i < 16; ++i) c.u[i] = inputs[34 * at + i];
  for (int i = 0; i < 6; ++i)
    c.d[i] = vec3(inputs[34 * at + 16 + 3 * i], inputs[34 * at + 17 + 3 * i], inputs[34 * at + 18 + 3 * i]);
  CaseOutput r;
  for (int i = 0; i < 144; ++i) r.v[i] = 0.0f;
  CASE(c, r);
  for (int i = 0; i < RESULTS; ++i) outputs[RESULTS * at + i] = r.v[i];
}
