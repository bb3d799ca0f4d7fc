#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>
#include <set>

#include "corpus/generators/random.h"
#include "fuzz/properties.h"
#include "mesher/base/check.h"
#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "oracles/base/exact_points.h"
#include "oracles/base/exact_sum.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

namespace exact = oracles::exact;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Points = std::vector<std::array<double, 3>>;
using Cell = std::array<std::uint32_t, 4>;

// Spheres with a point on them besides their own four: any choice is Delaunay.
Leniency ties_found("not-unique-not-compared", 0.6);
Leniency dissimilar("exponents-too-far-apart-for-cgal", 0.3);
Leniency not_spatial("points-in-one-plane", 0.3);

constexpr std::uint32_t kMostPoints = 300;

// Points one by one, with any doubles: two dozen show the bugs that few points can show.
Points points_of_bytes(Bytes& bytes) {
  Points points;
  while (!bytes.empty() && points.size() < 24) {
    const double x = bytes.coordinate(), y = bytes.coordinate(), z = bytes.coordinate();
    points.push_back({x, y, z});
  }
  return points;
}

// Any number of points from a seed, with many ties or nearly so: on a grid, on a sphere of a grid,
// near a plane, in clusters, anywhere.
Points points_of_seed(Bytes& bytes) {
  const std::uint32_t kind = bytes.below(6), count = 4 + (bytes.byte() << 8 | bytes.byte()) % 297;
  const int fine = 1 + static_cast<int>(bytes.below(7));
  Random random(bytes.word());
  const auto on_grid = [&] { return random.integer(-fine, fine) * 0.25; };
  Points points;
  for (std::uint32_t i = 0; i < count; ++i) {
    switch (kind) {
      case 0:
        points.push_back({on_grid(), on_grid(), on_grid()});
        break;
      case 1: {  // signs and permutations of few triples: on few spheres
        const double triples[][3] = {{0, 0, 3}, {1, 2, 2}, {0, 0, 7}, {2, 3, 6}, {1, 4, 8}};
        const auto& t = triples[random.below(5)];
        const std::uint64_t turn = random.below(3);
        points.push_back({random.sign() * t[turn], random.sign() * t[(turn + 1) % 3],
                          random.sign() * t[(turn + 2) % 3]});
        break;
      }
      case 2:
        points.push_back({random.unit(), random.unit(),
                          random.chance(0.5) ? 0.1 : 0.1 + random.sign() * random.tiny(54)});
        break;
      case 3: {
        const double reach = random.tiny(30);
        points.push_back({on_grid() + reach * random.unit(), on_grid() + reach * random.unit(),
                          on_grid() + reach * random.unit()});
        break;
      }
      case 4: {  // nearly on a sphere
        const double u = random.between(-1, 1), v = random.between(-1, 1);
        const double w = 1 + u * u + v * v;
        points.push_back({2 * u / w, 2 * v / w, (w - 2) / w});
        break;
      }
      default:
        points.push_back({random.unit(), random.unit(), random.unit()});
    }
  }
  return points;
}

