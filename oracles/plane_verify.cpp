#include "oracles/plane_verify.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "oracles/plane_grid.h"
#include "oracles/plane_points.h"

namespace tetproof {
namespace {

using delmesher::ExactPoint;
using delmesher::Insideness;
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using delmesher::Region;
using Side = PlaneRecord::Side;
using Index = PlanePoints::Index;
using Point = PlanePoints::Point;
constexpr Index kNothing = 0xffffffffU;

class Verifier {
 public:
  Verifier(const PlanarGraph& graph, const delmesher::Options& options,
           const delmesher::PlaneResult& result)
      : graph_(graph), options_(options), result_(result), record_(result.exact) {}

  PlaneVerdict run() {
    check_all();
    verdict_.checks = exact_.checks;
    return verdict_;
  }

 private:
  void check_all() {
    if (!read_points()) return;
    sort_into_cells();
    verify_corners();
    Mesh refined = index("refined", record_.refined, record_.refined_edges);
    verify_complex(refined);
    verify_tiling(refined, false);
    verify_delaunay(refined);
    verify_refinement(refined);
    if (!options_.approximate) {
      Mesh final = index("final", record_.final, record_.final_edges);
      verify_complex(final);
      verify_tiling(final, true);
      verify_delaunay(final);
      verify_sides(final);
      verify_vertices(final, refined);
      verify_area(final);
    }
    verify_mesh();
  }

  using Edge = std::pair<Index, Index>;
  struct Mesh {
    std::string name;
    const std::vector<PlaneRecord::Triangle>* triangles;
    const std::vector<PlaneRecord::Edge>* edges;
    std::map<Edge, Index> left_of;  // directed edge to the triangle on its left
    std::map<Edge, Index> segment;  // undirected (smaller first) to the input segment
  };

