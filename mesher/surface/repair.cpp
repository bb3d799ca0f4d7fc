#include "mesher/surface/repair.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/face_key.h"
#include "mesher/geometry/orientation.h"
#include "mesher/geometry/triangulate.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::surface {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // the smaller vertex first

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// Of the diagonal. A hole that deviates by less from a plane is planar; one that is less wide is
// small.
constexpr double kPlanar = 1e-6, kSmall = 0.05;

Edge edge_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

double distance(const Point3& a, const Point3& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

// Of the box of these vertices.
template <class Indices>
double diagonal(const std::vector<Point3>& vertices, const Indices& which) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Point3 low = {kInf, kInf, kInf}, high = {-kInf, -kInf, -kInf};
  for (const std::uint32_t v : which) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], vertices[v][k]);
      high[k] = std::max(high[k], vertices[v][k]);
    }
  }
  return low[0] <= high[0] ? distance(low, high) : 0;
}

double diagonal(const Surface& surface) {
  std::vector<std::uint32_t> all(surface.vertices.size());
  std::iota(all.begin(), all.end(), 0U);
  return diagonal(surface.vertices, all);
}

bool repeats_a_vertex(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool collinear(const std::vector<Point3>& vertices, const Triangle& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (predicates::orient2d_sign(project(vertices[t[0]], axis), project(vertices[t[1]], axis),
                                  project(vertices[t[2]], axis)) != 0) {
      return false;
    }
  }
  return true;
}

// The corner of a collinear triangle between the other two; coordinates along a line are in its
// order.
std::size_t middle_corner(const std::vector<Point3>& vertices, const Triangle& t) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return vertices[t[a]] < vertices[t[b]]; });
  return order[1];
}

std::map<Edge, std::vector<std::uint32_t>> triangles_of_edges(
    const std::vector<Triangle>& triangles) {
  std::map<Edge, std::vector<std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges[edge_of(triangles[t][k], triangles[t][(k + 1) % 3])].push_back(t);
    }
  }
  return edges;
}

// Joins the vertices of `which` that are no farther apart than `weld`; equal ones, if that is 0.
void join_near(const std::vector<Point3>& vertices, const std::vector<std::uint32_t>& which,
               double weld, DisjointSets& groups) {
  std::map<Point3, std::vector<std::uint32_t>> cells;
  const auto cell_of = [&](const Point3& p) {
    Point3 cell;
    for (std::size_t k = 0; k < 3; ++k) cell[k] = weld > 0 ? std::floor(p[k] / weld) : p[k] + 0.0;
    return cell;
  };
  for (const std::uint32_t v : which) cells[cell_of(vertices[v])].push_back(v);
  for (const auto& [cell, members] : cells) {
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      Point3 other = cell;
      if (weld > 0) {
        other[0] += neighbour % 3 - 1;
        other[1] += neighbour / 3 % 3 - 1;
        other[2] += neighbour / 9 - 1;
      } else if (neighbour > 0) {
        break;
      }
      const auto found = cells.find(other);
      if (found == cells.end() || found->first < cell) continue;
      for (const std::uint32_t a : members) {
        for (const std::uint32_t b : found->second) {
          if (weld == 0 || distance(vertices[a], vertices[b]) <= weld) groups.join(a, b);
        }
      }
    }
  }
}

class Repair {
 public:
  Repair(const Surface& surface, const RepairOptions& options)
      : surface_(surface), options_(options) {
    surface_.labels.resize(surface_.triangles.size());
  }

  RepairResult run();

 private:
  void drop_invalid();
  void weld();
  void drop_degenerate();
  bool flip_collinear();
  void drop_duplicates();
  void orient();
  void fill();
  void drop_unused();
  template <class Unwanted>
  std::uint64_t drop_if(Unwanted unwanted);
  void tell(std::uint64_t count, const char* one, const char* many) {
    if (count == 0) return;
    done_.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  }

  Surface surface_;
  const RepairOptions& options_;
  Polling polling_;
  std::vector<std::string> done_;
};

template <class Unwanted>
std::uint64_t Repair::drop_if(Unwanted unwanted) {
  std::size_t kept = 0;
  auto& triangles = surface_.triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    polling_.poll();
    if (unwanted(t)) continue;
    triangles[kept] = triangles[t];
    surface_.labels[kept++] = surface_.labels[t];
  }
  const std::uint64_t dropped = triangles.size() - kept;
  triangles.resize(kept);
  surface_.labels.resize(kept);
  return dropped;
}

