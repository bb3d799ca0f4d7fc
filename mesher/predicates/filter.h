// Semi-static double filters of the hot predicates, for every mix of point kinds.
//
// All return -1 or +1 if the sign is certain and 0 if it is not. The determinant D of the nearest
// doubles is compared with a bound on |D - exact determinant| that has three parts.
//
// Rounding. u = 2^-53. A computed polynomial is the sum of its monomials in the exact differences,
// each times (1 + theta), |theta| <= k u / (1 - k u), where k counts the roundings on the longest
// path from a difference of coordinates to the result. The computed maxima M of the differences
// exceed the true ones by at most a factor 1 + u; that, and the roundings in evaluating the bound,
// are made up for by writing 0x1.8001 for 0x1.8, which leaves a relative slack of 2^-15.
//
// Inexact arguments. With E the largest error of the coordinates of implicit points, differences
// are off by at most 2 E =: D; D = 2.0625 E and N = M + D bound the differences before and after.
// Exchanging the factors of a monomial one at a time gives |product of N-bounded factors' change|
// <= sum over factors of its change times the bounds of the others.
//
// Underflow and overflow. A product that underflows is off by at most 2^-1075, which is multiplied
// by at most the bounds of the other factors; the last term of each bound exceeds the sum of these
// errors amply (2^-900, so that no subnormal number slows down the usual case). Overflow of a
// partial result makes the bound infinite or NaN, because the bound multiplies the same maxima in
// the same order with a larger constant, and comparisons with those fail.
#pragma once

#include <cmath>

#include "mesher/arithmetic/floating_point.h"
#include "mesher/predicates/points.h"

