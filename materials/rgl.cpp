#include "materials/rgl.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/sampling.h"

namespace zonal {
namespace {

/// Samples beyond this are no measurement; below it every product stays a float.
constexpr double kLargest = 1e10;

/// The paper's map of directions on the unit square: finer near the normal.
float square_of_theta(float theta) {
  return std::sqrt(theta * (2.0f / kPi));
}
float square_of_phi(float phi) {
  const float u = phi * (0.5f / kPi) + 0.5f;
  return u - std::floor(u);
}
/// The interval of `knots` that holds x, and the place in it; beyond the ends the end.
struct Interval {
  uint32_t first = 0, count = 1;
  float second_weight = 0;

  Interval(const std::vector<float>& knots, float x) {
    if (knots.size() < 2) return;
    const auto above = std::upper_bound(knots.begin(), knots.end(), x);
    first = static_cast<uint32_t>(std::clamp<std::ptrdiff_t>(above - knots.begin() - 1, 0,
                                                             static_cast<std::ptrdiff_t>(knots.size()) - 2));
    const float a = knots[first], b = knots[first + 1];
    second_weight = std::min(std::max((x - a) / (b - a), 0.0f), 1.0f);
    count = 2;
  }
  float weight(uint32_t i) const { return i == 0 ? 1.0f - second_weight : second_weight; }
};

std::vector<float> ascending(const TensorFile& tensors, const char* name, Range range) {
  std::vector<float> values = tensors.floats(tensors.require(name, TensorType::f32, {kAnyLength}), range);
  for (size_t i = 1; i < values.size(); ++i)
    if (!(values[i - 1] < values[i]))
      tensors.fail(name,
                   fmt::format("found {} after {}, expected ascending numbers", values[i], values[i - 1]));
  return values;
}

}  // namespace

struct RglBrdf::View {
  vec3 w_out;
  vec2 flip{1.0f};  ///< signs that take x and y where the data are
  vec2 turn{1, 0};  ///< isotropic: cosine and sine of w_out's azimuth, which half vectors are measured from
  SliceMix mix;
  float scale = 1;  ///< 1 / (4 sigma)
};

struct RglBrdf::Place {
  vec2 u{0};           ///< the half vector on the unit square
  float jacobian = 1;  ///< solid angle of w_in per area of that square
};

float RglBrdf::Grid::at(vec2 p) const {
  const GridCell cell(p, width, height);
  const float* row =
      &values[static_cast<size_t>(cell.y) * static_cast<size_t>(width) + static_cast<size_t>(cell.x)];
  const float top = row[0] + cell.along * (row[1] - row[0]);
  const float low = row[width] + cell.along * (row[width + 1] - row[width]);
  return top + cell.down * (low - top);
}

RglBrdf::RglBrdf(const TensorFile& tensors) {
  file = tensors.file();
  if (tensors.find("spectra") && !tensors.find("rgb"))
    tensors.fail("rgb",
                 "found none but \"spectra\", expected colours: take the file of this material that ends in "
                 "_rgb.bsdf");
  for (const char c : tensors.bytes(tensors.require("description", TensorType::u8, {kAnyLength})))
    description += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
  const std::string_view jacobian = tensors.bytes(tensors.require("jacobian", TensorType::u8, {1}));
  if (jacobian[0] != 0 && jacobian[0] != 1)
    tensors.fail("jacobian",
                 fmt::format("found {}, expected 0 or 1", static_cast<unsigned char>(jacobian[0])));
  scaled_ = jacobian[0] == 1;

  // Which directions the slices stand for.
  theta_ = ascending(tensors, "theta_i", {0, 1.5708});
  phi_ = ascending(tensors, "phi_i", {-6.2832, 6.2832});
  isotropic_ = phi_.size() <= 2;
  if (!isotropic_) {
    const float range = phi_.back() - phi_.front();
    reduction_ = static_cast<int>(std::lround(std::min(2.0f * kPi / range, 100.0f)));
    if (reduction_ != 1 && reduction_ != 2 && reduction_ != 4)
      tensors.fail("phi_i", fmt::format("found azimuths over {:.1f} degrees, expected about 360, 180 or 90",
                                        range * 180 / kPi));
    const float middle = 0.5f * (phi_.front() + phi_.back());
    middle_ = {std::cos(middle), std::sin(middle)};
  }

  const uint64_t slices_phi = phi_.size(), slices_theta = theta_.size();
  const auto grid = [&](const char* name, Range range) {
    const TensorField& field = tensors.require(name, TensorType::f32, {kAnyLength, kAnyLength});
    if (field.shape[0] < 2 || field.shape[1] < 2)
      tensors.fail(name, fmt::format("found {} x {} numbers, expected at least 2 x 2", field.shape[0],
                                     field.shape[1]));
    return Grid{static_cast<int>(field.shape[1]), static_cast<int>(field.shape[0]),
                tensors.floats(field, range)};
  };
  ndf_ = grid("ndf", {0, kLargest});
  sigma_ = grid("sigma", {1e-6, kLargest});

  const TensorField& normals =
      tensors.require("vndf", TensorType::f32, {slices_phi, slices_theta, kAnyLength, kAnyLength});
  const TensorField& weights =
      tensors.require("luminance", TensorType::f32, {slices_phi, slices_theta, kAnyLength, kAnyLength});
  const uint64_t side = weights.shape[3];
  const TensorField& rgb = tensors.require("rgb", TensorType::f32, {slices_phi, slices_theta, 3, side, side});
  tensors.require("luminance", TensorType::f32, {slices_phi, slices_theta, side, side});
  if (side < 2 || normals.shape[2] < 2 || normals.shape[3] < 2)
    tensors.fail(side < 2 ? "rgb" : "vndf",
                 "found slices of one row or column, expected at least 2 x 2 numbers");
  side_ = static_cast<int>(side);

  tables_.normals = WarpGrid(static_cast<int>(normals.shape[3]), static_cast<int>(normals.shape[2]),
                             tensors.floats(normals, {0, kLargest}));
  for (size_t i = 0; i < tables_.normals.slices(); ++i)
    if (tables_.normals.is_empty(i))
      tensors.fail("vndf", fmt::format("found zeros alone for elevation {} of {}, expected a density",
                                       i % theta_.size() + 1, theta_.size()));
  // Measured luminance may be a little below zero; the warp takes that as zero.
  luminance_ = WarpGrid(side_, side_, tensors.floats(weights, {-kLargest, kLargest}));

  const std::vector<float> samples = tensors.floats(rgb, {-kLargest, kLargest});
  const size_t area = side * side, slices = slices_phi * slices_theta;
  tables_.colors.resize(slices * area);
  for (size_t slice = 0; slice < slices; ++slice)
    for (size_t i = 0; i < area; ++i) {
      vec4& c = tables_.colors[slice * area + i];
      for (int k = 0; k < 3; ++k) c[k] = samples[(slice * 3 + static_cast<size_t>(k)) * area + i];
      c.w = luminance_.vertex_density(slice, i);
    }
  negative_samples =
      static_cast<size_t>(std::count_if(samples.begin(), samples.end(), [](float x) { return x < 0.0f; }));
  estimate_albedo();
}

inline RglBrdf::View RglBrdf::view(vec3 w_out) const {
  View v;
  if (reduction_ == 4) {
    v.flip = {w_out.x * middle_.x < 0.0f ? -1.0f : 1.0f, w_out.y * middle_.y < 0.0f ? -1.0f : 1.0f};
  } else if (reduction_ == 2 && w_out.x * middle_.x + w_out.y * middle_.y < 0.0f) {
    v.flip = vec2(-1.0f);
  }
  w_out.x *= v.flip.x, w_out.y *= v.flip.y;
  v.w_out = w_out;

  const float sine = std::sqrt(w_out.x * w_out.x + w_out.y * w_out.y);
  const float theta = std::atan2(sine, w_out.z);
  float phi = std::atan2(w_out.y, w_out.x);
  if (scaled_) v.scale = 0.25f / sigma_.at({square_of_theta(theta), square_of_phi(phi)});
  if (isotropic_) {
    if (sine > 0.0f) v.turn = vec2(w_out.x, w_out.y) / sine;
  } else if (phi < phi_.front()) {
    phi += 2.0f * kPi;
  } else if (phi > phi_.back()) {
    phi -= 2.0f * kPi;
  }

  const Interval t(theta_, theta), p(phi_, phi);
  v.mix.count = static_cast<int>(t.count * p.count);
  for (uint32_t i = 0; i < p.count; ++i)
    for (uint32_t j = 0; j < t.count; ++j) {
      v.mix.index[i * t.count + j] = (p.first + i) * static_cast<uint32_t>(theta_.size()) + t.first + j;
      v.mix.weight[i * t.count + j] = p.weight(i) * t.weight(j);
    }
  return v;
}

/// `half` = w_out + w_in, in the data's frame, of any length.
inline RglBrdf::Place RglBrdf::place(const View& v, vec3 half) const {
  const float x = half.x * v.turn.x + half.y * v.turn.y, y = half.y * v.turn.x - half.x * v.turn.y;
  Place p;
  const float across2 = x * x + y * y, across = std::sqrt(across2), length2 = across2 + half.z * half.z;
  p.u = {square_of_theta(std::atan2(across, half.z)), square_of_phi(std::atan2(y, x))};
  // With d theta = pi u du and d phi = 2 pi du', the solid angle of m is 2 pi^2 u sin(theta) of the square's
  // area, and that of w_in 4 (m.w_out) times as much; |w_out + w_in| = 2 m.w_out. At the pole the area
  // vanishes, hence the floor.
  const float length = std::sqrt(length2);
  p.jacobian = std::max(2.0f * kPi * kPi * p.u.x * across / length, 1e-6f) * (2.0f * length);
  return p;
}

inline vec4 RglBrdf::color(const Tables& tables, const SliceMix& mix, vec2 s) const {
  const GridCell cell(s, side_, side_);
  const size_t side = static_cast<size_t>(side_);
  const size_t first = static_cast<size_t>(cell.y) * side + static_cast<size_t>(cell.x);
  vec4 sum(0.0f);
  for (size_t i = 0; i < static_cast<size_t>(mix.count); ++i) {
    const vec4* c = &tables.colors[mix.index[i] * side * side + first];
    const vec4 top = c[0] + cell.along * (c[1] - c[0]), low = c[side] + cell.along * (c[side + 1] - c[side]);
    sum += mix.weight[i] * (top + cell.down * (low - top));
  }
  return sum;
}

/// (RGL-1)
inline vec3 RglBrdf::value(const View& v, const Place& p, vec4 c, float cosine) const {
  const float factor = (scaled_ ? ndf_.at(p.u) * v.scale : 1.0f) / std::max(cosine, kSmallestCosine);
  return glm::max(vec3(c) * factor, vec3(0.0f));
}

/// Of the data's own sampling.
inline float RglBrdf::density(const Place& p, float normals, float colors) const {
  return normals * std::max(colors, 0.0f) / p.jacobian;
}

vec3 RglBrdf::evaluate(vec3 w_out, vec3 w_in) const {
  if (!(w_out.z > 0.0f) || !(w_in.z > 0.0f)) return vec3(0.0f);
  const View v = view(w_out);
  const Place p = place(v, v.w_out + vec3(w_in.x * v.flip.x, w_in.y * v.flip.y, w_in.z));
  return value(v, p, color(tables_, v.mix, tables_.normals.invert(v.mix, p.u)), w_in.z);
}

void RglBrdf::evaluate_with_pdf(vec3 w_out, vec3 w_in, vec3* f, float* pdf) const {
  *f = vec3(0.0f), *pdf = 0.0f;
  if (!(w_out.z > 0.0f) || !(w_in.z > 0.0f)) return;
  const View v = view(w_out);
  const Place p = place(v, v.w_out + vec3(w_in.x * v.flip.x, w_in.y * v.flip.y, w_in.z));
  float normals;
  const vec4 c = color(tables_, v.mix, tables_.normals.invert(v.mix, p.u, &normals));
  *f = value(v, p, c, w_in.z);
  *pdf = kCosineShare * w_in.z * kInvPi + (1.0f - kCosineShare) * density(p, normals, c.w);
}

float RglBrdf::pdf(vec3 w_out, vec3 w_in) const {
  vec3 f;
  float density;
  evaluate_with_pdf(w_out, w_in, &f, &density);
  return density;
}

vec3 RglBrdf::sample_direction(vec3 w_out, float u_lobe, vec2 u) const {
  if (!(w_out.z > 0.0f)) return vec3(0.0f);
  if (u_lobe < kCosineShare) return cosine_hemisphere(u);
  const View v = view(w_out);
  const vec2 m = tables_.normals.sample(v.mix, luminance_.sample(v.mix, u));

  const float theta = m.x * m.x * (0.5f * kPi), phi = (2.0f * m.y - 1.0f) * kPi;
  const float sine = std::sin(theta), x = sine * std::cos(phi), y = sine * std::sin(phi);
  const vec3 half(x * v.turn.x - y * v.turn.y, x * v.turn.y + y * v.turn.x, std::cos(theta));
  const vec3 w_in = glm::normalize(2.0f * glm::dot(v.w_out, half) * half - v.w_out);
  return {w_in.x * v.flip.x, w_in.y * v.flip.y, w_in.z};
}

void RglBrdf::evaluate_many(vec3 w_out, int n, const vec3* w_in, vec3* f) const {
  if (!(w_out.z > 0.0f)) {
    std::fill(f, f + n, vec3(0.0f));
    return;
  }
  const View v = view(w_out);
  // Mixing all of the slices first pays when there are more look-ups than a few per row of the grid.
  constexpr int kWorthMixing = 1024;
  const bool mixed = n >= kWorthMixing && v.mix.count > 1;
  Tables one;
  if (mixed) {
    one.normals = tables_.normals.blended(v.mix);
    const size_t area = static_cast<size_t>(side_) * static_cast<size_t>(side_);
    one.colors.assign(area, vec4(0.0f));
    for (size_t i = 0; i < static_cast<size_t>(v.mix.count); ++i)
      for (size_t j = 0; j < area; ++j)
        one.colors[j] += v.mix.weight[i] * tables_.colors[v.mix.index[i] * area + j];
  }
  const Tables& tables = mixed ? one : tables_;
  const SliceMix mix = mixed ? SliceMix{} : v.mix;

  for (int i = 0; i < n; ++i) {
    const vec3 w = w_in[i];
    if (!(w.z > 0.0f)) {
      f[i] = vec3(0.0f);
      continue;
    }
    const Place p = place(v, v.w_out + vec3(w.x * v.flip.x, w.y * v.flip.y, w.z));
    f[i] = value(v, p, color(tables, mix, tables.normals.invert(mix, p.u)), w.z);
  }
}

std::unique_ptr<MeasuredBrdf> load_rgl(const std::string& file) {
  return std::make_unique<RglBrdf>(TensorFile(file));
}

}  // namespace zonal