  void fail(const std::string& kind, const std::string& detail) {
    if (++count_[kind] <= 3) verdict_.failures.push_back(kind + ": " + detail);
  }
  static std::string name(const Mesh& mesh, Index t) {
    return mesh.name + " triangle " + std::to_string(t);
  }
  static Edge undirected(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

  // ------------------------------------------------------------------------------ points

  bool read_points() {
    const auto& given = record_.points;
    if (given.size() < graph_.vertices.size()) {
      fail("points", "fewer than input vertices");
      return false;
    }
    for (std::size_t i = 0; i < given.size(); ++i) {
      const ExactPoint& p = given[i];
      if (i < graph_.vertices.size()) {
        const auto& v = graph_.vertices[i];
        if (p.kind != ExactPoint::Kind::explicit_point || p.x != v[0] || p.y != v[1]) {
          fail("points", "input vertex " + std::to_string(i) + " was changed");
        }
      }
      Point q;
      if (p.kind == ExactPoint::Kind::explicit_point) {
        q.x = p.x;
        q.y = p.y;
      } else {
        if (p.i >= graph_.vertices.size() || p.j >= graph_.vertices.size() ||
            !(p.x > 0 && p.x < 1)) {
          fail("points", "point " + std::to_string(i) + " is not between input vertices");
          return false;
        }
        const mpq_class t = p.x;
        q.x = t * points_[p.i].x + (1 - t) * points_[p.j].x;
        q.y = t * points_[p.i].y + (1 - t) * points_[p.j].y;
      }
      q.dx = q.x.get_d();
      q.dy = q.y.get_d();
      exact_.add(std::move(q));
    }
    return true;
  }

  // The segments, then the vertices.
  void sort_into_cells() {
    std::vector<PlaneGrid::Box> boxes;
    const auto enter = [&](Index a, Index b) {
      const Point &p = points_[a], &q = points_[b];
      boxes.push_back({{std::min(p.dx, q.dx), std::min(p.dy, q.dy)},
                       {std::max(p.dx, q.dx), std::max(p.dy, q.dy)}});
    };
    for (const auto& [a, b] : graph_.segments) enter(a, b);
    for (Index v = 0; v < graph_.vertices.size(); ++v) enter(v, v);
    near_ = PlaneGrid(boxes);
  }

  // A little larger than points, so that rounding hides nothing.
  template <class Indices>
  PlaneGrid::Box box(const Indices& indices, double margin = 0) const {
    PlaneGrid::Box result{{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    for (const Index v : indices) {
      const Point& p = points_[v];
      result.low = {std::min(result.low[0], p.dx), std::min(result.low[1], p.dy)};
      result.high = {std::max(result.high[0], p.dx), std::max(result.high[1], p.dy)};
    }
    margin += 4 * exact_.error();
    for (std::size_t k = 0; k < 2; ++k) {
      result.low[k] -= margin;
      result.high[k] += margin;
    }
    return result;
  }

  void verify_corners() {
    // Corners that were promised to be chamfered and are not would spoil the bound.
    if (!(record_.acute >= options_.acute)) fail("chamfer", "a threshold below what was promised");
    const auto segments = static_cast<Index>(graph_.segments.size());
    for (const auto& corner : record_.corners) {
      radius_[corner.vertex] = corner.radius;
      const std::string what = "corner " + std::to_string(corner.vertex);
      if (!(corner.radius > 0)) fail("chamfer", what + " has no radius");
      if (options_.chamfer_radius > 0 && corner.radius > options_.chamfer_radius * (1 + 1e-9)) {
        fail("chamfer", what + " is cut farther out than allowed");
      }
      double least = HUGE_VAL;
      near_.visit(box(std::array{corner.vertex}, 3 * corner.radius), [&](Index item) {
        if (item >= segments) {
          const Index v = item - segments;
          if (v != corner.vertex) least = std::min(least, exact_.distance(corner.vertex, v));
          return;
        }
        const auto [a, b] = graph_.segments[item];
        if (a == corner.vertex || b == corner.vertex) return;
        if (exact_.orient(a, b, corner.vertex) == 0) return;  // on it, or met by its ends
        least = std::min(least, exact_.distance_to_segment(corner.vertex, a, b));
      });
      if (corner.radius > least / 3 * (1 + 1e-6)) {
        fail("chamfer", what + " is cut beyond a third of its feature size");
      }
    }
  }

  // ------------------------------------------------------------------------------ complex

  Mesh index(const char* mesh_name, const std::vector<PlaneRecord::Triangle>& triangles,
             const std::vector<PlaneRecord::Edge>& edges) {
    Mesh mesh{mesh_name, &triangles, &edges, {}, {}};
    for (Index t = 0; t < triangles.size(); ++t) {
      const auto& v = triangles[t].vertices;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!mesh.left_of.emplace(Edge(v[i], v[(i + 1) % 3]), t).second) {
          fail("complex", name(mesh, t) + " shares a directed edge");
        }
      }
    }
    for (const auto& edge : edges) {
      const Edge key = undirected(edge.vertices[0], edge.vertices[1]);
      if (!mesh.segment.emplace(key, edge.segment).second) fail("edges", "an edge listed twice");
      if (!mesh.left_of.contains(key) && !mesh.left_of.contains({key.second, key.first})) {
        fail("edges", mesh.name + " edge is not in the mesh");
      }
    }
    return mesh;
  }

  void verify_complex(const Mesh& mesh) {
    mpq_class area = 0, low_x, low_y, high_x, high_y;
    bool first = true;
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const auto& [a, b, c] = (*mesh.triangles)[t].vertices;
      if (exact_.orient(a, b, c) <= 0) fail("orientation", name(mesh, t) + " is not positive");
      for (const Index v : {a, b, c}) {
        const Point& p = points_[v];
        if (first || p.x < low_x) low_x = p.x;
        if (first || p.y < low_y) low_y = p.y;
        if (first || p.x > high_x) high_x = p.x;
        if (first || p.y > high_y) high_y = p.y;
        first = false;
      }
      const Point &p = points_[a], &q = points_[b], &r = points_[c];
      area += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    }
    if (area != 2 * (high_x - low_x) * (high_y - low_y)) {
      fail("complex", mesh.name + " does not have the area of its rectangle");
    }
    for (const auto& [edge, t] : mesh.left_of) {
      if (mesh.left_of.contains({edge.second, edge.first})) continue;
      const Point &p = points_[edge.first], &q = points_[edge.second];
      const bool on_side = (p.x == q.x && (p.x == low_x || p.x == high_x)) ||
                           (p.y == q.y && (p.y == low_y || p.y == high_y));
      if (!on_side) fail("complex", name(mesh, t) + " has a border inside the rectangle");
    }
  }

