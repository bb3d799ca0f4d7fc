#include "oracles/filter.h"

#include <algorithm>
#include <cmath>

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// The filter compares distances in doubles; ties within this share of the tolerance are its to
// decide.
constexpr double kSlack = 1e-9;

BoxTree::Box enlarged(BoxTree::Box box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] -= by;
    box.high[axis] += by;
  }
  return box;
}

// The constrained edges and facets of the input, some of them present.
class Features {
 public:
  Features(const ExactPoints& points, const InputSurface& surface, const FacetIndex& facets)
      : points_(points), surface_(surface), present_(surface.facets().size()) {
    for (Index f = 0; f < present_.size(); ++f) present_[f] = facets.kept(f);
    std::vector<BoxTree::Box> boxes;
    const Index vertices = surface.used_vertices().back() + 1;
    edges_at_.resize(vertices);
    facets_at_.resize(vertices);
    for (Index e = 0; e < surface.edges().size(); ++e) {
      const InputSurface::Edge& edge = surface.edges()[e];
      boxes.push_back(box_around(points, std::array{edge.from, edge.to}));
      edges_at_[edge.from].push_back(e);
      edges_at_[edge.to].push_back(e);
    }
    edge_tree_ = std::make_unique<BoxTree>(std::move(boxes));
    for (Index t = 0; t < surface.triangles().size(); ++t) {
      for (const Index v : surface.triangles()[t]) {
        facets_at_[v].push_back(surface.facet_of_triangle()[t]);
      }
    }
  }

  bool present(Index facet) const { return present_[facet]; }
  void set_present(Index facet, bool present) { present_[facet] = present; }
  bool edge_present(Index e) const {
    return present_[surface_.edges()[e].left] || present_[surface_.edges()[e].right];
  }
  bool vertex_present(Index v) const {
    return std::any_of(edges_at_[v].begin(), edges_at_[v].end(),
                       [&](Index e) { return edge_present(e); });
  }

  // These name something present that is closer, in square, than the bound; empty if nothing is.
  std::string near_vertex(Index v, double reach, const mpq_class& bound);
  std::string near_edge(Index e, double reach, const mpq_class& bound);
  std::string near_facet(Index facet, double reach, const mpq_class& bound);
  std::string near_any_of(Index facet, double reach, const mpq_class& bound);

 private:
  bool touches(Index v, Index facet) const {
    return std::find(facets_at_[v].begin(), facets_at_[v].end(), facet) != facets_at_[v].end();
  }
  std::string edge_name(Index e) const {
    return "edge " + std::to_string(surface_.edges()[e].from) + "-" +
           std::to_string(surface_.edges()[e].to);
  }
  std::vector<Index> vertices_of(Index facet) const;

  const ExactPoints& points_;
  const InputSurface& surface_;
  std::vector<bool> present_;
  std::vector<std::vector<Index>> edges_at_, facets_at_;
  std::unique_ptr<BoxTree> edge_tree_;
  std::vector<Index> found_;
  mutable std::vector<std::vector<Index>> triangles_of_;
};

std::string Features::near_vertex(Index v, double reach, const mpq_class& bound) {
  const BoxTree::Box box = enlarged(box_around(points_, std::array{v}), reach);
  found_.clear();
  edge_tree_->query(box, found_);
  for (const Index e : found_) {
    if (!edge_present(e)) continue;
    const InputSurface::Edge& edge = surface_.edges()[e];
    // Of an edge at the vertex, the other end.
    const mpq_class distance =
        edge.from == v || edge.to == v
            ? mpq_class(exact::squared(exact::difference(points_, edge.from, edge.to)))
            : squared_distance_to_segment(points_, v, edge.from, edge.to);
    if (distance < bound) return "vertex " + std::to_string(v) + " and " + edge_name(e);
  }
  found_.clear();
  surface_.triangles_near(box, found_);
  for (const Index t : found_) {
    const Index f = surface_.facet_of_triangle()[t];
    if (!present_[f] || touches(v, f)) continue;
    const mpq_class distance = squared_distance_to_face(points_, v, surface_.triangles()[t]);
    if (distance >= 0 && distance < bound) {
      return "vertex " + std::to_string(v) + " and facet " +
             std::to_string(surface_.facets()[f].id);
    }
  }
  return {};
}

