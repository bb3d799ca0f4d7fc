#include "oracles/plane/record.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tetproof::oracles {

namespace {

using delmesher::ExactPoint;
using delmesher::PlaneRecord;
using Side = PlaneRecord::Side;
using Index = PlanePoints::Index;
using Point = PlanePoints::Point;
constexpr unsigned kVersion = 1;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::array<Index, 3> smallest_first(std::array<Index, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// --------------------------------------------------------------------------------- the points

class PointReader {
 public:
  PointReader(const PlaneGraph& input, const PlaneRecord& record, PlanePoints& exact)
      : graph_(input.given()), record_(record), exact_(exact), inputs_(graph_.vertices.size()) {}

  bool run(VerifyReport& report) {
    if (record_.points.size() < inputs_) oracle_.fail("fewer points than input vertices");
    for (Index i = 0; i < record_.points.size() && oracle_.violations == 0; ++i) {
      ++oracle_.checked;
      read(i);
    }
    check_references();
    const bool usable = oracle_.violations == 0;
    if (usable) check_points_are_used();
    report.oracles.push_back(std::move(oracle_));
    return usable;
  }

 private:
  void read(Index i) {
    const ExactPoint& p = record_.points[i];
    if (i < inputs_) {
      const auto& v = graph_.vertices[i];
      if (p.kind != ExactPoint::Kind::explicit_point || p.x != v[0] || p.y != v[1]) {
        oracle_.fail("input vertex " + std::to_string(i) + " was changed");
      }
    }
    if (p.kind == ExactPoint::Kind::explicit_point) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
        return oracle_.fail("point " + std::to_string(i) + " is not finite");
      }
      return add(p.x, p.y);
    }
    if (p.i >= inputs_ || p.j >= inputs_ || p.i >= i || p.j >= i || !(p.x > 0 && p.x < 1)) {
      return oracle_.fail("point " + std::to_string(i) + " is not between input vertices");
    }
    const mpq_class t = p.x;
    const Point &a = exact_.all()[p.i], &b = exact_.all()[p.j];
    add(t * a.x + (1 - t) * b.x, t * a.y + (1 - t) * b.y);
  }

  void add(mpq_class x, mpq_class y) {
    Point q;
    q.x = std::move(x);
    q.y = std::move(y);
    q.dx = q.x.get_d();
    q.dy = q.y.get_d();
    exact_.add(std::move(q));
  }

  // All later checks take these references for granted.
  void check_references() {
    const auto refers = [&](const char* what, const auto& vertices) {
      ++oracle_.checked;
      for (const Index v : vertices) {
        if (v >= record_.points.size()) oracle_.fail(std::string(what) + " refers to no point");
      }
    };
    for (const auto* triangles : {&record_.refined, &record_.final}) {
      for (const auto& triangle : *triangles) refers("a triangle", triangle.vertices);
    }
    for (const auto* edges : {&record_.refined_edges, &record_.final_edges}) {
      for (const auto& edge : *edges) refers("an edge", edge.vertices);
    }
    refers("a written vertex", record_.mesh_vertices);
  }

  // No oracle would look at the others. Points on segments are given by vertices of the input.
  void check_points_are_used() {
    std::vector<std::uint8_t> used(record_.points.size(), 0);
    for (const auto* triangles : {&record_.refined, &record_.final}) {
      for (const auto& triangle : *triangles) {
        for (const Index v : triangle.vertices) used[v] = 1;
      }
    }
    for (std::size_t v = inputs_; v < used.size(); ++v) {
      if (used[v] == 0) oracle_.fail("point " + std::to_string(v) + " is used by nothing");
    }
  }

  const delmesher::PlanarGraph& graph_;
  const PlaneRecord& record_;
  PlanePoints& exact_;
  const std::size_t inputs_;
  OracleReport oracle_{"sidecar", "entries"};
};

// --------------------------------------------------------------------- the file is the record

class SameMesh {
 public:
  SameMesh(const RecordedPlane& recorded, const PlaneFile& file)
      : recorded_(recorded),
        mesh_(recorded.promise.approximate ? recorded.refined : recorded.final),
        ids_(recorded.record.mesh_vertices),
        file_(file) {}

