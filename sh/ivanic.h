#pragma once
/// Rotation matrices of real spherical harmonics, each band's from the one before and that of band 1: the
/// recurrences of Ivanic and Ruedenberg (J. Phys. Chem. 1996, 100, 6342, with the corrections of 1998, 102,
/// 9099) in a stable form.
///
/// Band l is the top of the product of band 1 and band l-1: R^l = C (R^1 x R^(l-1)) C^T, where the rows of C,
/// the couplings, are orthonormal. The paper divides by one coupling of the three that a column has, and
/// rounding grows as errors are divided by numbers below 1: 5e-8 at l = 100 in double. Summing over all three
/// only projects, so errors just add up: 1e-13.

#include "sh/rotation.h"

namespace zonal::sh {

/// Writes band after band, (2l+1)^2 each, column by column (Rotation's layout). R is orthonormal; computed in
/// double.
template <class T>
void ivanic_ruedenberg(int bands, const Mat3<double>& R, T* columns);

}  // namespace zonal::sh
