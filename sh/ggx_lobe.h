#pragma once
/// Zonal coefficients of GGX lobes by roughness, and their derivatives with respect to it. F_l = 2 pi K_l int
/// f(theta) P_l(cos theta) sin theta dtheta, K_l = sqrt((2l+1)/4pi) (Mézières 2022, Eq. 3.2-3.4), with D the
/// GGX distribution of width alpha, alpha^2/(pi (cos^2 theta (alpha^2 - 1) + 1)^2).
///
///     double z[30];
///     sh::ggx_zonal(30, sh::GgxLobe::ndf_cos, 0.1, z);
///
/// Quadrature whose nodes crowd logarithmically at the peak, computed in double: about 30 to 300 us, meant
/// for tables.

#include "sh/basis.h"

namespace zonal::sh {

enum class GgxLobe {
  ndf,                      ///< D(theta) for theta <= pi/2
  ndf_cos,                  ///< D(theta) cos theta, which integrates to 1
  reflect_normal_incidence  ///< D(theta/2)/4 for theta <= pi/2: BRDF times cosine at normal incidence with F
                            ///< = G = 1
};

/// alpha in [1e-6, 1]; z[bands], dz_dalpha[bands] or null.
template <class T>
void ggx_zonal(int bands, GgxLobe lobe, T alpha, T* z, T* dz_dalpha = nullptr);

/// Batch: z[l * n + i] for alpha[i].
template <class T>
void ggx_zonal_batch(int bands, GgxLobe lobe, int n, const T* alpha, T* z, T* dz_dalpha = nullptr);

}  // namespace zonal::sh
