#include "core/render.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <sched.h>
#include <xmmintrin.h>

#include <algorithm>
#include <mutex>
#include <optional>

namespace zonal {
namespace {

/// Denormals cost a hundred cycles each and carry nothing a picture shows: they are flushed inside tiles.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | 0x8040);
  }  // flush-to-zero, denormals-are-zero
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

void add_counters(TileStats& sum, const TileStats& tile) {
  sum.camera_rays += tile.camera_rays;
  sum.bounce_rays += tile.bounce_rays;
  sum.shadow_rays += tile.shadow_rays;
  sum.light_evaluations += tile.light_evaluations;
  sum.clamped_energy += tile.clamped_energy;
  sum.total_energy += tile.total_energy;
  sum.skipped_pairs += tile.skipped_pairs;
  sum.skipped_bound += tile.skipped_bound;
  sum.skipped_total += tile.skipped_total;
}

/// Calls `on_progress` at most ten times a second, from whichever thread notices first.
class ProgressGate {
 public:
  explicit ProgressGate(const std::function<void(const Progress&)>& on_progress)
      : on_progress_(on_progress) {}
  bool wanted() const { return static_cast<bool>(on_progress_); }
  void offer(const Progress& progress) {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || seconds_since(last_) < 0.1) return;
    last_ = Clock::now();
    on_progress_(progress);
  }

 private:
  const std::function<void(const Progress&)>& on_progress_;
  std::mutex mutex_;
  Clock::time_point last_ = Clock::now();
};

/// One picture's worth of tiles, 8x8 pixels each, in reading order.
struct TileGrid {
  int width, height, columns, rows;
  TileGrid(int w, int h) : width(w), height(h), columns((w + 7) / 8), rows((h + 7) / 8) {}
  int count() const { return columns * rows; }
};

/// Keeps each thread of an arena on a core of its own, as long as it lives; the caller's thread gets its
/// freedom back.
class Pinning {
 public:
  Pinning() { sched_getaffinity(0, sizeof allowed_, &allowed_); }
  ~Pinning() { sched_setaffinity(0, sizeof allowed_, &allowed_); }

  /// Called by each thread at work: the arena's slot picks among the cores this process may use.
  void hold() const {
    static thread_local const Pinning* held = nullptr;
    if (held == this) return;
    held = this;
    const int slot = oneapi::tbb::this_task_arena::current_thread_index();
    int left = slot % std::max(1, CPU_COUNT(&allowed_));
    for (int core = 0; core < CPU_SETSIZE; ++core) {
      if (!CPU_ISSET(core, &allowed_) || left-- > 0) continue;
      cpu_set_t one;
      CPU_ZERO(&one);
      CPU_SET(core, &one);
      sched_setaffinity(0, sizeof one, &one);
      return;
    }
  }

 private:
  cpu_set_t allowed_;
};

}  // namespace

const char* pixels_name(RenderOptions::Pixels pixels) {
  switch (pixels) {
    case RenderOptions::Pixels::center:
      return "center";
    case RenderOptions::Pixels::jitter:
      return "jitter";
    default:
      return "automatic";
  }
}

void trace_tile(const Scene& scene, const Camera& camera, ivec2 corner, uint64_t seed, int pass, bool jitter,
                Tile* tile, Sampler* samplers) {
  tile->count = 0;
  const int x_end = std::min(corner.x + 8, camera.width), y_end = std::min(corner.y + 8, camera.height);
  for (int y = corner.y; y < y_end; ++y) {
    for (int x = corner.x; x < x_end; ++x) {
      const int i = tile->count++;
      const auto pixel_index = static_cast<uint32_t>(y) * static_cast<uint32_t>(camera.width) + x;
      samplers[i] = Sampler(seed, pixel_index, static_cast<uint32_t>(pass));
      const vec2 inside = samplers[i].next_2d();
      tile->pixels[i] = {x, y};
      tile->directions[i] = camera.direction(vec2(x, y) + (jitter ? inside : vec2(0.5f)));
      tile->hits[i] = scene.intersect(camera.position, tile->directions[i]);
    }
  }
  // Trace first, look up afterwards: the tree stays in cache, then the geometry does.
  scene.look_up(tile->hits.data(), tile->directions.data(), tile->count, tile->surfaces.data(),
                tile->bsdfs.data());
}

