#include "sh/products.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <tuple>

#include "sh/grid_transform.h"
#include "sh/product_table.h"

namespace zonal::sh {
namespace {

/// One object a key, made by the first who asks.
template <class Key, class Value>
class Shared {
 public:
  template <class Make>
  const Value& get(const Key& key, const Make& make) {
    {
      const std::shared_lock lock(mutex_);
      if (const auto found = values_.find(key); found != values_.end()) return *found->second;
    }
    const std::unique_lock lock(mutex_);
    auto& value = values_[key];
    if (!value) value = make();
    return *value;
  }

 private:
  std::shared_mutex mutex_;
  std::map<Key, std::unique_ptr<Value>> values_;
};

template <class T>
const ProductTable<T>& shared_table(int bands_a, int bands_b, int bands_out) {
  static Shared<std::tuple<int, int, int>, ProductTable<T>> tables;
  return tables.get({bands_a, bands_b, bands_out},
                    [&] { return std::make_unique<ProductTable<T>>(bands_a, bands_b, bands_out); });
}

template <class T>
const GridTransform<T>& shared_grid(int bands, int degree) {
  static Shared<std::tuple<int, int>, GridTransform<T>> grids;
  return grids.get({bands, degree}, [&] { return std::make_unique<GridTransform<T>>(bands, degree); });
}

/// Few bands of one factor make the table short, however many the other has.
bool fits_table(int bands_a, int bands_b, int most) {
  const int low = std::min(bands_a, bands_b), high = std::max(bands_a, bands_b);
  return high <= most || (low <= 3 && high <= 30);
}

constexpr int kLanes = 16;  ///< functions gathered together

/// `lanes` functions of a structure of arrays, each to a row of its own.
template <class T>
void gather(int size, int functions, int first, int lanes, const T* from, T* to) {
  for (int i = 0; i < size; ++i)
    for (int f = 0; f < lanes; ++f) to[size_t(f) * size + i] = from[size_t(i) * functions + first + f];
}

}  // namespace

template <class T>
T triple_product(int bands, const T* a, const T* b, const T* c) {
  if (fits_table(bands, bands, kTableBands)) return shared_table<T>(bands, bands, bands).triple(a, b, c);
  std::vector<T> ab(count(bands));
  product(bands, a, b, ab.data());
  return dot(bands, ab.data(), c);
}

template <class T>
void triple_product(int bands, int functions, const T* a, const T* b, const T* c, T* out) {
  std::vector<T> ab(size_t(count(bands)) * functions);
  product(bands, functions, a, b, ab.data());
  dot(bands, functions, ab.data(), c, out);
}

template <class T>
void product(int bands_a, int bands_b, int bands_out, const T* a, const T* b, T* out) {
  if (fits_table(bands_a, bands_b, kTableBands))
    shared_table<T>(bands_a, bands_b, bands_out).multiply(a, b, out);
  else
    product_by_quadrature(bands_a, bands_b, bands_out, a, b, out);
}

template <class T>
void product(int bands_a, int bands_b, int bands_out, int functions, const T* a, const T* b, T* out) {
  if (fits_table(bands_a, bands_b, kTableBandsBatch)) {
    shared_table<T>(bands_a, bands_b, bands_out).multiply(functions, a, b, out);
    return;
  }
  // Turned a cache line of functions at a time.
  const int size_a = count(bands_a), size_b = count(bands_b), size_out = count(bands_out);
  std::vector<T> block(size_t(size_a + size_b + size_out) * kLanes);
  T *block_a = block.data(), *block_b = block_a + size_t(size_a) * kLanes,
    *block_out = block_b + size_t(size_b) * kLanes;
  for (int first = 0; first < functions; first += kLanes) {
    const int lanes = std::min(kLanes, functions - first);
    gather(size_a, functions, first, lanes, a, block_a);
    gather(size_b, functions, first, lanes, b, block_b);
    for (int f = 0; f < lanes; ++f)
      product_by_quadrature(bands_a, bands_b, bands_out, block_a + size_t(f) * size_a,
                            block_b + size_t(f) * size_b, block_out + size_t(f) * size_out);
    for (int i = 0; i < size_out; ++i)
      for (int f = 0; f < lanes; ++f)
        out[size_t(i) * functions + first + f] = block_out[size_t(f) * size_out + i];
  }
}

template <class T>
void product_by_quadrature(int bands_a, int bands_b, int bands_out, const T* a, const T* b, T* out) {
  const int most = std::max({bands_a, bands_b, bands_out});
  const GridTransform<T>& grid = shared_grid<T>(most, bands_a + bands_b + bands_out - 3);
  std::vector<T> values(2 * grid.size());
  T *va = values.data(), *vb = va + grid.size();
  grid.synthesize(bands_a, a, va);
  grid.synthesize(bands_b, b, vb);
  for (size_t i = 0; i < grid.size(); ++i) va[i] *= vb[i];
  grid.analyze(bands_out, va, out);
}

template <class T>
void product_of_many(int bands, int M, const T* const* functions, int bands_out, T* out) {
  const GridTransform<T> grid(std::max(bands, bands_out), M * (bands - 1) + bands_out - 1);
  std::vector<T> values(grid.size(), T(1)), factor(grid.size());
  for (int f = 0; f < M; ++f) {
    grid.synthesize(bands, functions[f], factor.data());
    for (size_t i = 0; i < values.size(); ++i) values[i] *= factor[i];
  }
  grid.analyze(bands_out, values.data(), out);
}

template <class T>
void product_of_many_truncated(int bands, int M, const T* const* functions, T* out) {
  product_of_many_truncated(bands, M, 1, functions, out);
}

template <class T>
void product_of_many_truncated(int bands, int M, int count, const T* const* functions, T* out) {
  const size_t size = size_t(sh::count(bands)) * count;
  std::copy_n(functions[0], size, out);
  std::vector<T> before(size);
  for (int f = 1; f < M; ++f) {
    std::copy_n(out, size, before.data());
    product(bands, count, before.data(), functions[f], out);
  }
}

template <class T>
void transfer_matrix(int bands, const T* f, T* matrix) {
  if (bands <= 20) {
    shared_table<T>(bands, bands, bands).transfer_matrix(f, matrix);
    return;
  }
  const int size = count(bands);
  std::vector<T> unit(size), column(size);
  for (int i = 0; i < size; ++i) {
    unit[i] = 1;
    product_by_quadrature(bands, bands, bands, unit.data(), f, column.data());
    unit[i] = 0;
    for (int k = 0; k < size; ++k) matrix[size_t(k) * size + i] = column[k];
  }
}

template <class T>
void transfer_matrix(int bands, int degree, const std::function<T(const Vec3<T>&)>& f, T* matrix) {
  const int size = count(bands);
  const GridTransform<T> grid(1, degree + 2 * (bands - 1));  // for its nodes and weights only
  std::vector<T> Y(size);
  std::fill(matrix, matrix + size_t(size) * size, T(0));
  for (int j = 0; j < grid.rows(); ++j)
    for (int c = 0; c < grid.columns(); ++c) {
      const Vec3<T> w(grid.direction(j, c));
      evaluate(bands, w, Y.data());
      const T value = T(grid.weight(j)) * f(w);
      for (int k = 0; k < size; ++k) {
        T* row = matrix + size_t(k) * size;
        const T factor = value * Y[k];
        for (int i = 0; i <= k; ++i) row[i] += factor * Y[i];
      }
    }
  for (int k = 0; k < size; ++k)
    for (int i = 0; i < k; ++i) matrix[size_t(i) * size + k] = matrix[size_t(k) * size + i];
}

template <class T>
void apply_transfer_matrix(int bands, const T* matrix, const T* in, T* out) {
  const int size = count(bands);
  for (int k = 0; k < size; ++k) out[k] = dot(bands, matrix + size_t(k) * size, in);
}

template <class T>
void apply_transfer_matrix(int bands, int functions, const T* matrix, const T* in, T* out) {
  const int size = count(bands);
  std::fill(out, out + size_t(size) * functions, T(0));
  for (int k = 0; k < size; ++k)
    for (int i = 0; i < size; ++i) {
      const T factor = matrix[size_t(k) * size + i];
      for (int f = 0; f < functions; ++f)
        out[size_t(k) * functions + f] += factor * in[size_t(i) * functions + f];
    }
}

#define ZONAL_INSTANTIATE(T)                                                            \
  template T triple_product(int, const T*, const T*, const T*);                         \
  template void triple_product(int, int, const T*, const T*, const T*, T*);             \
  template void product(int, int, int, const T*, const T*, T*);                         \
  template void product(int, int, int, int, const T*, const T*, T*);                    \
  template void product_by_quadrature(int, int, int, const T*, const T*, T*);           \
  template void product_of_many(int, int, const T* const*, int, T*);                    \
  template void product_of_many_truncated(int, int, const T* const*, T*);               \
  template void product_of_many_truncated(int, int, int, const T* const*, T*);          \
  template void transfer_matrix(int, const T*, T*);                                     \
  template void transfer_matrix(int, int, const std::function<T(const Vec3<T>&)>&, T*); \
  template void apply_transfer_matrix(int, const T*, const T*, T*);                     \
  template void apply_transfer_matrix(int, int, const T*, const T*, T*);
ZONAL_INSTANTIATE(float)
ZONAL_INSTANTIATE(double)
#undef ZONAL_INSTANTIATE

}  // namespace zonal::sh
