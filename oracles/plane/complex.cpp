#include "oracles/plane/complex.h"

#include <algorithm>

namespace tetproof::oracles {

namespace {
using Index = PlaneComplex::Index;
using Point = PlaneComplex::Point;

struct Rectangle {
  mpq_class low_x, low_y, high_x, high_y;

  explicit Rectangle(const PlaneComplex& mesh) {
    bool first = true;
    for (const auto& triangle : mesh.triangles()) {
      for (const Index v : triangle.vertices) {
        const Point& p = mesh.point(v);
        if (first || p.x < low_x) low_x = p.x;
        if (first || p.y < low_y) low_y = p.y;
        if (first || p.x > high_x) high_x = p.x;
        if (first || p.y > high_y) high_y = p.y;
        first = false;
      }
    }
  }
  mpq_class doubled_area() const { return 2 * (high_x - low_x) * (high_y - low_y); }
  bool contains(const Point& p) const {
    return p.x >= low_x && p.x <= high_x && p.y >= low_y && p.y <= high_y;
  }
  bool on_border(const Point& p, const Point& q) const {
    return (p.x == q.x && (p.x == low_x || p.x == high_x)) ||
           (p.y == q.y && (p.y == low_y || p.y == high_y));
  }
};

class ComplexCheck {
 public:
  ComplexCheck(const PlaneComplex& mesh, const PlaneGraph& input, const std::string& prefix)
      : mesh_(mesh),
        input_(input),
        rectangle_(mesh),
        complex_(prefix + "complex", "triangles"),
        orientation_(prefix + "orientation", "triangles") {}

  bool run(VerifyReport& report) {
    check_triangles();
    check_rectangle();
    check_border();
    check_listed();
    const bool hopeless = is_hopeless(complex_);
    report.oracles.push_back(std::move(complex_));
    report.oracles.push_back(std::move(orientation_));
    return !hopeless;
  }

 private:
  bool on_border(const PlaneEdge& edge) const {
    return rectangle_.on_border(mesh_.point(edge.first), mesh_.point(edge.second));
  }

  void check_triangles() {
    for (Index t = 0; t < mesh_.triangles().size(); ++t) {
      ++complex_.checked;
      ++orientation_.checked;
      const auto& [a, b, c] = mesh_.triangles()[t].vertices;
      if (mesh_.exact().orient(a, b, c) <= 0) {
        orientation_.fail(triangle_name(t) + " is not positive");
      }
      for (const auto& edge : {PlaneEdge(a, b), PlaneEdge(b, c), PlaneEdge(c, a)}) {
        if (mesh_.left_of().at(edge) != t) {
          complex_.fail(triangle_name(t) + " shares a directed edge");
        }
      }
    }
  }

  void check_rectangle() {
    mpq_class area = 0;
    for (const auto& triangle : mesh_.triangles()) area += mesh_.doubled_area(triangle);
    if (area != rectangle_.doubled_area()) {
      complex_.fail("the triangles do not have the area of their rectangle");
    }
    for (Index v = 0; v < input_.given().vertices.size(); ++v) {
      if (mesh_.triangles().empty() || !rectangle_.contains(mesh_.point(v))) {
        complex_.fail("input vertex " + std::to_string(v) + " is outside the rectangle");
      }
    }
  }

  void check_border() {
    for (const auto& [edge, t] : mesh_.left_of()) {
      if (mesh_.right_of(edge) != PlaneComplex::kNone) continue;
      if (!on_border(edge)) complex_.fail(triangle_name(t) + " has a border inside the rectangle");
      // Else nothing would ask whether a vertex encroaches upon it.
      if (!mesh_.segment_of().contains(undirected(edge.first, edge.second))) {
        complex_.fail(triangle_name(t) + " has an edge on the border that is not listed");
      }
    }
  }

  void check_listed() {
    if (mesh_.segment_of().size() != mesh_.listed().size()) {
      complex_.fail("an edge is listed twice");
    }
    for (const auto& [edge, segment] : mesh_.segment_of()) {
      ++complex_.checked;
      if (!mesh_.has(edge)) complex_.fail("a listed edge is not in the mesh");
      const bool known =
          segment == kOuterRectangle ? on_border(edge) : segment < input_.given().segments.size();
      if (!known) complex_.fail("a listed edge is neither on a segment nor on the outer rectangle");
    }
  }

