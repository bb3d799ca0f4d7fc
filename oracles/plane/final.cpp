#include "oracles/plane/final.h"

#include <algorithm>
#include <deque>
#include <set>

namespace tetproof::oracles {

namespace {

using Side = delmesher::PlaneRecord::Side;
using Index = PlaneComplex::Index;
using Triangle = PlaneComplex::Triangle;

void check_tiling(const RecordedPlane& recorded, VerifyReport& report) {
  OracleReport oracle("exact-conformity", "edges");
  const auto parts = parts_of(recorded.final, recorded.input, oracle);
  for (Index s = 0; s < parts.size(); ++s) {
    if (recorded.input.pieces_of()[s].empty() && parts[s].empty()) continue;  // given twice
    const std::string what = "segment " + std::to_string(s);
    mpq_class at = 0;
    for (const SegmentPart& part : parts[s]) {
      if (part.from < at) oracle.fail(what + " is covered twice");
      if (part.from > at) oracle.fail(what + " has a hole");
      at = part.to;
    }
    if (at != 1) oracle.fail(what + " is not covered to its end");
  }
  report.oracles.push_back(std::move(oracle));
}

// How many separating segments lie between a triangle and the border, at least: with `nested` sides
// 0, 1, 2, ..., otherwise 0 for all that the flood reaches.
class Flood {
 public:
  explicit Flood(RecordedPlane& recorded)
      : recorded_(recorded),
        mesh_(recorded.final),
        nested_(recorded.graph().insideness == delmesher::Insideness::nested),
        depth_(mesh_.triangles().size(), kNotReached) {
    start_at_border();
    if (!nested_) start_in_holes();
    while (!queue_.empty()) {
      const Index t = queue_.front();
      queue_.pop_front();
      const auto& v = mesh_.triangles()[t].vertices;
      for (std::size_t i = 0; i < 3; ++i) step(t, {v[i], v[(i + 1) % 3]});
    }
  }

  bool inside(Index t) const { return nested_ ? depth_[t] % 2 != 0 : depth_[t] != 0; }

 private:
  static constexpr int kNotReached = -1;

  void start(Index t) {
    if (depth_[t] == 0) return;
    depth_[t] = 0;
    queue_.push_back(t);
  }

  void start_at_border() {
    for (const auto& [edge, t] : mesh_.left_of()) {
      if (mesh_.right_of(edge) == PlaneComplex::kNone) start(t);
    }
  }

  void start_in_holes() {
    for (const auto& hole : recorded_.graph().holes) {
      if (recorded_.input.on_segment(hole)) continue;
      const Index t = mesh_.triangle_with({hole[0], hole[1], hole[0], hole[1]});
      if (t != PlaneComplex::kNone) start(t);
    }
  }

  // Across an edge of the triangle, whose left it is.
  void step(Index t, const PlaneEdge& edge) {
    const Index other = mesh_.right_of(edge);
    if (other == PlaneComplex::kNone) return;
    const auto found = mesh_.segment_of().find(undirected(edge.first, edge.second));
    int cost = 0;
    if (found != mesh_.segment_of().end()) {
      if (!nested_ || found->second >= recorded_.graph().segments.size()) return;
      cost = recorded_.input.separates(found->second) ? 1 : 0;
    }
    const int depth = depth_[t] + cost;
    int& known = depth_[other];
    if (known != kNotReached && known <= depth) return;
    known = depth;
    // Shallow triangles first.
    cost == 0 ? queue_.push_front(other) : queue_.push_back(other);
  }

