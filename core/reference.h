#pragma once
/// Cached references: two independent halves A and B of the same length, their mean, its variance, and a
/// record of what made them. The halves tell the error of a picture from the noise of the reference
/// (docs/metrics.md).
///
///     const ReferenceRequest request{.scene_file = "box.json", .integrator = "path", .passes = 4096};
///     if (!reference_is_current("box_reference.exr", request)) {
///       if (auto reference = make_reference(scene, request)) write_reference("box_reference.exr", request,
///       *reference);
///     }
///
/// The EXR holds layers "" (the mean), "A", "B", "variance", "albedo", "normal", "depth"; the record lies
/// beside it under the same name ending in .json.

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/image.h"
#include "core/render.h"

namespace zonal {

/// What decides a reference's pixels. Equal requests on unchanged scene files: equal references.
struct ReferenceRequest {
  std::string scene_file, integrator = "path";
  nlohmann::json settings = nlohmann::json::object();  ///< what the user set; defaults are left to the method
  int passes = 0;  ///< of both halves together; an odd number is rounded up
  double seconds =
      0;  ///< alternatively: of both halves together; the second half takes as many passes as the first
  int width = 0, height = 0, frame = 0;
  uint64_t seed = 0;
  nlohmann::json materials = nlohmann::json::object();  ///< replacements, as in LoadOptions
  /// Score one-pass pictures against a reference of pixel centres: otherwise edges are measured as errors.
  RenderOptions::Pixels pixels = RenderOptions::Pixels::jitter;
};

struct ReferenceOptions {
  int threads = 0;  ///< 0: all
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Progress&)> on_progress;
};

struct Reference {
  ImageFile image;
  nlohmann::json record;
};

/// Renders both halves. Empty when `stop` ended it: a reference is complete or not there. Throws SceneError
/// for settings the method does not take.
std::optional<Reference> make_reference(const Scene& scene, const ReferenceRequest& request,
                                        const ReferenceOptions& options = {});

/// Seeds of A and B. Mixed, so that no half shares its random numbers with a picture rendered with a seed
/// people type.
uint64_t half_seed(uint64_t seed, int half);

/// Names the request and the content of the scene file and of the files it names: one changed byte is another
/// key.
std::string reference_key(const ReferenceRequest& request);
/// "box.exr" -> "box.json".
std::string record_file(const std::string& exr);
/// Whether EXR and record are there, whole, and made by this very request.
bool reference_is_current(const std::string& exr, const ReferenceRequest& request);
/// Writes EXR and record, each whole or not at all.
void write_reference(const std::string& exr, const ReferenceRequest& request, const Reference& reference);

}  // namespace zonal