namespace delmesher::predicates::filters {

inline double larger(double a, double b) {
  return a > b ? a : b;
}

inline double largest(double a, double b, double c) {
  return larger(larger(std::fabs(a), std::fabs(b)), std::fabs(c));
}

inline double largest(double a, double b, double c, double d) {
  return larger(larger(std::fabs(a), std::fabs(b)), larger(std::fabs(c), std::fabs(d)));
}

// Without branches on the sign, which is random: gcc mispredicts half of them.
inline int certain_sign(double value, double bound) {
  return static_cast<int>(value > bound) - static_cast<int>(value < -bound);
}

// D is at most this much larger than E.
inline constexpr double kDifferenceError = 2.0625;

// In the plane z = 0. 2 monomials; roundings: 2 differences, 1 product, 1 sum, k = 4, bound 4 u;
// the sum of the absolute values is rounded once more.
inline int orient2d(const Approximation& a, const Approximation& b, const Approximation& c) {
  const double bx = b.x - a.x, by = b.y - a.y;
  const double cx = c.x - a.x, cy = c.y - a.y;
  const double l = bx * cy, r = by * cx;
  double bound = (std::fabs(l) + std::fabs(r)) * 0x1.0002p-51 + 0x1p-900;
  const double error = larger(larger(a.error, b.error), c.error);
  if (error != 0) {
    const double d = kDifferenceError * error;
    bound +=
        1.001 * d * (std::fabs(bx) + std::fabs(by) + std::fabs(cx) + std::fabs(cy) + 2.001 * d);
  }
  return certain_sign(l - r, bound);
}

// Errors of degree 1 of the products |x y z|.
inline double orient3d_argument_error(double mx, double my, double mz, double error) {
  const double d = kDifferenceError * error;
  const double nx = mx + d, ny = my + d, nz = mz + d;
  return 6.001 * d * (nx * ny + ny * nz + nz * nx);
}

// 6 monomials of at most mx my mz; roundings: 3 differences, 2 products, 1 + 2 sums, k = 8:
// 6 * 8 u = 48 u. Underflow: 6 * 2^-1075 mz + 3 * 2^-1075.
inline int orient3d(const Approximation& a, const Approximation& b, const Approximation& c,
                    const Approximation& d) {
  const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
  const double cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
  const double dx = d.x - a.x, dy = d.y - a.y, dz = d.z - a.z;
  const double det =
      (bz * (cx * dy - cy * dx) - cz * (bx * dy - by * dx)) + dz * (bx * cy - by * cx);
  const double mx = largest(bx, cx, dx);
  const double my = largest(by, cy, dy);
  const double mz = largest(bz, cz, dz);
  double bound = (0x1.8001p5 * mx * my * mz) * 0x1p-53 + (mz + 1) * 0x1p-900;
  const double error = larger(larger(a.error, b.error), larger(c.error, d.error));
  if (error != 0) bound += orient3d_argument_error(mx, my, mz, error);
  return certain_sign(det, bound);
}

// 24 monomials of at most NxNyNz times a squared length of at most N^2 := Nx^2 + Ny^2 + Nz^2, whose
// change is at most 2 D (Nx + Ny + Nz).
inline double insphere_argument_error(double mx, double my, double mz, double error) {
  const double d = kDifferenceError * error;
  const double nx = mx + d, ny = my + d, nz = mz + d;
  const double pairs = nx * ny + ny * nz + nz * nx;
  const double squares = nx * nx + ny * ny + nz * nz;
  return 24.001 * d * (pairs * squares + nx * ny * nz * 2 * (nx + ny + nz));
}

// The polynomial of polynomials::Insphere. 4 * 6 monomials of at most mx my mz l, l the largest
// squared length; roundings: 5 differences, 3 in the length, 2 in the 2 x 2 minors, 3 in the 3 x 3
// minors, 3 in the last product and sums, k = 16: 24 * 16 u = 384 u. Underflow, in units of
// 2^-1075: 24 mz l (minors) + 12 l (3 x 3 minors) + 4 (last products) + 72 mx my mz (lengths); the
// last one is below the slack of the rounding term if l >= 2^-1000, else below 2^-1075.
inline int insphere(const Approximation& a, const Approximation& b, const Approximation& c,
                    const Approximation& d, const Approximation& e) {
  const double ax = a.x - e.x, ay = a.y - e.y, az = a.z - e.z;
  const double bx = b.x - e.x, by = b.y - e.y, bz = b.z - e.z;
  const double cx = c.x - e.x, cy = c.y - e.y, cz = c.z - e.z;
  const double dx = d.x - e.x, dy = d.y - e.y, dz = d.z - e.z;
  const double ab = ax * by - ay * bx;
  const double ac = ax * cy - ay * cx;
  const double ad = ax * dy - ay * dx;
  const double bc = bx * cy - by * cx;
  const double bd = bx * dy - by * dx;
  const double cd = cx * dy - cy * dx;
  const double abc = (az * bc - bz * ac) + cz * ab;
  const double abd = (az * bd - bz * ad) + dz * ab;
  const double acd = (az * cd - cz * ad) + dz * ac;
  const double bcd = (bz * cd - cz * bd) + dz * bc;
  const double al = ax * ax + ay * ay + az * az;
  const double bl = bx * bx + by * by + bz * bz;
  const double cl = cx * cx + cy * cy + cz * cz;
  const double dl = dx * dx + dy * dy + dz * dz;
  const double det = (al * bcd - bl * acd) + (cl * abd - dl * abc);
  const double mx = largest(ax, bx, cx, dx);
  const double my = largest(ay, by, cy, dy);
  const double mz = largest(az, bz, cz, dz);
  const double l = larger(larger(al, bl), larger(cl, dl));
  double bound = (0x1.8001p8 * mx * my * mz * l) * 0x1p-53 + (mz + 1) * (l + 1) * 0x1p-900;
  const double error = larger(larger(larger(a.error, b.error), larger(c.error, d.error)), e.error);
  if (error != 0) bound += insphere_argument_error(mx, my, mz, error);
  return certain_sign(det, bound);
}

// (p - q) . (r - q). Roundings: 2 differences, 1 product, 2 sums, k = 5, applied to the sum of the
// absolute products.
inline int dot(const Approximation& p, const Approximation& q, const Approximation& r) {
  const double ux = p.x - q.x, uy = p.y - q.y, uz = p.z - q.z;
  const double vx = r.x - q.x, vy = r.y - q.y, vz = r.z - q.z;
  const double x = ux * vx, y = uy * vy, z = uz * vz;
  double bound = (std::fabs(x) + std::fabs(y) + std::fabs(z)) * 0x1.4001p-51 + 0x1p-900;
  const double error = larger(larger(p.error, q.error), r.error);
  if (error != 0) {
    const double d = kDifferenceError * error;
    const double sum = std::fabs(ux) + std::fabs(uy) + std::fabs(uz) + std::fabs(vx) +
                       std::fabs(vy) + std::fabs(vz);
    bound += 1.001 * d * (sum + 3 * d);
  }
  return certain_sign(x + y + z, bound);
}

// The polynomial of polynomials::InDiametralBall, with u = b - a, v = c - a, w = p - a, x = b - c
// and U, V, W, X their squared lengths. By Cauchy and Schwarz the absolute monomials sum up to at
// most
//   U V sqrt(X W) + U V sqrt(X W) + 2 U V W <= U V (X + 3 W) =: F.
// Roundings of the first term: 5 in each scalar product (2 differences, 1 product, 2 sums), 2
// products, 2 sums, k = 19 (the third term: 8 + 3 in |n|^2, 5 in W, 1, 1). Inexact arguments: every
// vector is off by at most s = 2 sqrt(3) E in length; with rho = s / (smallest length) <= 2^-10
// the change is at most F ((1 + rho)^6 - 1) < 6.1 rho F. Underflow: fewer than 2^8 errors of
// 2^-1075, times at most S^2, S = 1 + U + V + W + X; overflow is excluded by S < 2^300.
inline int in_diametral_ball(const Approximation& a, const Approximation& b, const Approximation& c,
                             const Approximation& p) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double wx = p.x - a.x, wy = p.y - a.y, wz = p.z - a.z;
  const double xx = b.x - c.x, xy = b.y - c.y, xz = b.z - c.z;
  const double uu = ux * ux + uy * uy + uz * uz;
  const double vv = vx * vx + vy * vy + vz * vz;
  const double ww = wx * wx + wy * wy + wz * wz;
  const double xs = xx * xx + xy * xy + xz * xz;
  const double sum = 1 + uu + vv + ww + xs;
  if (!(sum < 0x1p300)) return 0;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double value = (vv * (ux * xx + uy * xy + uz * xz)) * (wx * ux + wy * uy + wz * uz) -
                       (uu * (vx * xx + vy * xy + vz * xz)) * (wx * vx + wy * vy + wz * vz) -
                       (nx * nx + ny * ny + nz * nz) * ww;
  const double scale = uu * vv * (xs + 3 * ww);
  double bound = scale * 0x1.3001p-49 + sum * sum * 0x1p-900;
  const double error = larger(larger(a.error, b.error), larger(c.error, p.error));
  if (error != 0) {
    const double smallest = -larger(larger(-uu, -vv), larger(-ww, -xs));
    const double rho = 3.5 * error / std::sqrt(smallest);
    if (!(rho < 0x1p-10)) return 0;
    bound += 6.1 * rho * scale;
  }
  return certain_sign(value, bound);
}

}  // namespace delmesher::predicates::filters
