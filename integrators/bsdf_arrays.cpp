#include "integrators/bsdf_arrays.h"

#include <algorithm>
#include <array>
#include <bit>

#include "core/glsl.h"
#include "materials/measured_brdf.h"
#include "materials/microfacet.h"

// Loops over the kernel become vectors when every call in them is gone.
#undef KERNEL
#define KERNEL [[gnu::always_inline]] inline

namespace zonal {
#include "materials/brdf.glsl"

namespace {

using Entry = BsdfArrays::Entry;
constexpr int kRow = SpecularAlbedo::Row::kPoints;

enum class Fresnel { schlick, dielectric, conductor };

/// One evaluation of a GGX coat over a diffuse base, without a branch: what `evaluate_both` of
/// materials/bsdf.cpp does.
template <Fresnel kFresnel, bool kPdf>
[[gnu::always_inline]] inline void evaluate_lane(const Entry& e, const float* rows, float x, float y, float z,
                                                 float& r, float& g, float& b, float& pdf) {
  const float above = z > kMinCosine ? 1.0f : 0.0f;
  const float cos_in = std::fmax(z, kMinCosine);
  float cosine, density;
  const float lobe = e.specular * above *
                     brdf_ggx(vec3(e.ox, e.oy, e.oz), e.stretch, vec3(x, y, cos_in),
                              vec2(e.alpha_x, e.alpha_y), vec2(e.inverse_x, e.inverse_y), cosine, density);

  float fr, fg, fb;
  if constexpr (kFresnel == Fresnel::schlick) {
    const float m = brdf_schlick_weight(cosine);
    fr = e.f_r + (1.0f - e.f_r) * m, fg = e.f_g + (1.0f - e.f_g) * m, fb = e.f_b + (1.0f - e.f_b) * m;
  } else if constexpr (kFresnel == Fresnel::dielectric) {
    const float f = brdf_dielectric(cosine, e.f_r);
    fr = e.t_r * f, fg = e.t_g * f, fb = e.t_b * f;
  } else {
    fr = e.t_r * brdf_conductor(cosine, e.f_r, e.k_r);
    fg = e.t_g * brdf_conductor(cosine, e.f_g, e.k_g);
    fb = e.t_b * brdf_conductor(cosine, e.f_b, e.k_b);
  }
  r = fr * lobe, g = fg * lobe, b = fb * lobe;

  if constexpr (kFresnel != Fresnel::conductor) {
    // What the coat keeps, from its table over the fourth root of the cosine.
    const float at = brdf_coat_place(cos_in, float(kRow));
    const int node = static_cast<int>(std::fmin(at, kRow - 2.0f));
    const float* row = rows + static_cast<int>(e.row) * kRow;
    const float low = row[node], kept = low + (at - static_cast<float>(node)) * (row[node + 1] - low);
    const float base = above * (1.0f - e.coat * kept);
    r += e.d_r * base, g += e.d_g * base, b += e.d_b * base;
  }
  if constexpr (kPdf) {
    pdf = above * (e.share * density + e.diffuse_share * cos_in * kInvPi);
  }
}

/// The members of entry i, read from their arrays.
inline Entry read(const float* numbers, int stride, int i) {
  const float* n = numbers + i;
  Entry e;
  e.alpha_x = n[0], e.alpha_y = n[stride], e.inverse_x = n[2 * stride], e.inverse_y = n[3 * stride];
  e.ox = n[4 * stride], e.oy = n[5 * stride], e.oz = n[6 * stride], e.stretch = n[7 * stride];
  e.specular = n[8 * stride], e.share = n[9 * stride];
  e.f_r = n[10 * stride], e.f_g = n[11 * stride], e.f_b = n[12 * stride];
  e.k_r = n[13 * stride], e.k_g = n[14 * stride], e.k_b = n[15 * stride];
  e.t_r = n[16 * stride], e.t_g = n[17 * stride], e.t_b = n[18 * stride];
  e.d_r = n[19 * stride], e.d_g = n[20 * stride], e.d_b = n[21 * stride];
  e.coat = n[22 * stride], e.row = n[23 * stride], e.diffuse_share = n[24 * stride];
  return e;
}

// Without __restrict the tables of coats might be what is written.
template <Fresnel kFresnel, bool kPdf>
void evaluate_each(const float* numbers, int stride, int first, int count, const float* rows, const float* x,
                   const float* y, const float* z, float* __restrict r, float* __restrict g,
                   float* __restrict b, float* __restrict pdf) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    float fr, fg, fb, density = 0;
    evaluate_lane<kFresnel, kPdf>(read(numbers, stride, first + i), rows, x[i], y[i], z[i], fr, fg, fb,
                                  density);
    r[i] = fr, g[i] = fg, b[i] = fb;
    if constexpr (kPdf) pdf[i] = density;
  }
}

