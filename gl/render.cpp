#include "gl/render.h"

#include <epoxy/gl.h>

#include <optional>

#include "core/sampling.h"
#include "gl/direct.h"
#include "gl/timer.h"
#include "gl/twin.h"

namespace zonal::gl {
namespace {

/// Adds the pass' picture to the film.
void add_pass(const Scene& scene, const Camera& camera, vec2 inside, const GBuffer& points, bool with_glow,
              const Texture2D& direct, const Texture2D& sum, Film& film) {
  const std::vector<GBuffer::Pixel> pixels = points.read();
  const std::vector<vec4> gathered = sum.read_rgba(), lit = direct.read_rgba();
  const Light* sky = scene.environment();
  film.begin_pass();
  for (int y = 0; y < film.height(); ++y) {
    for (int x = 0; x < film.width(); ++x) {
      const size_t i = static_cast<size_t>(y) * film.width() + x;
      const GBuffer::Pixel& p = pixels[i];
      vec3 radiance = vec3(lit[i]) + glm::max(vec3(gathered[i]), vec3(0));
      if (with_glow) radiance += p.emitted;
      if (with_glow && p.depth == 0 && sky) {
        const vec3 w = camera.direction(vec2(x, y) + inside);
        radiance = sky->radiance({.normal = w}, -w);
      }
      film.add(x, y, radiance, p.albedo, p.normal, p.depth);
    }
  }
  film.commit_pass();
}

}  // namespace

RenderReport render(const Context& context, const ShaderText& text, const Scene& scene, Integrator& cpu,
                    const std::string& method, Film& film, const Budget& budget, const RenderOptions& options,
                    const std::function<void(const Film&, double)>& on_pass,
                    const std::function<void(const Progress&)>& on_progress, bool warm_up) {
  RenderReport report;
  Camera camera = scene.camera();
  camera.width = film.width(), camera.height = film.height();
  const bool timed = budget.seconds > 0;
  using Pixels = RenderOptions::Pixels;
  const bool jitter = options.pixels == Pixels::jitter ||
                      (options.pixels == Pixels::automatic && (timed || budget.passes > 1));
  const Stop stop(options.stop, Clock::time_point::max());
  const auto twin = make_twin(method, text, cpu, scene);
  std::optional<DirectLight> direct;
  if (samples_direct(cpu)) direct.emplace(text, scene);
  cpu.load(scene, stop, report.pass);
  SceneBuffers buffers(scene);
  GBuffer points(text, film.width(), film.height());
  const Texture2D sum(GL_RGBA32F, film.width(), film.height());
  const Texture2D direct_sum(GL_RGBA32F, film.width(), film.height());
  Timer timer(context);
  const float nothing[4] = {0, 0, 0, 0};
  glClearTexImage(direct_sum.id(), 0, GL_RGBA, GL_FLOAT, nothing);
  context.check("loading the scene");

  if (warm_up) {
    const Pass pass{.scene = scene, .camera = camera, .seed = options.seed};
    cpu.begin_pass(pass, stop, report.pass);
    twin->begin_pass(pass, buffers);
    points.draw(buffers, camera, vec2(0.5f), scene.bounds().radius);
    if (direct) direct->add(buffers, points, direct_sum);
    twin->gather(points, sum);
    glFinish();
    report.pass = {};
  }

  double spent = 0;
  for (int index = 0; budget.passes <= 0 || index < budget.passes; ++index) {
    // The first pass is finished even when it is late.
    if (timed && index > 0 && spent >= budget.seconds) break;
    if (stop.asked()) {
      report.interrupted = true;
      break;
    }
    const auto start = Clock::now();
    const Pass pass{.scene = scene, .camera = camera, .index = index, .seed = options.seed};
    cpu.begin_pass(pass, stop, report.pass);
    twin->begin_pass(pass, buffers);
    glFinish();
    const double begin_seconds = seconds_since(start);
    if (stop.asked()) {
      report.interrupted = true;
      break;
    }

    const auto radiance_start = Clock::now();
    Sampler sampler(options.seed, 0, static_cast<uint32_t>(index));
    const vec2 inside = jitter ? sampler.next_2d() : vec2(0.5f);
    const float zero[4] = {0, 0, 0, 0};
    glClearTexImage(sum.id(), 0, GL_RGBA, GL_FLOAT, zero);
    timer.begin();
    points.draw(buffers, camera, inside, scene.bounds().radius);
    report.pass.numbers["gpu_points_seconds"] += timer.end();
    // Direct light has a picture of its own: it is never below 0, and what the sum over virtual lights is cut
    // off at must not eat it.
    if (direct) {
      glClearTexImage(direct_sum.id(), 0, GL_RGBA, GL_FLOAT, zero);
      timer.begin();
      direct->add(buffers, points, direct_sum);
      report.pass.numbers["gpu_direct_seconds"] += timer.end();
    }
    timer.begin();
    twin->gather(points, sum);
    report.pass.numbers["gpu_gather_seconds"] += timer.end();
    context.check(method + " on the GPU");
    report.begin_pass_seconds += begin_seconds;
    report.radiance_seconds += seconds_since(radiance_start);
    spent = report.begin_pass_seconds + report.radiance_seconds;

    add_pass(scene, camera, inside, points, shows_glow(cpu), direct_sum, sum, film);
    report.passes = film.passes();
    report.counters.camera_rays += static_cast<uint64_t>(film.width()) * film.height();
    if (on_pass) on_pass(film, spent);
    const double by_passes = budget.passes > 0 ? double(index + 1) / budget.passes : 0;
    const double by_time = timed ? spent / budget.seconds : 0;
    if (on_progress) on_progress({index, std::min(1.0, std::max(by_passes, by_time)), spent});
  }
  return report;
}

}  // namespace zonal::gl
