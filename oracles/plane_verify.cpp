#include "oracles/plane_verify.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <set>

#include "oracles/plane_chamfer.h"
#include "oracles/plane_conformity.h"
#include "oracles/plane_graph.h"

namespace tetproof {
namespace {

using delmesher::ExactPoint;
using delmesher::Insideness;
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using delmesher::Region;
using oracles::OracleReport;
using oracles::PlaneFile;
using oracles::Promise;
using oracles::Verdict;
using oracles::VerifyReport;
using Side = PlaneRecord::Side;
using Index = PlanePoints::Index;
using Point = PlanePoints::Point;
using Edge = std::pair<Index, Index>;
constexpr Index kNothing = 0xffffffffU;
// Angle bounds up to this one, in degrees, are guaranteed in the plane; above it the bound is best
// effort.
constexpr double kGuaranteed = 20.7;
constexpr unsigned kVersion = 1;

Edge undirected(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::array<Index, 3> smallest_first(std::array<Index, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

class RecordVerifier {
 public:
  RecordVerifier(PlaneGraph& graph, const PlaneFile& file, const PlaneRecord& record,
                 const PlaneVerifyOptions& options, VerifyReport& report)
      : input_(graph),
        graph_(graph.given()),
        file_(file),
        record_(record),
        options_(options),
        promise_(options.promised),
        report_(report) {}

  // Returns the largest distance of a written vertex from its exact place.
  double run() {
    check_promise();
    if (!read_points()) return 0;
    Mesh refined = index("refined-", record_.refined, record_.refined_edges);
    Mesh final = index("exact-", record_.final, record_.final_edges);
    verify_complex(refined);
    verify_delaunay(refined);
    const std::vector<oracles::PieceRest> rests = verify_segments(refined);
    verify_refinement(refined);
    if (!promise_.approximate) {
      verify_complex(final);
      verify_delaunay(final);
      verify_tiling(final);
      verify_sides(final);
      verify_vertices(final, refined);
      verify_area(final);
    }
    verify_refined_sides(refined, final);
    verify_chamfers(rests, final);
    verify_same_mesh(promise_.approximate ? refined : final);
    return verify_rounding();
  }

 private:
  struct Mesh {
    std::string prefix;
    const std::vector<PlaneRecord::Triangle>* triangles;
    const std::vector<PlaneRecord::Edge>* edges;
    std::map<Edge, Index> left_of;           // directed edge to the triangle on its left
    std::map<Edge, Index> segment;           // undirected (smaller first) to the input segment
    std::map<Index, std::vector<Index>> at;  // the triangles at each vertex
    PlaneGrid cells;                         // of the triangles
  };

  void tell(OracleReport oracle) { report_.oracles.push_back(std::move(oracle)); }
  static std::string name(Index t) { return "triangle " + std::to_string(t); }
  bool hull() const { return promise_.region == Region::hull; }
  const std::vector<Point>& points() const { return exact_.all(); }

  // ----------------------------------------------------------------------------- the record

  void check_promise() {
    OracleReport oracle("promise", "promises");
    const auto demand = [&](bool kept, const std::string& otherwise) {
      ++oracle.checked;
      if (!kept) oracle.fail(otherwise);
    };
    const auto section = [&](const char* what, std::size_t size) {
      demand(size > 0, std::string("the record has nothing in its section ") + what);
    };
    demand(options_.record_version == kVersion,
           "the record is of version " + std::to_string(options_.record_version) +
               ", what is promised needs version " + std::to_string(kVersion));
    section("points", record_.points.size());
    section("refined", record_.refined.size());
    section("refined_edges", record_.refined_edges.size());
    if (promise_.approximate) {
      demand(record_.final.empty(), "the record has a final mesh, promised was --approximate");
    } else {
      section("final", record_.final.size());
      section("final_edges", record_.final_edges.size());
      section("mesh_vertices", record_.mesh_vertices.size());
    }
    // There is no guard in the plane that would make anything stricter than was asked for.
    const auto within = [&](const char* what, double recorded, double low, double high) {
      demand(recorded >= low && recorded <= high, std::string("the record has ") + what + " " +
                                                      number(recorded) + ", promised was " +
                                                      number(high));
    };
    within("delta", record_.delta, std::min(promise_.delta, kGuaranteed), promise_.delta);
    within("acute", record_.acute, promise_.acute, promise_.acute);
    if (record_.delta < promise_.delta) {
      oracle.figures.emplace_back("delta reached", record_.delta);
    }
    tell(std::move(oracle));
  }

  bool read_points() {
    OracleReport oracle("sidecar", "entries");
    const auto& given = record_.points;
    const std::size_t inputs = graph_.vertices.size();
    if (given.size() < inputs) oracle.fail("fewer points than input vertices");
    for (std::size_t i = 0; i < given.size() && oracle.violations == 0; ++i) {
      ++oracle.checked;
      const ExactPoint& p = given[i];
      const std::string what = "point " + std::to_string(i);
      if (i < inputs) {
        const auto& v = graph_.vertices[i];
        if (p.kind != ExactPoint::Kind::explicit_point || p.x != v[0] || p.y != v[1]) {
          oracle.fail("input vertex " + std::to_string(i) + " was changed");
        }
      }
      Point q;
      if (p.kind == ExactPoint::Kind::explicit_point) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
          oracle.fail(what + " is not finite");
          break;
        }
        q.x = p.x;
        q.y = p.y;
      } else {
        if (p.i >= inputs || p.j >= inputs || p.i >= i || p.j >= i || !(p.x > 0 && p.x < 1)) {
          oracle.fail(what + " is not between input vertices");
          break;
        }
        const mpq_class t = p.x;
        q.x = t * points()[p.i].x + (1 - t) * points()[p.j].x;
        q.y = t * points()[p.i].y + (1 - t) * points()[p.j].y;
      }
      q.dx = q.x.get_d();
      q.dy = q.y.get_d();
      exact_.add(std::move(q));
    }
    // All later checks take these references for granted.
    const auto refers = [&](const char* what, const auto& vertices) {
      ++oracle.checked;
      for (const Index v : vertices) {
        if (v >= given.size()) oracle.fail(std::string(what) + " refers to no point");
      }
    };
    for (const auto* triangles : {&record_.refined, &record_.final}) {
      for (const auto& triangle : *triangles) refers("a triangle", triangle.vertices);
    }
    for (const auto* edges : {&record_.refined_edges, &record_.final_edges}) {
      for (const auto& edge : *edges) refers("an edge", edge.vertices);
    }
    refers("a written vertex", record_.mesh_vertices);
    const bool good = oracle.violations == 0;
    if (good) check_points_are_used(oracle);
    tell(std::move(oracle));
    return good;
  }

  // No oracle would look at the others. Points on segments are given by vertices of the input.
  void check_points_are_used(OracleReport& oracle) const {
    std::vector<std::uint8_t> used(record_.points.size(), 0);
    for (const auto* triangles : {&record_.refined, &record_.final}) {
      for (const auto& triangle : *triangles) {
        for (const Index v : triangle.vertices) used[v] = 1;
      }
    }
    for (std::size_t v = graph_.vertices.size(); v < used.size(); ++v) {
      if (used[v] == 0) oracle.fail("point " + std::to_string(v) + " is used by nothing");
    }
  }

  // ------------------------------------------------------------------------------ complexes

  PlaneGrid::Box box(const std::array<Index, 3>& v) const {
    return box_of({&points()[v[0]], &points()[v[1]], &points()[v[2]]}, 0);
  }

  Mesh index(const char* prefix, const std::vector<PlaneRecord::Triangle>& triangles,
             const std::vector<PlaneRecord::Edge>& edges) {
    Mesh mesh{prefix, &triangles, &edges, {}, {}, {}, {}};
    std::vector<PlaneGrid::Box> boxes;
    for (Index t = 0; t < triangles.size(); ++t) {
      const auto& v = triangles[t].vertices;
      boxes.push_back(box(v));
      for (std::size_t i = 0; i < 3; ++i) {
        mesh.left_of.emplace(Edge(v[i], v[(i + 1) % 3]), t);
        mesh.at[v[i]].push_back(t);
      }
    }
    for (const auto& edge : edges) {
      mesh.segment.emplace(undirected(edge.vertices[0], edge.vertices[1]), edge.segment);
    }
    mesh.cells = PlaneGrid(boxes);
    return mesh;
  }

  static bool has(const Mesh& mesh, const Edge& edge) {
    return mesh.left_of.contains(edge) || mesh.left_of.contains({edge.second, edge.first});
  }

  void verify_complex(const Mesh& mesh) {
    OracleReport oracle(mesh.prefix + "complex", "triangles"),
        orientation(mesh.prefix + "orientation", "triangles");
    mpq_class area = 0, low_x, low_y, high_x, high_y;
    bool first = true;
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      ++oracle.checked;
      ++orientation.checked;
      const auto& [a, b, c] = (*mesh.triangles)[t].vertices;
      if (exact_.orient(a, b, c) <= 0) orientation.fail(name(t) + " is not positive");
      for (const auto& edge : {Edge(a, b), Edge(b, c), Edge(c, a)}) {
        if (mesh.left_of.at(edge) != t) oracle.fail(name(t) + " shares a directed edge");
      }
      for (const Index v : {a, b, c}) {
        const Point& p = points()[v];
        if (first || p.x < low_x) low_x = p.x;
        if (first || p.y < low_y) low_y = p.y;
        if (first || p.x > high_x) high_x = p.x;
        if (first || p.y > high_y) high_y = p.y;
        first = false;
      }
      const Point &p = points()[a], &q = points()[b], &r = points()[c];
      area += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    }
    if (area != 2 * (high_x - low_x) * (high_y - low_y)) {
      oracle.fail("the triangles do not have the area of their rectangle");
    }
    for (Index v = 0; v < graph_.vertices.size(); ++v) {
      const Point& p = points()[v];
      if (first || p.x < low_x || p.x > high_x || p.y < low_y || p.y > high_y) {
        oracle.fail("input vertex " + std::to_string(v) + " is outside the rectangle");
      }
    }
    const auto on_side = [&](const Edge& edge) {
      const Point &p = points()[edge.first], &q = points()[edge.second];
      return (p.x == q.x && (p.x == low_x || p.x == high_x)) ||
             (p.y == q.y && (p.y == low_y || p.y == high_y));
    };
    for (const auto& [edge, t] : mesh.left_of) {
      if (mesh.left_of.contains({edge.second, edge.first})) continue;
      if (!on_side(edge)) oracle.fail(name(t) + " has a border inside the rectangle");
      // Else nothing would ask whether a vertex encroaches upon it.
      if (!mesh.segment.contains(undirected(edge.first, edge.second))) {
        oracle.fail(name(t) + " has an edge on the border that is not listed");
      }
    }
    // Marked edges are edges of the mesh, once each; an edge on no segment is on the outer
    // rectangle.
    if (mesh.segment.size() != mesh.edges->size()) oracle.fail("an edge is listed twice");
    for (const auto& [edge, segment] : mesh.segment) {
      ++oracle.checked;
      if (!has(mesh, edge)) oracle.fail("a listed edge is not in the mesh");
      if (segment == kNothing ? !on_side(edge) : segment >= graph_.segments.size()) {
        oracle.fail("a listed edge is neither on a segment nor on the outer rectangle");
      }
    }
    tell(std::move(oracle));
    tell(std::move(orientation));
  }

