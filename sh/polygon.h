#pragma once
/// Polygonal lights: exact SH coefficients of the light a uniform polygon of radiance 1 sends to a point,
/// both faces, no horizon, any orientation, and their gradient as the point moves.
///
///     float L[81];
///     sh::polygon_light<float>(9, 3, vertices, x, L);
///
/// On the sphere -lap Y = l(l+1) Y, so the area integral becomes a boundary integral (Stokes), n the unit
/// normal u_a x u_b of an edge's great circle and w(t) the direction along it:
///     L_lm = 1/(l(l+1)) sum over edges of int grad Y_lm(w).n dt,  L_00 = Omega/(2 sqrt pi)
///     grad_x L_lm = sum over edges of n int Y_lm(w)/rho dt,       rho the distance of the edge's point
/// Along an edge these are trigonometric polynomials of degree l: Gauss-Legendre with about l T/2 + 9 nodes
/// is exact to rounding. The edges of a narrow, far or edge-on polygon cancel; where they would cost more
/// than three digits, the plane polygon is integrated instead, int Y(p/|p|) |p.A|/|p|^3, split until each
/// part is small against its distance: nothing cancels there. Both run in double, for float too; the relative
/// error is near 1e-13 in either.

#include "sh/basis.h"

namespace zonal::sh {

/// n >= 3 vertices of a simple polygon in a plane, in order, none at x. L[count(bands)]; gradient with
/// respect to x, or null. Degenerate polygons give 0. With x inside the polygon the value is the limit from
/// one side.
template <class T>
void polygon_light(int bands, int n, const Vec3<T>* vertices, const Vec3<T>& x, T* L,
                   Vec3<T>* gradient = nullptr);

/// Batch: polygon k has the vertices first[k] .. first[k+1]-1; adds radiance[k] times its coefficients to L
/// (one colour a coefficient) and, if not null, to gradient[axis][count(bands)].
template <class T>
void accumulate_polygon_lights(int bands, int polygons, const int* first, const Vec3<T>* vertices,
                               const Vec3<T>* radiance, const Vec3<T>& x, Vec3<T>* L,
                               Vec3<T>* const gradient[3] = nullptr);

}  // namespace zonal::sh