std::string Features::near_edge(Index e, double reach, const mpq_class& bound) {
  const Index a = surface_.edges()[e].from, b = surface_.edges()[e].to;
  found_.clear();
  edge_tree_->query(enlarged(box_around(points_, std::array{a, b}), reach), found_);
  for (const Index other : found_) {
    const Index c = surface_.edges()[other].from, d = surface_.edges()[other].to;
    if (!edge_present(other) || a == c || a == d || b == c || b == d) continue;
    const mpq_class distance = squared_distance_inside(points_, a, b, c, d);
    if (distance >= 0 && distance < bound) return edge_name(e) + " and " + edge_name(other);
  }
  return {};
}

std::vector<Index> Features::vertices_of(Index facet) const {
  if (triangles_of_.empty()) {
    triangles_of_.resize(surface_.facets().size());
    for (Index t = 0; t < surface_.triangles().size(); ++t) {
      triangles_of_[surface_.facet_of_triangle()[t]].push_back(t);
    }
  }
  std::vector<Index> vertices;
  for (const Index t : triangles_of_[facet]) {
    vertices.insert(vertices.end(), surface_.triangles()[t].begin(), surface_.triangles()[t].end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// A vertex, on some edge that is present, above or below a triangle of the facet.
std::string Features::near_facet(Index facet, double reach, const mpq_class& bound) {
  vertices_of(facet);
  for (const Index t : triangles_of_[facet]) {
    std::vector<Index> edges;
    edge_tree_->query(enlarged(box_around(points_, surface_.triangles()[t]), reach), edges);
    for (const Index e : edges) {
      if (!edge_present(e)) continue;
      for (const Index v : {surface_.edges()[e].from, surface_.edges()[e].to}) {
        if (touches(v, facet)) continue;
        const mpq_class distance = squared_distance_to_face(points_, v, surface_.triangles()[t]);
        if (distance >= 0 && distance < bound) {
          return "vertex " + std::to_string(v) + " and facet " +
                 std::to_string(surface_.facets()[facet].id);
        }
      }
    }
  }
  return {};
}

std::string Features::near_any_of(Index facet, double reach, const mpq_class& bound) {
  for (const Index v : vertices_of(facet)) {
    if (std::string pair = near_vertex(v, reach, bound); !pair.empty()) return pair;
    for (const Index e : edges_at_[v]) {
      const InputSurface::Edge& edge = surface_.edges()[e];
      if (edge.left != facet && edge.right != facet) continue;
      if (std::string pair = near_edge(e, reach, bound); !pair.empty()) return pair;
    }
  }
  return near_facet(facet, reach, bound);
}

class FilterCheck {
 public:
  explicit FilterCheck(const RefinedMesh& mesh)
      : record_(*mesh.record),
        surface_(*mesh.surface),
        facets_(surface_, record_),
        features_(*mesh.points, surface_, facets_),
        exponent_(mesh.points->exponent()) {}

  OracleReport run() {
    const double tolerance = record_.parameters.tolerance;
    const double low = tolerance * (1 - kSlack), high = tolerance * (1 + kSlack);
    check_kept(low, bound(low));
    check_dropped(high, bound(high));
    report_.figures.emplace_back("tolerance", tolerance);
    return std::move(report_);
  }

 private:
  // The square of a length, in integer units.
  mpq_class bound(double length) const {
    mpq_class square = mpq_class(length) * mpq_class(length);
    const long shift = 2 * exponent_;
    if (shift >= 0) {
      mpq_div_2exp(square.get_mpq_t(), square.get_mpq_t(), static_cast<unsigned long>(shift));
    } else {
      mpq_mul_2exp(square.get_mpq_t(), square.get_mpq_t(), static_cast<unsigned long>(-shift));
    }
    return square;
  }

  void check_kept(double reach, const mpq_class& squared) {
    const auto judge = [&](const std::string& pair) {
      ++report_.checked;
      if (!pair.empty()) report_.fail(pair + " were kept and are closer than the tolerance");
    };
    for (const Index v : surface_.used_vertices()) {
      if (features_.vertex_present(v)) judge(features_.near_vertex(v, reach, squared));
    }
    for (Index e = 0; e < surface_.edges().size(); ++e) {
      if (features_.edge_present(e)) judge(features_.near_edge(e, reach, squared));
    }
  }

  void check_dropped(double reach, const mpq_class& squared) {
    std::vector<Index> dropped;
    for (Index f = 0; f < surface_.facets().size(); ++f) {
      if (!facets_.kept(f)) dropped.push_back(f);
    }
    std::uint64_t could_return = 0, by_chamfering = 0;
    for (const Index f : dropped) {
      features_.set_present(f, true);
      could_return += features_.near_any_of(f, reach, squared).empty();
      features_.set_present(f, false);
    }
    for (const Index f : dropped) features_.set_present(f, true);
    for (const Index f : dropped) {
      ++report_.checked;
      by_chamfering += features_.near_any_of(f, reach, squared).empty();
    }
    if (by_chamfering > 0 && record_.corners.empty()) {
      report_.fail("facets were dropped that are near nothing, and nothing was chamfered");
    }
    report_.figures.emplace_back("dropped facets", dropped.size());
    report_.figures.emplace_back("dropped for what chamfering made of them", by_chamfering);
    report_.figures.emplace_back("dropped that could return", could_return);
  }

  const ExactRecord& record_;
  const InputSurface& surface_;
  const FacetIndex facets_;
  Features features_;
  long exponent_;
  OracleReport report_{"filter", "vertices, edges and dropped facets"};
};

}  // namespace

mpq_class squared_distance_to_segment(const ExactPoints& points, Index v, Index a, Index b) {
  const IntegerVector d = exact::difference(points, a, b), w = exact::difference(points, a, v);
  if (exact::dot(d, w) <= 0) return exact::squared(w);
  const IntegerVector u = exact::difference(points, b, v);
  if (exact::dot(d, u) >= 0) return exact::squared(u);
  mpq_class result(exact::squared(exact::cross(d, w)), exact::squared(d));
  result.canonicalize();
  return result;
}

mpq_class squared_distance_inside(const ExactPoints& points, Index a, Index b, Index c, Index d) {
  const IntegerVector u = exact::difference(points, a, b), v = exact::difference(points, c, d),
                      w = exact::difference(points, a, c), n = exact::cross(u, v);
  const mpz_class nn = exact::squared(n);
  if (nn == 0) return -1;
  // a + s u and c + t v are closest at s = det(w, v, n) / |n|^2, t = det(w, u, n) / |n|^2.
  const mpz_class s = exact::dot(exact::cross(w, v), n), t = exact::dot(exact::cross(w, u), n);
  if (s <= 0 || s >= nn || t <= 0 || t >= nn) return -1;
  const mpz_class height = exact::dot(w, n);
  mpq_class result(mpz_class(height * height), nn);
  result.canonicalize();
  return result;
}

mpq_class squared_distance_to_face(const ExactPoints& points, Index v,
                                   const std::array<Index, 3>& triangle) {
  const IntegerVector n = exact::area2(points, triangle[0], triangle[1], triangle[2]);
  if (exact::is_zero(n)) return -1;
  for (int i = 0; i < 3; ++i) {
    const Index p = triangle[i], q = triangle[(i + 1) % 3];
    if (exact::dot(n, exact::area2(points, p, q, v)) < 0) return -1;
  }
  const mpz_class height = exact::dot(n, exact::difference(points, triangle[0], v));
  mpq_class result(mpz_class(height * height), exact::squared(n));
  result.canonicalize();
  return result;
}

OracleReport check_filter(const RefinedMesh& mesh) {
  return FilterCheck(mesh).run();
}

}  // namespace tetproof::oracles
