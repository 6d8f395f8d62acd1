#include "core/flip.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace zonal {
namespace {

using Plane = std::vector<float>;

// ---- colours ----------------------------------------------------------------------------------------------

/// sRGB's primaries and white (IEC 61966-2-1) as a matrix to XYZ, row by row, and its inverse; to the digits
/// that the authors' program has, whose white is (0.950429, 1, 1.088900).
constexpr float kToXyz[9] = {0.412386563f,  0.357591491f,  0.180450491f, 0.212636822f, 0.715182982f,
                             0.0721801965f, 0.0193306202f, 0.119197164f, 0.950372587f};
constexpr float kToRgb[9] = {3.24100323f,   -1.53739897f,  -0.498615882f, -0.969224252f, 1.87592998f,
                             0.0415542263f, 0.0556394199f, -0.204011206f, 1.05714898f};
constexpr float kWhite[3] = {kToXyz[0] + kToXyz[1] + kToXyz[2], kToXyz[3] + kToXyz[4] + kToXyz[5],
                             kToXyz[6] + kToXyz[7] + kToXyz[8]};

/// One row of a 3x3 matrix times (x, y, z).
float dot(const float* row, float x, float y, float z) {
  return row[0] * x + row[1] * y + row[2] * z;
}

/// Cube root of x > 0 without a call, so that loops of it vectorise: a third of the exponent's bits as a
/// first guess (error below 4 %), then two of Halley's steps, each of which cubes the relative error.
float cube_root(float x) {
  float y = std::bit_cast<float>(std::bit_cast<uint32_t>(x) / 3 + 709921077u);
  for (int i = 0; i < 2; ++i) {
    const float cube = y * y * y;
    y *= (cube + 2 * x) / (2 * cube + x);
  }
  return y;
}

/// CIE L*a*b*'s compression of a tristimulus value: linear below (6/29)^3.
float lab_curve(float t) {
  constexpr float kDelta = 6.0f / 29;
  return t > kDelta * kDelta * kDelta ? cube_root(std::max(t, 1e-9f)) : t / (3 * kDelta * kDelta) + 4.0f / 29;
}

struct Lab {
  float l, a, b;
};

/// L*a*b* of a linear colour; a* and b* shrink with L*, for dark colours look less saturated (Hunt's effect).
Lab hunt_lab(float red, float green, float blue) {
  const float x = lab_curve(dot(kToXyz, red, green, blue) / kWhite[0]);
  const float y = lab_curve(dot(kToXyz + 3, red, green, blue) / kWhite[1]);
  const float z = lab_curve(dot(kToXyz + 6, red, green, blue) / kWhite[2]);
  const float l = 116 * y - 16;
  return {l, 0.01f * l * 500 * (x - y), 0.01f * l * 200 * (y - z)};
}

/// HyAB (Abasi et al. 2020): lightness and colour differ apart from each other.
float hyab(float l, float a, float b) {
  return std::fabs(l) + std::sqrt(a * a + b * b);
}

// ---- filters ----------------------------------------------------------------------------------------------

/// Weights of a filter along one axis, taps -reach..reach.
struct Filter {
  int reach;
  std::vector<float> weights;
  template <class Function>
  Filter(int reach_in, Function f) : reach(reach_in) {
    for (int i = -reach; i <= reach; ++i) weights.push_back(static_cast<float>(f(i)));
  }
  /// Positive weights are made to sum to 1, negative ones to -1.
  Filter normalized() const {
    double positive = 0, negative = 0;
    for (const float w : weights) (w > 0 ? positive : negative) += std::fabs(w);
    Filter result = *this;
    for (float& w : result.weights) w = static_cast<float>(w / (w > 0 ? positive : negative));
    return result;
  }
  double sum() const {
    double total = 0;
    for (const float w : weights) total += w;
    return total;
  }
};

/// out[x] = sum of weights[k] sources[k][x]: both directions of a filter are this, over shifts of one row or
/// over rows. Blocks stay in registers.
void weighted_sum(const Filter& filter, const float* const* sources, float* out, int count) {
  constexpr int kBlock = 64;
  int x = 0;
  for (; x + kBlock <= count; x += kBlock) {
    float sum[kBlock] = {};
    for (size_t k = 0; k < filter.weights.size(); ++k) {
      const float w = filter.weights[k];
      const float* source = sources[k] + x;
      for (int i = 0; i < kBlock; ++i) sum[i] += w * source[i];
    }
    std::copy(sum, sum + kBlock, out + x);
  }
  for (; x < count; ++x) {
    float sum = 0;
    for (size_t k = 0; k < filter.weights.size(); ++k) sum += filter.weights[k] * sources[k][x];
    out[x] = sum;
  }
}

/// The picture goes on beyond its edges with the pixels there.
Plane filtered_rows(const Plane& in, int width, int height, const Filter& filter) {
  Plane out(in.size()), padded(width + 2 * filter.reach);
  std::vector<const float*> sources(filter.weights.size());
  for (size_t k = 0; k < sources.size(); ++k) sources[k] = padded.data() + k;
  for (int y = 0; y < height; ++y) {
    const float* row = in.data() + size_t(y) * width;
    std::fill_n(padded.begin(), filter.reach, row[0]);
    std::copy(row, row + width, padded.begin() + filter.reach);
    std::fill_n(padded.end() - filter.reach, filter.reach, row[width - 1]);
    weighted_sum(filter, sources.data(), out.data() + size_t(y) * width, width);
  }
  return out;
}

Plane filtered_columns(const Plane& in, int width, int height, const Filter& filter) {
  Plane out(in.size());
  std::vector<const float*> sources(filter.weights.size());
  for (int y = 0; y < height; ++y) {
    for (int k = -filter.reach; k <= filter.reach; ++k)
      sources[k + filter.reach] = in.data() + size_t(std::clamp(y + k, 0, height - 1)) * width;
    weighted_sum(filter, sources.data(), out.data() + size_t(y) * width, width);
  }
  return out;
}

/// One Gaussian of a contrast sensitivity function: a sqrt(pi/b) exp(-pi^2 x^2 / b), x in degrees.
struct Sensitivity {
  double a, b;
};
// The paper's table 1: achromatic, red-green; blue-yellow is a sum of two.
constexpr Sensitivity kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053},
    kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

