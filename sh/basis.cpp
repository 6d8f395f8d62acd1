#include "sh/basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sh/basis_rows.h"
#include "sh/tables.h"

#ifdef __clang__
#pragma clang fp reassociate(off)
#endif

namespace zonal::sh {

namespace {

/// A unit direction with u = 1 - |z| known to its own rounding. A float vector is unit only to 6e-8; near a
/// pole, where dY/dz reaches l^2/2 times the normalisation, that alone would cost 1e-5 at 20 bands. What is
/// evaluated is Y(d/|d|).
template <class T>
struct Direction {
  T x, y, z, u, sign;
};

template <class T>
ZONAL_SH_ROWS_INLINE Direction<T> direction(const Vec3<T>& d) {
  // |d|^2 - 1, accurate to the rounding of 1 - z^2: factors, because z^2 - 1 would cancel.
  const T excess = (d.z - 1) * (d.z + 1) + (d.x * d.x + d.y * d.y);
  // 1/|d| - 1: to second order where that is exact, since a root and two quotients cost as much as five
  // bands.
  const T scale = std::abs(excess) < T(1e-5) ? excess * (T(0.375) * excess - T(0.5))
                                             : -excess / (1 + excess + std::sqrt(1 + excess));
  const T up = std::abs(d.z);
  return {d.x + d.x * scale, d.y + d.y * scale, d.z + d.z * scale, (1 - up) - up * scale,
          std::copysign(T(1), d.z)};
}

/// Powers of x+iy, from exponent -2 (as 0) so that derivatives need no special cases.
template <class T>
struct Powers {
  T c_[kMaxBands + 2], s_[kMaxBands + 2];
  Powers(int bands, T x, T y) {
    c_[0] = c_[1] = s_[0] = s_[1] = s_[2] = 0;
    c_[2] = 1;
    for (int m = 1; m < bands; ++m) {
      c_[m + 2] = x * c_[m + 1] - y * s_[m + 1];
      s_[m + 2] = x * s_[m + 1] + y * c_[m + 1];
    }
  }
  T re(int m) const { return c_[m + 2]; }
  T im(int m) const { return s_[m + 2]; }
};

/// p[l] = sign(z)^{l-m} p_l^m(|z|) for l = m..bands-1, tables.h, and zero at l < m.
template <class T>
void legendre_column(int bands, int m, const Direction<T>& d, T* p) {
  std::fill(p, p + std::min(m, bands), T(0));
  if (m >= bands) return;
  const Step<T>* step = tables<T>().column(m);
  T value = 1, change = 0, sign = 1;
  p[m] = 1;
  for (int l = m + 1; l < bands; ++l) {
    ++step;
    change = step->fall * change - step->rise * value;
    value += d.u * change;
    sign *= d.sign;
    p[l] = value * sign;
  }
}

/// v times a power of two, and that over its largest component: within [-1, 1], one of them 1. The power
/// keeps 1/scale a normal number, which a quotient may be computed with.
template <class T>
Vec3<T> scaled(const Vec3<T>& v, T& power, T& scale) {
  scale = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  power = scale < T(1e-20) ? T(0x1p66) : scale > T(1e20) ? T(0x1p-66) : T(1);
  scale *= power;
  return v * power / scale;
}

/// Unit direction and 1/|v|.
template <class T>
ZONAL_SH_ROWS_INLINE Direction<T> direction(const Vec3<T>& v, T& inverse_length) {
  const T square = v.x * v.x + v.y * v.y + v.z * v.z;
  if (std::abs(square - 1) < T(1e-6)) {  // unit already, the common case: no root
    const Direction<T> d = direction(v);
    inverse_length = 1 + (square - 1) * (T(0.375) * (square - 1) - T(0.5));
    return d;
  }
  if (square > T(1e-20) && square < T(1e20)) {
    inverse_length = 1 / std::sqrt(square);
    return direction(Vec3<T>(v * inverse_length));
  }
  T power, scale;
  const Vec3<T> w = scaled(v, power, scale);
  const T length = std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
  inverse_length =
      std::min(1 / length / scale * power, std::numeric_limits<T>::max());  // denormal v: large, not infinite
  return direction(Vec3<T>(w / length));
}

}  // namespace

template <class T>
Vec3<T> normalized(const Vec3<T>& v) {
  T power, scale;
  const Vec3<T> w = scaled(v, power, scale);
  return w / std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
}

template <class T>
void evaluate(int bands, const Vec3<T>& unit, T* Y) {
  const Direction<T> d = direction(unit);
  rows::evaluate_any<false>(bands, rows::Input<T>{d.x, d.y, std::abs(d.z), d.u, d.sign, T(1)}, Y, Y, Y, Y);
}

/// The polynomial p = q(z) Re (x+iy)^m has the gradient (m q C_{m-1}, -m q S_{m-1}, q' C_m). That of Y(v/|v|)
/// is its part tangent to the sphere over |v|; d . grad p = (m q + z q') C_m by Euler's theorem in (x, y).
/// With S for C, the y component turns: Im i(x+iy)^{m-1} = C_{m-1}. (Mézières 2022, section 3.2, without its
/// angles.)
template <class T>
void evaluate_gradient(int bands, const Vec3<T>& v, T* Y, T* gradient_x, T* gradient_y, T* gradient_z) {
  T inverse;
  const Direction<T> d = direction(v, inverse);
  const rows::Input<T> input{d.x, d.y, std::abs(d.z), d.u, d.sign, inverse};
  rows::evaluate_any<true>(bands, input, Y, gradient_x, gradient_y, gradient_z);
}

template <class T>
void evaluate_gradient(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient) {
  constexpr int kSmall = 20;
  T small[3 * kSmall * kSmall];
  std::vector<T> large;
  const int n = count(bands);
  if (bands > kSmall) large.resize(3 * n);
  T* const g = bands > kSmall ? large.data() : small;
  evaluate_gradient(bands, v, Y, g, g + n, g + 2 * n);
  for (int i = 0; i < n; ++i) gradient[i] = Vec3<T>(g[i], g[n + i], g[2 * n + i]);
}

/// The Hessian of Y(v/|v|) is (P (H_p - (d.g) I) P - d t^T - t d^T) / |v|^2 with P = I - d d^T, g and H_p the
/// gradient and Hessian of the polynomial, t = P g. Written out; q'' is replaced by Legendre's equation
/// wherever it comes with 1 - z^2, so that the l^4 of q'' at the pole never has to cancel.
template <class T>
void evaluate_hessian(int bands, const Vec3<T>& v, T* Y, Vec3<T>* gradient, Hessian<T>* hessian) {
  T inverse;
  const Direction<T> d = direction(v, inverse);
  const Powers<T> powers(bands, d.x, d.y);
  const T x = d.x, y = d.y, z = d.z, rho2 = x * x + y * y;
  T columns[3][kMaxBands];
  T *p = columns[0], *p1 = columns[1], *p2 = columns[2];
  legendre_column(bands, 0, d, p);
  legendre_column(bands, 1, d, p1);
  for (int m = 0; m < bands; ++m) {
    legendre_column(bands, m + 2, d, p2);
    const Step<T>* column = tables<T>().column(m);
    for (int l = m; l < bands; ++l) {
      const Step<T>& step = column[l - m];
      const T f = step.norm * p[l], df = step.slope * p1[l], ddf = step.curve * p2[l];
      const T degree = T(l) * T(l + 1);
      const T radial = m * f + z * df, up = rho2 * df - m * z * f;
      const T squares = T(m) * (m + 2) * f + (2 * m + 3) * z * df + z * z * ddf;
      const T side = z * (degree + m) * f - (m + rho2) * df;
      const T zz = (z * z * m * (m + 1) - rho2 * (degree - T(m) * m)) * f - rho2 * z * df;
      const T mf = m * f, mmf = T(m) * (m - 1) * f, mr = m * radial, mu = m * up;

      // One part of (x+iy)^m: p0 itself, px and py the parts of (x+iy)^{m-1} and i(x+iy)^{m-1}, pxx and pxy
      // likewise.
      auto write = [&](int i, T p0, T px, T py, T pxx, T pxy) {
        Y[i] = f * p0;
        gradient[i] = Vec3<T>(mf * px - radial * x * p0, mf * py - radial * y * p0, up * p0) * inverse;
        Hessian<T>& h = hessian[i];
        h.xx = mmf * pxx - 2 * x * mr * px + (x * x * squares - radial) * p0;
        h.yy = -mmf * pxx - 2 * y * mr * py + (y * y * squares - radial) * p0;
        h.xy = mmf * pxy - mr * (x * py + y * px) + x * y * squares * p0;
        h.xz = mu * px + x * side * p0;
        h.yz = mu * py + y * side * p0;
        h.zz = zz * p0;
        for (T* entry : {&h.xx, &h.xy, &h.xz, &h.yy, &h.yz, &h.zz}) *entry = *entry * inverse * inverse;
      };
      write(index(l, -m), powers.im(m), powers.im(m - 1), powers.re(m - 1), powers.im(m - 2),
            powers.re(m - 2));
      write(index(l, m), powers.re(m), powers.re(m - 1), -powers.im(m - 1), powers.re(m - 2),
            -powers.im(m - 2));
    }
    T* freed = p;
    p = p1, p1 = p2, p2 = freed;
  }
}

#define ZONAL_INSTANTIATE(T)                                            \
  template Vec3<T> normalized(const Vec3<T>&);                          \
  template void evaluate(int, const Vec3<T>&, T*);                      \
  template void evaluate_gradient(int, const Vec3<T>&, T*, T*, T*, T*); \
  template void evaluate_gradient(int, const Vec3<T>&, T*, Vec3<T>*);   \
  template void evaluate_hessian(int, const Vec3<T>&, T*, Vec3<T>*, Hessian<T>*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
