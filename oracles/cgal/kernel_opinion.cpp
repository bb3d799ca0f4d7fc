#include "oracles/cgal/kernel_opinion.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_data_structure_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/convex_hull_3.h>

namespace tetproof::oracles {
namespace {

using Rough = CGAL::Simple_cartesian<CGAL::Interval_nt<false>>;
// Both predicates need ring operations only, so integers suffice; points with denominators are
// multiplied by a common one.
using Exact = CGAL::Simple_cartesian<CGAL::Gmpz>;

Rough::Point_3 rough_point(const ExactPoints& points, Index i) {
  const IntervalVector enclosure = points.enclosure(i);
  const auto coordinate = [&](std::size_t axis) {
    const Interval& x = enclosure[axis];
    return CGAL::Interval_nt<false>(x.low, x.high);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

Exact::Point_3 exact_point(const ExactPoints& points, Index i, const mpz_class& denominator) {
  const ExactVector exact = points.exact(i);
  const auto coordinate = [&](std::size_t axis) {
    const ExactNumber& x = exact[axis];
    if (x.is_integer() && denominator == 1) return CGAL::Gmpz(x.numerator().get_mpz_t());
    return CGAL::Gmpz(mpz_class(x.numerator() * (denominator / x.denominator())).get_mpz_t());
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

template <class... Indices>
mpz_class common_denominator(const ExactPoints& points, Indices... indices) {
  mpz_class result = 1;
  if (points.all_integers()) return result;
  for (const Index i : {indices...}) {
    if (points.is_integer(i)) continue;
    for (const ExactNumber& x : points.exact(i)) result = lcm(result, x.denominator());
  }
  return result;
}

}  // namespace

struct KernelOpinion::Kernel {
  const ExactPoints& points;

  // CGAL's intervals need the rounding mode set upwards, and tell when they are not certain. Of
  // numbers below the least normal double they say 0 where the sign is not.
  template <class Predicate, class... Indices>
  int decide(const Predicate& predicate, Indices... indices) const {
    {
      const CGAL::Protect_FPU_rounding<true> protection;
      const auto rough = predicate(rough_point(points, indices)...);
      const int sign = CGAL::is_certain(rough) ? static_cast<int>(CGAL::get_certain(rough)) : 0;
      const bool normal = points.exponent() >= -1022;
      if (sign != 0 || (normal && CGAL::is_certain(rough))) return sign;
    }
    const mpz_class denominator = common_denominator(points, indices...);
    return static_cast<int>(
        CGAL::make_certain(predicate(exact_point(points, indices, denominator)...)));
  }
};

KernelOpinion::KernelOpinion(const ExactPoints& points)
    : kernel_(std::make_unique<const Kernel>(Kernel{points})) {}
KernelOpinion::~KernelOpinion() = default;

int KernelOpinion::orient3d(Index a, Index b, Index c, Index d) const {
  return kernel_->decide([](const auto&... p) { return CGAL::orientation(p...); }, a, b, c, d);
}

int KernelOpinion::insphere(Index a, Index b, Index c, Index d, Index e) const {
  return kernel_->decide([](const auto&... p) { return CGAL::side_of_oriented_sphere(p...); }, a, b,
                         c, d, e);
}

ExactNumber cgal_hull_volume6(const ExactPoints& points, std::span<const Index> corners) {
  using Rational = CGAL::Simple_cartesian<CGAL::Gmpq>;
  std::vector<Rational::Point_3> list;
  list.reserve(corners.size());
  for (const Index v : corners) {
    const ExactVector exact = points.exact(v);
    const auto coordinate = [&](std::size_t axis) {
      return CGAL::Gmpq(exact[axis].rational().get_mpq_t());
    };
    list.emplace_back(coordinate(0), coordinate(1), coordinate(2));
  }
  CGAL::Surface_mesh<Rational::Point_3> hull;
  CGAL::convex_hull_3(list.begin(), list.end(), hull);
  if (hull.number_of_faces() == 0) return 0;
  const Rational::Point_3 origin(0, 0, 0);
  CGAL::Gmpq sum = 0;
  for (const auto face : hull.faces()) {
    // Faces may be polygons, which are taken as fans of triangles around their first corner.
    std::vector<Rational::Point_3> ring;
    for (const auto v : hull.vertices_around_face(hull.halfedge(face))) {
      ring.push_back(hull.point(v));
    }
    for (std::size_t i = 2; i < ring.size(); ++i) {
      sum += CGAL::determinant(ring[0] - origin, ring[i - 1] - origin, ring[i] - origin);
    }
  }
  return ExactNumber(mpq_class(abs(mpq_class(sum.mpq()))));
}

std::vector<std::array<Index, 4>> cgal_delaunay(std::span<const Position> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
  using Structure =
      CGAL::Triangulation_data_structure_3<VertexBase,
                                           CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  std::vector<std::pair<Kernel::Point_3, Index>> list;
  list.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    list.emplace_back(Kernel::Point_3(points[i][0], points[i][1], points[i][2]),
                      static_cast<Index>(i));
  }
  const CGAL::Delaunay_triangulation_3<Kernel, Structure> triangulation(list.begin(), list.end());
  std::vector<std::array<Index, 4>> tetrahedra;
  tetrahedra.reserve(triangulation.number_of_finite_cells());
  for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end();
       ++cell) {
    tetrahedra.push_back({cell->vertex(0)->info(), cell->vertex(1)->info(), cell->vertex(2)->info(),
                          cell->vertex(3)->info()});
  }
  return tetrahedra;
}

}  // namespace tetproof::oracles
