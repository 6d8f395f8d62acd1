// Frame times of the GPU side at the settings the thesis quotes (Mézières 2022, tables 5.1 to 5.3 on an RTX
// 2080), beside the CPU twin's time for the same picture.
//
//     gl_frame_times [SCENE.json] [--frames N] [--scale S] [--cpu] [--only WORD]
//
// Prints a table: the median and the largest of N finished frames (default 30), without upload and reading
// back. --scale divides both sides of the picture, for software renderers; --cpu also times the CPU twin
// once; --only takes the rows whose label has the word. Rows of sh_direct have a scene of their own and count
// their grid's building, which the column "build" shows alone, in the frame.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "core/scene_loader.h"
#include "gl/render.h"
#include "gl/timer.h"
#include "gl/twin.h"
#include "integrators/table.h"

namespace zonal {
namespace {

struct Configuration {
  const char* label;
  const char* method;
  const char* settings;
  int width, height;
  double thesis_ms, bar_ms;
  const char* scene = nullptr;  ///< null: the one asked for
};
constexpr const char* kManySpheres = "scenes/direct_lights/spheres_512.json";
const Configuration kConfigurations[] = {
    {"vpl, 400 lights", "vpl", R"({"lights": 400})", 1280, 1024, 13, 4},
    {"hvl, 400 lights, 5 bands", "hvl", R"({"lights": 400, "bands": 5, "emission_bands": 3})", 1280, 1024, 61,
     8},
    {"hvl, 1500 lights, 9 bands", "hvl", R"({"lights": 1500, "bands": 9, "emission_bands": 3})", 1280, 1024,
     500, 60},
    {"hvl zonal, 400 lights, 10 bands", "hvl",
     R"({"lights": 400, "bands": 10, "product": "zonal", "emission": "brdf"})", 1600, 900, 32, 6},
    {"vsgl, 400 lights", "vsgl", R"({"lights": 400, "block_texels": 3})", 1280, 1024, 0, 0},
    {"vsl, 400 lights, 4 samples", "vsl", R"({"lights": 400, "samples": 4})", 1280, 1024, 0, 0},
    {"sh_direct, 8^3, 5 bands", "sh_direct", R"({"at": "grid", "grid": 8, "light_bands": 5})", 1920, 1080,
     12.6, 1.2, kManySpheres},
    {"sh_direct, 8^3, 5 bands, forward", "sh_direct",
     R"({"at": "grid", "grid": 8, "light_bands": 5, "loops": "forward"})", 1920, 1080, 0, 0, kManySpheres},
    {"sh_direct, 8^3, 9 bands", "sh_direct", R"({"at": "grid", "grid": 8, "light_bands": 9})", 1920, 1080, 0,
     0, kManySpheres},
    {"sh_direct, 8^3, 9 bands, forward", "sh_direct",
     R"({"at": "grid", "grid": 8, "light_bands": 9, "loops": "forward"})", 1920, 1080, 0, 0, kManySpheres},
    {"sh_direct, cosine, 9 bands", "sh_direct",
     R"({"at": "grid", "grid": 8, "light_bands": 9, "shading": "cosine"})", 1920, 1080, 0, 0, kManySpheres},
    {"sh_direct, turned, 9 bands", "sh_direct",
     R"({"at": "grid", "grid": 8, "light_bands": 9, "shading": "turned", "cosine_bands": 3})", 1920, 1080, 0,
     0, kManySpheres},
    {"sh_direct, general, 9 bands", "sh_direct",
     R"({"at": "grid", "grid": 8, "light_bands": 9, "shading": "general"})", 1920, 1080, 0, 0, kManySpheres},
    {"sh_direct, pixel, 5 bands", "sh_direct", R"({"light_bands": 5})", 1920, 1080, 0, 0, kManySpheres},
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure(const gl::Context& context, const Scene& scene, const Configuration& c, int frames, int scale,
             bool cpu) {
  nlohmann::json settings = nlohmann::json::parse(c.settings);
  const IntegratorRow& row = find_integrator(c.method, "gl_frame_times");
  settings["occlusion"] = "none";
  if (row.has("direct")) settings["direct"] = "none";
  const auto integrator = row.make(settings, c.label, nullptr);
  Camera camera = scene.camera();
  camera.width = c.width / scale, camera.height = c.height / scale;
  const gl::ShaderText text;
  const auto twin = gl::make_twin(c.method, text, *integrator, scene);
  PassStats stats;
  integrator->load(scene, {}, stats);
  const Pass pass{.scene = scene, .camera = camera, .seed = 1};
  integrator->begin_pass(pass, {}, stats);
  gl::SceneBuffers buffers(scene);
  gl::GBuffer points(text, camera.width, camera.height);
  const gl::Texture2D sum(GL_RGBA32F, camera.width, camera.height);
  twin->begin_pass(pass, buffers);
  gl::Timer timer(context);
  // Many-light methods trace their lights on the CPU: only a grid is built anew each frame.
  const bool builds = settings.contains("at");
  std::vector<double> build_ms, points_ms, gather_ms, frame_ms;
  const float zero[4] = {0, 0, 0, 0};
  for (int frame = -2; frame < frames; ++frame) {  // the first two warm up
    glClearTexImage(sum.id(), 0, GL_RGBA, GL_FLOAT, zero);
    timer.begin();
    if (builds) twin->begin_pass(pass, buffers);
    const double build = 1e3 * timer.end();
    timer.begin();
    points.draw(buffers, camera, vec2(0.5f), scene.bounds().radius);
    const double first = 1e3 * timer.end();
    timer.begin();
    twin->gather(points, sum);
    const double second = 1e3 * timer.end();
    if (frame < 0) continue;
    points_ms.push_back(first), gather_ms.push_back(second), frame_ms.push_back(build + first + second);
    build_ms.push_back(build);
  }
  context.check(c.label);
  fmt::print("{:<32} {:>5}x{:<5} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>8} {:>6}", c.label,
             camera.width, camera.height, median(build_ms), median(points_ms), median(gather_ms),
             median(frame_ms), *std::max_element(frame_ms.begin(), frame_ms.end()),
             c.thesis_ms > 0 ? fmt::format("{:g}", c.thesis_ms) : "-",
             c.bar_ms > 0 ? fmt::format("{:g}", c.bar_ms) : "-");
  if (cpu) {
    Film film(camera.width, camera.height);
    const auto alone = row.make(settings, c.label, nullptr);
    const RenderReport report = render(scene, *alone, film, {.passes = 1}, {.seed = 1});
    const double ms = 1e3 * (report.radiance_seconds + (builds ? report.begin_pass_seconds : 0));
    fmt::print(" {:>9.1f} {:>6.2f}", ms, median(frame_ms) / ms);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  std::string scene_file = "scenes/cornell/cornell.json", only;
  int frames = 30, scale = 1;
  bool cpu = false;
  for (int i = 1; i < argc; ++i) {
    const auto number = [&] { return i + 1 < argc ? std::max(1, std::atoi(argv[++i])) : 1; };
    if (!std::strcmp(argv[i], "--frames"))
      frames = number();
    else if (!std::strcmp(argv[i], "--scale"))
      scale = number();
    else if (!std::strcmp(argv[i], "--cpu"))
      cpu = true;
    else if (!std::strcmp(argv[i], "--only") && i + 1 < argc)
      only = argv[++i];
    else
      scene_file = argv[i];
  }
  const auto context = gl::Context::headless();
  const Scene scene = load_scene(scene_file);
  fmt::print("{} ({}), {}; {} frames\n", context->info().renderer, context->info().platform, scene.name(),
             frames);
  fmt::print("{:<32} {:<11} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>6}{}\n", "milliseconds", "", "build",
             "points", "gather", "frame", "largest", "thesis", "bar", cpu ? "       cpu  ratio" : "");
  for (const Configuration& c : kConfigurations) {
    if (std::string(c.label).find(only) == std::string::npos) continue;
    if (c.scene)
      measure(*context, load_scene(c.scene), c, frames, scale, cpu);
    else
      measure(*context, scene, c, frames, scale, cpu);
  }
  return 0;
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  try {
    return zonal::run(argc, argv);
  } catch (const zonal::SceneError& error) {
    fmt::print(stderr, "gl_frame_times: {}\n", error.what());
    return 2;
  }
}
