#include "reports/benchmark/floor.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <numeric>

#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "reports/thread_seconds.h"

namespace tetproof::benchmark {
namespace {

using delmesher::ExactPoint;
using delmesher::base::VertexId;
using delmesher::predicates::PointStore;

Timing timed_build(PointStore& points, const std::vector<VertexId>& vertices) {
  const delmesher::Options options;
  delmesher::base::Control control(options);
  delmesher::predicates::Predicates predicates(points);
  delmesher::delaunay::Tetrahedrization mesh(predicates);
  const double start = thread_seconds();
  mesh.build(vertices, control);
  Timing timing;
  timing.seconds = thread_seconds() - start;
  timing.tetrahedra = mesh.tetrahedra();
  return timing;
}

void add(PointStore& points, const ExactPoint& p) {
  switch (p.kind) {
    case ExactPoint::Kind::explicit_point:
      points.add_explicit(p.x, p.y, p.z);
      break;
    case ExactPoint::Kind::on_segment:
      points.add_on_segment(p.i, p.j, p.x);
      break;
    case ExactPoint::Kind::on_triangle:
      points.add_on_triangle(p.i, p.j, p.k, p.x, p.y);
      break;
    case ExactPoint::Kind::on_planes:
      points.add_on_planes(p.i, p.j, p.k);
      break;
  }
}

PointStore store_of(const FinalPoints& final) {
  PointStore points;
  points.reserve(final.all.size());
  for (const auto& plane : final.planes) {
    points.add_plane({plane.normal, plane.through, plane.spanned});
  }
  for (const ExactPoint& p : final.all) add(points, p);
  return points;
}

}  // namespace

Timing cgal_delaunay(const std::vector<std::array<double, 3>>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> list;
  list.reserve(points.size());
  for (const auto& p : points) list.emplace_back(p[0], p[1], p[2]);
  const double start = thread_seconds();
  const CGAL::Delaunay_triangulation_3<Kernel> triangulation(list.begin(), list.end());
  Timing timing;
  timing.seconds = thread_seconds() - start;
  timing.tetrahedra = triangulation.number_of_finite_cells();
  return timing;
}

Timing own_delaunay(const std::vector<std::array<double, 3>>& points) {
  PointStore store;
  store.reserve(points.size());
  for (const auto& p : points) store.add_explicit(p[0], p[1], p[2]);
  std::vector<VertexId> vertices(points.size());
  std::iota(vertices.begin(), vertices.end(), VertexId{0});
  return timed_build(store, vertices);
}

FinalPoints::FinalPoints(const delmesher::ExactRecord& record)
    : planes(record.planes), all(record.points) {
  for (const auto& t : record.final) used.insert(used.end(), t.vertices.begin(), t.vertices.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const PointStore points = store_of(*this);
  for (const std::uint32_t v : used) nearest.push_back(points.nearest(v));
  // Rounding may have made neighbours of a sharp corner coincide.
  std::sort(nearest.begin(), nearest.end());
  nearest.erase(std::unique(nearest.begin(), nearest.end()), nearest.end());
}

Timing FinalPoints::own_delaunay() const {
  PointStore points = store_of(*this);
  return timed_build(points, used);
}

}  // namespace tetproof::benchmark