/// Blurs a channel as the eye does; of several Gaussians each counts by its share of the volume.
Plane blurred(const Plane& channel, int width, int height, float ppd,
              std::initializer_list<Sensitivity> eye) {
  // Three standard deviations of the widest Gaussian, b = 0.04.
  const int reach = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * M_PI * M_PI)) * ppd));
  const auto gaussian = [&](const Sensitivity& s) {
    return Filter(reach, [&](int i) { return std::exp(-M_PI * M_PI * (i / ppd) * (i / ppd) / s.b); });
  };
  const auto volume = [&](const Sensitivity& s) {
    const double sum = gaussian(s).sum();
    return s.a * std::sqrt(M_PI / s.b) * sum * sum;
  };
  double total = 0;
  for (const Sensitivity& s : eye) total += volume(s);
  Plane result(channel.size());
  for (const Sensitivity& s : eye) {
    const Filter filter = gaussian(s).normalized();
    const Plane one = filtered_columns(filtered_rows(channel, width, height, filter), width, height, filter);
    const float share = static_cast<float>(volume(s) / total);
    for (size_t i = 0; i < result.size(); ++i) result[i] += share * one[i];
  }
  return result;
}

Plane length_of(const Plane& x, const Plane& y) {
  Plane length(x.size());
  for (size_t i = 0; i < x.size(); ++i) length[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return length;
}

/// Edges and points of the luminance: derivatives of a Gaussian 0.082 degrees wide.
void find_features(const Plane& luminance, float ppd, FlipView* view) {
  const double sigma = 0.5 * 0.082 * ppd;
  const int reach = static_cast<int>(std::ceil(3 * sigma)), w = view->width, h = view->height;
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  const Filter smooth = Filter(reach, gaussian).normalized();
  const Filter slope = Filter(reach, [&](int i) { return -i * gaussian(i); }).normalized();
  const Filter bend =
      Filter(reach, [&](int i) { return (i * i / (sigma * sigma) - 1) * gaussian(i); }).normalized();
  const Plane along = filtered_rows(luminance, w, h, smooth);
  view->edges = length_of(filtered_columns(filtered_rows(luminance, w, h, slope), w, h, smooth),
                          filtered_columns(along, w, h, slope));
  view->points = length_of(filtered_columns(filtered_rows(luminance, w, h, bend), w, h, smooth),
                           filtered_columns(along, w, h, bend));
}

// ---- the difference
// -----------------------------------------------------------------------------------------

constexpr float kColorPower = 0.7f;            // q_c
constexpr float kKnee = 0.4f, kShare = 0.95f;  // p_c, p_t
constexpr float kFeaturePower = 0.5f;          // q_f

/// The largest colour difference there is, between green and blue.
float largest_color_difference() {
  const Lab green = hunt_lab(0, 1, 0), blue = hunt_lab(0, 0, 1);
  return std::pow(hyab(green.l - blue.l, green.a - blue.a, green.b - blue.b), kColorPower);
}

/// Differences up to 0.4 of the largest take 95 % of the scale, those beyond the rest:
/// small differences are the ones that tell pictures apart.
float redistributed(float difference, float largest) {
  const float knee = kKnee * largest;
  return difference < knee ? kShare / knee * difference
                           : kShare + (difference - knee) / (largest - knee) * (1 - kShare);
}

}  // namespace

