#include "mesher/geometry/orientation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "mesher/geometry/vector.h"

namespace delmesher::geometry {
namespace {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller vertex first

std::map<Edge, std::vector<std::uint32_t>> triangles_at_edges(
    const std::vector<Triangle>& triangles) {
  std::map<Edge, std::vector<std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges[std::minmax(triangles[t][k], triangles[t][(k + 1) % 3])].push_back(t);
    }
  }
  return edges;
}

bool runs_along(const Triangle& t, std::uint32_t a, std::uint32_t b) {
  return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
}

// The patches of a surface, as solids where they are closed.
class Nesting {
 public:
  Nesting(Surface& surface, std::vector<Patch> patches, Polling& polling)
      : surface_(surface), patches_(std::move(patches)), polling_(polling) {
    for (Patch& patch : patches_) orient_outwards(patch);
  }

  void find_depths() {
    for (const Patch& patch : patches_) depths_.push_back(patches_around(vertex_of(patch)));
  }

  void turn_cavities() {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      if (depths_[i].value_or(0) % 2 == 1) turn(patches_[i]);
    }
  }

  // What TetGen would do otherwise.
  std::vector<std::string> differences(const std::vector<Point>& holes) {
    std::vector<std::string> texts;
    std::vector<bool> emptied(patches_.size(), false);
    for (const Point& hole : holes) {
      const std::optional<int> depth = patches_around(hole, &emptied);
      if (depth.value_or(0) % 2 == 0) continue;
      texts.push_back("the hole point " + text(hole) +
                      " is inside the solid: TetGen leaves that part out, here --regions all does");
    }
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      if (depths_[i].value_or(0) % 2 == 0 || emptied[i]) continue;
      texts.push_back("the closed surface at " + text(vertex_of(patches_[i])) +
                      " is inside another, without a hole point: TetGen fills it, here --regions "
                      "all does");
    }
    return texts;
  }

 private:
  static std::string text(const Point& p) {
    std::string text = "(";
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0) text += ", ";
      char number[32];
      text.append(number, std::to_chars(number, number + sizeof number, p[k]).ptr);
    }
    return text + ")";
  }
  const Point& vertex_of(const Patch& patch) const {
    return surface_.vertices[surface_.triangles[patch[0].triangle][0]];
  }
  void turn(const Patch& patch) {
    for (const PatchTriangle& t : patch) {
      Triangle& corners = surface_.triangles[t.triangle];
      std::swap(corners[1], corners[2]);
    }
  }

  void orient_outwards(Patch& patch) {
    const Point origin = vertex_of(patch);
    double volume = 0;
    Box box;
    for (const PatchTriangle& t : patch) {
      polling_.poll();
      Triangle& corners = surface_.triangles[t.triangle];
      if (t.turned) std::swap(corners[1], corners[2]);
      for (const std::uint32_t v : corners) box.add(surface_.vertices[v]);
      volume += dot(subtract(surface_.vertices[corners[0]], origin),
                    cross(subtract(surface_.vertices[corners[1]], origin),
                          subtract(surface_.vertices[corners[2]], origin)));
    }
    boxes_.push_back(box);
    if (volume < 0) turn(patch);
  }

  // The solid angle of the patch seen from a point, in full spheres: 1 inside, 0 outside.
  double winding(const Patch& patch, const Point& p) {
    double angle = 0;
    for (const PatchTriangle& t : patch) {
      polling_.poll();
      std::array<Point, 3> d;
      std::array<double, 3> length;
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = subtract(surface_.vertices[surface_.triangles[t.triangle][k]], p);
        length[k] = norm(d[k]);
      }
      angle += 2 * std::atan2(dot(d[0], cross(d[1], d[2])),
                              length[0] * length[1] * length[2] + dot(d[0], d[1]) * length[2] +
                                  dot(d[1], d[2]) * length[0] + dot(d[2], d[0]) * length[1]);
    }
    return std::fabs(angle) / (4 * std::numbers::pi);
  }

  // How many patches a point is inside of; nothing if it is on one, or too near to tell. The
  // innermost of them is put down as emptied.
  std::optional<int> patches_around(const Point& p, std::vector<bool>* emptied = nullptr) {
    int count = 0;
    std::size_t innermost = patches_.size();
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      if (!boxes_[i].contains(p) || vertex_of(patches_[i]) == p) continue;
      const double share = winding(patches_[i], p);
      if (share > 0.25 && share < 0.75) return {};
      if (share < 0.5) continue;
      ++count;
      if (innermost == patches_.size() || boxes_[i].within(boxes_[innermost])) innermost = i;
    }
    if (emptied != nullptr && count > 0) (*emptied)[innermost] = true;
    return count;
  }

  struct Box {
    Point low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    void add(const Point& p) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    bool contains(const Point& p) const {
      for (std::size_t k = 0; k < 3; ++k) {
        if (p[k] < low[k] || p[k] > high[k]) return false;
      }
      return true;
    }
    bool within(const Box& other) const { return other.contains(low) && other.contains(high); }
  };

  Surface& surface_;
  std::vector<Patch> patches_;
  Polling& polling_;
  std::vector<Box> boxes_;
  std::vector<std::optional<int>> depths_;
};

}  // namespace

std::vector<Patch> patches_of(const std::vector<Triangle>& triangles, Polling& polling) {
  const auto edges = triangles_at_edges(triangles);
  std::vector<bool> seen(triangles.size(), false);
  std::vector<Patch> patches;
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (seen[seed]) continue;
    Patch patch = {{seed, false}};
    seen[seed] = true;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      polling.poll(20);
      const PatchTriangle at = patch[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[at.triangle][k], b = triangles[at.triangle][(k + 1) % 3];
        const std::vector<std::uint32_t>& both = edges.at(std::minmax(a, b));
        if (both.size() != 2) continue;
        const std::uint32_t other = both[0] == at.triangle ? both[1] : both[0];
        if (seen[other]) continue;
        seen[other] = true;
        patch.push_back({other, runs_along(triangles[other], b, a) == at.turned});
      }
    }
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<std::string> orient_facets(Surface& surface, const std::vector<Point>& holes,
                                       Polling& polling) {
  const auto edges = triangles_at_edges(surface.triangles);
  const bool closed = std::all_of(edges.begin(), edges.end(),
                                  [](const auto& edge) { return edge.second.size() == 2; });
  Nesting nesting(surface, patches_of(surface.triangles, polling), polling);
  if (!closed) return {};
  nesting.find_depths();
  std::vector<std::string> differences = nesting.differences(holes);
  nesting.turn_cavities();
  return differences;
}

}  // namespace delmesher::geometry
