#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/json_fields.h"
#include "materials/merl_fits.h"
#include "materials/merl_grid.h"

namespace zonal {
namespace {

/// Widest layer read; the published ones have 21.
constexpr int kWidest = 64;

struct Layer {
  int inputs = 0, outputs = 0;
  std::vector<float> weights;  ///< by input, then output
  std::vector<float> biases;

  void apply(const std::array<float, kWidest>& x, std::array<float, kWidest>* y) const {
    std::array<float, kWidest>& sum = *y;
    std::copy(biases.begin(), biases.end(), sum.begin());
    for (int i = 0; i < inputs; ++i) {
      const float* w = &weights[size_t(i) * size_t(outputs)];
      const float xi = x[size_t(i)];
      for (int j = 0; j < outputs; ++j) sum[size_t(j)] += xi * w[j];
    }
  }
};

/// Words of a text, with the line each stands in.
class Words {
 public:
  Words(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  bool at_end() {
    skip();
    return next_ == text_.size();
  }
  template <class T>
  T number(const std::string& what, T low, T high) {
    skip();
    size_t end = next_;
    while (end < text_.size() && !space(text_[end])) ++end;
    T value{};
    const auto [stop, error] = std::from_chars(&text_[next_], &text_[0] + end, value);
    if (next_ == end || error != std::errc() || stop != &text_[0] + end || !(value >= low && value <= high)) {
      throw SceneError(fmt::format(
          "{}: line {}: {}: found {}, expected a number from {} to {}", file_, line_, what,
          next_ == end ? "the end of the file" : in_quotes(text_.substr(next_, end - next_)), low, high));
    }
    next_ = end;
    return value;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(fmt::format("{}: line {}: {}", file_, line_, what));
  }

 private:
  const std::string& file_;
  const std::string& text_;
  size_t next_ = 0;
  int line_ = 1;

  static bool space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void skip() {
    for (; next_ < text_.size() && space(text_[next_]); ++next_) line_ += text_[next_] == '\n';
  }
};

}  // namespace

MerlFunction read_merl_network(const std::string& file, const std::string& text) {
  Words words(file, text);
  std::vector<Layer> layers;
  int inputs = 6;
  do {
    Layer layer;
    const std::string name = fmt::format("layer {}", layers.size() + 1);
    layer.inputs = words.number(name + ", inputs", 1, kWidest);
    layer.outputs = words.number(name + ", outputs", 1, kWidest);
    if (layer.inputs != inputs) {
      words.fail(fmt::format("{}: found {} inputs, expected {}", name, layer.inputs, inputs));
    }
    for (int i = 0; i < layer.inputs * layer.outputs; ++i) {
      layer.weights.push_back(words.number(name + ", weight", -1e6f, 1e6f));
    }
    for (int i = 0; i < layer.outputs; ++i)
      layer.biases.push_back(words.number(name + ", bias", -1e6f, 1e6f));
    inputs = layer.outputs;
    layers.push_back(std::move(layer));
    if (layers.size() > 8) words.fail("found more than 8 layers, expected 3");
  } while (!words.at_end());
  if (inputs != 3)
    words.fail(fmt::format("last layer: found {} outputs, expected 3 (red, green, blue)", inputs));

  return [layers = std::move(layers)](const glm::dvec3& w_out, const glm::dvec3& w_in) {
    // Half vector turned to azimuth 0, and w_in in its frame.
    const glm::dvec3 sum = w_out + w_in;
    const double length = glm::length(sum), rho = std::hypot(sum.x, sum.y);
    const double cosine = rho > 0 ? sum.x / rho : 1, sine = rho > 0 ? sum.y / rho : 0;
    const double outward = cosine * w_in.x + sine * w_in.y, across = cosine * w_in.y - sine * w_in.x;
    const double sin_h = rho / length, cos_h = sum.z / length;
    std::array<float, kWidest> x{}, y{};
    x[0] = float(sin_h), x[1] = 0, x[2] = float(cos_h);
    x[3] = float(cos_h * outward - sin_h * w_in.z), x[4] = float(across), x[5] = float(0.5 * length);

    for (size_t i = 0; i < layers.size(); ++i) {
      layers[i].apply(x, &y);
      if (i + 1 < layers.size()) {
        for (int j = 0; j < layers[i].outputs; ++j) y[size_t(j)] = std::fmax(y[size_t(j)], 0.0f);
      }
      std::swap(x, y);
    }
    glm::dvec3 f;
    for (int c = 0; c < 3; ++c) f[c] = std::max(std::expm1(double(x[size_t(c)])), 0.0);
    return f;
  };
}

}  // namespace zonal
