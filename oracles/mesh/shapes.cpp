#include "oracles/mesh/shapes.h"

#include <algorithm>
#include <cmath>

#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

constexpr int kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// With d six times the volume, n the doubled areas as vectors and l the edges: the radius of the
// inscribed sphere is d over the sum of |n|, that of the circumsphere |c| / (2 d), where c = |u|^2
// v x w + |v|^2 w x u + |w|^2 u x v for the edges u, v, w from one corner, and SICN is
// 6 d / sqrt(sum l^2 sum n^2).
struct Terms {
  double d, areas, squared_areas, squared_edges, c;
  TetShape shape() const {
    return {6 * (d / areas) * (d / c), 6 * d / std::sqrt(squared_edges * squared_areas)};
  }
};

// In doubles; false if they are not certain. As in angles.cpp, with edges of at most h that are
// off by at most e each, d is off by less than 300 h^2 e, |n| by less than 100 h e and |c| by less
// than 1000 h^3 e; and d is at most 3 h |n|, and |c| at least h d, because the circumsphere is no
// smaller than the longest edge.
bool terms_in_doubles(const ExactPoints& points, const Tet& tet, Terms& terms) {
  Position edge[6];
  double h = 0;
  terms.squared_edges = 0;
  for (int e = 0; e < 6; ++e) {
    edge[e] = points.close_difference(tet[kPairs[e][0]], tet[kPairs[e][1]]);
    for (const double x : edge[e]) h = std::max(h, std::fabs(x));
    terms.squared_edges += dot(edge[e], edge[e]);
  }
  if (!(h > 0x1p-100 && h < 0x1p100)) return false;  // else something could over- or underflow
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  const Position vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  terms.d = dot(u, vw);
  const double error = h * 0x1p-53 + points.close_error();
  if (!(1000 * h * h * error < 1e-8 * std::fabs(terms.d))) return false;
  terms.areas = terms.squared_areas = 0;
  for (const Position& n : {vw, wu, uv, cross(edge[3], edge[4])}) {
    terms.squared_areas += dot(n, n);
    terms.areas += std::sqrt(dot(n, n));
  }
  Position c;
  for (int axis = 0; axis < 3; ++axis) {
    c[axis] = dot(u, u) * vw[axis] + dot(v, v) * wu[axis] + dot(w, w) * uv[axis];
  }
  terms.c = std::sqrt(dot(c, c));
  return true;
}

constexpr mp_bitcnt_t kBits = 256;

mpf_class rounded(const ExactNumber& x) {
  mpq_class fraction;  // not in lowest terms, which take longer to find than all the rest
  fraction.get_num() = x.numerator();
  fraction.get_den() = x.denominator();
  return mpf_class(fraction, kBits);
}

TetShape exact_shape(const ExactPoints& points, const Tet& tet) {
  ExactVector edge[6];
  mpf_class squared_edges(0, kBits), areas(0, kBits), squared_areas(0, kBits);
  for (int e = 0; e < 6; ++e) {
    edge[e] = exact::difference(points, tet[kPairs[e][0]], tet[kPairs[e][1]]);
    squared_edges += rounded(exact::squared(edge[e]));
  }
  const auto &u = edge[0], &v = edge[1], &w = edge[2];
  const ExactVector vw = exact::cross(v, w), wu = exact::cross(w, u), uv = exact::cross(u, v);
  const ExactNumber volume6 = exact::dot(u, vw);
  if (sgn(volume6) == 0) return {0, 0};
  for (const ExactVector& n : {vw, wu, uv, exact::cross(edge[3], edge[4])}) {
    const mpf_class square = rounded(exact::squared(n));
    squared_areas += square;
    areas += sqrt(square);
  }
  ExactVector c;
  for (int axis = 0; axis < 3; ++axis) {
    c[axis] =
        exact::squared(u) * vw[axis] + exact::squared(v) * wu[axis] + exact::squared(w) * uv[axis];
  }
  const mpf_class d = rounded(volume6);
  const mpf_class radii(areas * sqrt(rounded(exact::squared(c))), kBits);
  const mpf_class gamma(6 * d * d / radii, kBits);
  const mpf_class sicn(6 * d / sqrt(mpf_class(squared_edges * squared_areas, kBits)), kBits);
  return {gamma.get_d(), sicn.get_d()};
}

// Linear between the two nearest values; leaves them in another order.
double one_percent(std::vector<double>& values) {
  const double place = 0.01 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const auto at = values.begin() + below;
  std::nth_element(values.begin(), at, values.end());
  const auto next = std::min_element(at + 1, values.end());
  const double share = place - static_cast<double>(below);
  return next == values.end() ? *at : (1 - share) * *at + share * *next;
}

}  // namespace

TetShape shape_of(const ExactPoints& points, const Tet& tet) {
  Terms terms;
  return terms_in_doubles(points, tet, terms) ? terms.shape() : exact_shape(points, tet);
}

void ShapeMeasure::add(const TetShape& shape, double smallest_dihedral) {
  dihedrals_.push_back(smallest_dihedral);
  gammas_.push_back(shape.gamma);
  below_5_ += smallest_dihedral < 5 ? 1 : 0;
  below_10_ += smallest_dihedral < 10 ? 1 : 0;
  smallest_gamma_ = std::min(smallest_gamma_, shape.gamma);
  smallest_sicn_ = std::min(smallest_sicn_, shape.sicn);
  gamma_sum_ += shape.gamma;
  sicn_sum_ += shape.sicn;
}

void ShapeMeasure::report(OracleReport& report) {
  if (gammas_.empty()) return;
  const auto count = static_cast<double>(gammas_.size());
  report.figures.emplace_back("tetrahedra below 5 degrees", below_5_);
  report.figures.emplace_back("tetrahedra below 10 degrees", below_10_);
  report.figures.emplace_back("1 % quantile of smallest dihedral angles", one_percent(dihedrals_));
  report.figures.emplace_back("smallest gamma", smallest_gamma_);
  report.figures.emplace_back("mean gamma", gamma_sum_ / count);
  report.figures.emplace_back("1 % quantile of gamma", one_percent(gammas_));
  report.figures.emplace_back("smallest SICN", smallest_sicn_);
  report.figures.emplace_back("mean SICN", sicn_sum_ / count);
}

}  // namespace tetproof::oracles
