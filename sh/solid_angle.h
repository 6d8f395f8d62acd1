#pragma once
/// Solid angle of a polygon and how it changes as the point moves.
///
///     float omega = sh::polygon_solid_angle<float>(3, vertices, x);   // > 0 if det(v0-x, v1-x, v2-x) > 0
///
/// Van Oosterom and Strackee's formula with atan2 (Mézières 2022, Eq. 4.13), a fan of triangles from vertex
/// 0, so simple polygons that are not convex come out right as well. Determinants are summed in twice the
/// precision: narrow, far and edge-on polygons keep all digits that their vertices define. float is computed
/// in double.

#include "sh/basis.h"

namespace zonal::sh {

/// Signed, steradians. Optionally the gradient with respect to x (Eq. 4.16 with its sign, sum and quotient
/// corrected): sum over edges of (u_i x u_j)/(1 + u_i.u_j) (1/l_i + 1/l_j). An edge through x itself counts
/// for nothing.
template <class T>
T polygon_solid_angle(int n, const Vec3<T>* vertices, const Vec3<T>& x, Vec3<T>* gradient = nullptr);

/// Batch: `count` triangles with corners a, b, c as nine arrays; omega[count], gradient as three arrays or
/// null.
template <class T>
void triangle_solid_angles(int count, const T* const a[3], const T* const b[3], const T* const c[3],
                           const Vec3<T>& x, T* omega, T* const gradient[3]);

}  // namespace zonal::sh