template <Fresnel kFresnel>
void evaluate_all(const Entry& e, const float* rows, int count, const float* x, const float* y,
                  const float* z, float* __restrict r, float* __restrict g, float* __restrict b) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    float fr, fg, fb, unused;
    evaluate_lane<kFresnel, false>(e, rows, x[i], y[i], z[i], fr, fg, fb, unused);
    r[i] = fr, g[i] = fg, b[i] = fb;
  }
}

template <Fresnel kFresnel>
void multiply_by_all(const Entry& e, const float* rows, int count, const float* x, const float* y,
                     const float* z, const float* weights, vec3 color, float most, float* __restrict r,
                     float* __restrict g, float* __restrict b) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    float fr, fg, fb, unused;
    evaluate_lane<kFresnel, false>(e, rows, x[i], y[i], z[i], fr, fg, fb, unused);
    r[i] = std::fmin(r[i] * weights[i] * (fr * color.x), most);
    g[i] = std::fmin(g[i] * weights[i] * (fg * color.y), most);
    b[i] = std::fmin(b[i] * weights[i] * (fb * color.z), most);
  }
}

bool is_measured_from_camera(const Bsdf& bsdf, const BsdfContext& view, Lobes lobes) {
  return bsdf.kind == BsdfKind::measured && view.end == PathEnd::camera && has(lobes, Lobes::specular);
}

}  // namespace

BsdfArrays::BsdfArrays(int count)
    : count_(count),
      classes_(static_cast<size_t>(count)),
      numbers_(static_cast<size_t>(count) * kNumbers),
      rows_(kRow, 0.0f),
      single_of_(static_cast<size_t>(count)) {}

float BsdfArrays::row_of(const SpecularAlbedo::Row& row) {
  // Materials without a roughness texture have one row; textured ones rarely meet the same again.
  const auto newest = coats_.rbegin();
  const auto oldest = coats_.size() > 32 ? newest + 32 : coats_.rend();
  const auto known = std::find(newest, oldest, row);
  if (known != oldest) return static_cast<float>(coats_.rend() - known);
  coats_.push_back(row);
  rows_.resize(rows_.size() + kRow);
  row.tabulate(&rows_[coats_.size() * kRow]);
  return static_cast<float>(coats_.size());
}

void BsdfArrays::set(int i, const Bsdf& bsdf, const BsdfContext& view, Lobes lobes) {
  Entry e;
  Class kind = Class::constant;
  const bool seen = view.w_out.z > kMinCosine && bsdf.kind != BsdfKind::black;
  const bool diffuse = seen && has(lobes, Lobes::diffuse) && !is_black(bsdf.diffuse);
  e.ox = view.w_out.x, e.oy = view.w_out.y, e.oz = std::fmax(view.w_out.z, kMinCosine);
  vec3 base(0);
  if (seen && bsdf.kind == BsdfKind::lambert) {
    if (diffuse) base = bsdf.diffuse * kInvPi;
    e.diffuse_share = 1;
  } else if (seen && (bsdf.kind == BsdfKind::blinn_phong || bsdf.kind == BsdfKind::measured ||
                      (diffuse && bsdf.coat && bsdf.coat->aspect() != 1.0f))) {
    kind = Class::other;
    single_of_[i] = static_cast<int>(singles_.size());
    singles_.push_back({bsdf, view, lobes});
  } else if (seen) {
    kind = bsdf.kind == BsdfKind::conductor ? Class::conductor
           : bsdf.kind == BsdfKind::coated  ? Class::dielectric
                                            : Class::schlick;
    e.alpha_x = bsdf.alpha_x, e.alpha_y = bsdf.alpha_y;
    e.inverse_x = 1.0f / e.alpha_x, e.inverse_y = 1.0f / e.alpha_y;
    e.stretch = view.stretch_out;
    e.specular = has(lobes, Lobes::specular) ? 1.0f : 0.0f;
    e.share = view.specular_share;
    e.diffuse_share = 1.0f - e.share;
    const vec3 f = kind == Class::schlick ? bsdf.specular : bsdf.eta;
    e.f_r = f.x, e.f_g = f.y, e.f_b = f.z;
    e.k_r = bsdf.k.x, e.k_g = bsdf.k.y, e.k_b = bsdf.k.z;
    e.t_r = bsdf.specular.x, e.t_g = bsdf.specular.y, e.t_b = bsdf.specular.z;
    if (diffuse && kind != Class::conductor && view.normalization > 0) {
      base = bsdf.diffuse * view.normalization;
      e.coat = 1, e.row = row_of(view.coat);
    }
  }
  e.d_r = base.x, e.d_g = base.y, e.d_b = base.z;
  classes_[i] = kind;
  const auto values = std::bit_cast<std::array<float, kNumbers>>(e);
  for (int m = 0; m < kNumbers; ++m) numbers_[size_t(m) * count_ + i] = values[m];
}