  RecordedPlane& recorded_;
  PlaneComplex& mesh_;
  const bool nested_;
  std::vector<int> depth_;
  std::deque<Index> queue_;
};

void check_sides(RecordedPlane& recorded, VerifyReport& report) {
  OracleReport oracle("exact-sides", "triangles");
  const Flood flood(recorded);
  for (Index t = 0; t < recorded.final.triangles().size(); ++t) {
    ++oracle.checked;
    const Triangle& triangle = recorded.final.triangles()[t];
    const bool inside = flood.inside(t);
    if (triangle.side != (inside ? Side::inside : Side::outside)) {
      oracle.fail(triangle_name(t) + (inside ? " should be inside" : " should be outside"));
    } else if (recorded.input.closed_rings() &&
               recorded.input.inside_by_ray(recorded.final.centroid(triangle)) != inside) {
      oracle.fail(triangle_name(t) + " is on the other side by a ray");
    }
  }
  report.oracles.push_back(std::move(oracle));
}

// Per point of the record: is it a vertex of the mesh?
std::vector<std::uint8_t> vertices_of(const PlaneComplex& mesh) {
  std::vector<std::uint8_t> there(mesh.exact().all().size(), 0);
  for (const auto& triangle : mesh.triangles()) {
    for (const Index v : triangle.vertices) there[v] = 1;
  }
  return there;
}

// The edges on segments that were cut off at a vertex of the input and came back.
class CutOff {
 public:
  explicit CutOff(const RecordedPlane& recorded) : recorded_(recorded) {
    std::vector<PlaneBoxes::Box> discs;
    for (const auto& [edge, segment] : recorded.final.segment_of()) {
      const auto& [a, b] = edge;
      const bool at_input = std::min(a, b) < recorded.graph().vertices.size();
      if (!at_input || segment == kOuterRectangle || recorded.refined.segment_of().contains(edge))
        continue;
      edges_.push_back(edge);
      const auto &p = recorded.points()[a], &q = recorded.points()[b];
      const double x = (p.dx + q.dx) / 2, y = (p.dy + q.dy) / 2;
      const double r = recorded.exact.distance(a, b) * 0.51;
      discs.push_back({{x - r, y - r}, {x + r, y + r}});
    }
    discs_ = PlaneBoxes(discs);
  }

  bool encroached_by(Index v) {
    const auto& p = recorded_.points()[v];
    bool found = false;
    discs_.visit({{p.dx, p.dy}, {p.dx, p.dy}}, [&](std::uint32_t e) {
      found = found || recorded_.exact.encroaches(edges_[e].first, v, edges_[e].second);
    });
    return found;
  }

 private:
  const RecordedPlane& recorded_;
  std::vector<PlaneEdge> edges_;
  PlaneBoxes discs_;
};

void check_vertices(const RecordedPlane& recorded, VerifyReport& report) {
  OracleReport oracle("enrichment", "vertices");
  CutOff cut_off(recorded);
  std::uint64_t left_out = 0;
  const auto& points = recorded.points();
  const std::size_t inputs = recorded.graph().vertices.size();
  const auto there = vertices_of(recorded.final), refined = vertices_of(recorded.refined);
  std::set<std::pair<double, double>> places;  // of input vertices that are there
  for (Index v = 0; v < inputs; ++v) {
    if (there[v] != 0) places.insert({points[v].dx, points[v].dy});
  }
  for (Index v = 0; v < there.size(); ++v) {
    ++oracle.checked;
    const std::string what = "vertex " + std::to_string(v);
    if (v < inputs) {
      if (there[v] == 0) oracle.fail("input " + what + " is missing");
    } else if (refined[v] != 0) {
      if (there[v] != 0 || places.contains({points[v].dx, points[v].dy})) continue;
      const bool in_a_face =
          recorded.record.points[v].kind == delmesher::ExactPoint::Kind::explicit_point;
      if (!recorded.promise.kept_points && in_a_face && cut_off.encroached_by(v)) {
        ++left_out;
      } else {
        oracle.fail("refined " + what + " is missing");
      }
    } else if (there[v] != 0) {
      oracle.fail("final " + what + " is neither of the input nor of the refined mesh");
    }
  }
  if (left_out > 0) oracle.figures.emplace_back("left out", static_cast<double>(left_out));
  report.oracles.push_back(std::move(oracle));
}

void check_area(const RecordedPlane& recorded, VerifyReport& report) {
  if (recorded.input.area_of_ring() < 0) return;
  OracleReport oracle("exact-area", "triangles");
  mpq_class inside = 0;
  for (const auto& triangle : recorded.final.triangles()) {
    ++oracle.checked;
    if (triangle.side == Side::inside) inside += recorded.final.doubled_area(triangle);
  }
  if (inside != recorded.input.area_of_ring()) {
    oracle.fail("the inside does not have the area of the polygon");
  }
  report.oracles.push_back(std::move(oracle));
}

}  // namespace

void check_plane_final(RecordedPlane& recorded, VerifyReport& report) {
  check_tiling(recorded, report);
  check_sides(recorded, report);
  check_vertices(recorded, report);
  check_area(recorded, report);
}

}  // namespace tetproof::oracles
