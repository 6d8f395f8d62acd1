#pragma once
/// Windows soften the cut at the last band, which would ring (Mézières 2022, Eq. 2.45; the thesis
/// interchanges the names): each band is scaled by a weight that falls from 1 at l = 0 to the `size` of the
/// window. A small size blurs more.
///
///     sh::apply_window(bands, sh::Window::hann, double(bands), coefficients);
///     const sh::Dering found = sh::dering(bands, coefficients);   // the least change that leaves nothing
///     negative
///
/// A window of size N does not remove ringing altogether: a delta at 9 bands keeps -2.8 % (Hann), -4.3 %
/// (Lanczos) and -2.0 % (Hamming) of its peak, and a Hann window that removes the last of it has 1.64 bands,
/// whatever N. The kernel of `positive_weights` rings never, and keeps 31 % of that peak where the Hann
/// window of 1.64 bands keeps 2 %. 1 <= bands <= kMaxBands.

#include <limits>

#include "sh/basis.h"

namespace zonal::sh {

enum class Window {
  none,
  hann,     ///< (1 + cos(pi l/w)) / 2
  lanczos,  ///< sin(pi l/w) / (pi l/w)
  hamming   ///< 0.54 + 0.46 cos(pi l/w)
};

/// The weight of band l in a window of `size` > 0 bands, any real number; 0 beyond it (l > size).
double window_weight(Window window, int l, double size);

/// In place, coefficients[count(bands)].
template <class T>
void apply_window(int bands, Window window, double size, T* coefficients);
template <class T>
void apply_window(int bands, Window window, double size, int functions, T* coefficients);
/// zonal[bands]
template <class T>
void apply_window_zonal(int bands, Window window, double size, T* zonal);

/// Weights of the non-negative zonal kernel of N bands with the highest peak: any function that was
/// non-negative before it was cut to `bands` is non-negative under them. The kernel is a square of the
/// Legendre series' kernel (Fejer's idea), (sum of (2l+1) P_l)^2 for odd N, (1+z) (P'_{N/2})^2 for even N.
/// weights[bands], weights[0] = 1.
template <class T>
void positive_weights(int bands, T* weights);

/// What deringing found.
struct Dering {
  double size =
      std::numeric_limits<double>::infinity();  ///< of the window, in bands; infinite: nothing was to be done
  double strength =
      0;  ///< automatic: 0 to 1 from no window to positive_weights, 1 to 2 from them to the mean alone
  double minimum = 0;  ///< of the function it leaves
  bool non_negative =
      true;  ///< false where the mean is negative: no window can help, all but the mean is removed
};

/// Windows the coefficients, in place, by the least strength that leaves no value below -1e-9 of the
/// function's mean. The smallest value is a concave function of the strength, so bisection finds it; above 1
/// only where the function was negative before it was cut. The minimum is searched on a grid of 6 samples a
/// wavelength, then by Newton's method.
template <class T>
Dering dering(int bands, T* coefficients);
/// Each function of a structure of arrays by its own strength. found[functions]
template <class T>
void dering(int bands, int functions, T* coefficients, Dering* found);
/// A zonal function, zonal[bands]: the search is along one meridian.
template <class T>
Dering dering_zonal(int bands, T* zonal);

/// The same with the size of a chosen window, not none (Sloan 2017, "Deringing Spherical Harmonics", there
/// for 3 bands). The automatic one above blurs less.
template <class T>
Dering dering(int bands, Window window, T* coefficients);
template <class T>
void dering(int bands, Window window, int functions, T* coefficients, Dering* found);
template <class T>
Dering dering_zonal(int bands, Window window, T* zonal);

}  // namespace zonal::sh
