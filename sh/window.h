#pragma once
/// Windows soften the cut at the last band, which would ring (Mézières 2022, Eq. 2.45; the thesis
/// interchanges the names): each band is scaled by a weight that falls from 1 at l = 0 to the `size` of the
/// window. A small size blurs more.
///
///     sh::apply_window(bands, sh::Window::hann, double(bands), coefficients);
///     const sh::Dering found = sh::dering(bands, sh::Window::hann, coefficients);   // smallest change that
///     is >= 0
///
/// A window of size N does not remove ringing altogether: a delta at 9 bands keeps -2.8 % (Hann), -4.3 %
/// (Lanczos) and -2.0 % (Hamming) of its peak. `dering` finds the size that does, for any function and any 1
/// <= bands <= kMaxBands.

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

/// What deringing found.
struct Dering {
  double size =
      std::numeric_limits<double>::infinity();  ///< of the window, in bands; infinite: nothing was to be done
  double minimum = 0;                           ///< of the function it leaves
  bool non_negative =
      true;  ///< false where the mean is negative: no window can help, all but the mean is removed
};

/// Windows the coefficients, in place, by the largest size that leaves no value below -1e-9 of the function's
/// mean (Sloan 2017, "Deringing Spherical Harmonics", there for 3 bands; here the minimum is searched on a
/// grid of 6 samples a wavelength, then by Newton's method, so any number of bands will do). `window` is not
/// none.
template <class T>
Dering dering(int bands, Window window, T* coefficients);
/// Each function of a structure of arrays by its own window. found[functions]
template <class T>
void dering(int bands, Window window, int functions, T* coefficients, Dering* found);
/// A zonal function: the search is along one meridian.
template <class T>
Dering dering_zonal(int bands, Window window, T* zonal);

}  // namespace zonal::sh