RenderReport render(const Scene& scene, Integrator& integrator, Film& film, const Budget& budget,
                    const RenderOptions& options, const std::function<void(const Film&, double)>& on_pass,
                    const std::function<void(const Progress&)>& on_progress) {
  RenderReport report;
  Camera camera = scene.camera();
  camera.width = film.width(), camera.height = film.height();
  const bool timed = budget.seconds > 0;
  using Pixels = RenderOptions::Pixels;
  const bool jitter = options.pixels == Pixels::jitter ||
                      (options.pixels == Pixels::automatic && (timed || budget.passes > 1));
  const int threads = options.threads > 0 ? options.threads : oneapi::tbb::info::default_concurrency();
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  oneapi::tbb::task_arena arena(threads);
  std::optional<Pinning> pinning;
  if (options.pin) pinning.emplace();

  const TileGrid grid(film.width(), film.height());
  std::vector<TileStats> tile_stats(grid.count());
  ProgressGate gate(on_progress);
  arena.execute([&] { integrator.load(scene, Stop(options.stop, Clock::time_point::max()), report.pass); });
  double spent = 0;  // on the clock: begin_pass and radiance, nothing else

  for (int index = 0; budget.passes <= 0 || index < budget.passes; ++index) {
    const double left = budget.seconds - spent;
    // The first pass is finished even when it is late: a whole picture is worth more than a punctual half.
    if (timed && index > 0 && left <= 0) break;
    const auto start = Clock::now();
    const auto deadline =
        timed && index > 0
            ? start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(left))
            : Clock::time_point::max();
    const Stop stop(options.stop, deadline);
    if (stop.asked()) {
      report.interrupted = true;
      break;
    }

    const Pass pass{scene, camera, index, options.seed, budget.seconds, threads};
    arena.execute([&] { integrator.begin_pass(pass, stop, report.pass); });
    const double begin_seconds = seconds_since(start);

    film.begin_pass();
    std::fill(tile_stats.begin(), tile_stats.end(), TileStats{});
    std::atomic<int> tiles_done = 0;
    std::atomic<bool> cut = false;
    const auto radiance_start = Clock::now();
    arena.execute([&] {
      oneapi::tbb::parallel_for(0, grid.count(), [&](int t) {
        if (cut.load(std::memory_order_relaxed) || stop()) {
          cut = true;
          return;
        }
        if (pinning) pinning->hold();
        const FlushDenormals flush;
        Tile tile;
        std::array<Sampler, kTilePixels> samplers;
        std::array<vec3, kTilePixels> radiance;
        trace_tile(scene, camera, {t % grid.columns * 8, t / grid.columns * 8}, options.seed, index, jitter,
                   &tile, samplers.data());
        tile_stats[t].camera_rays += tile.count;
        integrator.shade(tile, radiance.data(), samplers.data(), stop, tile_stats[t]);
        if (stop()) {  // the tile may be unfinished
          cut = true;
          return;
        }
        for (int i = 0; i < tile.count; ++i) {
          const bool found = tile.found(i);
          film.add(tile.pixels[i].x, tile.pixels[i].y, radiance[i], found ? albedo(tile.bsdfs[i]) : vec3(0),
                   found ? tile.surfaces[i].shading.z : vec3(0), found ? tile.hits[i].t : 0.0f);
        }
        const int done = ++tiles_done;
        if (gate.wanted()) {
          const double share = static_cast<double>(done) / grid.count();
          const double now = spent + seconds_since(start);
          const double by_passes = budget.passes > 0 ? (index + share) / budget.passes : 0;
          const double by_time = timed ? now / budget.seconds : 0;
          gate.offer({index, std::min(1.0, std::max(by_passes, by_time)), now});
        }
      });
    });
    report.begin_pass_seconds += begin_seconds;
    report.radiance_seconds += seconds_since(radiance_start);
    spent += seconds_since(start);

    if (cut) {
      report.interrupted = stop.asked();
      if (index > 0) {
        film.discard_pass();
        break;
      }
      report.partial = true;
    }
    film.commit_pass();
    report.passes = film.passes();
    for (const TileStats& stats : tile_stats) add_counters(report.counters, stats);
    if (cut) break;
    if (on_pass) on_pass(film, report.begin_pass_seconds + report.radiance_seconds);
  }
  return report;
}

}  // namespace zonal
