#pragma once
/// The pass loop, written once: tiles, threads, primary rays, layers, budget, stop and clocks.
///
///     Film film(camera.width, camera.height);
///     RenderReport report = render(scene, *integrator, film, {.passes = 16}, {.seed = 1});

#include <functional>

#include "core/film.h"
#include "core/integrator.h"

namespace zonal {

/// Ends after `passes`, or when `seconds` of begin_pass plus radiance are spent; 0 = not limited by this.
struct Budget {
  int passes = 0;
  double seconds = 0;
};

struct RenderOptions {
  uint64_t seed = 0;
  int threads = 0;  ///< 0: all
  /// Where in the pixel rays start. `automatic`: a single pass at the centre, more passes jittered over the pixel; a
  /// timed render cannot know how many passes it will have, and jitters.
  enum class Pixels { automatic, center, jitter } pixels = Pixels::automatic;
  const std::atomic<bool>* stop = nullptr;  ///< set from a signal handler or another thread
  bool pin = false;  ///< each thread stays on one core: steadier times
};

/// "automatic", "center", "jitter": as options and records call it.
const char* pixels_name(RenderOptions::Pixels pixels);

struct RenderReport {
  int passes = 0;
  bool interrupted = false;  ///< `stop` was set; the film holds what was finished
  bool partial = false;      ///< the first and only pass is incomplete: some tiles are black
  double begin_pass_seconds = 0, radiance_seconds = 0;
  TileStats counters;
  PassStats pass;
};

struct Progress {
  int pass = 0;
  double fraction = 0;  ///< of the whole budget
  double seconds = 0;   ///< spent so far, on_pass and output not counted
};

/// Traces the primary rays of up to 8x8 pixels from `corner` on (cut off at the picture's edge) and starts their
/// samplers. `render` does this for every tile; methods may, to measure themselves.
void trace_tile(const Scene& scene, const Camera& camera, ivec2 corner, uint64_t seed, int pass, bool jitter,
                Tile* tile, Sampler* samplers);

/// `on_pass` runs after each finished pass, outside the clock, and is told the seconds on it so far; `on_progress` at most ten times a second.
RenderReport render(const Scene& scene, Integrator& integrator, Film& film, const Budget& budget,
                    const RenderOptions& options, const std::function<void(const Film&, double seconds)>& on_pass = {},
                    const std::function<void(const Progress&)>& on_progress = {});

}  // namespace zonal