  OracleReport run() {
    if (ids_.size() != file_.vertices.size()) {
      oracle_.fail("the record has " + std::to_string(ids_.size()) +
                   " written vertices, the file " + std::to_string(file_.vertices.size()));
      return std::move(oracle_);
    }
    compare_triangles();
    check_names_of_sides();
    if (file_.lists_edges) compare_edges();
    if (!file_.lacks.empty()) oracle_.fail(file_.lacks + " is missing");
    return std::move(oracle_);
  }

 private:
  void compare_triangles() {
    std::map<std::array<Index, 3>, bool> expected;  // and whether it is inside
    for (const auto& triangle : mesh_.triangles()) {
      if (!recorded_.hull() && triangle.side != Side::inside) continue;
      expected.emplace(smallest_first(triangle.vertices), triangle.side == Side::inside);
    }
    const std::size_t wanted = expected.size();
    for (std::size_t t = 0; t < file_.triangles.size(); ++t) {
      ++oracle_.checked;
      const auto& [a, b, c] = file_.triangles[t];
      if (std::max({a, b, c}) >= ids_.size()) {
        oracle_.fail(triangle_name(t) + " refers to no vertex");
        continue;
      }
      const auto found = expected.find(smallest_first({ids_[a], ids_[b], ids_[c]}));
      if (found == expected.end()) {
        oracle_.fail(triangle_name(t) + " of the file is not in the record, or is there twice");
        continue;
      }
      if (t < file_.inside.size() && (file_.inside[t] != 0) != found->second) {
        oracle_.fail(triangle_name(t) + " of the file is on the other side in the record");
      }
      for (const auto& [u, v] : {PlaneEdge(a, b), PlaneEdge(b, c), PlaneEdge(c, a)}) {
        written_edges_.insert(undirected(ids_[u], ids_[v]));
      }
      expected.erase(found);
    }
    if (!expected.empty()) {
      oracle_.fail("the file lacks " + std::to_string(expected.size()) + " of " +
                   std::to_string(wanted) + " triangles of the record");
    }
    if (wanted == 0) ++oracle_.checked;
  }

  void check_names_of_sides() {
    const bool outside = std::any_of(mesh_.triangles().begin(), mesh_.triangles().end(),
                                     [](const auto& t) { return t.side != Side::inside; });
    if (recorded_.hull() && outside && file_.names_sides &&
        file_.inside.size() != file_.triangles.size()) {
      oracle_.fail("the file does not say which triangles are inside");
    }
  }

  void compare_edges() {
    std::map<PlaneEdge, Index> expected;
    for (const auto& [edge, segment] : mesh_.segment_of()) {
      if (segment != kOuterRectangle && written_edges_.contains(edge)) {
        expected.emplace(edge, segment);
      }
    }
    if (file_.markers.size() != file_.edges.size()) {
      oracle_.fail("not every listed edge has a marker");
    }
    if (file_.names_segments && file_.segments.size() != file_.edges.size()) {
      oracle_.fail("not every listed edge has a segment");
    }
    for (std::size_t i = 0; i < file_.edges.size(); ++i) {
      ++oracle_.checked;
      const auto& [a, b] = file_.edges[i];
      const std::string what = "listed edge " + std::to_string(i);
      if (std::max(a, b) >= ids_.size()) {
        oracle_.fail(what + " refers to no vertex");
        continue;
      }
      const auto found = expected.find(undirected(ids_[a], ids_[b]));
      if (found == expected.end()) {
        oracle_.fail(what + " is not an edge on a segment in the record");
        continue;
      }
      compare_edge(i, found->second, what);
      expected.erase(found);
    }
    if (!expected.empty()) oracle_.fail("an edge on a segment is not listed in the file");
  }

  void compare_edge(std::size_t i, Index segment, const std::string& what) {
    const auto& graph = recorded_.graph();
    const bool marked = !graph.markers.empty() && segment < graph.segments.size();
    const std::int32_t marker = marked ? graph.markers[segment] : 0;
    if (i < file_.markers.size() && file_.markers[i] != marker) {
      oracle_.fail(what + " does not have the marker of its segment");
    }
    if (i < file_.segments.size() && file_.segments[i] != segment) {
      oracle_.fail(what + " is on another segment in the record");
    }
  }

