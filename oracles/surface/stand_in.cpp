#include "oracles/surface/stand_in.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "oracles/base/distances.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;
using Triangles = std::vector<std::array<Index, 3>>;

class StandInCheck {
 public:
  StandInCheck(const Polyhedron& input, const ExactRecord& record, const InputSurface& surface)
      : input_(input),
        record_(record),
        surface_(surface),
        triangles_(record.triangles.empty() ? input.triangles : record.triangles),
        given_(static_cast<Index>(input.vertices.size())) {}

  OracleReport run() {
    // The vertices that were meshed, then those as given: corners refer to no other points.
    std::vector<ExactPoint> all(record_.points.begin(), record_.points.begin() + given_);
    const std::vector<ExactPoint> given = explicit_points(input_.vertices);
    all.insert(all.end(), given.begin(), given.end());
    if (std::string why = points_.assign(all, record_.planes); !why.empty()) {
      report_.fail(why);
      return std::move(report_);
    }
    const InputSurface::Members members = surface_.members();
    const auto facets = static_cast<Index>(surface_.facets().size());
    grouped_.assign(given_, 0);
    for (Index facet = 0; facet < facets; ++facet) {
      if (members.of(facet).size() < 2) continue;
      for (const Index t : members.of(facet)) {
        for (const Index v : triangles_[t]) grouped_[v] = 1;
      }
    }
    check_vertices();
    for (Index facet = 0; facet < facets; ++facet) check_facet(facet, members.of(facet));
    report_.figures.emplace_back("facets", surface_.facets().size());
    report_.figures.emplace_back("vertices moved", moved_);
    report_.figures.emplace_back("deviation", deviation_);
    report_.figures.emplace_back("displacement", displacement_);
    return std::move(report_);
  }

 private:
  bool moved(Index v) const { return record_.points[v].kind == ExactPoint::Kind::on_planes; }

  void check_vertices() {
    std::vector<double> shortest(given_, HUGE_VAL);
    for (const auto& t : input_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = t[i], b = t[(i + 1) % 3];
        const double length = exact::distance(points_, given_ + a, given_ + b);
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    }
    for (Index v = 0; v < given_; ++v) {
      if (!moved(v)) continue;
      ++moved_;
      ++report_.checked;
      const double distance = exact::distance(points_, v, given_ + v);
      displacement_ = std::max(displacement_, distance);
      if (shortest[v] == HUGE_VAL) {
        report_.fail("vertex " + std::to_string(v) + " was moved, and is in no triangle");
      } else if (grouped_[v] == 0) {
        report_.fail("vertex " + std::to_string(v) +
                     " was moved, and is in no facet of more than one triangle");
      } else if (!(4 * distance <= shortest[v] * (1 + 1e-9))) {
        report_.fail("vertex " + std::to_string(v) + " was moved by " + std::to_string(distance) +
                     ", its shortest edge is " + std::to_string(shortest[v]) + " long");
      }
    }
  }

  void check_facet(Index facet, std::span<const Index> members) {
    ++report_.checked;
    const std::string name = "facet " + std::to_string(surface_.facets()[facet].id);
    if (!record_.triangles.empty() && !same_outline(members)) {
      report_.fail(name + " has other corners or another outline than as given");
    }
    // A triangle is written on its corners as given, wherever they were moved in between.
    if (members.size() == 1) return;
    std::vector<Index> vertices;
    for (const Index t : members) {
      vertices.insert(vertices.end(), input_.triangles[t].begin(), input_.triangles[t].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return moved(v); })) return;
    const ExactVector normal = normal_of(members);
    const ExactNumber length2 = exact::squared(normal);
    const Index origin = triangles_[members[0]][0];
    mpq_class bound(record_.parameters.planar);
    bound *= bound;
    for (const Index v : vertices) {
      const ExactNumber height = exact::dot(normal, exact::difference(points_, origin, given_ + v));
      if (height == 0) continue;
      const mpq_class square = ratio(height * height, length2);
      deviation_ = std::max(deviation_, square_root(square, points_.exponent()));
      if (times_power_of_two(square, 2 * points_.exponent()) <= bound) continue;
      report_.fail("vertex " + std::to_string(v) + " is farther from the plane of " + name +
                   " than the record says");
    }
  }

  // All of a facet's triangles are in its plane; some may be degenerate.
  ExactVector normal_of(std::span<const Index> members) const {
    ExactVector normal;
    for (const Index t : members) {
      const auto& [a, b, c] = triangles_[t];
      normal = exact::area2(points_, a, b, c);
      if (!exact::is_zero(normal)) break;
    }
    return normal;
  }

  struct Outline {
    std::vector<Index> corners;
    std::vector<std::pair<Index, Index>> sides;
    bool operator==(const Outline&) const = default;
  };
  static Outline outline(const Triangles& triangles, std::span<const Index> members) {
    Outline result;
    std::vector<std::pair<Index, Index>> all;
    for (const Index t : members) {
      for (std::size_t i = 0; i < 3; ++i) {
        result.corners.push_back(triangles[t][i]);
        all.emplace_back(triangles[t][i], triangles[t][(i + 1) % 3]);
      }
    }
    std::sort(all.begin(), all.end());
    for (const auto& [a, b] : all) {
      if (!std::binary_search(all.begin(), all.end(), std::pair(b, a))) {
        result.sides.emplace_back(a, b);
      }
    }
    std::sort(result.corners.begin(), result.corners.end());
    result.corners.erase(std::unique(result.corners.begin(), result.corners.end()),
                         result.corners.end());
    return result;
  }
  bool same_outline(std::span<const Index> members) const {
    return outline(input_.triangles, members) == outline(triangles_, members);
  }

  const Polyhedron& input_;
  const ExactRecord& record_;
  const InputSurface& surface_;
  const Triangles& triangles_;
  const Index given_;
  ExactPoints points_;
  std::vector<std::uint8_t> grouped_;  // per vertex: is it in a facet of several triangles?
  std::uint64_t moved_ = 0;
  double deviation_ = 0, displacement_ = 0;
  OracleReport report_{"stand-in", "moved vertices and facets"};
};

}  // namespace

OracleReport check_stand_in(const Polyhedron& input, const ExactRecord& record,
                            const InputSurface& surface) {
  return StandInCheck(input, record, surface).run();
}

}  // namespace tetproof::oracles
