#include "sweep/score.h"

#include <algorithm>
#include <cmath>

#include "core/metrics.h"

namespace zonal {
namespace {

using nlohmann::json;

json number(double x) {
  if (std::isinf(x)) return x > 0 ? json("inf") : json("-inf");
  return std::isnan(x) ? json(nullptr) : json(x);
}

}  // namespace

Scorer::Scorer(const std::string& reference_file, bool with_flip_hdr) : file_(read_image(reference_file)) {
  const auto found = file_.metadata.find("exposure");
  if (found != file_.metadata.end()) exposure_ = std::stof(found->second);
  display_ = to_display(reference(), exposure_);
  flip_ = std::make_unique<FlipReference>(display_);
  if (with_flip_hdr) flip_hdr_ = std::make_unique<FlipHdr>(reference());
}

const Image* Scorer::layer(const char* name) const {
  const auto found = file_.layers.find(name);
  return found == file_.layers.end() ? nullptr : &found->second;
}

json Scorer::score(const Image& image) const {
  const LinearMetrics linear = linear_metrics(image, reference(), layer("A"), layer("B"), layer("variance"));
  const DisplayMetrics display = display_metrics(to_display(image, exposure_), display_, flip_.get());
  json scores = {{"rmse", number(linear.rmse)},           {"mae", number(linear.mae)},
                 {"relmse", number(linear.relmse)},       {"relmse_trimmed", number(linear.relmse_trimmed)},
                 {"smape", number(linear.smape)},         {"bias", number(linear.bias)},
                 {"fireflies", number(linear.fireflies)}, {"nan", linear.nan},
                 {"rmse_display", number(display.rmse)},  {"mae_display", number(display.mae)},
                 {"psnr", number(display.psnr)},          {"ssim", number(display.ssim)},
                 {"flip", number(display.flip)}};
  if (flip_hdr_) scores["flip_hdr"] = number(mean_of_map(flip_hdr_->map(image)));
  if (linear.mse_unbiased) {
    scores["rmse_unbiased"] = number(std::sqrt(std::max(0.0, *linear.mse_unbiased)));
    scores["reference_floor"] = number(*linear.reference_floor);
    scores["reference_limited"] = linear.reference_limited();
  }
  return scores;
}

}  // namespace zonal