FlipView flip_view(const Image& rgb, float ppd) {
  FlipView view{
      .width = rgb.width, .height = rgb.height, .lightness = {}, .a = {}, .b = {}, .edges = {}, .points = {}};
  const size_t count = size_t(rgb.width) * rgb.height;
  // YCxCz, a linearised L*a*b*, without its factors and its shift: they pass the blur unchanged, and near
  // black they would cost digits.
  Plane luminance(count), red_green(count), blue_yellow(count);
  for (size_t i = 0; i < count; ++i) {
    const float* c = rgb.pixels.data() + 3 * i;
    const float y = dot(kToXyz + 3, c[0], c[1], c[2]) / kWhite[1];
    luminance[i] = y;
    red_green[i] = dot(kToXyz, c[0], c[1], c[2]) / kWhite[0] - y;
    blue_yellow[i] = y - dot(kToXyz + 6, c[0], c[1], c[2]) / kWhite[2];
  }
  find_features(luminance, ppd, &view);
  view.lightness = blurred(luminance, view.width, view.height, ppd, {kAchromatic});
  view.a = blurred(red_green, view.width, view.height, ppd, {kRedGreen});
  view.b = blurred(blue_yellow, view.width, view.height, ppd, {kBlueYellow[0], kBlueYellow[1]});
  // Back to RGB, which the blur may have left, and on to L*a*b*.
  for (size_t i = 0; i < count; ++i) {
    const float y = view.lightness[i];
    const float X = kWhite[0] * (y + view.a[i]), Y = kWhite[1] * y, Z = kWhite[2] * (y - view.b[i]);
    const auto clamped = [&](const float* row) { return std::clamp(dot(row, X, Y, Z), 0.0f, 1.0f); };
    const Lab lab = hunt_lab(clamped(kToRgb), clamped(kToRgb + 3), clamped(kToRgb + 6));
    view.lightness[i] = lab.l, view.a[i] = lab.a, view.b[i] = lab.b;
  }
  return view;
}

Image flip_difference(const FlipView& x, const FlipView& r) {
  Image map(x.width, x.height, 1);
  const float largest = largest_color_difference();
  for (size_t i = 0; i < map.pixels.size(); ++i) {
    const float color = redistributed(
        std::pow(hyab(x.lightness[i] - r.lightness[i], x.a[i] - r.a[i], x.b[i] - r.b[i]), kColorPower),
        largest);
    const float feature = std::max(std::fabs(x.edges[i] - r.edges[i]), std::fabs(x.points[i] - r.points[i]));
    // A feature that only one of them has makes the colour difference look larger.
    map.pixels[i] = std::pow(color, 1 - std::pow(feature / std::sqrt(2.0f), kFeaturePower));
  }
  return map;
}

FlipReference::FlipReference(const Image& reference, float pixels_per_degree)
    : pixels_per_degree_(pixels_per_degree), linear_(reference.width, reference.height) {
  for (int y = 0; y < linear_.height; ++y) {
    for (int x = 0; x < linear_.width; ++x) {
      const vec3 c = reference.rgb(x, y);
      usable_.push_back(is_finite(c));
      for (int k = 0; k < 3; ++k) linear_.at(x, y)[k] = usable_.back() ? srgb_decode(c[k]) : 0;
    }
  }
  view_ = flip_view(linear_, pixels_per_degree_);
}

Image FlipReference::map(const Image& image) const {
  // What is no number shows the reference's colour, so that its neighbours see no difference there.
  Image shown = linear_;
  std::vector<bool> usable = usable_;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const vec3 c = image.rgb(x, y);
      const size_t i = size_t(y) * image.width + x;
      usable[i] = usable[i] && is_finite(c);
      for (int k = 0; k < 3 && usable[i]; ++k) shown.at(x, y)[k] = srgb_decode(c[k]);
    }
  }
  Image map = flip_difference(flip_view(shown, pixels_per_degree_), view_);
  for (size_t i = 0; i < usable.size(); ++i)
    if (!usable[i]) map.pixels[i] = std::numeric_limits<float>::quiet_NaN();
  return map;
}

Image flip_map(const Image& image, const Image& reference, float pixels_per_degree) {
  return FlipReference(reference, pixels_per_degree).map(image);
}

double mean_of_map(const Image& map) {
  double sum = 0;
  size_t count = 0;
  for (const float value : map.pixels)
    if (!std::isnan(value)) sum += value, ++count;
  return count ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace zonal