// What no later step can look at.
void Repair::drop_invalid() {
  const auto bad = [&](std::uint32_t v) {
    if (v >= surface_.vertices.size()) return true;
    const Point3& p = surface_.vertices[v];
    return !std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]);
  };
  tell(drop_if([&](std::uint32_t t) {
         const Triangle& corners = surface_.triangles[t];
         return std::any_of(corners.begin(), corners.end(), bad);
       }),
       "triangle with a corner that is not a point dropped",
       "triangles with corners that are not points dropped");
  for (std::uint32_t v = 0; v < surface_.vertices.size(); ++v) {
    if (bad(v)) surface_.vertices[v] = {0, 0, 0};  // of no triangle; drop_unused takes it
  }
}

void Repair::weld() {
  std::vector<std::uint32_t> all(surface_.vertices.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<bool> used(all.size());
  for (const Triangle& t : surface_.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  std::erase_if(all, [&](std::uint32_t v) { return !used[v]; });
  const auto weld_within = [&](double reach) {
    DisjointSets groups(surface_.vertices.size());
    join_near(surface_.vertices, all, reach, groups);
    std::uint64_t joined = 0;
    for (const std::uint32_t v : all) joined += groups.smallest(v) != v ? 1 : 0;
    for (Triangle& t : surface_.triangles) {
      for (std::uint32_t& v : t) v = groups.smallest(v);
    }
    std::erase_if(all, [&](std::uint32_t v) { return groups.smallest(v) != v; });
    return joined;
  };
  tell(weld_within(0), "vertex welded to another at the same place",
       "vertices welded to others at the same place");
  if (options_.weld > 0) {
    tell(weld_within(options_.weld), "vertex welded to one near it",
         "vertices welded to others near them");
  }
}

// A triangle with one corner on its opposite edge leaves a slit when it is dropped. Where another
// triangle has that edge, both become two others: the edge of the other one gets the corner. True
// if there was one.
bool Repair::flip_collinear() {
  const auto edges = triangles_of_edges(surface_.triangles);
  std::vector<bool> touched(surface_.triangles.size());
  bool any = false;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    polling_.poll(20);
    Triangle& flat = surface_.triangles[t];
    if (touched[t] || repeats_a_vertex(flat) || !collinear(surface_.vertices, flat)) continue;
    const std::size_t m = middle_corner(surface_.vertices, flat);
    const std::uint32_t middle = flat[m], a = flat[(m + 1) % 3], b = flat[(m + 2) % 3];
    const std::vector<std::uint32_t>& both = edges.at(edge_of(a, b));
    if (both.size() != 2) continue;
    const std::uint32_t other = both[0] == t ? both[1] : both[0];
    if (touched[other]) continue;
    Triangle& beside = surface_.triangles[other];
    if (repeats_a_vertex(beside)) continue;
    Triangle second = beside;
    std::replace(beside.begin(), beside.end(), a, middle);
    std::replace(second.begin(), second.end(), b, middle);
    flat = second;
    surface_.labels[t] = surface_.labels[other];
    touched[t] = touched[other] = true;
    any = true;
  }
  return any;
}

void Repair::drop_degenerate() {
  const std::size_t before = surface_.triangles.size();
  std::uint64_t flat = 0;
  for (std::uint32_t t = 0; t < before; ++t) {
    const Triangle& corners = surface_.triangles[t];
    flat += repeats_a_vertex(corners) || collinear(surface_.vertices, corners) ? 1 : 0;
  }
  const auto repeats = [&](std::uint32_t t) { return repeats_a_vertex(surface_.triangles[t]); };
  drop_if(repeats);
  constexpr int kPasses = 64;  // one per collinear triangle beside the same edge, at most
  for (int pass = 0; pass < kPasses && flip_collinear(); ++pass) drop_if(repeats);
  drop_if([&](std::uint32_t t) { return collinear(surface_.vertices, surface_.triangles[t]); });
  tell(flat, "triangle without area removed", "triangles without area removed");
}

// Of triangles with the same corners one stays, or none. That is decided for all that hang together
// by edges of nothing else: they are a wall between bodies, a piece that lies on a surface, or a
// whole surface of two sides. One of each stays where they close up, or close more edges of others
// than they open; also where nothing else is there.
void Repair::drop_duplicates() {
  std::map<Triangle, std::vector<std::uint32_t>> same;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    Triangle key = surface_.triangles[t];
    std::sort(key.begin(), key.end());
    same[key].push_back(t);
  }
  struct Around {
    std::vector<std::uint32_t> doubled;  // the first of each
    std::size_t single = 0;
  };
  std::map<Edge, Around> edges;
  std::size_t singles = 0;
  for (const auto& [key, members] : same) {
    const bool alone = members.size() == 1;
    singles += alone ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      Around& around = edges[edge_of(key[k], key[(k + 1) % 3])];
      alone ? void(++around.single) : around.doubled.push_back(members[0]);
    }
  }
  DisjointSets pieces(surface_.triangles.size());
  for (const auto& [edge, around] : edges) {
    if (around.single > 0) continue;
    for (const std::uint32_t t : around.doubled) pieces.join(around.doubled[0], t);
  }
  struct Rim {
    int closed = 0, opened = 0, bare = 0;  // edges of others: of one, of more; of none
  };
  std::map<std::uint32_t, Rim> rims;  // of a piece
  for (const auto& [edge, around] : edges) {
    for (const std::uint32_t t : around.doubled) {
      Rim& rim = rims[pieces.smallest(t)];
      if (around.single > 0) {
        ++(around.single % 2 == 1 ? rim.closed : rim.opened);
      } else if (around.doubled.size() == 1) {
        ++rim.bare;
      }
    }
  }
  const bool only_doubled = singles == 0;
  std::vector<bool> unwanted(surface_.triangles.size());
  for (const auto& [key, members] : same) {
    if (members.size() < 2) continue;
    const Rim& rim = rims.at(pieces.smallest(members[0]));
    const bool stays = rim.closed > rim.opened + rim.bare ||
                       (rim.closed + rim.opened == 0 && (rim.bare == 0 || only_doubled));
    for (const std::uint32_t t : members) unwanted[t] = true;
    unwanted[members[0]] = !stays;
  }
  tell(drop_if([&](std::uint32_t t) { return unwanted[t]; }), "duplicate triangle dropped",
       "duplicate triangles dropped");
}

