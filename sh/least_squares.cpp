#include "sh/least_squares.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace zonal::sh {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Method = LeastSquaresOptions::Method;
using Penalty = LeastSquaresOptions::Penalty;

constexpr int kLargestDense = 32;

}  // namespace

template <class T>
struct LeastSquares<T>::Problem {
  int bands;
  LeastSquaresOptions options;
  SphereNodes<double> nodes;
  Vector root;     ///< of the weights
  Vector penalty;  ///< sqrt(lambda) Gamma, one number a coefficient; empty without
  Eigen::HouseholderQR<Matrix> qr;
  Eigen::BDCSVD<Matrix> svd;

  int rows() const { return int(root.size() + penalty.size()); }
  int columns() const { return count(bands); }
  Method method() const {
    if (options.method != Method::automatic) return options.method;
    return bands <= kLargestDense ? Method::qr : Method::iterative;
  }

  /// sqrt(w) Y over sqrt(lambda) Gamma.
  Matrix matrix() const {
    Matrix A = Matrix::Zero(rows(), columns());
    Vector Y(columns());
    for (int k = 0; k < root.size(); ++k) {
      evaluate(bands, nodes.direction(k), Y.data());
      A.row(k) = root[k] * Y.transpose();
    }
    for (int i = 0; i < penalty.size(); ++i) A(root.size() + i, i) = penalty[i];
    return A;
  }

  Vector multiply(const Vector& x) const {
    Vector out(rows());
    reconstruct(bands, x.data(), nodes.x.data(), nodes.y.data(), nodes.z.data(), nodes.size(), out.data());
    out.head(root.size()).array() *= root.array();
    if (penalty.size() > 0) out.tail(penalty.size()) = penalty.cwiseProduct(x);
    return out;
  }

  Vector multiply_transposed(const Vector& y) const {
    const Vector weighted = root.cwiseProduct(y.head(root.size()));
    Vector out = Vector::Zero(columns());
    project(bands, nodes.x.data(), nodes.y.data(), nodes.z.data(), weighted.data(), nodes.size(), out.data());
    if (penalty.size() > 0) out += penalty.cwiseProduct(y.tail(penalty.size()));
    return out;
  }

  /// Conjugate gradients for least squares (Hestenes and Stiefel 1952): A^T A is never formed.
  Vector iterate(const Vector& b) const {
    Vector x = Vector::Zero(columns()), residual = b, gradient = multiply_transposed(b), direction = gradient;
    double now = gradient.squaredNorm();
    const double enough = now * options.tolerance * options.tolerance;
    for (int step = 0; step < options.largest_steps && now > enough; ++step) {
      const Vector image = multiply(direction);
      const double length2 = image.squaredNorm();
      if (!(length2 > 0)) break;
      x += now / length2 * direction;
      residual -= now / length2 * image;
      gradient = multiply_transposed(residual);
      const double next = gradient.squaredNorm();
      direction = gradient + next / now * direction;
      now = next;
    }
    return x;
  }

  Vector solve(const Vector& b) const {
    switch (method()) {
      case Method::svd:
        return svd.solve(b);
      case Method::iterative:
        return iterate(b);
      default:
        return qr.solve(b);
    }
  }
};

template <class T>
LeastSquares<T>::LeastSquares(int bands, const SphereNodes<T>& nodes, const LeastSquaresOptions& options)
    : problem_(std::make_unique<Problem>()) {
  Problem& p = *problem_;
  p.bands = bands, p.options = options;
  p.root.resize(nodes.size());
  for (int k = 0; k < nodes.size(); ++k) {
    const Vec3<double> w = normalized(Vec3<double>(nodes.direction(k)));
    p.nodes.x.push_back(w.x), p.nodes.y.push_back(w.y), p.nodes.z.push_back(w.z);
    p.root[k] = std::sqrt(double(nodes.weights[k]));
  }
  if (options.lambda > 0) {
    p.penalty.resize(count(bands));
    for (int l = 0; l < bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i)
        p.penalty[i] =
            std::sqrt(options.lambda) * (options.penalty == Penalty::laplacian ? l * (l + 1.0) : 1.0);
  }
  if (p.method() == Method::qr) p.qr.compute(p.matrix());
  if (p.method() == Method::svd) {
    p.svd.compute(p.matrix(), Eigen::ComputeThinU | Eigen::ComputeThinV);
    p.svd.setThreshold(options.cutoff);
  }
}

template <class T>
LeastSquares<T>::~LeastSquares() = default;
template <class T>
LeastSquares<T>::LeastSquares(LeastSquares&&) noexcept = default;

template <class T>
void LeastSquares<T>::solve(const T* values, T* coefficients) const {
  solve(1, values, coefficients);
}

template <class T>
void LeastSquares<T>::solve(int functions, const T* values, T* coefficients) const {
  const Problem& p = *problem_;
  Vector b = Vector::Zero(p.rows());
  for (int f = 0; f < functions; ++f) {
    for (int k = 0; k < p.root.size(); ++k) b[k] = p.root[k] * double(values[size_t(f) * p.root.size() + k]);
    const Vector x = p.solve(b);
    for (int i = 0; i < p.columns(); ++i) coefficients[size_t(i) * functions + f] = T(x[i]);
  }
}

template <class T>
double LeastSquares<T>::condition() const {
  if (problem_->rows() < problem_->columns()) return std::numeric_limits<double>::infinity();
  const Vector values = Eigen::BDCSVD<Matrix>(problem_->matrix()).singularValues();
  return values[0] / values[values.size() - 1];
}

template class LeastSquares<float>;
template class LeastSquares<double>;

}  // namespace zonal::sh