  void verify_tiling(const Mesh& mesh, bool complete) {
    std::vector<std::vector<std::pair<mpq_class, mpq_class>>> parts(graph_.segments.size());
    for (const auto& edge : *mesh.edges) {
      if (edge.segment == kNothing) continue;
      if (edge.segment >= parts.size()) {
        fail("tiling", "an edge of no segment");
        continue;
      }
      const auto [a, b] = graph_.segments[edge.segment];
      const auto [u, v] = edge.vertices;
      if (exact_.orient(a, b, u) != 0 || exact_.orient(a, b, v) != 0) {
        fail("tiling", mesh.name + " edge is not on segment " + std::to_string(edge.segment));
        continue;
      }
      mpq_class s = exact_.parameter(u, a, b), t = exact_.parameter(v, a, b);
      if (t < s) std::swap(s, t);
      parts[edge.segment].push_back({s, t});
    }
    const std::set<Index> dropped(record_.dropped.begin(), record_.dropped.end());
    std::set<Edge> seen;
    for (Index i = 0; i < parts.size(); ++i) {
      // No structured binding: clang 14 cannot capture one.
      const Index a = graph_.segments[i][0], b = graph_.segments[i][1];
      if (!seen.insert(undirected(a, b)).second) continue;  // given twice: counted once
      std::sort(parts[i].begin(), parts[i].end());
      mpq_class at = 0;
      const double length = exact_.distance(a, b);
      parts[i].push_back({1, 1});
      for (const auto& [s, t] : parts[i]) {
        const std::string what = mesh.name + " segment " + std::to_string(i);
        if (s < at) fail("tiling", what + " is covered twice");
        if (s > at && complete) fail("tiling", what + " has a hole");
        if (s > at && !complete && !dropped.contains(i)) {
          // Only what lies around a chamfered corner may be missing (also vertices on the segment).
          const double from = at.get_d() * length, to = s.get_d() * length;
          bool explained = false;
          near_.visit(box(std::array{a, b}), [&](Index item) {
            const auto corner =
                item < parts.size() ? radius_.end() : radius_.find(item - Index(parts.size()));
            if (corner == radius_.end() || exact_.orient(a, b, corner->first) != 0) return;
            const double place = exact_.parameter(corner->first, a, b).get_d() * length;
            const double r = corner->second, reach = r * (1 + 1e-5);
            explained = explained || (place - reach <= from * (1 + 1e-12) + 1e-12 * r &&
                                      place + reach >= to * (1 - 1e-12) - 1e-12 * r);
          });
          if (!explained) fail("tiling", what + " is missing away from chamfered corners");
        }
        if (t > at) at = t;
      }
    }
  }

  void verify_delaunay(const Mesh& mesh) {
    for (const auto& [edge, t] : mesh.left_of) {
      if (edge.first > edge.second || mesh.segment.contains(edge)) continue;
      const auto other = mesh.left_of.find({edge.second, edge.first});
      if (other == mesh.left_of.end()) continue;
      const auto& v = (*mesh.triangles)[t].vertices;
      for (const Index d : (*mesh.triangles)[other->second].vertices) {
        if (d == edge.first || d == edge.second) continue;
        if (exact_.in_circle(v[0], v[1], v[2], d) > 0) fail("Delaunay", name(mesh, t));
      }
    }
  }

  // ------------------------------------------------------------------------------ refined

  bool in_region(const PlaneRecord::Triangle& t) const {
    return options_.region == Region::hull || t.side != Side::outside;
  }