// Orients the triangles of a component as most of them are.
void Repair::orient() {
  auto& triangles = surface_.triangles;
  std::uint64_t count = 0;
  for (const Patch& patch : patches_of(triangles, polling_)) {
    const auto turned = static_cast<std::size_t>(
        std::count_if(patch.begin(), patch.end(), [](const PatchTriangle& t) { return t.turned; }));
    const bool minority = 2 * turned <= patch.size();
    for (const auto& [t, is_turned] : patch) {
      if (is_turned != minority) continue;
      std::swap(triangles[t][1], triangles[t][2]);
      ++count;
    }
  }
  tell(count, "triangle turned round", "triangles turned round");
}

void Repair::fill() {
  if (!options_.fill) return;
  const double all = diagonal(surface_);
  std::uint64_t holes = 0, added = 0;
  std::map<Triangle, std::uint32_t> there;  // from the smallest corner on
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    there[base::directed_face(surface_.triangles[t])] = t;
  }
  std::vector<bool> fins(surface_.triangles.size());
  for (const Hole& hole : holes_of(surface_).holes) {
    if (hole.corners.size() < 3 || hole.corners.size() > kMaxPolygonCorners) continue;
    const std::vector<Loop> loops = {hole.corners};
    const FaceTriangulation face = triangulate_face(surface_.vertices, loops, polling_);
    if (!face.simple || (face.deviation > kPlanar * all && hole.width > kSmall * all)) continue;
    // A slit: there a vertex lies on an edge.
    if (std::any_of(face.triangles.begin(), face.triangles.end(),
                    [&](const Triangle& t) { return collinear(surface_.vertices, t); })) {
      continue;
    }
    std::uint64_t of_hole = 0;
    for (const Triangle& t : face.triangles) {
      // What would lie on its back does not close a hole: it sticks out of the surface.
      const auto back = there.find(base::directed_face({t[0], t[2], t[1]}));
      if (back != there.end()) {
        fins[back->second] = true;
        continue;
      }
      surface_.triangles.push_back(t);
      ++of_hole;
    }
    surface_.labels.resize(surface_.triangles.size(), hole.label);
    holes += of_hole > 0 ? 1 : 0;
    added += of_hole;
  }
  fins.resize(surface_.triangles.size());
  tell(drop_if([&](std::uint32_t t) { return fins[t]; }), "triangle that sticks out removed",
       "triangles that stick out removed");
  tell(holes, "hole filled", "holes filled");
  tell(added, "triangle added for them", "triangles added for them");
}

void Repair::drop_unused() {
  std::vector<std::uint32_t> number(surface_.vertices.size(), kNone);
  for (const Triangle& t : surface_.triangles) {
    for (const std::uint32_t v : t) number[v] = 0;
  }
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    surface_.vertices[kept] = surface_.vertices[v];
    number[v] = kept++;
  }
  surface_.vertices.resize(kept);
  for (Triangle& t : surface_.triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
}

RepairResult Repair::run() {
  drop_invalid();
  weld();
  drop_degenerate();
  drop_duplicates();
  orient();
  fill();
  drop_unused();
  return {std::move(surface_), std::move(done_)};
}

// 1 if the triangle goes along the edge from its first vertex to its second, -1 if back.
int direction_of(const Triangle& t, const Edge& edge) {
  int direction = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k], b = t[(k + 1) % 3];
    if (edge_of(a, b) == edge) direction += a == edge.first ? 1 : -1;
  }
  return direction;
}