  void verify_delaunay(const Mesh& mesh) {
    OracleReport oracle(mesh.prefix + "delaunay", "edges");
    for (const auto& [edge, t] : mesh.left_of) {
      if (edge.first > edge.second || mesh.segment.contains(edge)) continue;
      const auto other = mesh.left_of.find({edge.second, edge.first});
      if (other == mesh.left_of.end()) continue;
      ++oracle.checked;
      const auto& v = (*mesh.triangles)[t].vertices;
      for (const Index d : (*mesh.triangles)[other->second].vertices) {
        if (d == edge.first || d == edge.second) continue;
        if (exact_.in_circle(v[0], v[1], v[2], d) > 0) oracle.fail(name(t));
      }
    }
    if (mesh.left_of.empty()) return;
    if (oracle.checked == 0) {  // two triangles beside a segment
      oracle.checked = 1;
      oracle.notes.emplace_back("every edge is on a segment");
    }
    tell(std::move(oracle));
  }

  // ------------------------------------------------------------------------------- segments

  struct Part {
    mpq_class from, to;
    bool operator<(const Part& other) const {
      return from != other.from ? from < other.from : to < other.to;
    }
  };

  // Per segment, the edges that the record says are on it, as ranges of the segment's parameter.
  std::vector<std::vector<Part>> parts_of(const Mesh& mesh, OracleReport& oracle) {
    std::vector<std::vector<Part>> parts(graph_.segments.size());
    for (const auto& [edge, segment] : mesh.segment) {
      if (segment >= parts.size()) continue;
      ++oracle.checked;
      const auto [a, b] = graph_.segments[segment];
      const auto [u, v] = edge;
      if (exact_.orient(a, b, u) != 0 || exact_.orient(a, b, v) != 0) {
        oracle.fail("an edge is not on segment " + std::to_string(segment));
        continue;
      }
      mpq_class s = exact_.parameter(u, a, b), t = exact_.parameter(v, a, b);
      if (t < s) std::swap(s, t);
      parts[segment].push_back({s, t});
    }
    for (auto& of : parts) std::sort(of.begin(), of.end());
    return parts;
  }