Points read_points(Bytes& bytes) {
  const Points all = bytes.below(2) == 0 ? points_of_bytes(bytes) : points_of_seed(bytes);
  std::set<std::array<double, 3>> seen;
  Points points;
  for (const auto& [x, y, z] : all) {
    // -0 is the same point as 0.
    if (points.size() < kMostPoints && seen.insert({x + 0.0, y + 0.0, z + 0.0}).second) {
      points.push_back({x, y, z});
    }
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

// CGAL's exact arithmetic is slow where coordinates differ by hundreds of binary digits.
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

// Every tetrahedron is positive, and no point is in the sphere of any. Among few points all are
// asked; among more the points beside its faces, which is enough in a complex that fills the hull.
// `ties`: does a point lie on a sphere?
class Judge {
 public:
  Judge(const oracles::ExactPoints& points, const std::vector<Cell>& cells)
      : points_(points), cells_(cells) {}

  Finding run(bool& ties) {
    for (const Cell& c : cells_) {
      if (exact::orient3d(points_, c[0], c[1], c[2], c[3]) <= 0) {
        return "delaunay orientation: not positive";
      }
    }
    if (Finding f = collect_faces(); !f.empty()) return f;
    if (Finding f = judge_hull(); !f.empty()) return f;
    if (Finding f = judge_volume(); !f.empty()) return f;
    constexpr std::uint32_t kFew = 24;
    return points_.size() <= kFew ? judge_all(ties) : judge_neighbours(ties);
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> corners{};  // seen from the first of them
    std::vector<std::uint32_t> cells;
  };

  Finding collect_faces() {
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      const Cell& c = cells_[i];
      for (const auto& f : {std::array{c[1], c[3], c[2]}, std::array{c[0], c[2], c[3]},
                            std::array{c[0], c[3], c[1]}, std::array{c[0], c[1], c[2]}}) {
        auto key = f;
        std::sort(key.begin(), key.end());
        Face& face = faces_[key];
        face.corners = f;
        face.cells.push_back(i);
        if (face.cells.size() > 2) return "delaunay faces: of three tetrahedra";
      }
    }
    return {};
  }

  // Faces of one tetrahedron only have all points on their inner side, or the hull is not covered.
  Finding judge_hull() const {
    for (const auto& [key, face] : faces_) {
      if (face.cells.size() == 2) continue;
      const auto& f = face.corners;
      for (std::uint32_t v = 0; v < points_.size(); ++v) {
        if (exact::orient3d(points_, f[0], f[1], f[2], v) < 0) {
          return "delaunay hull: a point outside";
        }
      }
    }
    return {};
  }

  // The tetrahedra together have the volume that the hull's faces enclose, seen from a point.
  // Otherwise two of them use a face from the same side.
  Finding judge_volume() const {
    oracles::ExactSum inside, around;
    for (const Cell& c : cells_) inside += exact::volume6(points_, c[0], c[1], c[2], c[3]);
    for (const auto& [key, face] : faces_) {
      const auto& f = face.corners;
      if (face.cells.size() == 1) around += exact::volume6(points_, f[0], f[1], f[2], 0);
    }
    return inside == around ? "" : "delaunay volume: not that of the hull";
  }

  Finding judge_all(bool& ties) const {
    for (const Cell& c : cells_) {
      for (std::uint32_t v = 0; v < points_.size(); ++v) {
        if (Finding f = judge_point(c, v, ties); !f.empty()) return f;
      }
    }
    return {};
  }

  Finding judge_neighbours(bool& ties) const {
    for (const auto& [key, face] : faces_) {
      if (face.cells.size() != 2) continue;
      for (const std::uint32_t v : cells_[face.cells[1]]) {
        if (Finding f = judge_point(cells_[face.cells[0]], v, ties); !f.empty()) return f;
      }
    }
    return {};
  }

  Finding judge_point(const Cell& c, std::uint32_t v, bool& ties) const {
    if (std::find(c.begin(), c.end(), v) != c.end()) return {};
    const int side = exact::insphere(points_, c[0], c[1], c[2], c[3], v);
    ties = ties || side == 0;
    return side > 0 ? "delaunay sphere: not empty" : "";
  }

  const oracles::ExactPoints& points_;
  const std::vector<Cell>& cells_;
  std::map<std::array<std::uint32_t, 3>, Face> faces_;
};

// Without ties there is only one Delaunay tetrahedrization.
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
  if (coordinates.size() < 4 || !p.assign(coordinates).empty()) return {};
  judging({&not_spatial, &ties_found, &dissimilar});
  if (!span_space(p)) {
    not_spatial.take();
    return {};
  }
  delmesher::predicates::PointStore store;
  std::vector<delmesher::base::VertexId> ids;
  for (const auto& [x, y, z] : coordinates) ids.push_back(store.add_explicit(x, y, z));
  delmesher::predicates::Predicates predicates(store);
  delmesher::delaunay::Tetrahedrization mesh(predicates);
  const delmesher::Options options;
  delmesher::base::Control control(options);
  try {
    mesh.build(ids, control);
    mesh.validate(true);
  } catch (const delmesher::base::InternalError& error) {
    return std::string("delaunay check: ") + error.what();
  }
  std::vector<Cell> ours;
  for (delmesher::base::TetId t = 0; t < mesh.capacity(); ++t) {
    if (!mesh.alive(t) || mesh.is_ghost(t)) continue;
    ours.push_back({mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2), mesh.vertex(t, 3)});
  }
  std::set<Cell> cells;
  for (const Cell& c : ours) cells.insert(sorted(c));
  if (cells.size() != ours.size()) return "delaunay cells: one occurs twice";
  bool ties = false;
  if (Finding f = Judge(p, ours).run(ties); !f.empty()) return f;
  if (ties) {
    ties_found.take();
  } else if (!similar(coordinates)) {
    dissimilar.take();
  } else {
    return compare_with_cgal(coordinates, cells);
  }
  return {};
}

}  // namespace tetproof::fuzz
