#include "sh/hemispherical.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/quadrature.h"

namespace zonal::sh {

template <class T>
void evaluate_hemispherical(int bands, const Vec3<T>& d, T* H) {
  if (d.z < 0) {
    std::fill(H, H + count(bands), T(0));
    return;
  }
  // sin theta' / sin theta = 2 sqrt(z(1-z)) / sqrt((1-z)(1+z)): no pole at z = 1. Rounding may leave z
  // above 1.
  const T scale = 2 * std::sqrt(d.z / (1 + d.z));
  evaluate(bands, normalized(Vec3<T>(scale * d.x, scale * d.y, 2 * d.z - 1)), H);
  for (int i = 0; i < count(bands); ++i) H[i] *= T(std::numbers::sqrt2);
}

template <class T>
void evaluate_hemispherical(int bands, const T* x, const T* y, const T* z, int count, T* H) {
  T one[sh::count(kMaxBands)];
  for (int k = 0; k < count; ++k) {
    evaluate_hemispherical(bands, Vec3<T>(x[k], y[k], z[k]), one);
    for (int i = 0; i < sh::count(bands); ++i) H[size_t(i) * count + k] = one[i];
  }
}

template <class T>
HemisphericalConversion<T>::HemisphericalConversion(int hsh_bands, int sh_bands)
    : hsh_bands_(hsh_bands), sh_bands_(sh_bands) {
  // z = t^2 turns the square roots of odd m into polynomials times sqrt(1 + t^2): 24 nodes more than the
  // polynomials of even m need bring that factor to 1e-16 (its singularity t = i lies on the ellipse 4.2 of
  // [0, 1], error 4.2^-48).
  const int nodes = hsh_bands + sh_bands + 24;
  const GaussLegendre rule = gauss_legendre(nodes, 0, 1);
  const int hsh_count = legendre_count(hsh_bands), sh_count = legendre_count(sh_bands);
  std::vector<double> H(size_t(nodes) * hsh_count), Y(size_t(nodes) * sh_count);
  for (int k = 0; k < nodes; ++k) {
    const double t = rule.nodes[k], z = t * t;
    normalized_legendre(hsh_bands, 2 * z - 1, 2 * t * std::sqrt(1 - z), &H[size_t(k) * hsh_count]);
    normalized_legendre(sh_bands, z, std::sqrt((1 - z) * (1 + z)), &Y[size_t(k) * sh_count]);
    // dz = 2t dt; sqrt2 of H; 2 pi of the azimuth.
    const double weight = rule.weights[k] * 2 * t * std::numbers::sqrt2 * 2 * std::numbers::pi;
    for (int i = 0; i < hsh_count; ++i) H[size_t(k) * hsh_count + i] *= weight;
  }
  const int orders = std::min(hsh_bands, sh_bands);
  std::vector<double> block;
  for (int m = 0; m < orders; ++m) {
    const int height = hsh_bands - m, width = sh_bands - m;
    block.assign(size_t(height) * width, 0);
    for (int k = 0; k < nodes; ++k) {
      const double* h = &H[size_t(k) * hsh_count + legendre_index(hsh_bands, m, m)];
      const double* y = &Y[size_t(k) * sh_count + legendre_index(sh_bands, m, m)];
      for (int i = 0; i < height; ++i)
        for (int j = 0; j < width; ++j) block[size_t(i) * width + j] += h[i] * y[j];
    }
    block_.push_back(int(elements_.size()));
    elements_.insert(elements_.end(), block.begin(), block.end());
  }
}

template <class T>
T HemisphericalConversion<T>::element(int lh, int ls, int m) const {
  m = std::abs(m);
  return elements_[block_[m] + (lh - m) * (sh_bands_ - m) + ls - m];
}

template <class T>
void HemisphericalConversion<T>::to_hemispherical(const T* sh, T* hsh) const {
  to_hemispherical(1, sh, hsh);
}
template <class T>
void HemisphericalConversion<T>::to_spherical(const T* hsh, T* sh) const {
  to_spherical(1, hsh, sh);
}

template <class T>
void HemisphericalConversion<T>::to_hemispherical(int functions, const T* sh, T* hsh) const {
  for (int l = 0; l < hsh_bands_; ++l)
    for (int m = -l; m <= l; ++m) {
      T* out = hsh + size_t(index(l, m)) * functions;
      std::fill(out, out + functions, T(0));
      for (int j = std::abs(m); j < sh_bands_; ++j) {
        const T factor = element(l, j, m);
        const T* in = sh + size_t(index(j, m)) * functions;
        for (int f = 0; f < functions; ++f) out[f] += factor * in[f];
      }
    }
}

template <class T>
void HemisphericalConversion<T>::to_spherical(int functions, const T* hsh, T* sh) const {
  for (int l = 0; l < sh_bands_; ++l)
    for (int m = -l; m <= l; ++m) {
      T* out = sh + size_t(index(l, m)) * functions;
      std::fill(out, out + functions, T(0));
      for (int j = std::abs(m); j < hsh_bands_; ++j) {
        const T factor = element(j, l, m);
        const T* in = hsh + size_t(index(j, m)) * functions;
        for (int f = 0; f < functions; ++f) out[f] += factor * in[f];
      }
    }
}

#define ZONAL_INSTANTIATE(T)                                                        \
  template void evaluate_hemispherical(int, const Vec3<T>&, T*);                    \
  template void evaluate_hemispherical(int, const T*, const T*, const T*, int, T*); \
  template class HemisphericalConversion<T>;
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
