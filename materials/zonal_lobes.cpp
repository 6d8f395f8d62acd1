#include "materials/zonal_lobes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "materials/blinn_phong.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"
#include "sh/quadrature.h"

namespace zonal {
namespace {

using dvec3 = glm::dvec3;
constexpr double kPiD = 3.14159265358979323846;

/// Blinn-Phong's exponent as the width of a GGX lobe that falls off alike near its peak: alpha^2 = 2 / (n +
/// 2).
double exponent_of_width(double alpha) {
  return 2 / (alpha * alpha) - 2;
}
float width_of_exponent(float exponent) {
  return std::sqrt(2.0f / (exponent + 2.0f));
}

/// One lobe without Fresnel, seen from one elevation, in double.
struct Lobe {
  bool ggx;
  double alpha, exponent, normalization, stretch_out;
  dvec3 w_out;

  Lobe(bool ggx, double alpha, double cos_out)
      : ggx(ggx),
        alpha(alpha),
        exponent(exponent_of_width(alpha)),
        w_out(-std::sqrt((1 - cos_out) * (1 + cos_out)), 0, cos_out) {
    const double n = exponent;
    normalization = (n + 2) * (n + 4) / (8 * kPiD * (std::exp2(-n / 2) + n));
    stretch_out = stretch(w_out);
  }
  double stretch(const dvec3& w) const {
    return std::sqrt(alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z);
  }

  /// BRDF, 1/sr; w.z >= 0.
  double operator()(const dvec3& w) const {
    const dvec3 sum = w_out + w;
    const double inverse2 = 1 / std::max(glm::dot(sum, sum), 1e-30);
    const double x2y2 = (sum.x * sum.x + sum.y * sum.y) * inverse2;
    if (!ggx) return normalization * std::exp(0.5 * exponent * std::log1p(-std::min(x2y2, 1.0 - 1e-15)));
    const double s = x2y2 / (alpha * alpha) + sum.z * sum.z * inverse2;
    return 0.5 / (kPiD * alpha * alpha * s * s * (w_out.z * stretch(w) + w.z * stretch_out));
  }

  /// (1 - h.w)^5 at the half vector.
  double schlick_weight(const dvec3& w) const {
    const dvec3 sum = w_out + w;
    const double m = 1 - std::min(0.5 * std::sqrt(glm::dot(sum, sum)), 1.0);
    return m * m * m * m * m;
  }

  /// Polar angle, towards the mirror direction, at which f cos peaks: between the normal and the mirror
  /// direction, by golden section.
  double peak() const {
    const double ratio = 0.6180339887498949, mirror = std::acos(w_out.z);
    const auto value = [&](double t) { return (*this)(dvec3(std::sin(t), 0, std::cos(t))) * std::cos(t); };
    double low = 0, high = mirror;
    double a = high - ratio * (high - low), b = low + ratio * (high - low), fa = value(a), fb = value(b);
    while (high - low > 1e-4 * mirror) {
      if (fa > fb) {
        high = b, b = a, fb = fa;
        a = high - ratio * (high - low), fa = value(a);
      } else {
        low = a, a = b, fa = fb;
        b = low + ratio * (high - low), fb = value(b);
      }
    }
    // A narrow lobe's peak is the mirror direction to well within a table's precision; say so exactly.
    const double t = 0.5 * (low + high);
    return value(t) > value(mirror) ? t : mirror;
  }
};

/// Angles to the axis, and P_l there times what turns an integral over circles into a zonal coefficient.
struct Circles {
  std::vector<double> angle, area;
  std::vector<double> legendre;  ///< [circle][l]: 2 pi sqrt((2l+1)/4pi) P_l(cos) sin(angle) weight

  /// Gauss-Legendre on panels that double from the lobe's width to 0.15 rad, where P_63 turns through 10 rad.
  explicit Circles(double width) {
    double low = 0, high = std::min(0.5 * width, 0.15);
    while (low < kPiD) {
      if (high > kPiD - 1e-3) high = kPiD;
      const sh::GaussLegendre rule = sh::gauss_legendre(8, low, high);
      for (size_t i = 0; i < rule.nodes.size(); ++i) add(rule.nodes[i], rule.weights[i]);
      low = high, high = std::min(2 * high, high + 0.15);
    }
  }
  void add(double theta, double weight) {
    angle.push_back(theta);
    area.push_back(std::sin(theta) * weight);
    const double x = std::cos(theta), scale = std::sqrt(kPiD) * std::sin(theta) * weight;
    double before = 0, p = 1;
    for (int l = 0; l < kMaxZonalBands; ++l) {
      legendre.push_back(scale * std::sqrt(2 * l + 1.0) * p);
      const double next = ((2 * l + 1) * x * p - l * before) / (l + 1);
      before = p, p = next;
    }
  }
};

/// Lobes by width and elevation, linear between nodes uniform in alpha^(1/4) and cosine^(1/4), as the coat's
/// albedo is, and for the same reason: features sit at cosine ~ alpha.
class LobeTable {
 public:
  static const LobeTable& ggx() {
    static const LobeTable table(true);
    return table;
  }
  static const LobeTable& blinn_phong() {
    static const LobeTable table(false);
    return table;
  }