// An edge at which a triangle is missing, as that would go along it.
struct RingEdge {
  std::uint32_t from, to, triangle;
  bool open;  // of one triangle
};

class Rings {
 public:
  void add(const RingEdge& edge) {
    next_[edge.from].push_back(edge);
    ++ends_[edge.to];
  }

  // Those whose edges go on in one way only, without these vertices; by their first one.
  std::vector<std::vector<RingEdge>> closed(const std::set<std::uint32_t>& without) const {
    std::vector<std::vector<RingEdge>> rings;
    std::set<std::uint32_t> seen = without;
    for (const auto& [start, unused] : next_) {
      if (seen.contains(start)) continue;
      std::vector<RingEdge> ring;
      bool goes_on = true;
      std::uint32_t at = start;
      do {
        const auto found = next_.find(at);
        goes_on = found != next_.end() && found->second.size() == 1 && ends_.contains(at) &&
                  ends_.at(at) == 1 && seen.insert(at).second;
        if (!goes_on) break;
        ring.push_back(found->second[0]);
        at = ring.back().to;
      } while (at != start);
      if (goes_on) rings.push_back(std::move(ring));
    }
    return rings;
  }

 private:
  std::map<std::uint32_t, std::vector<RingEdge>> next_;
  std::map<std::uint32_t, int> ends_;
};

}  // namespace

Holes holes_of(const Surface& surface) {
  Holes result;
  Rings open, all;
  for (const auto& [edge, triangles] : triangles_of_edges(surface.triangles)) {
    if (edge.first == edge.second) continue;
    // How many more go from the first vertex to the second than back.
    int surplus = 0;
    for (const std::uint32_t t : triangles) surplus += direction_of(surface.triangles[t], edge);
    if (std::abs(surplus) != 1) continue;
    const bool is_open = triangles.size() == 1;
    result.open_edges += is_open ? 1 : 0;
    // The other way round than the triangle.
    const RingEdge next{surplus > 0 ? edge.second : edge.first,
                        surplus > 0 ? edge.first : edge.second, triangles[0], is_open};
    if (is_open) open.add(next);
    all.add(next);
  }
  std::set<std::uint32_t> done;
  for (Rings* rings : {&open, &all}) {
    for (const std::vector<RingEdge>& ring : rings->closed(done)) {
      // Edges of three triangles alone are the rim of a wall.
      if (std::none_of(ring.begin(), ring.end(), [](const RingEdge& e) { return e.open; }))
        continue;
      Hole hole;
      for (const RingEdge& edge : ring) {
        hole.corners.push_back(edge.from);
        done.insert(edge.from);
      }
      if (!surface.labels.empty()) hole.label = surface.labels[ring[0].triangle];
      hole.width = diagonal(surface.vertices, hole.corners);
      result.holes.push_back(std::move(hole));
    }
  }
  std::sort(result.holes.begin(), result.holes.end(),
            [](const Hole& a, const Hole& b) { return a.corners[0] < b.corners[0]; });
  return result;
}

WeldHint weld_hint(const Surface& surface) {
  std::vector<std::uint32_t> ends;
  std::map<Edge, int> count;
  for (const auto& [edge, triangles] : triangles_of_edges(surface.triangles)) {
    if (triangles.size() == 1 && edge.first != edge.second) {
      ends.push_back(edge.first);
      ends.push_back(edge.second);
      ++count[edge];
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const double all = diagonal(surface);
  const auto still_open = [&](double reach) {
    DisjointSets groups(surface.vertices.size());
    join_near(surface.vertices, ends, reach, groups);
    std::map<Edge, int> left;
    for (const auto& [edge, once] : count) {
      const std::uint32_t a = groups.smallest(edge.first), b = groups.smallest(edge.second);
      if (a != b) ++left[edge_of(a, b)];
    }
    return static_cast<std::uint64_t>(
        std::count_if(left.begin(), left.end(), [](const auto& e) { return e.second % 2 == 1; }));
  };
  WeldHint hint;
  if (count.empty() || !(all > 0)) return hint;
  std::uint64_t fewest = still_open(0);
  hint.closed = count.size() - fewest;
  for (const double part : {1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    char digits[32];  // of one digit, to be printed and entered
    std::snprintf(digits, sizeof digits, "%.0e", all * part);
    double reach = 0;
    std::from_chars(digits, digits + std::strlen(digits), reach);
    const std::uint64_t left = still_open(reach);
    if (left >= fewest) continue;
    fewest = left;
    hint = {reach, count.size() - left};
  }
  return hint;
}

}  // namespace delmesher::surface

namespace delmesher {

RepairResult repair_surface(const Surface& surface, const RepairOptions& options) {
  return surface::Repair(surface, options).run();
}

}  // namespace delmesher