  void verify_refinement(const Mesh& mesh) {
    const long double radians =
        static_cast<long double>(record_.delta) * 3.14159265358979323846L / 180;
    const mpq_class sine_squared =
        static_cast<double>(std::sin(radians) * std::sin(radians) * (1 - 1e-15L));
    if (!(record_.delta >= std::min(options_.delta, 20.7))) fail("angle", "a bound below 20.7");
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const PlaneRecord::Triangle& triangle = (*mesh.triangles)[t];
      if (!in_region(triangle)) continue;
      const auto& v = triangle.vertices;
      mpq_class length[3];
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &p = points_[v[i]], &q = points_[v[(i + 1) % 3]];
        length[i] = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
        const Edge edge = undirected(v[i], v[(i + 1) % 3]);
        if (mesh.segment.contains(edge) &&
            exact_.encroaches(edge.first, v[(i + 2) % 3], edge.second)) {
          fail("encroached", name(mesh, t));
        }
      }
      std::sort(std::begin(length), std::end(length));
      const Point &p = points_[v[0]], &q = points_[v[1]], &r = points_[v[2]];
      const mpq_class area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
      ++exact_.checks;
      if (area * area < sine_squared * length[1] * length[2]) fail("angle", name(mesh, t));
    }
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const PlaneRecord::Triangle& triangle = (*mesh.triangles)[t];
      bool crossed = false;
      near_.visit(box(triangle.vertices), [&](Index i) {
        if (i >= graph_.segments.size() || crossed) return;
        const auto [a, b] = graph_.segments[i];
        crossed = crosses(a, b, triangle);
      });
      if (crossed != (triangle.side == Side::mixed)) {
        fail("side", name(mesh, t) + (crossed ? " is crossed by a segment" : " is not mixed"));
      } else if (!crossed && closed_rings() &&
                 by_ray(triangle) != (triangle.side == Side::inside)) {
        fail("side", name(mesh, t) + " is on the other side");
      }
    }
  }

  // Does the segment meet the interior of the triangle? (Separating axes.)
  bool crosses(Index a, Index b, const PlaneRecord::Triangle& triangle) {
    const auto& v = triangle.vertices;
    const auto outside_box = [&](double Point::*x) {
      const auto [low, high] = std::minmax({points_[v[0]].*x, points_[v[1]].*x, points_[v[2]].*x});
      const double lo = std::min(points_[a].*x, points_[b].*x),
                   hi = std::max(points_[a].*x, points_[b].*x);
      return hi < low - 2 * exact_.error() || lo > high + 2 * exact_.error();
    };
    if (outside_box(&Point::dx) || outside_box(&Point::dy)) return false;
    const int s[] = {exact_.orient(a, b, v[0]), exact_.orient(a, b, v[1]),
                     exact_.orient(a, b, v[2])};
    const auto [least, most] = std::minmax({s[0], s[1], s[2]});
    if (least >= 0 || most <= 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index p = v[i], q = v[(i + 1) % 3];
      if (exact_.orient(p, q, a) <= 0 && exact_.orient(p, q, b) <= 0) return false;
    }
    return true;
  }

  // ------------------------------------------------------------------------------ inside

  bool separates(Index segment) const {
    return graph_.partitions.empty() || graph_.partitions[segment] == 0;
  }

  // Do the separating segments form closed curves, with parity deciding?
  bool closed_rings() {
    if (rings_ >= 0) return rings_ != 0;
    rings_ = graph_.insideness == Insideness::nested;
    std::map<Index, int> degree;
    std::set<Edge> seen;
    for (Index i = 0; i < graph_.segments.size(); ++i) {
      const auto [a, b] = graph_.segments[i];
      if (!seen.insert(undirected(a, b)).second) rings_ = 0;
      if (!separates(i)) continue;
      ++degree[a];
      ++degree[b];
    }
    for (const auto& [v, d] : degree) {
      if (d % 2 != 0) rings_ = 0;
    }
    // A single ring encloses what parity says.
    if (graph_.insideness == Insideness::enclosed && graph_.holes.empty()) {
      rings_ = degree.size() == graph_.segments.size() &&
               std::all_of(degree.begin(), degree.end(), [](auto& d) { return d.second == 2; }) &&
               connected(degree.size());
    }
    return rings_ != 0;
  }

  bool connected(std::size_t vertices) const {
    std::map<Index, std::vector<Index>> next;
    for (const auto& [a, b] : graph_.segments) {
      next[a].push_back(b);
      next[b].push_back(a);
    }
    std::set<Index> seen;
    std::vector<Index> stack = {graph_.segments[0][0]};
    while (!stack.empty()) {
      const Index v = stack.back();
      stack.pop_back();
      if (!seen.insert(v).second) continue;
      for (const Index w : next[v]) stack.push_back(w);
    }
    return seen.size() == vertices;
  }

  // Parity of separating segments on a ray to the right from the centroid.
  bool by_ray(const PlaneRecord::Triangle& triangle) {
    const auto& v = triangle.vertices;
    Point c;
    c.x = (points_[v[0]].x + points_[v[1]].x + points_[v[2]].x) / 3;
    c.y = (points_[v[0]].y + points_[v[1]].y + points_[v[2]].y) / 3;
    c.dx = c.x.get_d();
    c.dy = c.y.get_d();
    bool inside = false;
    near_.visit({{c.dx, c.dy}, {HUGE_VAL, c.dy}}, [&](Index i) {
      if (i >= graph_.segments.size() || !separates(i)) return;
      const Point &a = points_[graph_.segments[i][0]], &b = points_[graph_.segments[i][1]];
      const bool below_a = a.y <= c.y, below_b = b.y <= c.y;
      if (below_a == below_b) return;
      if ((exact_.orient(a, b, c) > 0) == below_a) inside = !inside;
    });
    return inside;
  }

  Index triangle_with(const Mesh& mesh, const std::array<double, 2>& at) {
    Point p{at[0], at[1], at[0], at[1]};
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const auto& v = (*mesh.triangles)[t].vertices;
      if (exact_.orient(points_[v[0]], points_[v[1]], p) >= 0 &&
          exact_.orient(points_[v[1]], points_[v[2]], p) >= 0 &&
          exact_.orient(points_[v[2]], points_[v[0]], p) >= 0) {
        return t;
      }
    }
    return kNothing;
  }

  // A hole point on a segment means no face.
  bool on_segment(const std::array<double, 2>& at) {
    const Point p{at[0], at[1], at[0], at[1]};
    bool found = false;
    near_.visit({at, at}, [&](Index i) {
      if (found || i >= graph_.segments.size()) return;
      const Point &a = points_[graph_.segments[i][0]], &b = points_[graph_.segments[i][1]];
      found = exact_.orient(a, b, p) == 0 && std::min(a.x, b.x) <= p.x &&
              p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
    });
    return found;
  }

  // A flood from the border, with the number of separating segments that have to be crossed.
  void verify_sides(const Mesh& mesh) {
    const bool nested = graph_.insideness == Insideness::nested;
    std::vector<int> depth(mesh.triangles->size(), -1);
    std::deque<Index> queue;
    const auto start = [&](Index t, int d) {
      depth[t] = d;
      queue.push_back(t);
    };
    for (const auto& [edge, t] : mesh.left_of) {
      if (!mesh.left_of.contains({edge.second, edge.first}) && depth[t] < 0) start(t, 0);
    }
    if (!nested) {
      for (const auto& hole : graph_.holes) {
        if (on_segment(hole)) continue;
        const Index t = triangle_with(mesh, hole);
        if (t != kNothing && depth[t] < 0) start(t, 0);
      }
    }
    while (!queue.empty()) {
      const Index t = queue.front();
      queue.pop_front();
      const auto& v = (*mesh.triangles)[t].vertices;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = v[i], b = v[(i + 1) % 3];
        const auto other = mesh.left_of.find({b, a});
        if (other == mesh.left_of.end()) continue;
        const auto segment = mesh.segment.find(undirected(a, b));
        int cost = 0;
        if (segment != mesh.segment.end()) {
          if (!nested || segment->second == kNothing) continue;
          cost = separates(segment->second) ? 1 : 0;
        }
        const int d = depth[t] + cost;
        int& known = depth[other->second];
        if (known >= 0 && known <= d) continue;
        known = d;
        if (cost == 0) {
          queue.push_front(other->second);
        } else {
          queue.push_back(other->second);
        }
      }
    }
    for (Index t = 0; t < depth.size(); ++t) {
      const bool inside = nested ? depth[t] % 2 != 0 : depth[t] != 0;
      if ((*mesh.triangles)[t].side != (inside ? Side::inside : Side::outside)) {
        fail("side", name(mesh, t) + (inside ? " should be inside" : " should be outside"));
      }
    }
  }

  void verify_vertices(const Mesh& final, const Mesh& refined) {
    std::vector<std::uint8_t> there(points_.size(), 0);
    std::set<std::pair<double, double>> places;
    for (const auto& triangle : *final.triangles) {
      for (const Index v : triangle.vertices) {
        there[v] = 1;
        if (v < graph_.vertices.size()) places.insert({points_[v].dx, points_[v].dy});
      }
    }
    for (Index v = 0; v < graph_.vertices.size(); ++v) {
      if (there[v] == 0) fail("vertices", "input vertex " + std::to_string(v) + " is missing");
    }
    for (const auto& triangle : *refined.triangles) {
      for (const Index v : triangle.vertices) {
        if (there[v] == 0 && !places.contains({points_[v].dx, points_[v].dy})) {
          fail("vertices", "refined vertex " + std::to_string(v) + " is missing");
        }
      }
    }
  }

  // Of the inside, where a single ring bounds it.
  void verify_area(const Mesh& mesh) {
    if (!closed_rings() || !graph_.partitions.empty()) return;
    mpq_class inside = 0, ring = 0;
    for (const auto& triangle : *mesh.triangles) {
      if (triangle.side != Side::inside) continue;
      const Point &p = points_[triangle.vertices[0]], &q = points_[triangle.vertices[1]],
                  &r = points_[triangle.vertices[2]];
      inside += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    }
    std::map<Index, int> degree;
    for (const auto& [a, b] : graph_.segments) {
      ++degree[a];
      ++degree[b];
    }
    const bool simple =
        std::all_of(degree.begin(), degree.end(), [](auto& d) { return d.second == 2; }) &&
        connected(degree.size());
    if (!simple) return;
    std::map<Index, std::vector<Index>> next;
    for (const auto& [a, b] : graph_.segments) {
      next[a].push_back(b);
      next[b].push_back(a);
    }
    Index before = graph_.segments[0][0], at = graph_.segments[0][1];
    const Index start = before;
    do {
      const Point &p = points_[before], &q = points_[at];
      ring += p.x * q.y - p.y * q.x;
      const Index after = next[at][0] == before ? next[at][1] : next[at][0];
      before = at;
      at = after;
    } while (before != start);
    if (inside != abs(ring)) fail("area", "the inside does not have the area of the polygon");
  }

  // ------------------------------------------------------------------------------ as written

  void verify_mesh() {
    const delmesher::PlaneMesh& mesh = result_.mesh;
    const auto& ids = record_.mesh_vertices;
    if (ids.size() != mesh.vertices.size()) return fail("written", "vertices do not match");
    std::vector<Point> written;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto& p = mesh.vertices[i];
      written.push_back({p[0], p[1], p[0], p[1]});
      const double ulps = 16 * 2.3e-16 * std::max(std::fabs(p[0]), std::fabs(p[1])) + 1e-320;
      if (abs(points_[ids[i]].x - written[i].x) > ulps ||
          abs(points_[ids[i]].y - written[i].y) > ulps) {
        fail("written", "vertex " + std::to_string(i) + " is away from its place");
      }
    }
    std::set<std::array<Index, 3>> expected;
    for (const auto& triangle : options_.approximate ? record_.refined : record_.final) {
      if (options_.region == Region::interior && triangle.side != Side::inside) continue;
      expected.insert(triangle.vertices);
    }
    if (expected.size() != mesh.triangles.size()) fail("written", "triangles do not match");
    std::uint64_t bad = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      if (!expected.contains({ids[a], ids[b], ids[c]})) fail("written", "an unknown triangle");
      bad += exact_.orient(written[a], written[b], written[c]) <= 0;
    }
    // Whether the statistics confess it or not.
    if (bad > 0) fail("written", std::to_string(bad) + " triangles not positive as written");
  }

  const PlanarGraph& graph_;
  const delmesher::Options& options_;
  const delmesher::PlaneResult& result_;
  const PlaneRecord& record_;
  PlaneVerdict verdict_;
  std::map<std::string, int> count_;
  PlanePoints exact_;
  const std::vector<Point>& points_ = exact_.all();
  PlaneGrid near_;
  std::map<Index, double> radius_;
  int rings_ = -1;
};

}  // namespace

std::string PlaneVerdict::text() const {
  std::string text;
  for (const std::string& failure : failures) text += failure + "\n";
  return text;
}

PlaneVerdict verify_plane(const delmesher::PlanarGraph& graph, const delmesher::Options& options,
                          const delmesher::PlaneResult& result) {
  return Verifier(graph, options, result).run();
}

}  // namespace tetproof
