#include "sh/ggx_lobe.h"

#include <algorithm>
#include <vector>

#include "sh/gauss_panel.h"
#include "sh/zonal_lanes.h"

namespace zonal::sh {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct LobeValue {
  double f, df_dalpha;
};

/// The lobe at versine u = 1 - cos theta, which keeps sin^2 = u(2 - u) exact at the peak.
LobeValue lobe_at(GgxLobe lobe, double a, double u) {
  const bool half = lobe == GgxLobe::reflect_normal_incidence;
  const double sine2 = half ? u / 2 : u * (2 - u), cosine2 = 1 - sine2;
  const double x = sine2 + a * a * cosine2;
  const double d = a * a / (kPi * x * x), dd = d * (2 / a - 4 * a * cosine2 / x);
  const double scale = half ? 0.25 : lobe == GgxLobe::ndf_cos ? 1 - u : 1;
  return {d * scale, dd * scale};
}

}  // namespace

template <class T>
void ggx_zonal(int bands, GgxLobe lobe, T alpha, T* z, T* dz_dalpha) {
  const double a = alpha;
  double sum[kMaxBands] = {}, slope[kMaxBands] = {};

  // u = (a^2/2)(e^y - 1): the peak is as wide as a^2, and in y everything is as smooth as the Legendre
  // polynomials, whose phase l theta advances by at most l sqrt(u/2) 2 e^y/(e^y - 1) per unit of y.
  const double y_end = std::log1p(2 / (a * a));
  const double panel = std::min(1.0, 24.0 / (10.0 + bands));
  const int panels = static_cast<int>(std::ceil(y_end / panel));
  const double half = y_end / panels / 2;
  const double* nodes = GaussPanels::get().nodes(kMaxPanel);
  const double* weights = GaussPanels::get().weights(kMaxPanel);
  for (int k = 0; k < panels; ++k) {
    for (int i = 0; i < kMaxPanel; ++i) {
      const double y = half * (2 * k + 1 + nodes[i]);
      const double u = std::min(1.0, a * a / 2 * std::expm1(y)), du_dy = a * a / 2 * std::exp(y);
      const LobeValue f = lobe_at(lobe, a, u);
      const double weight = half * weights[i] * du_dy;
      CapRecurrence<double> r(u);
      for (int l = 0; l < bands; ++l) {
        if (l > 0) r.step_p(l);
        sum[l] += weight * f.f * r.p;
        slope[l] += weight * f.df_dalpha * r.p;
      }
    }
  }
  for (int l = 0; l < bands; ++l) {
    const double factor = std::sqrt(kPi * (2 * l + 1));  // 2 pi K_l
    z[l] = T(factor * sum[l]);
    if (dz_dalpha) dz_dalpha[l] = T(factor * slope[l]);
  }
}

template <class T>
void ggx_zonal_batch(int bands, GgxLobe lobe, int n, const T* alpha, T* z, T* dz_dalpha) {
  T one[kMaxBands], slope[kMaxBands];
  for (int i = 0; i < n; ++i) {
    ggx_zonal(bands, lobe, alpha[i], one, slope);
    for (int l = 0; l < bands; ++l) {
      z[static_cast<size_t>(l) * n + i] = one[l];
      if (dz_dalpha) dz_dalpha[static_cast<size_t>(l) * n + i] = slope[l];
    }
  }
}

template void ggx_zonal<float>(int, GgxLobe, float, float*, float*);
template void ggx_zonal<double>(int, GgxLobe, double, double*, double*);
template void ggx_zonal_batch<float>(int, GgxLobe, int, const float*, float*, float*);
template void ggx_zonal_batch<double>(int, GgxLobe, int, const double*, double*, double*);

}  // namespace zonal::sh