  const RecordedPlane& recorded_;
  const PlaneComplex& mesh_;  // the last of the record
  const std::vector<std::uint32_t>& ids_;
  const PlaneFile& file_;
  std::set<PlaneEdge> written_edges_;  // of the triangles in the file, as points of the record
  OracleReport oracle_{"same-mesh", "triangles, edges"};
};

}  // namespace

OracleReport check_plane_promise(const PlaneRecord& record, const Promise& promise,
                                 unsigned version) {
  OracleReport oracle("promise", "promises");
  const auto demand = [&](bool kept, const std::string& otherwise) {
    ++oracle.checked;
    if (!kept) oracle.fail(otherwise);
  };
  const auto section = [&](const char* what, std::size_t size) {
    demand(size > 0, std::string("empty section of the record: ") + what);
  };
  demand(version == kVersion, "the record is of version " + std::to_string(version) +
                                  ", what is promised needs version " + std::to_string(kVersion));
  section("points", record.points.size());
  section("refined", record.refined.size());
  section("refined_edges", record.refined_edges.size());
  if (promise.approximate) {
    demand(record.final.empty() && record.final_edges.empty(),
           "the record has a final mesh, or edges of one, promised was --approximate");
  } else {
    section("final", record.final.size());
    section("final_edges", record.final_edges.size());
    section("mesh_vertices", record.mesh_vertices.size());
  }
  const auto within = [&](const char* what, double recorded, double low, double high) {
    demand(recorded >= low && recorded <= high, std::string("the record has ") + what + " " +
                                                    number(recorded) + ", promised was " +
                                                    number(high));
  };
  within("delta", record.delta, promise.guaranteed_delta(), promise.delta);
  within("acute", record.acute, promise.acute, promise.acute);
  if (promise.max_vertices > 0) {
    within("written vertices", static_cast<double>(record.mesh_vertices.size()), 0,
           promise.max_vertices);
  }
  if (record.delta < promise.delta) oracle.figures.emplace_back("delta reached", record.delta);
  return oracle;
}

bool read_plane_points(const PlaneGraph& input, const PlaneRecord& record, PlanePoints& exact,
                       VerifyReport& report) {
  return PointReader(input, record, exact).run(report);
}

OracleReport check_plane_same_mesh(const RecordedPlane& recorded, const PlaneFile& file) {
  return SameMesh(recorded, file).run();
}

OracleReport check_plane_rounding(const RecordedPlane& recorded, const PlaneFile& file,
                                  double declared, double& deviation) {
  constexpr double kUlps = 4;
  OracleReport oracle("rounding", "vertices");
  const auto& ids = recorded.record.mesh_vertices;
  std::set<Index> seen;
  deviation = 0;
  for (std::size_t i = 0; i < std::min(ids.size(), file.vertices.size()); ++i) {
    ++oracle.checked;
    const std::string what = "vertex " + std::to_string(i);
    if (!seen.insert(ids[i]).second) oracle.fail(what + " is a point that was written before");
    const Point& p = recorded.points()[ids[i]];
    const auto& w = file.vertices[i];
    if (!std::isfinite(w[0]) || !std::isfinite(w[1])) {
      oracle.fail(what + " is not finite");
      continue;
    }
    const mpq_class dx = p.x - mpq_class(w[0]), dy = p.y - mpq_class(w[1]);
    const double off = std::hypot(dx.get_d(), dy.get_d());
    // A point beyond the input is known to its own ulp. What is written there moves no segment.
    const double own = std::max(std::fabs(p.dx), std::fabs(p.dy));
    const bool beyond = own > recorded.input.largest();
    const double ulp = beyond ? std::ldexp(1.0, std::ilogb(own) - 52) : recorded.input.ulp();
    if (ids[i] < recorded.graph().vertices.size() && off != 0) {
      oracle.fail(what + " is of the input, and was moved");
    } else if (off > std::max(kUlps * ulp, declared)) {
      oracle.fail(what + " is " + number(off / ulp) + " ulp away from its place");
    }
    if (!beyond) deviation = std::max(deviation, off);
  }
  if (ids.size() != file.vertices.size()) oracle.fail("another number of vertices was written");
  if (ids.empty() && recorded.promise.approximate) ++oracle.checked;
  oracle.figures.emplace_back("deviation", deviation);
  return oracle;
}

}  // namespace tetproof::oracles