  const PlaneComplex& mesh_;
  const PlaneGraph& input_;
  const Rectangle rectangle_;
  OracleReport complex_, orientation_;
};

void check_delaunay(const PlaneComplex& mesh, const std::string& prefix, VerifyReport& report) {
  if (mesh.left_of().empty()) return;
  OracleReport oracle(prefix + "delaunay", "edges");
  for (const auto& [edge, t] : mesh.left_of()) {
    if (edge.first > edge.second || mesh.segment_of().contains(edge)) continue;
    const Index other = mesh.right_of(edge);
    if (other == PlaneComplex::kNone) continue;
    ++oracle.checked;
    const auto& [a, b, c] = mesh.triangles()[t].vertices;
    for (const Index d : mesh.triangles()[other].vertices) {
      if (d == edge.first || d == edge.second) continue;
      if (mesh.exact().in_circle(a, b, c, d) > 0) oracle.fail(triangle_name(t));
    }
  }
  if (oracle.checked == 0) {  // two triangles beside a segment
    oracle.checked = 1;
    oracle.notes.emplace_back("every edge is on a segment");
  }
  report.oracles.push_back(std::move(oracle));
}

}  // namespace

PlaneEdge undirected(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

std::string triangle_name(std::size_t t) {
  return "triangle " + std::to_string(t);
}

PlaneComplex::PlaneComplex(const std::vector<Triangle>& triangles,
                           const std::vector<ListedEdge>& edges, PlanePoints& points)
    : triangles_(triangles), listed_(edges), exact_(points) {
  std::vector<PlaneBoxes::Box> boxes;
  for (Index t = 0; t < triangles.size(); ++t) {
    const auto& v = triangles[t].vertices;
    boxes.push_back(box(triangles[t]));
    for (std::size_t i = 0; i < 3; ++i) {
      left_of_.emplace(PlaneEdge(v[i], v[(i + 1) % 3]), t);
      at_[v[i]].push_back(t);
    }
  }
  for (const auto& edge : edges) {
    segment_of_.emplace(undirected(edge.vertices[0], edge.vertices[1]), edge.segment);
  }
  boxes_ = PlaneBoxes(boxes);
}

bool PlaneComplex::has(const PlaneEdge& edge) const {
  return left_of_.contains(edge) || right_of(edge) != kNone;
}

Index PlaneComplex::right_of(const PlaneEdge& edge) const {
  const auto found = left_of_.find({edge.second, edge.first});
  return found == left_of_.end() ? kNone : found->second;
}

const std::vector<Index>& PlaneComplex::at(Index v) const {
  static const std::vector<Index> kNoTriangles;
  const auto found = at_.find(v);
  return found == at_.end() ? kNoTriangles : found->second;
}

Point PlaneComplex::centroid(const Triangle& triangle) const {
  const auto& [a, b, c] = triangle.vertices;
  Point middle;
  middle.x = (point(a).x + point(b).x + point(c).x) / 3;
  middle.y = (point(a).y + point(b).y + point(c).y) / 3;
  middle.dx = middle.x.get_d();
  middle.dy = middle.y.get_d();
  return middle;
}

mpq_class PlaneComplex::doubled_area(const Triangle& triangle) const {
  const Point &p = point(triangle.vertices[0]), &q = point(triangle.vertices[1]),
              &r = point(triangle.vertices[2]);
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

PlaneBoxes::Box PlaneComplex::box(const Triangle& triangle) const {
  const auto& [a, b, c] = triangle.vertices;
  return plane_box({&point(a), &point(b), &point(c)}, 0);
}

Index PlaneComplex::triangle_with(const Point& p) {
  Index found = kNone;
  boxes_.visit(plane_box({&p}, 0), [&](Index t) {
    const auto& [a, b, c] = triangles_[t].vertices;
    if (found == kNone && exact_.orient(point(a), point(b), p) >= 0 &&
        exact_.orient(point(b), point(c), p) >= 0 && exact_.orient(point(c), point(a), p) >= 0) {
      found = t;
    }
  });
  return found;
}

std::vector<std::vector<SegmentPart>> parts_of(const PlaneComplex& mesh, const PlaneGraph& input,
                                               OracleReport& oracle) {
  const auto& segments = input.given().segments;
  std::vector<std::vector<SegmentPart>> parts(segments.size());
  for (const auto& [edge, segment] : mesh.segment_of()) {
    if (segment >= parts.size()) continue;
    ++oracle.checked;
    const auto [a, b] = segments[segment];
    const auto [u, v] = edge;
    if (mesh.exact().orient(a, b, u) != 0 || mesh.exact().orient(a, b, v) != 0) {
      oracle.fail("an edge is not on segment " + std::to_string(segment));
      continue;
    }
    mpq_class s = mesh.exact().parameter(u, a, b), t = mesh.exact().parameter(v, a, b);
    if (t < s) std::swap(s, t);
    parts[segment].push_back({s, t});
  }
  for (auto& of : parts) std::sort(of.begin(), of.end());
  return parts;
}

bool check_plane_complex(const PlaneComplex& mesh, const PlaneGraph& input,
                         const std::string& prefix, VerifyReport& report) {
  if (!ComplexCheck(mesh, input, prefix).run(report)) return false;
  check_delaunay(mesh, prefix, report);
  return true;
}

}  // namespace tetproof::oracles
