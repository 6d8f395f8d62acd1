#include "materials/measured_brdf.h"

#include <cmath>
#include <fstream>

#include "core/sampling.h"
#include "materials/merl.h"
#include "materials/rgl.h"
#include "materials/tensor_file.h"

namespace zonal {

void MeasuredBrdf::evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const {
  for (int i = 0; i < n; ++i) f[i] = evaluate(w_out, w_in[i]);
}

void MeasuredBrdf::estimate_albedo() {
  // Mean of f cos / pdf over cosine-weighted w_out and sampled w_in, in five stratified dimensions: with 4096
  // points about half a percent, enough for choosing lights and for the albedo layer.
  constexpr uint32_t kSamples = 4096;
  glm::dvec3 sum(0.0);
  for (uint32_t i = 0; i < kSamples; ++i) {
    Sampler sampler(0, 0, i);
    const vec3 w_out = cosine_hemisphere(sampler.next_2d());
    const float u_lobe = sampler.next_1d();
    const vec3 w_in = sample_direction(w_out, u_lobe, sampler.next_2d());
    if (!(w_out.z > 0.0f) || !(w_in.z > 0.0f)) continue;
    vec3 f;
    float density;
    evaluate_with_pdf(w_out, w_in, &f, &density);
    if (density > 0.0f) sum += glm::dvec3(f * (w_in.z / density));
  }
  albedo = glm::clamp(vec3(sum / double(kSamples)), vec3(0.0f), vec3(1.0f));
}

std::unique_ptr<MeasuredBrdf> load_measured(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string front(kTensorMagic.size(), '\0');
  stream.read(front.data(), static_cast<std::streamsize>(front.size()));
  // By content; a damaged front of a file that calls itself .bsdf is answered by the reader that knows what
  // it should be.
  if (front == kTensorMagic || file.ends_with(".bsdf")) return load_rgl(file);
  return load_merl(file);
}

}  // namespace zonal