  struct Found {
    float axis;     ///< cosine between axis and normal
    float albedo;   ///< what the lobe reflects without Fresnel
    float fresnel;  ///< cosine at which to take Fresnel
  };
  /// Also fills lobe[bands].
  Found look_up(float alpha, float cos_out, int bands, float* lobe) const {
    const float x = (fourth_root(alpha) - kFirstRoot) * ((kAlphas - 1) / (1.0f - kFirstRoot));
    const float y = fourth_root(cos_out) * (kCosines - 1);
    const int i = std::clamp(static_cast<int>(x), 0, kAlphas - 2);
    const int j = std::clamp(static_cast<int>(y), 0, kCosines - 2);
    const float u = std::clamp(x - float(i), 0.0f, 1.0f), v = std::clamp(y - float(j), 0.0f, 1.0f);
    const Row* rows[4] = {&row(i, j), &row(i, j + 1), &row(i + 1, j), &row(i + 1, j + 1)};
    const float weights[4] = {(1 - u) * (1 - v), (1 - u) * v, u * (1 - v), u * v};
    float root = 0, angle = 0, albedo = 0;
    for (int k = 0; k < 4; ++k) {
      root += weights[k] * rows[k]->axis_root;
      angle += weights[k] * rows[k]->fresnel_angle;
      albedo += weights[k] * rows[k]->albedo;
    }
    const float cosine = std::min(sqr(sqr(root)), 1.0f);
    const float inverse = 1.0f / cosine;
    for (int l = 0; l < bands; ++l) {
      lobe[l] = inverse * (weights[0] * rows[0]->lobe[l] + weights[1] * rows[1]->lobe[l] +
                           weights[2] * rows[2]->lobe[l] + weights[3] * rows[3]->lobe[l]);
    }
    return {cosine, albedo, 1.0f - angle};
  }

  std::span<const float> numbers() const {
    static_assert(sizeof(Row) == 67 * sizeof(float));
    return {&rows_[0].albedo, rows_.size() * 67};
  }

 private:
  static constexpr int kAlphas = 56, kCosines = 64;
  static constexpr float kFirstRoot = 0.1f;  ///< kMinAlpha^(1/4)
  static float fourth_root(float x) { return std::sqrt(std::sqrt(x)); }

  struct Row {
    float albedo = 1;         ///< what the lobe reflects without Fresnel
    float fresnel_angle = 0;  ///< 1 - cosine at which Schlick's (1 - cosine)^5 is the lobe's mean of it
    float axis_root =
        1;  ///< fourth root of the axis' cosine: linear along the nodes where the axis is the mirror
    float lobe[kMaxZonalBands];  ///< F_l times the axis' cosine, which is bounded by the lobe's albedo where
                                 ///< it is narrow
  };
  const Row& row(int i, int j) const { return rows_[size_t(i) * kCosines + j]; }

  explicit LobeTable(bool ggx) : rows_(size_t(kAlphas) * kCosines) {
    tbb::parallel_for(0, kAlphas, [&](int i) {
      const double root = kFirstRoot + (1.0 - kFirstRoot) * i / (kAlphas - 1);
      const double alpha = std::pow(root, 4);
      const Circles circles(alpha);
      for (int j = 0; j < kCosines; ++j) {
        const double cosine = std::max(std::pow(double(j) / (kCosines - 1), 4), 1e-7);
        fill(Lobe(ggx, alpha, cosine), circles, &rows_[size_t(i) * kCosines + j]);
      }
    });
  }

