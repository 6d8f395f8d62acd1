/// Any bytes as an RGL file: a BRDF that stays finite, or a SceneError; never a crash.
/// Run: fuzz_material -max_len=8192 -timeout=20 -close_fd_mask=1 CORPUS
/// CORPUS: small .bsdf files, such as rgl_tensors() of tests/measured_files.h makes; from nothing, little is reached.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "materials/rgl.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const zonal::RglBrdf brdf(zonal::TensorFile("fuzz.bsdf", std::string(reinterpret_cast<const char*>(data), size)));
    const zonal::vec3 w_out(0.36f, 0.48f, 0.8f), w_in(-0.6f, 0, 0.8f);
    zonal::vec3 f;
    float pdf;
    brdf.evaluate_with_pdf(w_out, w_in, &f, &pdf);
    if (!zonal::is_finite(f) || !std::isfinite(pdf) || !zonal::is_finite(brdf.albedo)) std::abort();
  } catch (const zonal::SceneError&) {
  }
  return 0;
}