  void verify_tiling(const Mesh& mesh) {
    OracleReport oracle(mesh.prefix + "conformity", "edges");
    const auto parts = parts_of(mesh, oracle);
    for (Index s = 0; s < parts.size(); ++s) {
      if (input_.pieces_of()[s].empty() && parts[s].empty()) continue;  // given twice
      const std::string what = "segment " + std::to_string(s);
      mpq_class at = 0;
      for (const Part& part : parts[s]) {
        if (part.from < at) oracle.fail(what + " is covered twice");
        if (part.from > at) oracle.fail(what + " has a hole");
        at = part.to;
      }
      if (at != 1) oracle.fail(what + " is not covered to its end");
    }
    tell(std::move(oracle));
  }

  // The part that is left of each piece, which has no holes.
  std::vector<oracles::PieceRest> verify_segments(const Mesh& mesh) {
    OracleReport oracle("refined-segments", "edges");
    oracle.checked = input_.pieces().size();
    const auto parts = parts_of(mesh, oracle);
    std::vector<oracles::PieceRest> rests(input_.pieces().size());
    for (Index s = 0; s < parts.size(); ++s) {
      const auto [a, b] = graph_.segments[s];
      const std::string what = "segment " + std::to_string(s);
      auto part = parts[s].begin();
      for (const Index p : input_.pieces_of()[s]) {
        const auto& piece = input_.pieces()[p];
        const mpq_class begin = exact_.parameter(piece.a, a, b),
                        end = exact_.parameter(piece.b, a, b);
        if (part == parts[s].end() || part->from >= end) continue;
        const mpq_class low = part->from;
        mpq_class at = low;
        for (; part != parts[s].end() && part->from < end; ++part) {
          if (part->from < at) oracle.fail(what + " is covered twice");
          if (part->from > at) oracle.fail(what + " has a hole away from vertices");
          at = part->to;
        }
        if (low < begin || at > end) oracle.fail(what + " has an edge over a vertex");
        const double length = exact_.distance(a, b);
        rests[p] = {true, mpq_class(low - begin).get_d() * length,
                    mpq_class(end - at).get_d() * length};
      }
      if (part != parts[s].end()) oracle.fail(what + " has an edge beyond its ends");
    }
    tell(std::move(oracle));
    return rests;
  }