void BsdfArrays::finish() {
  // Where Lambert lies between Schlick's kinds it is evaluated as one of them, so that runs are long.
  const bool schlick = std::find(classes_.begin(), classes_.end(), Class::schlick) != classes_.end();
  if (schlick) std::replace(classes_.begin(), classes_.end(), Class::constant, Class::schlick);
  runs_.clear();
  run_of_.resize(static_cast<size_t>(count_));
  for (int i = 0; i < count_; ++i) {
    if (runs_.empty() || runs_.back().kind != classes_[i]) runs_.push_back({i, i, classes_[i]});
    runs_.back().end = i + 1;
    run_of_[i] = static_cast<int>(runs_.size()) - 1;
  }
}

BsdfArrays::Entry BsdfArrays::entry(int i) const {
  return read(numbers_.data(), count_, i);
}

template <bool kPdf>
void BsdfArrays::evaluate_runs(int first, int end, const float* x, const float* y, const float* z, float* r,
                               float* g, float* b, float* pdf) const {
  for (int from = first; from < end;) {
    const Run& run = runs_[run_of_[from]];
    const int to = std::min(end, run.end), n = to - from, o = from - first;
    const auto each = [&](auto function) {
      function(numbers_.data(), count_, from, n, rows_.data(), x + o, y + o, z + o, r + o, g + o, b + o,
               kPdf ? pdf + o : nullptr);
    };
    switch (run.kind) {
      case Class::constant:
        for (int i = 0; i < n; ++i) {
          const float above = z[o + i] > kMinCosine ? 1.0f : 0.0f;
          r[o + i] = above * numbers_[size_t(19) * count_ + from + i];
          g[o + i] = above * numbers_[size_t(20) * count_ + from + i];
          b[o + i] = above * numbers_[size_t(21) * count_ + from + i];
          if constexpr (kPdf)
            pdf[o + i] = above * numbers_[size_t(24) * count_ + from + i] * z[o + i] * kInvPi;
        }
        break;
      case Class::schlick:
        each(evaluate_each<Fresnel::schlick, kPdf>);
        break;
      case Class::dielectric:
        each(evaluate_each<Fresnel::dielectric, kPdf>);
        break;
      case Class::conductor:
        each(evaluate_each<Fresnel::conductor, kPdf>);
        break;
      case Class::other:
        for (int i = 0; i < n; ++i) {
          const Single& s = singles_[single_of_[from + i]];
          const vec3 w(x[o + i], y[o + i], z[o + i]);
          const vec3 f = zonal::evaluate(s.bsdf, s.view, w, s.lobes);
          r[o + i] = f.x, g[o + i] = f.y, b[o + i] = f.z;
          if constexpr (kPdf) pdf[o + i] = zonal::pdf(s.bsdf, s.view, w);
        }
        break;
    }
    from = to;
  }
}

void BsdfArrays::evaluate(int first, int end, const float* x, const float* y, const float* z, float* r,
                          float* g, float* b) const {
  evaluate_runs<false>(first, end, x, y, z, r, g, b, nullptr);
}

