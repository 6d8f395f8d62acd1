#pragma once
/// Scores of pictures against one reference, which is read and prepared once.
///
///     const Scorer scorer("references/KEY.exr");
///     nlohmann::json scores = scorer.score(image);   // {"rmse": 0.1, ..., "flip": 0.04, ...}

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "core/flip_hdr.h"
#include "core/image.h"

namespace zonal {

class Scorer {
 public:
  /// `with_flip_hdr`: HDR-FLIP too, which takes as long as all else many times over.
  explicit Scorer(const std::string& reference_file, bool with_flip_hdr = false);

  /// Every metric by name: {"rmse", ..., "rmse_display", "flip", "reference_limited", "reference_floor"}.
  /// Numbers JSON cannot hold are null; PSNR of equal pictures is "inf". Throws SceneError when the sizes
  /// differ.
  nlohmann::json score(const Image& image) const;

  const Image& reference() const { return file_.layers.at(""); }
  float exposure() const { return exposure_; }

 private:
  const Image* layer(const char* name) const;
  ImageFile file_;
  float exposure_ = 1;
  Image display_;
  std::unique_ptr<FlipReference> flip_;
  std::unique_ptr<FlipHdr> flip_hdr_;
};

}  // namespace zonal