  // -------------------------------------------------------------------------------- refined

  bool in_region(const PlaneRecord::Triangle& t) const { return hull() || t.side != Side::outside; }

  void verify_refinement(const Mesh& mesh) {
    OracleReport angles("refined-angles", "triangles"), balls("refined-encroachment", "triangles"),
        edges("refined-edges", "triangles");
    // The record's claim counts if it is larger. No triangle can keep a bound above 60 degrees, so
    // such a claim is ignored.
    double delta = std::min(promise_.delta, kGuaranteed);
    if (record_.delta <= 60) delta = std::max(delta, record_.delta);
    const long double radians = static_cast<long double>(delta) * 3.14159265358979323846L / 180;
    const mpq_class sine_squared =
        static_cast<double>(std::sin(radians) * std::sin(radians) * (1 - 1e-15L));
    const mpq_class longest = promise_.max_edge * (1 + 1e-9);
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const PlaneRecord::Triangle& triangle = (*mesh.triangles)[t];
      if (!in_region(triangle)) continue;
      for (OracleReport* oracle : {&angles, &balls, &edges}) ++oracle->checked;
      const auto& v = triangle.vertices;
      std::array<mpq_class, 3> length;
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &p = points()[v[i]], &q = points()[v[(i + 1) % 3]];
        length[i] = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
        const Edge edge = undirected(v[i], v[(i + 1) % 3]);
        if (mesh.segment.contains(edge) &&
            exact_.encroaches(edge.first, v[(i + 2) % 3], edge.second)) {
          balls.fail(name(t) + " has a corner in the disc of an edge on a segment");
        }
      }
      std::sort(length.begin(), length.end());
      const Point &p = points()[v[0]], &q = points()[v[1]], &r = points()[v[2]];
      const mpq_class area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
      if (area * area < sine_squared * length[1] * length[2]) {
        angles.fail(name(t) + " has an angle below " + number(delta));
      }
      if (length[2] > longest * longest) edges.fail(name(t) + " has an edge above --max-edge");
    }
    tell(std::move(angles));
    tell(std::move(balls));
    if (promise_.max_edge > 0) tell(std::move(edges));
  }

  void verify_refined_sides(const Mesh& mesh, const Mesh& final) {
    OracleReport oracle("refined-sides", "triangles");
    std::uint64_t unknown = 0;
    for (Index t = 0; t < mesh.triangles->size(); ++t) {
      const PlaneRecord::Triangle& triangle = (*mesh.triangles)[t];
      ++oracle.checked;
      const Crossing crossing = crossing_of(triangle, final);
      if (crossing == Crossing::unknown) {
        ++unknown;
        continue;
      }
      const bool mixed = crossing == Crossing::separating;
      if (mixed != (triangle.side == Side::mixed)) {
        oracle.fail(name(t) + (mixed ? " is crossed by a segment" : " is not mixed"));
      }
      if (mixed) continue;
      bool inside = false;
      if (input_.closed_rings()) {
        inside = input_.inside_by_ray(centroid(triangle));
      } else if (const Index found = triangle_beside(final, triangle); found != kNothing) {
        inside = (*final.triangles)[found].side == Side::inside;
      } else {
        ++unknown;
        continue;
      }
      if (inside != (triangle.side == Side::inside)) {
        oracle.fail(name(t) + (inside ? " is inside" : " is outside"));
      }
    }
    if (unknown > 0) oracle.figures.emplace_back("of unknown side", static_cast<double>(unknown));
    tell(std::move(oracle));
  }

  // Does a part of a segment run through a triangle that separates the inside from the outside?
  enum class Crossing : std::uint8_t { none, separating, unknown };

  Crossing crossing_of(const PlaneRecord::Triangle& triangle, const Mesh& final) {
    Crossing found = Crossing::none;
    input_.near_segments(box(triangle.vertices), [&](Index s) {
      for (const Index p : input_.pieces_of()[s]) {
        const PlaneGraph::Piece& piece = input_.pieces()[p];
        if (found == Crossing::separating || !crosses(piece.a, piece.b, triangle)) continue;
        const std::optional<bool> separating = separates(piece, final);
        if (!separating) {
          found = Crossing::unknown;
        } else if (*separating) {
          found = Crossing::separating;
        }
      }
    });
    return found;
  }

  // By parity, or by the triangles beside the piece in the final mesh, if there is one.
  std::optional<bool> separates(const PlaneGraph::Piece& piece, const Mesh& final) {
    if (input_.closed_rings()) return input_.separates(piece.segment);
    const auto at = final.at.find(piece.a);
    if (at == final.at.end()) return {};
    std::optional<bool> left, right;
    for (const Index t : at->second) {
      const auto& w = (*final.triangles)[t].vertices;
      const auto i = static_cast<std::size_t>(std::find(w.begin(), w.end(), piece.a) - w.begin());
      const bool inside = (*final.triangles)[t].side == Side::inside;
      if (leads(piece, w[(i + 1) % 3])) left = inside;
      if (leads(piece, w[(i + 2) % 3])) right = inside;
    }
    if (!left || !right) return {};
    return *left != *right;
  }

  // Is the point on the ray from the piece's first end through the other one?
  bool leads(const PlaneGraph::Piece& piece, Index v) {
    const Point &a = points()[piece.a], &b = points()[piece.b], &p = points()[v];
    return exact_.orient(piece.a, piece.b, v) == 0 &&
           (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y) > 0;
  }

  Point centroid(const PlaneRecord::Triangle& triangle) const {
    const auto& v = triangle.vertices;
    Point c;
    c.x = (points()[v[0]].x + points()[v[1]].x + points()[v[2]].x) / 3;
    c.y = (points()[v[0]].y + points()[v[1]].y + points()[v[2]].y) / 3;
    c.dx = c.x.get_d();
    c.dy = c.y.get_d();
    return c;
  }

  // Does the segment meet the interior of the triangle? (Separating axes.)
  bool crosses(Index a, Index b, const PlaneRecord::Triangle& triangle) {
    const auto& v = triangle.vertices;
    const auto outside_box = [&](double Point::*x) {
      const auto [low, high] =
          std::minmax({points()[v[0]].*x, points()[v[1]].*x, points()[v[2]].*x});
      const double lo = std::min(points()[a].*x, points()[b].*x),
                   hi = std::max(points()[a].*x, points()[b].*x);
      return hi < low - 2 * exact_.error() || lo > high + 2 * exact_.error();
    };
    if (outside_box(&Point::dx) || outside_box(&Point::dy)) return false;
    const std::array<int, 3> s = {exact_.orient(a, b, v[0]), exact_.orient(a, b, v[1]),
                                  exact_.orient(a, b, v[2])};
    const auto [least, most] = std::minmax({s[0], s[1], s[2]});
    if (least >= 0 || most <= 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index p = v[i], q = v[(i + 1) % 3];
      if (exact_.orient(p, q, a) <= 0 && exact_.orient(p, q, b) <= 0) return false;
    }
    return true;
  }

  // A triangle of the final mesh that overlaps this one, which no segment crosses: it has a corner
  // in common, and contains the direction from there to this one's centroid.
  Index triangle_beside(const Mesh& final, const PlaneRecord::Triangle& triangle) {
    const Point c = centroid(triangle);
    for (const Index v : triangle.vertices) {
      const auto at = final.at.find(v);
      if (at == final.at.end()) continue;
      for (const Index t : at->second) {
        const auto& w = (*final.triangles)[t].vertices;
        const auto i = static_cast<std::size_t>(std::find(w.begin(), w.end(), v) - w.begin());
        const Point &p = points()[w[(i + 1) % 3]], &q = points()[w[(i + 2) % 3]];
        if (exact_.orient(points()[v], p, c) >= 0 && exact_.orient(points()[v], c, q) >= 0) {
          return t;
        }
      }
    }
    return kNothing;
  }

  // A triangle that contains the point, possibly on its border.
  Index triangle_with(Mesh& mesh, const Point& p) {
    Index found = kNothing;
    mesh.cells.visit(box_of({&p}, 0), [&](Index t) {
      const auto& v = (*mesh.triangles)[t].vertices;
      if (found == kNothing && exact_.orient(points()[v[0]], points()[v[1]], p) >= 0 &&
          exact_.orient(points()[v[1]], points()[v[2]], p) >= 0 &&
          exact_.orient(points()[v[2]], points()[v[0]], p) >= 0) {
        found = t;
      }
    });
    return found;
  }

  void verify_chamfers(const std::vector<oracles::PieceRest>& rests, const Mesh& final) {
    const auto side_of = [&](Index v, Index from, Index to) {
      if (promise_.approximate) return side_by_probes(v, from, to);
      const auto at = final.at.find(v);
      if (at == final.at.end()) return 0;
      for (const Index t : at->second) {
        const PlaneRecord::Triangle& triangle = (*final.triangles)[t];
        if (triangle.side == Side::inside && between(v, from, to, centroid(triangle))) return 1;
      }
      return 0;
    };
    oracles::check_plane_chamfers(input_, record_, rests, side_of, promise_, report_);
  }

  bool between(Index v, Index from, Index to, const Point& p) {
    return exact_.orient(points()[v], points()[from], p) > 0 &&
           exact_.orient(points()[v], p, points()[to]) > 0;
  }

  // Without a final mesh: tries a point close to the vertex between every two neighbouring pieces.
  int side_by_probes(Index v, Index from, Index to) {
    if (!input_.closed_rings()) return -1;
    std::vector<Index> ends;
    for (const Index p : input_.pieces_at()[v]) {
      const auto& piece = input_.pieces()[p];
      const Index end = piece.a == v ? piece.b : piece.a;
      if (end == from || end == to || between(v, from, to, points()[end])) ends.push_back(end);
    }
    std::sort(ends.begin(), ends.end(), [&](Index p, Index q) {
      return exact_.orient(points()[v], points()[p], points()[q]) > 0;
    });
    double near = HUGE_VAL;
    for (const Index end : ends) near = std::min(near, exact_.distance(v, end));
    near = std::min(near, input_.feature_size(v, near)) / 8;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      const Point& o = points()[v];
      Point p;
      p.x = o.x;
      p.y = o.y;
      for (const Index end : {ends[k], ends[k + 1]}) {
        const mpq_class share = near / exact_.distance(v, end);
        p.x += share * (points()[end].x - o.x);
        p.y += share * (points()[end].y - o.y);
      }
      p.dx = p.x.get_d();
      p.dy = p.y.get_d();
      if (input_.inside_by_ray(p)) return 1;
    }
    return 0;
  }

  // ---------------------------------------------------------------------------------- final

  // Floods from the border, and counts the separating segments that have to be crossed.
  void verify_sides(Mesh& mesh) {
    OracleReport oracle("exact-sides", "triangles");
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
        if (input_.on_segment(hole)) continue;
        const Index t = triangle_with(mesh, {hole[0], hole[1], hole[0], hole[1]});
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
          if (!nested || segment->second >= graph_.segments.size()) continue;
          cost = input_.separates(segment->second) ? 1 : 0;
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
      ++oracle.checked;
      const PlaneRecord::Triangle& triangle = (*mesh.triangles)[t];
      const bool inside = nested ? depth[t] % 2 != 0 : depth[t] != 0;
      if (triangle.side != (inside ? Side::inside : Side::outside)) {
        oracle.fail(name(t) + (inside ? " should be inside" : " should be outside"));
      } else if (input_.closed_rings() && input_.inside_by_ray(centroid(triangle)) != inside) {
        oracle.fail(name(t) + " is on the other side by a ray");
      }
    }
    tell(std::move(oracle));
  }

  void verify_vertices(const Mesh& final, const Mesh& refined) {
    OracleReport oracle("enrichment", "vertices");
    std::vector<std::uint8_t> there(points().size(), 0), refined_has(points().size(), 0);
    std::set<std::pair<double, double>> places;
    for (const auto& triangle : *refined.triangles) {
      for (const Index v : triangle.vertices) refined_has[v] = 1;
    }
    for (const auto& triangle : *final.triangles) {
      for (const Index v : triangle.vertices) {
        there[v] = 1;
        if (v < graph_.vertices.size()) places.insert({points()[v].dx, points()[v].dy});
      }
    }
    for (Index v = 0; v < there.size(); ++v) {
      ++oracle.checked;
      const std::string what = "vertex " + std::to_string(v);
      if (v < graph_.vertices.size()) {
        if (there[v] == 0) oracle.fail("input " + what + " is missing");
      } else if (refined_has[v] != 0) {
        if (there[v] == 0 && !places.contains({points()[v].dx, points()[v].dy})) {
          oracle.fail("refined " + what + " is missing");
        }
      } else if (there[v] != 0) {
        oracle.fail("final " + what + " is neither of the input nor of the refined mesh");
      }
    }
    tell(std::move(oracle));
  }

  // The area of the inside, where a single ring bounds it.
  void verify_area(const Mesh& mesh) {
    if (input_.area_of_ring() < 0) return;
    OracleReport oracle("exact-area", "triangles");
    mpq_class inside = 0;
    for (const auto& triangle : *mesh.triangles) {
      ++oracle.checked;
      if (triangle.side != Side::inside) continue;
      const Point &p = points()[triangle.vertices[0]], &q = points()[triangle.vertices[1]],
                  &r = points()[triangle.vertices[2]];
      inside += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    }
    if (inside != input_.area_of_ring()) {
      oracle.fail("the inside does not have the area of the polygon");
    }
    tell(std::move(oracle));
  }

  // ---------------------------------------------------------------------- the file is the record

  void verify_same_mesh(const Mesh& mesh) {
    OracleReport oracle("same-mesh", "triangles, edges");
    const auto& ids = record_.mesh_vertices;
    if (ids.size() != file_.vertices.size()) {
      oracle.fail("the record has " + std::to_string(ids.size()) + " written vertices, the file " +
                  std::to_string(file_.vertices.size()));
      return tell(std::move(oracle));
    }
    std::map<std::array<Index, 3>, bool> expected;  // and whether it is inside
    for (const auto& triangle : *mesh.triangles) {
      if (!hull() && triangle.side != Side::inside) continue;
      expected.emplace(smallest_first(triangle.vertices), triangle.side == Side::inside);
    }
    std::set<Edge> edges;  // of the triangles in the file
    const std::size_t wanted = expected.size();
    for (std::size_t t = 0; t < file_.triangles.size(); ++t) {
      ++oracle.checked;
      const auto& [a, b, c] = file_.triangles[t];
      const std::string what = "triangle " + std::to_string(t);
      if (std::max({a, b, c}) >= ids.size()) {
        oracle.fail(what + " refers to no vertex");
        continue;
      }
      const auto found = expected.find(smallest_first({ids[a], ids[b], ids[c]}));
      if (found == expected.end()) {
        oracle.fail(what + " of the file is not in the record, or is there twice");
        continue;
      }
      if (t < file_.inside.size() && (file_.inside[t] != 0) != found->second) {
        oracle.fail(what + " of the file is on the other side in the record");
      }
      for (const Edge& edge : {Edge(ids[a], ids[b]), Edge(ids[b], ids[c]), Edge(ids[c], ids[a])}) {
        edges.insert(undirected(edge.first, edge.second));
      }
      expected.erase(found);
    }
    if (!expected.empty()) {
      oracle.fail("the file lacks " + std::to_string(expected.size()) + " of " +
                  std::to_string(wanted) + " triangles of the record");
    }
    const bool outside = std::any_of(mesh.triangles->begin(), mesh.triangles->end(),
                                     [](const auto& t) { return t.side != Side::inside; });
    if (hull() && outside && file_.names_sides && file_.inside.size() != file_.triangles.size()) {
      oracle.fail("the file does not say which triangles are inside");
    }
    if (file_.lists_edges) compare_edges(mesh, edges, oracle);
    if (wanted == 0) ++oracle.checked;
    tell(std::move(oracle));
  }

  void compare_edges(const Mesh& mesh, const std::set<Edge>& edges, OracleReport& oracle) {
    std::map<Edge, Index> expected;
    for (const auto& [edge, segment] : mesh.segment) {
      if (segment != kNothing && edges.contains(edge)) expected.emplace(edge, segment);
    }
    const auto& ids = record_.mesh_vertices;
    if (file_.markers.size() != file_.edges.size()) {
      oracle.fail("not every listed edge has a marker");
    }
    if (file_.names_segments && file_.segments.size() != file_.edges.size()) {
      oracle.fail("not every listed edge has a segment");
    }
    for (std::size_t i = 0; i < file_.edges.size(); ++i) {
      ++oracle.checked;
      const auto& [a, b] = file_.edges[i];
      const std::string what = "listed edge " + std::to_string(i);
      if (std::max(a, b) >= ids.size()) {
        oracle.fail(what + " refers to no vertex");
        continue;
      }
      const auto found = expected.find(undirected(ids[a], ids[b]));
      if (found == expected.end()) {
        oracle.fail(what + " is no edge on a segment in the record");
        continue;
      }
      const std::int32_t marker = graph_.markers.empty() || found->second >= graph_.segments.size()
                                      ? 0
                                      : graph_.markers[found->second];
      if (i < file_.markers.size() && file_.markers[i] != marker) {
        oracle.fail(what + " does not have the marker of its segment");
      }
      if (i < file_.segments.size() && file_.segments[i] != found->second) {
        oracle.fail(what + " is on another segment in the record");
      }
      expected.erase(found);
    }
    if (!expected.empty()) oracle.fail("an edge on a segment is not listed in the file");
  }

  double verify_rounding() {
    constexpr double kUlps = 4;
    OracleReport oracle("rounding", "vertices");
    const auto& ids = record_.mesh_vertices;
    double largest = 0;
    for (const auto& p : file_.vertices) {
      largest = std::max({largest, std::fabs(p[0]), std::fabs(p[1])});
    }
    const double ulp = std::nextafter(largest, HUGE_VAL) - largest;
    const double allowed = std::max(kUlps * ulp, options_.declared_deviation * input_.diagonal());
    std::set<Index> seen;
    double deviation = 0;
    for (std::size_t i = 0; i < std::min(ids.size(), file_.vertices.size()); ++i) {
      ++oracle.checked;
      const std::string what = "vertex " + std::to_string(i);
      if (!seen.insert(ids[i]).second) oracle.fail(what + " is a point that was written before");
      const Point& p = points()[ids[i]];
      const auto& w = file_.vertices[i];
      if (!std::isfinite(w[0]) || !std::isfinite(w[1])) {
        oracle.fail(what + " is not finite");
        continue;
      }
      const mpq_class dx = p.x - mpq_class(w[0]), dy = p.y - mpq_class(w[1]);
      const double off = std::hypot(dx.get_d(), dy.get_d());
      if (ids[i] < graph_.vertices.size() && off != 0) {
        oracle.fail(what + " is of the input, and was moved");
      } else if (off > allowed) {
        oracle.fail(what + " is " + number(off / ulp) + " ulp away from its place");
      }
      deviation = std::max(deviation, off);
    }
    if (ids.size() != file_.vertices.size()) oracle.fail("another number of vertices was written");
    if (ids.empty() && promise_.approximate) ++oracle.checked;
    oracle.figures.emplace_back("deviation", deviation);
    tell(std::move(oracle));
    return deviation;
  }

  PlaneGraph& input_;
  const PlanarGraph& graph_;
  const PlaneFile& file_;
  const PlaneRecord& record_;
  const PlaneVerifyOptions& options_;
  const Promise& promise_;
  VerifyReport& report_;
  PlanePoints exact_;
};

