#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "fuzz/properties.h"
#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"

namespace tetproof::fuzz {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Cell = std::array<std::uint32_t, 4>;

std::vector<std::array<double, 3>> read_points(Bytes& bytes) {
  std::set<std::array<double, 3>> seen;
  std::vector<std::array<double, 3>> points;
  while (!bytes.empty() && points.size() < 40) {
    const double x = bytes.coordinate(), y = bytes.coordinate(), z = bytes.coordinate();
    // -0 is the same point as 0.
    if (seen.insert({x + 0.0, y + 0.0, z + 0.0}).second) points.push_back({x, y, z});
  }
  return points;
}

bool span_space(const std::vector<Point>& p) {
  for (std::size_t c = 2; c < p.size(); ++c) {
    if (CGAL::collinear(p[0], p[1], p[c])) continue;
    return std::any_of(p.begin(), p.end(), [&](const Point& d) {
      return CGAL::orientation(p[0], p[1], p[c], d) != CGAL::COPLANAR;
    });
  }
  return false;
}

Cell sorted(Cell cell) {
  std::sort(cell.begin(), cell.end());
  return cell;
}

// Every tetrahedron positive and with an empty sphere. `ties` tells whether a point lies on one.
Finding judge(const std::set<Cell>& cells, const std::vector<Point>& p,
              const std::vector<Cell>& ours, bool& ties) {
  ties = false;
  for (const Cell& c : ours) {
    const Point &a = p[c[0]], &b = p[c[1]], &d = p[c[2]], &e = p[c[3]];
    if (CGAL::orientation(a, b, d, e) != CGAL::POSITIVE)
      return "delaunay orientation: not positive";
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      if (std::find(c.begin(), c.end(), v) != c.end()) continue;
      const auto side = CGAL::side_of_oriented_sphere(a, b, d, e, p[v]);
      if (side == CGAL::ON_POSITIVE_SIDE) return "delaunay sphere: not empty";
      ties = ties || side == CGAL::ON_ORIENTED_BOUNDARY;
    }
  }
  return cells.size() == ours.size() ? "" : "delaunay cells: one occurs twice";
}

}  // namespace

Finding delaunay_agrees(Bytes bytes) {
  const auto coordinates = read_points(bytes);
  std::vector<Point> p;
  for (const auto& [x, y, z] : coordinates) p.emplace_back(x, y, z);
  if (p.size() < 4 || !span_space(p)) return {};
  delmesher::PointStore store;
  std::vector<delmesher::VertexId> ids;
  for (const auto& [x, y, z] : coordinates) ids.push_back(store.add_explicit(x, y, z));
  delmesher::Predicates predicates(store);
  delmesher::Tetrahedrization mesh(predicates);
  const delmesher::Options options;
  delmesher::Control control(options);
  try {
    mesh.build(ids, control);
    mesh.validate(true);
  } catch (const delmesher::InternalError& error) {
    return std::string("delaunay check: ") + error.what();
  }
  std::vector<Cell> ours;
  for (delmesher::TetId t = 0; t < mesh.capacity(); ++t) {
    if (!mesh.alive(t) || mesh.is_ghost(t)) continue;
    ours.push_back({mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2), mesh.vertex(t, 3)});
  }
  std::set<Cell> cells;
  for (const Cell& c : ours) cells.insert(sorted(c));
  bool ties = false;
  if (Finding f = judge(cells, p, ours, ties); !f.empty() || ties) return f;
  CGAL::Delaunay_triangulation_3<Kernel> theirs(p.begin(), p.end());
  std::map<Point, std::uint32_t> id_of;
  for (std::uint32_t v = 0; v < p.size(); ++v) id_of[p[v]] = v;
  std::set<Cell> other;
  for (auto c = theirs.finite_cells_begin(); c != theirs.finite_cells_end(); ++c) {
    other.insert(sorted({id_of[c->vertex(0)->point()], id_of[c->vertex(1)->point()],
                         id_of[c->vertex(2)->point()], id_of[c->vertex(3)->point()]}));
  }
  return cells == other ? "" : "delaunay cells: not those of CGAL";
}

}  // namespace tetproof::fuzz
