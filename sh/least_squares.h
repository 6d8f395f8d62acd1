#pragma once
/// Projection by least squares: the coefficients whose function passes nearest to the samples (Mézières 2022,
/// Sec. 2.2.4). For band-limited functions it is exact with any good samples, where a sum of samples is not.
///
///     const sh::LeastSquares<float> fit(bands, sh::fibonacci_nodes<float>(samples));
///     fit.solve(values, coefficients);
///
/// Minimises sum of w (sum_i x_i Y_i - b)^2 + lambda |Gamma x|^2, w the nodes' weights (Eq. 2.43, 2.44):
/// dividing the sum by the density of samples makes lambda mean the same for any number of them. Take at
/// least 1.5 samples a coefficient: on Fibonacci points at 15 bands the condition number is
/// 230, 13.5, 2.5, 1.35 and 1.15 at 1, 1.05, 1.2, 1.5 and 2. The only file of sh/ that needs Eigen is the one
/// behind this.

#include <memory>

#include "sh/projection.h"

namespace zonal::sh {

struct LeastSquaresOptions {
  enum class Method {
    automatic,  ///< qr up to 32 bands, iterative beyond
    qr,         ///< Householder; needs as many equations as coefficients
    svd,  ///< drops singular values below `cutoff` of the largest: smallest norm where samples do not decide
    iterative  ///< conjugate gradients on the residual, no matrix: 16 M N^2 operations a step, few where well
               ///< sampled
  };
  enum class Penalty {
    tikhonov,  ///< Gamma = identity
    laplacian  ///< Gamma = l(l+1): against oscillation (Sloan 2008)
  };
  Method method = Method::automatic;
  Penalty penalty = Penalty::laplacian;
  double lambda = 0;         ///< >= 0; nothing is added at 0
  double cutoff = 1e-3;      ///< svd only
  double tolerance = 1e-12;  ///< iterative only: of the gradient, relative to its start
  int largest_steps = 200;   ///< iterative only
};

template <class T>
class LeastSquares {
 public:
  /// Factorises in double; the nodes are copied. 1 <= bands <= kMaxBands, nodes >= coefficients except for
  /// svd or lambda > 0: checked_operations.h refuses what this does not.
  LeastSquares(int bands, const SphereNodes<T>& nodes, const LeastSquaresOptions& options = {});
  ~LeastSquares();
  LeastSquares(LeastSquares&&) noexcept;

  void solve(const T* values, T* coefficients) const;
  /// values[f * nodes + k], coefficients[i * functions + f].
  void solve(int functions, const T* values, T* coefficients) const;

  /// Largest over smallest singular value of the weighted matrix with its penalty, of N^6 operations;
  /// infinite when there are fewer equations than coefficients.
  double condition() const;

 private:
  struct Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace zonal::sh