std::string reason_against(const PlanarGraph& graph) {
  if (graph.segments.empty()) return "no segments";
  std::set<std::array<double, 2>> places;
  for (const auto& p : graph.vertices) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1])) return "a vertex is not finite";
    if (!places.insert({p[0] + 0.0, p[1] + 0.0}).second) return "two vertices coincide";
  }
  for (const auto& [a, b] : graph.segments) {
    if (std::max(a, b) >= graph.vertices.size()) return "a segment refers to no vertex";
    if (a == b) return "a segment begins and ends at one vertex";
  }
  return {};
}

}  // namespace

std::string verify_plane(const PlanarGraph& graph, const PlaneFile& file, const PlaneRecord* record,
                         const PlaneVerifyOptions& options, VerifyReport& report) {
  constexpr double kUlps = 4;
  report = {};
  report.cells = "triangles";
  if (std::string why = reason_against(graph); !why.empty()) return why;
  PlaneGraph input(graph);
  double largest = input.largest();
  for (const auto& p : file.vertices) {
    largest = std::max({largest, std::fabs(p[0]), std::fabs(p[1])});
  }
  const double ulp = std::nextafter(largest, HUGE_VAL) - largest;
  oracles::check_plane_file(input, file, options.promised,
                            options.declared_deviation * input.diagonal(), report,
                            report.deviation);
  if (record != nullptr && options.promised.approximate && file.triangles.empty()) {
    // Corners may have taken all triangles; same-mesh decides whether the record has none either.
    for (OracleReport& oracle : report.oracles) {
      oracle.checked = std::max<std::uint64_t>(oracle.checked, 1);
      oracle.notes.emplace_back("the file has no triangle");
    }
  }
  if (record != nullptr) {
    const double off = RecordVerifier(input, file, *record, options, report).run();
    report.deviation = std::max(report.deviation, off);
  }
  report.deviation_ulps = ulp > 0 ? report.deviation / ulp : 0;
  report.deviation_share = input.diagonal() > 0 ? report.deviation / input.diagonal() : 0;
  report.verdict = !report.all_passed()              ? Verdict::broken
                   : report.deviation == 0           ? Verdict::exact
                   : report.deviation <= kUlps * ulp ? Verdict::rounded
                                                     : Verdict::deviating;
  return {};
}

std::string PlaneVerdict::text() const {
  std::string text;
  for (const std::string& failure : failures) text += failure + "\n";
  return text;
}

PlaneVerdict verify_plane(const PlanarGraph& graph, const delmesher::Options& options,
                          const delmesher::PlaneResult& result) {
  PlaneVerdict verdict;
  PlaneVerifyOptions how;
  how.promised = oracles::promise_of(options, oracles::Task::plane);
  const std::string why =
      verify_plane(graph, oracles::plane_file_of(result.mesh), &result.exact, how, verdict.report);
  if (!why.empty()) verdict.failures.push_back("input: " + why);
  for (const OracleReport& oracle : verdict.report.oracles) {
    verdict.checks += oracle.checked;
    if (!oracle.passed() && oracle.findings.empty()) {
      verdict.failures.push_back(oracle.name + ": nothing to check");
    }
    for (const std::string& finding : oracle.findings) {
      verdict.failures.push_back(oracle.name + ": " + finding);
    }
  }
  return verdict;
}

}  // namespace tetproof
