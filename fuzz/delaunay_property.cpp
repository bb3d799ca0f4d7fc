#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>
#include <set>

#include "fuzz/properties.h"
#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "oracles/exact_points.h"

namespace tetproof::fuzz {
namespace {

namespace exact = oracles::exact;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Points = std::vector<std::array<double, 3>>;
using Cell = std::array<std::uint32_t, 4>;

// Few: what can go wrong among many goes wrong among two dozen, and more inputs are tried.
Points read_points(Bytes& bytes) {
  std::set<std::array<double, 3>> seen;
  Points points;
  while (!bytes.empty() && points.size() < 24) {
    const double x = bytes.coordinate(), y = bytes.coordinate(), z = bytes.coordinate();
    // -0 is the same point as 0.
    if (seen.insert({x + 0.0, y + 0.0, z + 0.0}).second) points.push_back({x, y, z});
  }
  return points;
}

bool span_space(const oracles::ExactPoints& p) {
  const auto count = static_cast<std::uint32_t>(p.size());
  for (std::uint32_t c = 2; c < count; ++c) {
    if (exact::is_zero(exact::area2(p, 0, 1, c))) continue;
    for (std::uint32_t d = 2; d < count; ++d) {
      if (exact::orient3d(p, 0, 1, c, d) != 0) return true;
    }
    return false;
  }
  return false;
}

// CGAL's exact arithmetic takes its time where coordinates differ by hundreds of binary digits.
bool similar(const Points& points) {
  int low = INT_MAX, high = INT_MIN;
  for (const auto& p : points) {
    for (const double x : p) {
      if (x == 0) continue;
      low = std::min(low, std::ilogb(x));
      high = std::max(high, std::ilogb(x));
    }
  }
  return low == INT_MAX || high - low < 100;
}

Cell sorted(Cell cell) {
  std::sort(cell.begin(), cell.end());
  return cell;
}

// Every tetrahedron positive and with an empty sphere. `ties` tells whether a point lies on one.
Finding judge(const std::set<Cell>& cells, const oracles::ExactPoints& p,
              const std::vector<Cell>& ours, bool& ties) {
  ties = false;
  for (const Cell& c : ours) {
    if (exact::orient3d(p, c[0], c[1], c[2], c[3]) <= 0) {
      return "delaunay orientation: not positive";
    }
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      if (std::find(c.begin(), c.end(), v) != c.end()) continue;
      const int side = exact::insphere(p, c[0], c[1], c[2], c[3], v);
      if (side > 0) return "delaunay sphere: not empty";
      ties = ties || side == 0;
    }
  }
  return cells.size() == ours.size() ? "" : "delaunay cells: one occurs twice";
}

// The faces of one tetrahedron only have all points on their inner side, or the hull is not
// covered.
Finding judge_hull(const oracles::ExactPoints& p, const std::vector<Cell>& ours) {
  std::map<std::array<std::uint32_t, 3>, std::pair<int, std::array<std::uint32_t, 3>>> faces;
  for (const Cell& c : ours) {
    for (const auto& f : {std::array{c[1], c[3], c[2]}, std::array{c[0], c[2], c[3]},
                          std::array{c[0], c[3], c[1]}, std::array{c[0], c[1], c[2]}}) {
      auto key = f;
      std::sort(key.begin(), key.end());
      auto& [count, face] = faces[key];
      ++count;
      face = f;
    }
  }
  for (const auto& [key, entry] : faces) {
    const auto& [count, f] = entry;
    if (count > 2) return "delaunay faces: of three tetrahedra";
    for (std::uint32_t v = 0; count == 1 && v < p.size(); ++v) {
      if (exact::orient3d(p, f[0], f[1], f[2], v) < 0) return "delaunay hull: a point outside";
    }
  }
  return {};
}

// No ties, so there is only one.
Finding compare_with_cgal(const Points& coordinates, const std::set<Cell>& cells) {
  std::vector<Point> p;
  for (const auto& [x, y, z] : coordinates) p.emplace_back(x, y, z);
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

}  // namespace

Finding delaunay_agrees(Bytes bytes) {
  if (bytes.below(8) != 7) bytes.narrow();
  const Points coordinates = read_points(bytes);
  oracles::ExactPoints p;
  if (coordinates.size() < 4 || !p.assign(coordinates).empty() || !span_space(p)) return {};
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
  if (Finding f = judge(cells, p, ours, ties); !f.empty()) return f;
  if (Finding f = judge_hull(p, ours); !f.empty()) return f;
  return ties || !similar(coordinates) ? "" : compare_with_cgal(coordinates, cells);
}

}  // namespace tetproof::fuzz
