// How much of Embree's raw ray rate `path` keeps: every ray of one pass is recorded in order, then traced again with
// nothing around it. Both counts, both clocks and their ratio come from the same run, interleaved.
//
//     build/bench_path scenes/sponza/sponza.json [more scenes]
//
// The limit is the ray rate; all of path's work from camera ray to film counts against it.
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <numeric>

#include "core/embree.h"
#include "core/error.h"
#include "core/machine.h"
#include "core/ray_recorder.h"
#include "core/render.h"
#include "core/scene_loader.h"
#include "integrators/table.h"

namespace zonal {
namespace {

constexpr const char* kSettings = R"({"max_bounces": 5})";
constexpr int kWidth = 640, kHeight = 360, kRounds = 7;

RenderReport render_pass(const Scene& scene, int threads) {
  const auto path = find_integrator("path", "").make(nlohmann::json::parse(kSettings), "", nullptr);
  Film film(kWidth, kHeight);
  return render(scene, *path, film, {.passes = 1}, {.seed = 1, .threads = threads, .pixels = RenderOptions::Pixels::jitter});
}

std::vector<RayRecord> record(const Scene& scene) {
  std::vector<RayRecord> rays;
  ray_recorder = &rays;  // one thread: the render runs in this one
  render_pass(scene, 1);
  ray_recorder = nullptr;
  return rays;
}

RTCRayHit to_embree(const RayRecord& r) {
  RTCRayHit query;
  query.ray = {r.origin.x, r.origin.y, r.origin.z, r.t_min, r.direction.x, r.direction.y, r.direction.z,
               0,          r.t_max,    ~0u,        0,       0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// Seconds Embree takes for the rays, in order, chunk by chunk.
double trace_raw(const Scene& scene, const std::vector<RayRecord>& rays, int threads) {
  const auto raw = static_cast<RTCScene>(scene.embree());
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  oneapi::tbb::task_arena arena(threads);
  constexpr size_t kChunk = 4096;
  const auto start = Clock::now();
  arena.execute([&] {
    oneapi::tbb::parallel_for(size_t{0}, (rays.size() + kChunk - 1) / kChunk, [&](size_t chunk) {
      embree::Context context = embree::context();
      const size_t end = std::min(rays.size(), (chunk + 1) * kChunk);
      for (size_t i = chunk * kChunk; i < end; ++i) {
        RTCRayHit query = to_embree(rays[i]);
        if (rays[i].shadow) {
          embree::occluded1(raw, context, query.ray);
        } else {
          embree::intersect1(raw, context, query);
        }
      }
    });
  });
  return seconds_since(start);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void measure(const std::string& file) {
  const Scene scene = load_scene(file);
  const std::vector<RayRecord> rays = record(scene);
  const size_t shadow = std::count_if(rays.begin(), rays.end(), [](const RayRecord& r) { return r.shadow; });
  fmt::print("{}: {} rays a pass at {}x{} ({} of them shadow rays), path {}\n", file, rays.size(), kWidth, kHeight,
             shadow, kSettings);
  for (int threads = 1; threads <= hardware_threads(); threads *= 2) {
    std::vector<double> path_rate, raw_rate, ratio;
    for (int round = 0; round < kRounds; ++round) {
      const RenderReport report = render_pass(scene, threads);
      path_rate.push_back(rays.size() / (report.begin_pass_seconds + report.radiance_seconds) * 1e-6);
      raw_rate.push_back(rays.size() / trace_raw(scene, rays, threads) * 1e-6);
      ratio.push_back(path_rate.back() / raw_rate.back());
    }
    fmt::print("  {} thread{}: path {:.2f} Mrays/s, Embree alone {:.2f} Mrays/s, ratio {:.3f} (medians of {} rounds)\n",
               threads, threads == 1 ? " " : "s", median(path_rate), median(raw_rate), median(ratio), kRounds);
  }
}

}  // namespace
}  // namespace zonal

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) zonal::measure(argv[i]);
    if (argc < 2) zonal::measure("scenes/cornell/cornell.json");
  } catch (const zonal::SceneError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
