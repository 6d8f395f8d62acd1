#include "gl/twin.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "gl/units.h"
#include "integrators/hvl/hvl_gl.h"
#include "integrators/many_lights.h"
#include "integrators/sh_direct/sh_direct_gl.h"
#include "integrators/vpl/vpl_gl.h"
#include "integrators/vsgl/vsgl_gl.h"
#include "integrators/vsl/vsl_gl.h"

namespace zonal::gl {
namespace {

struct TwinRow {
  std::string method;
  std::unique_ptr<Twin> (*make)(const ShaderText&, Integrator&, const Scene&);
};
const std::vector<TwinRow>& rows() {
  static const std::vector<TwinRow> table = {{"vpl", make_vpl_twin},
                                             {"hvl", make_hvl_twin},
                                             {"vsl", make_vsl_twin},
                                             {"vsgl", make_vsgl_twin},
                                             {"sh_direct", make_sh_direct_twin}};
  return table;
}

}  // namespace

const std::vector<std::string>& twin_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const TwinRow& row : rows()) list.push_back(row.method);
    return list;
  }();
  return names;
}

std::unique_ptr<Twin> make_twin(const std::string& method, const ShaderText& text, Integrator& cpu,
                                const Scene& scene) {
  for (const TwinRow& row : rows())
    if (row.method == method) return row.make(text, cpu, scene);
  throw SceneError(
      fmt::format("--backend gl: found the method \"{}\", which has no GPU twin, expected one of: {}", method,
                  fmt::join(twin_names(), ", ")));
}

bool samples_direct(const Integrator& cpu) {
  const auto* many = dynamic_cast<const ManyLights*>(&cpu);
  return many && many->shared().direct == ManyLightsParams::Direct::sampled;
}
bool shows_glow(const Integrator& cpu) {
  return samples_direct(cpu) || !dynamic_cast<const ManyLights*>(&cpu);
}

void refuse(const std::string& method, const std::string& key, const std::string& found,
            const std::string& expected) {
  throw SceneError(fmt::format("--backend gl: {}: /{}: found \"{}\", expected {} on the GPU", method, key,
                               found, expected));
}

void refuse_unsupported(const std::string& method, const ManyLights& cpu, const Scene& scene, bool measured) {
  static const char* kOcclusions[] = {"none", "center", "sphere"};
  const ManyLightsParams& shared = cpu.shared();
  if (shared.occlusion != Occlusion::none)
    refuse(method, "occlusion", kOcclusions[static_cast<int>(shared.occlusion)], "\"none\"");
  if (shared.skip > 0) refuse(method, "skip", fmt::format("{}", shared.skip), "0");
  if (shared.split > 0) refuse(method, "split", fmt::format("{}", shared.split), "0");
  for (const auto& material : scene.materials())
    if (!measured && std::string(material->type()) == "measured")
      throw SceneError(fmt::format(
          "--backend gl: {}: the material \"{}\" is measured, expected one with a formula on the GPU", method,
          material->name));
}

void gather_lights(const Program& program, const LightBuffer& lights, const GBuffer& points,
                   const Texture2D& sum, int batch) {
  program.use();
  program.set("size", ivec2(points.width(), points.height()));
  points.bind();
  sum.bind_image(1);
  for (const LightBuffer::Chunk& chunk : lights.chunks()) {
    chunk.texels.bind(units::kLights);
    for (int first = 0; first < chunk.count; first += batch) {
      program.set("range", ivec2(first, std::min(first + batch, chunk.count)));
      program.set("chunk_first", chunk.first);
      glDispatchCompute((points.width() + 7) / 8, (points.height() + 7) / 8, 1);
      glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    }
  }
}

}  // namespace zonal::gl