void BsdfArrays::evaluate_with_pdf(int first, int end, const float* x, const float* y, const float* z,
                                   float* r, float* g, float* b, float* pdf) const {
  evaluate_runs<true>(first, end, x, y, z, r, g, b, pdf);
}

bool BsdfArrays::constant(int i, vec3* f) const {
  const Entry e = entry(i);
  const bool flat =
      classes_[i] == Class::constant || (classes_[i] == Class::schlick && e.specular == 0 && e.coat == 0);
  if (flat) *f = {e.d_r, e.d_g, e.d_b};
  return flat;
}

void BsdfArrays::multiply_by_one(int i, int n, const float* x, const float* y, const float* z,
                                 const float* weights, vec3 color, float most, float* r, float* g,
                                 float* b) const {
  vec3 flat;
  if (constant(i, &flat)) {
    flat *= color;
    for (int k = 0; k < n; ++k) {
      const float w = z[k] > kMinCosine ? weights[k] : 0.0f;
      r[k] = std::fmin(r[k] * (w * flat.x), most), g[k] = std::fmin(g[k] * (w * flat.y), most);
      b[k] = std::fmin(b[k] * (w * flat.z), most);
    }
    return;
  }
  const Entry e = entry(i);
  const auto all = [&](auto function) {
    function(e, rows_.data(), n, x, y, z, weights, color, most, r, g, b);
  };
  switch (classes_[i]) {
    case Class::schlick:
      return all(multiply_by_all<Fresnel::schlick>);
    case Class::dielectric:
      return all(multiply_by_all<Fresnel::dielectric>);
    case Class::conductor:
      return all(multiply_by_all<Fresnel::conductor>);
    default:
      break;
  }
  constexpr int kMany = 64;
  float fr[kMany], fg[kMany], fb[kMany];
  for (int from = 0; from < n; from += kMany) {
    const int m = std::min(kMany, n - from);
    evaluate_one(i, m, x + from, y + from, z + from, fr, fg, fb);
    for (int k = 0; k < m; ++k) {
      const float w = weights[from + k];
      r[from + k] = std::fmin(r[from + k] * w * (fr[k] * color.x), most);
      g[from + k] = std::fmin(g[from + k] * w * (fg[k] * color.y), most);
      b[from + k] = std::fmin(b[from + k] * w * (fb[k] * color.z), most);
    }
  }
}

void BsdfArrays::evaluate_one(int i, int n, const float* x, const float* y, const float* z, float* r,
                              float* g, float* b) const {
  vec3 flat;
  if (constant(i, &flat)) {
    for (int k = 0; k < n; ++k) {
      const float above = z[k] > kMinCosine ? 1.0f : 0.0f;
      r[k] = above * flat.x, g[k] = above * flat.y, b[k] = above * flat.z;
    }
    return;
  }
  const Entry e = entry(i);
  switch (classes_[i]) {
    case Class::schlick:
      return evaluate_all<Fresnel::schlick>(e, rows_.data(), n, x, y, z, r, g, b);
    case Class::dielectric:
      return evaluate_all<Fresnel::dielectric>(e, rows_.data(), n, x, y, z, r, g, b);
    case Class::conductor:
      return evaluate_all<Fresnel::conductor>(e, rows_.data(), n, x, y, z, r, g, b);
    default:
      break;
  }
  const Single& s = singles_[single_of_[i]];
  constexpr int kMany = 64;
  for (int from = 0; from < n; from += kMany) {
    const int m = std::min(kMany, n - from);
    vec3 w[kMany], f[kMany];
    for (int k = 0; k < m; ++k) w[k] = {x[from + k], y[from + k], z[from + k]};
    if (is_measured_from_camera(s.bsdf, s.view, s.lobes)) {
      s.bsdf.measured->evaluate(s.view.w_out, m, w, f);
    } else {
      for (int k = 0; k < m; ++k) f[k] = zonal::evaluate(s.bsdf, s.view, w[k], s.lobes);
    }
    for (int k = 0; k < m; ++k) r[from + k] = f[k].x, g[from + k] = f[k].y, b[from + k] = f[k].z;
  }
}

}  // namespace zonal