  static void fill(const Lobe& lobe, const Circles& circles, Row* row) {
    const double tilt = lobe.peak(), axis_cos = std::max(std::cos(tilt), 1e-7), axis_sin = std::sin(tilt);
    // A lobe about the mirror direction is narrower across the plane of incidence than along it, by the
    // cosine. Azimuths that are uniform on the circle stretched by it resolve both; the plane is a symmetry,
    // so half a turn does.
    constexpr int kAround = 32;
    const double narrow = std::max(lobe.w_out.z, 0.5 * lobe.alpha);
    double cos_psi[kAround], weight[kAround];
    for (int k = 0; k < kAround; ++k) {
      const double chi = kPiD * (k + 0.5) / kAround;
      const double c2 = sqr_d(std::cos(chi)), s2 = sqr_d(narrow * std::sin(chi));
      cos_psi[k] = std::copysign(std::sqrt(c2 / (c2 + s2)), std::cos(chi));
      weight[k] = narrow / (c2 + s2);  // dpsi/dchi
    }
    // Circles wholly below the horizon keep the value the last one above tends to. No light is there; but a
    // step down to 0, or any other, makes few bands ring above, most for rough lobes.
    const double below = lobe(dvec3(-1, 0, 0));
    double sums[kMaxZonalBands] = {}, albedo = 0, schlick = 0;
    for (size_t n = 0; n < circles.angle.size(); ++n) {
      const double c = std::cos(circles.angle[n]), s = std::sin(circles.angle[n]);
      double reflected = 0, cosines = 0;
      for (int k = 0; k < kAround; ++k) {
        const double z = c * axis_cos - s * axis_sin * cos_psi[k];
        if (z <= 0) continue;
        const double along = s * axis_cos * cos_psi[k] + c * axis_sin;
        const double across = s * std::sqrt(std::max(1 - sqr_d(cos_psi[k]), 0.0));
        const dvec3 w(along, across, z);
        const double share = lobe(w) * z * weight[k];
        reflected += share, cosines += z * weight[k];
        if (lobe.ggx) schlick += share * circles.area[n] * lobe.schlick_weight(w);
      }
      const double mean = cosines > 0 ? reflected / cosines : below;
      albedo += reflected * circles.area[n];
      const double* legendre = &circles.legendre[n * kMaxZonalBands];
      for (int l = 0; l < kMaxZonalBands; ++l) sums[l] += mean * legendre[l];
    }
    row->albedo = static_cast<float>(albedo * 2 * kPiD / kAround);
    row->fresnel_angle = static_cast<float>(std::pow(schlick / std::max(albedo, 1e-300), 0.2));
    row->axis_root = static_cast<float>(std::pow(axis_cos, 0.25));
    for (int l = 0; l < kMaxZonalBands; ++l) row->lobe[l] = static_cast<float>(sums[l] * axis_cos);
  }
  static double sqr_d(double x) { return x * x; }

  std::vector<Row> rows_;
};

/// Fresnel's mean over the lobe. Schlick's is linear in its weight, so it is exact at the weight's mean; a
/// conductor's is taken there too. The coat's albedo with Fresnel is in a table of its own.
vec3 mean_fresnel(const Bsdf& b, vec3 w_out, const LobeTable::Found& lobe) {
  switch (b.kind) {
    case BsdfKind::conductor:
      return b.specular * fresnel_conductor(lobe.fresnel, b.eta, b.k);
    case BsdfKind::coated:
      return b.specular * std::min(b.coat->row(b.alpha_x).at(w_out) / lobe.albedo, 1.0f);
    case BsdfKind::metallic_roughness:
      return fresnel_schlick(lobe.fresnel, b.specular);
    default:
      return b.specular;
  }
}

}  // namespace

std::string zonal_lobe_refusal(const Bsdf& b) {
  switch (b.kind) {
    case BsdfKind::measured:
      return "is measured: its lobes have no axis of symmetry";
    case BsdfKind::conductor:
    case BsdfKind::coated:
    case BsdfKind::metallic_roughness:
      if (b.alpha_x != b.alpha_y) return "is anisotropic: its lobe has no axis of symmetry";
      return "";
    default:
      return "";
  }
}

ZonalBrdf zonal_brdf(const Bsdf& b, const BsdfContext& view, int bands) {
  assert(bands >= 1 && bands <= kMaxZonalBands);
  ZonalBrdf z;
  const vec3 o = view.w_out;
  if (b.kind == BsdfKind::black || !(o.z > kMinCosine) || !has_zonal_lobe(b)) return z;

  // Under a coat the base is dimmed towards the light as well; its mean over the hemisphere cancels 1 -
  // E_avg.
  const bool under_coat = b.kind == BsdfKind::coated || b.kind == BsdfKind::metallic_roughness;
  z.diffuse = b.diffuse * (kInvPi * (under_coat ? 1.0f - view.specular_albedo_out : 1.0f));
  if (b.kind == BsdfKind::lambert || (b.kind == BsdfKind::blinn_phong && is_black(b.specular))) return z;
  if (b.kind == BsdfKind::conductor) z.diffuse = vec3(0.0f);

  const bool ggx = b.kind != BsdfKind::blinn_phong;
  const LobeTable& table = ggx ? LobeTable::ggx() : LobeTable::blinn_phong();
  const float alpha = ggx ? b.alpha_x : width_of_exponent(b.exponent);
  const LobeTable::Found found = table.look_up(alpha, std::min(o.z, 1.0f), bands, z.lobe.data());
  const float sine_out = std::sqrt(o.x * o.x + o.y * o.y);
  if (sine_out > 0.0f) {
    const float turn = -safe_sqrt((1.0f - found.axis) * (1.0f + found.axis)) / sine_out;
    z.axis = vec3(turn * o.x, turn * o.y, found.axis);
  }
  z.specular = mean_fresnel(b, o, found);
  return z;
}

std::span<const float> zonal_lobe_table(bool ggx) {
  return (ggx ? LobeTable::ggx() : LobeTable::blinn_phong()).numbers();
}

}  // namespace zonal
