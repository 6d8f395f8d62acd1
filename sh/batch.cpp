#include "sh/batch.h"

#include <limits>
#include <vector>

namespace zonal::sh {

namespace {

/// A block of unit directions out of any non-zero vectors, and 1/|v|.
template <class T>
struct Normalized {
  T x[kLanes<T>], y[kLanes<T>], z[kLanes<T>], inverse[kLanes<T>];

  Normalized(const T* px, const T* py, const T* pz, int lanes) {
    for (int k = 0; k < kLanes<T>; ++k) {
      const int from = k < lanes ? k : lanes - 1;
      const T vx = px[from], vy = py[from], vz = pz[from];
      const T scale = std::max(std::abs(vx), std::max(std::abs(vy), std::abs(vz)));
      // A power of two first, so that 1/scale is a normal number.
      const T power = scale < T(1e-20) ? T(0x1p66) : scale > T(1e20) ? T(0x1p-66) : T(1), top = scale * power;
      const T a = vx * power / top, b = vy * power / top, c = vz * power / top;
      const T length = std::sqrt(a * a + b * b + c * c);
      x[k] = a / length, y[k] = b / length, z[k] = c / length;
      inverse[k] = std::min(1 / length / top * power, std::numeric_limits<T>::max());
    }
  }
};

/// Writes the lanes in use of a block's row i.
template <class T>
struct PartialRow {
  std::ptrdiff_t stride;
  int lanes;
  void operator()(T* out, int i, const batch::Pack<T>& v) const {
    std::memcpy(out + i * stride, &v, lanes * sizeof(T));
  }
};

}  // namespace

template <class T>
void evaluate_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y, int stride) {
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const auto d = batch::load(x + first, y + first, z + first, lanes);
    if (lanes == kLanes<T>) {
      batch::values<0>(table, bands, d, batch::Store<T>{Y + first, stride});
    } else {
      const PartialRow<T> row{stride, lanes};
      batch::values<0>(table, bands, d, [&](int i, const batch::Pack<T>& v) { row(Y + first, i, v); });
    }
  }
}

template <class T>
void evaluate_gradient_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y, T* gradient_x,
                             T* gradient_y, T* gradient_z, int stride) {
  using Pack = batch::Pack<T>;
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const Normalized<T> v(x + first, y + first, z + first, lanes);
    const auto d = batch::load(v.x, v.y, v.z, kLanes<T>);
    Pack inverse;
    std::memcpy(&inverse, v.inverse, sizeof inverse);
    T* const out[4] = {Y + first, gradient_x + first, gradient_y + first, gradient_z + first};
    if (lanes == kLanes<T>) {
      const batch::StoreGradient<T> rows{{out[0], out[1], out[2], out[3]}, stride};
      batch::gradients<0>(table, bands, d,
                          [&](int i, const Pack& f, const Pack& gx, const Pack& gy, const Pack& gz) {
                            rows(i, f, gx * inverse, gy * inverse, gz * inverse);
                          });
    } else {
      const PartialRow<T> row{stride, lanes};
      batch::gradients<0>(table, bands, d,
                          [&](int i, const Pack& f, const Pack& gx, const Pack& gy, const Pack& gz) {
                            row(out[0], i, f), row(out[1], i, gx * inverse), row(out[2], i, gy * inverse),
                                row(out[3], i, gz * inverse);
                          });
    }
  }
}

template <class T>
void evaluate_hessian_batch(int bands, const T* x, const T* y, const T* z, int count, T* Y,
                            T* const gradient[3], T* const hessian[6], int stride) {
  using Pack = batch::Pack<T>;
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const Normalized<T> v(x + first, y + first, z + first, lanes);
    const auto d = batch::load(v.x, v.y, v.z, kLanes<T>);
    Pack inverse;
    std::memcpy(&inverse, v.inverse, sizeof inverse);
    const PartialRow<T> row{stride, lanes};
    batch::hessians<0>(table, bands, d, [&](int i, const Pack& f, const Pack(&g)[3], const Pack(&h)[6]) {
      row(Y + first, i, f);
      for (int k = 0; k < 3; ++k) row(gradient[k] + first, i, g[k] * inverse);
      for (int k = 0; k < 6; ++k) row(hessian[k] + first, i, h[k] * inverse * inverse);
    });
  }
}

template <class T>
void reconstruct(int bands, const T* coefficients, const T* x, const T* y, const T* z, int count, T* value) {
  using Pack = batch::Pack<T>;
  const Tables<T>& table = tables<T>();
  for (int first = 0; first < count; first += kLanes<T>) {
    const int lanes = std::min(kLanes<T>, count - first);
    const auto d = batch::load(x + first, y + first, z + first, lanes);
    Pack c = Pack{} + T(1), s = {}, sum = {};  // (x+iy)^m
    for (int m = 0; m < bands; ++m) {
      batch::add_dot_column(table, bands, m, d, coefficients, c, s, sum);
      const Pack next = d.x * c - d.y * s;
      s = d.x * s + d.y * c;
      c = next;
    }
    std::memcpy(value + first, &sum, lanes * sizeof(T));
  }
}

template <class T>
void project(int bands, const T* x, const T* y, const T* z, const T* weight, int count, T* coefficients) {
  using Pack = batch::Pack<T>;
  constexpr int kRun = 64 * kLanes<T>;  // directions summed in T, a lane each 64th
  const Tables<T>& table = tables<T>();
  batch::Scratch<T> scratch(1, bands);
  T* const sums = scratch.array(0);
  const int n = sh::count(bands);
  std::vector<double> total(n, 0.0);
  for (int run = 0; run < count; run += kRun) {
    std::fill(sums, sums + std::size_t(n) * kLanes<T>, T(0));
    for (int first = run; first < std::min(count, run + kRun); first += kLanes<T>) {
      const int lanes = std::min(kLanes<T>, count - first);
      const auto d = batch::load(x + first, y + first, z + first, lanes);
      Pack w = {};
      std::memcpy(&w, weight + first, lanes * sizeof(T));
      batch::values<0>(table, bands, d, [&](int i, const Pack& v) {
        Pack sum;
        std::memcpy(&sum, sums + i * kLanes<T>, sizeof sum);
        sum += w * v;
        std::memcpy(sums + i * kLanes<T>, &sum, sizeof sum);
      });
    }
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < kLanes<T>; ++k) total[i] += double(sums[i * kLanes<T> + k]);
    }
  }
  for (int i = 0; i < n; ++i) coefficients[i] = T(coefficients[i] + total[i]);
}

#define ZONAL_SH_INSTANTIATE(T)                                                                              \
  template void evaluate_batch(int, const T*, const T*, const T*, int, T*, int);                             \
  template void evaluate_gradient_batch(int, const T*, const T*, const T*, int, T*, T*, T*, T*, int);        \
  template void evaluate_hessian_batch(int, const T*, const T*, const T*, int, T*, T* const[3], T* const[6], \
                                       int);                                                                 \
  template void reconstruct(int, const T*, const T*, const T*, const T*, int, T*);                           \
  template void project(int, const T*, const T*, const T*, const T*, int, T*);
ZONAL_SH_INSTANTIATE(float)
ZONAL_SH_INSTANTIATE(double)
#undef ZONAL_SH_INSTANTIATE

}  // namespace zonal::sh
