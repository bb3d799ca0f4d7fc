#include "oracles/mesh/hull.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "oracles/base/distances.h"
#include "oracles/base/union_find.h"
#include "oracles/mesh/measures.h"
#include "oracles/mesh/regions.h"
#ifdef TETPROOF_SECOND_OPINIONS
#include "oracles/cgal/kernel_opinion.h"
#endif

namespace tetproof::oracles {
namespace {

class Hull {
 public:
  Hull(const TetComplex& complex, const Neighbours& neighbours, const HullOptions& options)
      : complex_(complex),
        neighbours_(neighbours),
        points_(*complex.points),
        options_(options),
        allowed_(options.allowed) {
    for (Index i = 0; i < neighbours.across.size(); ++i) {
      if (neighbours.across[i] != kNone) continue;
      faces_.push_back(face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4)));
    }
  }

  OracleReport run() {
    check_edges();
    check_volume();
    return std::move(report_);
  }

 private:
  struct Side {
    Index from, to, opposite, face;
    bool operator<(const Side& other) const {
      return std::tie(from, to) < std::tie(other.from, other.to);
    }
  };

  void check_edges();
  void check_edge(const Side& side, const Side& other);
  void check_volume();
  void compare(const ExactSum& sum, const ExactSum& body, const char* whose);
  double area() const;  // in squares of 2^area_unit() input units

  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const ExactPoints& points_;
  const HullOptions options_;
  double allowed_;
  std::vector<Face> faces_;
  std::vector<std::uint8_t> corner_;  // per point: at the end of an edge that is not flat
  OracleReport report_{"hull", "boundary edges"};
};

// Every edge once each way, convex; the faces are connected, and vertices + faces - edges = 2.
void Hull::check_edges() {
  corner_.assign(points_.size(), 0);
  std::vector<Side> sides;
  for (Index f = 0; f < faces_.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      sides.push_back({faces_[f][i], faces_[f][(i + 1) % 3], faces_[f][(i + 2) % 3], f});
    }
  }
  std::sort(sides.begin(), sides.end());
  UnionFind joined(faces_.size());
  std::size_t components = faces_.size();
  std::int64_t euler = static_cast<std::int64_t>(faces_.size());
  std::vector<std::uint8_t> used(points_.size(), 0);
  for (const Side& side : sides) {
    if (!used[side.from]) ++euler;
    used[side.from] = 1;
    const auto [low, high] =
        std::equal_range(sides.begin(), sides.end(), Side{side.to, side.from, 0, 0});
    if (high - low != 1) {
      report_.fail("boundary edge " + complex_.vertex_name(side.from) + " - " +
                       complex_.vertex_name(side.to) + " does not have one face on each side",
                   complex_.edge_site(side.from, side.to));
      continue;
    }
    components -= joined.unite(side.face, low->face) ? 1 : 0;
    if (side.from > side.to) continue;
    --euler;
    check_edge(side, *low);
  }
  if (components != 1) {
    report_.fail("the outer boundary consists of " + std::to_string(components) + " pieces");
  } else if (euler != 2) {
    report_.fail("the outer boundary is not a sphere: its Euler characteristic is " +
                 std::to_string(euler));
  }
}

void Hull::check_edge(const Side& side, const Side& other) {
  ++report_.checked;
  const auto& [a, b, c, face] = side;
  const int sign = exact::orient3d(points_, a, b, c, other.opposite);
  if (sign != 0) corner_[a] = corner_[b] = 1;
  if (sign < 0) return;
  const ExactVector m = exact::area2(points_, a, b, c),
                    n = exact::area2(points_, b, a, other.opposite);
  if (sign == 0 && exact::dot(m, n) > 0) return;
  if (sign > 0 && allowed_ > 0) {
    // How far the opposite corner is in front of the face.
    const double height = component(exact::dot(m, exact::difference(points_, a, other.opposite)), m,
                                    points_.exponent());
    if (height <= allowed_) return;
  }
  report_.fail("the outer boundary is not convex at edge " + complex_.vertex_name(a) + " - " +
                   complex_.vertex_name(b),
               complex_.edge_site(a, b));
}

#ifdef TETPROOF_SECOND_OPINIONS
double Hull::area() const {
  double sum = 0;
  for (const Face& f : faces_) {
    const ExactVector n = exact::area2(points_, f[0], f[1], f[2]);
    sum += length(n, 2 * (points_.exponent() - area_unit(points_.largest_coordinate()))) / 2;
  }
  return sum;
}

void Hull::check_volume() {
  const ExactSum sum = sum_of_volumes6(complex_, neighbours_, {});
  std::vector<Index> corners;
  for (Index v = 0; v < corner_.size(); ++v) {
    if (corner_[v]) corners.push_back(v);
  }
  const ExactSum hull(cgal_hull_volume6(points_, corners));
  const long exponent = 3 * points_.exponent();
  const double volume = hull.value(exponent) / 6;
  report_.figures.emplace_back("volume of the hull", volume);
  compare(sum, hull, "the hull's");
  if (!options_.of.empty()) {
    compare(sum, ExactSum(cgal_hull_volume6(points_, options_.of)), "that of the input's hull,");
  }
}

void Hull::compare(const ExactSum& sum, const ExactSum& body, const char* whose) {
  if (sum == body) return;
  const long exponent = 3 * points_.exponent();
  const double excess = difference(sum, body, exponent) / 6;
  report_.figures.emplace_back("difference", excess);
  // In the unit of areas times the input's.
  const double thick =
      difference(sum, body, exponent - 2 * area_unit(points_.largest_coordinate())) / 6;
  if (allowed_ > 0 && std::fabs(thick) <= 2 * allowed_ * area()) return;
  char text[128];
  std::snprintf(text, sizeof text, "all tetrahedra have a volume that differs by %.3g from %s %.6g",
                excess, whose, body.value(exponent) / 6);
  report_.fail(text);
}
#else
void Hull::check_volume() {
  report_.notes.push_back(kNoSecondOpinion);
}
#endif

}  // namespace

OracleReport check_hull(const TetComplex& complex, const Neighbours& neighbours,
                        const HullOptions& options) {
  return Hull(complex, neighbours, options).run();
}

}  // namespace tetproof::oracles
