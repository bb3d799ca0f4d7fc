#include "oracles/record/filter.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>
#include <unordered_map>

#include "oracles/base/distances.h"
#include "oracles/record/chamfer_features.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// The filter compares distances in doubles, so it decides ties within this share of the tolerance.
constexpr double kSlack = 1e-9;

// Which distances count: their squares, in integer units, below `bound`, but not negative, which
// stands for none. `reach` is its root in input units.
struct Range {
  double reach;
  mpq_class bound;
  bool contains(const mpq_class& squared) const { return squared >= 0 && squared < bound; }
};

struct Element {
  enum class Kind : std::uint8_t { vertex, edge, facet };
  Kind kind;
  Index id;
  auto operator<=>(const Element&) const = default;
};

// The constrained edges and facets of the input, some of them present.
class Features {
 public:
  // The arguments must outlive this.
  Features(const ExactPoints& points, const InputSurface& surface, const FacetIndex& facets,
           const AcuteCorners& corners)
      : points_(points),
        surface_(surface),
        corners_(corners),
        present_(surface.facets().size()),
        triangles_(surface.members()) {
    for (Index f = 0; f < present_.size(); ++f) present_[f] = facets.kept(f);
  }

  bool present(Index facet) const { return present_[facet]; }
  void set_present(Index facet, bool present) { present_[facet] = present; }
  bool edge_present(Index e) const {
    return present_[surface_.edges()[e].left] || present_[surface_.edges()[e].right];
  }
  bool vertex_present(Index v) const {
    const std::span<const Index> edges = corners_.edges_at(v);
    return std::any_of(edges.begin(), edges.end(), [&](Index e) { return edge_present(e); });
  }

  bool absent(const Element& element) const {
    const std::vector<Index> facets = facets_of(element);
    return std::none_of(facets.begin(), facets.end(), [&](Index f) { return present_[f]; });
  }
  std::vector<Index> facets_of(const Element& element) const;
  // The facet, its vertices on constrained edges, and its edges.
  std::vector<Element> elements_of(Index facet) const;

  // These name something present at such a distance; empty if nothing is.
  std::string near(const Element& element, const Range& range);
  std::string near_vertex(Index v, const Range& range);
  std::string near_edge(Index e, const Range& range);

  // The vertices of the facet on present edges; where asked for, the other ends of these as well.
  std::vector<Index> vertices_of(Index facet, bool and_beyond) const;

 private:
  bool touches(Index v, Index facet) const {
    const std::span<const Index> triangles = corners_.triangles_at(v);
    return std::any_of(triangles.begin(), triangles.end(),
                       [&](Index t) { return surface_.facet_of_triangle()[t] == facet; });
  }
  std::string edge_name(Index e) const {
    return "edge " + std::to_string(surface_.edges()[e].from) + "-" +
           std::to_string(surface_.edges()[e].to);
  }
  bool surely_longer(const InputSurface::Edge& edge, double than) const {
    const IntervalVector u = points_.rough_difference(edge.from, edge.to);
    const Interval bound = Interval(than) * Interval(than);
    return (exact::dot(u, u) - bound).sign() == 1;
  }
  std::string vertex_near_edge(Index e, const Range& range);
  std::string near_facet(Index facet, const Range& range);

  const ExactPoints& points_;
  const InputSurface& surface_;
  const AcuteCorners& corners_;
  std::vector<bool> present_;
  const InputSurface::Members triangles_;  // of facets
  std::vector<Index> found_;
};

std::string Features::near_vertex(Index v, const Range& range) {
  const BoxTree::Box box = enlarged(box_around(points_, std::array{v}), range.reach);
  found_.clear();
  corners_.edge_tree().query(box, found_);
  for (const Index e : found_) {
    if (!edge_present(e)) continue;
    const InputSurface::Edge& edge = surface_.edges()[e];
    // From an edge at the vertex itself, the distance is that of the other end.
    const bool at_vertex = edge.from == v || edge.to == v;
    if (at_vertex && surely_longer(edge, range.reach)) continue;
    const mpq_class distance =
        at_vertex ? exact::squared(exact::difference(points_, edge.from, edge.to)).rational()
                  : squared_distance_to_segment(points_, v, edge.from, edge.to);
    if (range.contains(distance)) return "vertex " + std::to_string(v) + " and " + edge_name(e);
  }
  found_.clear();
  surface_.triangles_near(box, found_);
  for (const Index t : found_) {
    const Index f = surface_.facet_of_triangle()[t];
    if (!present_[f] || touches(v, f)) continue;
    const mpq_class distance = squared_distance_to_face(points_, v, surface_.triangles()[t]);
    if (range.contains(distance)) {
      return "vertex " + std::to_string(v) + " and facet " +
             std::to_string(surface_.facets()[f].id);
    }
  }
  return {};
}

std::string Features::near_edge(Index e, const Range& range) {
  const Index a = surface_.edges()[e].from, b = surface_.edges()[e].to;
  found_.clear();
  corners_.edge_tree().query(enlarged(box_around(points_, std::array{a, b}), range.reach), found_);
  for (const Index other : found_) {
    const Index c = surface_.edges()[other].from, d = surface_.edges()[other].to;
    if (!edge_present(other) || a == c || a == d || b == c || b == d) continue;
    const mpq_class distance = squared_distance_inside(points_, a, b, c, d);
    if (range.contains(distance)) return edge_name(e) + " and " + edge_name(other);
  }
  return {};
}

// Names the end of a present edge that is too close to this edge.
std::string Features::vertex_near_edge(Index e, const Range& range) {
  const Index a = surface_.edges()[e].from, b = surface_.edges()[e].to;
  found_.clear();
  corners_.edge_tree().query(enlarged(box_around(points_, std::array{a, b}), range.reach), found_);
  for (const Index other : found_) {
    if (!edge_present(other)) continue;
    for (const Index v : {surface_.edges()[other].from, surface_.edges()[other].to}) {
      if (v == a || v == b || !range.contains(squared_distance_to_segment(points_, v, a, b)))
        continue;
      return "vertex " + std::to_string(v) + " and " + edge_name(e);
    }
  }
  return {};
}

// Names a vertex, on some present edge, that is too close above or below a triangle of the facet.
std::string Features::near_facet(Index facet, const Range& range) {
  for (const Index t : triangles_.of(facet)) {
    std::vector<Index> edges;
    corners_.edge_tree().query(enlarged(box_around(points_, surface_.triangles()[t]), range.reach),
                               edges);
    for (const Index e : edges) {
      if (!edge_present(e)) continue;
      for (const Index v : {surface_.edges()[e].from, surface_.edges()[e].to}) {
        if (touches(v, facet)) continue;
        const mpq_class distance = squared_distance_to_face(points_, v, surface_.triangles()[t]);
        if (range.contains(distance)) {
          return "vertex " + std::to_string(v) + " and facet " +
                 std::to_string(surface_.facets()[facet].id);
        }
      }
    }
  }
  return {};
}

std::string Features::near(const Element& element, const Range& range) {
  switch (element.kind) {
    case Element::Kind::vertex:
      return near_vertex(element.id, range);
    case Element::Kind::edge: {
      std::string pair = near_edge(element.id, range);
      return pair.empty() ? vertex_near_edge(element.id, range) : pair;
    }
    default:
      return near_facet(element.id, range);
  }
}

std::vector<Index> Features::facets_of(const Element& element) const {
  switch (element.kind) {
    case Element::Kind::vertex: {
      std::vector<Index> facets;
      for (const Index t : corners_.triangles_at(element.id)) {
        const Index f = surface_.facet_of_triangle()[t];
        if (std::find(facets.begin(), facets.end(), f) == facets.end()) facets.push_back(f);
      }
      return facets;
    }
    case Element::Kind::edge:
      return {surface_.edges()[element.id].left, surface_.edges()[element.id].right};
    default:
      return {element.id};
  }
}

std::vector<Element> Features::elements_of(Index facet) const {
  std::vector<Element> elements = {{Element::Kind::facet, facet}};
  for (const Index t : triangles_.of(facet)) {
    for (const Index v : surface_.triangles()[t]) {
      if (corners_.edges_at(v).empty()) continue;
      elements.push_back({Element::Kind::vertex, v});
      for (const Index e : corners_.edges_at(v)) {
        const InputSurface::Edge& edge = surface_.edges()[e];
        if (edge.from == v && (edge.left == facet || edge.right == facet)) {
          elements.push_back({Element::Kind::edge, e});
        }
      }
    }
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

std::vector<Index> Features::vertices_of(Index facet, bool and_beyond) const {
  std::vector<Index> vertices;
  for (const Index t : triangles_.of(facet)) {
    for (const Index v : surface_.triangles()[t]) {
      for (const Index e : corners_.edges_at(v)) {
        if (!edge_present(e)) continue;
        vertices.push_back(v);
        if (!and_beyond) break;
        vertices.push_back(surface_.edges()[e].from);
        vertices.push_back(surface_.edges()[e].to);
      }
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

class FilterCheck {
 public:
  explicit FilterCheck(const RefinedMesh& mesh)
      : record_(*mesh.record),
        surface_(*mesh.surface),
        facets_(surface_, record_),
        corners_(*mesh.points, surface_),
        features_(*mesh.points, surface_, facets_, corners_),
        exponent_(mesh.points->exponent()),
        thresholds_(thresholds_of(record_.parameters)),
        chamfers_(*mesh.points, surface_, corners_, thresholds_,
                  {.limit = mesh.promise->chamfer_radius,
                   .to_link = mesh.promise->link || mesh.promise->bridges,
                   .per_triangle = mesh.promise->bridges}),
        pairs_(mesh.promise->filter_pairs),
        both_sides_(mesh.promise->filter_chamfered) {}
  FilterCheck(const FilterCheck&) = delete;
  FilterCheck& operator=(const FilterCheck&) = delete;

  OracleReport run() {
    const double tolerance = record_.parameters.tolerance;
    const double low = tolerance * (1 - kSlack), high = tolerance * (1 + kSlack);
    const std::vector<Index> first = dropped_in(1), second = dropped_in(2);
    // What the second step drops was kept by the first.
    for (const Index f : second) features_.set_present(f, true);
    check_kept(below(low));
    for (const Index f : second) features_.set_present(f, false);
    count_returnable(first, below(high));
    check_second_step(second, tolerance);
    for (const Index f : second) features_.set_present(f, true);
    if (pairs_) {
      check_all_pairs(first, low, high);
    } else {
      check_first_step(first, below(high));
    }
    report_.figures.emplace_back("dropped facets", first.size() + second.size());
    report_.figures.emplace_back("dropped for what chamfering made of them", second.size());
    report_.figures.emplace_back("tolerance", tolerance);
    if (within_roundings_ > 0) {
      report_.figures.emplace_back("dropped for features within two roundings", within_roundings_);
    }
    return std::move(report_);
  }

 private:
  // The square of a length, in integer units.
  mpq_class bound(double length) const {
    return times_power_of_two(mpq_class(length) * mpq_class(length), -2 * exponent_);
  }
  Range below(double length) const { return {length, bound(length)}; }

  void check_kept(const Range& range) {
    const auto judge = [&](const std::string& pair) {
      ++report_.checked;
      if (!pair.empty())
        report_.fail(pair + " were kept by the first step and are closer than the tolerance");
    };
    for (const Index v : surface_.used_vertices()) {
      if (features_.vertex_present(v)) judge(features_.near_vertex(v, range));
    }
    for (Index e = 0; e < surface_.edges().size(); ++e) {
      if (features_.edge_present(e)) judge(features_.near_edge(e, range));
    }
  }

  std::vector<Index> dropped_in(int step) const {
    std::vector<Index> dropped;
    for (const ExactRecord::Facet& facet : record_.facets) {
      const Index f = facets_.find(facet.id);
      if (facet.filtered == step && f != kNone) dropped.push_back(f);
    }
    return dropped;
  }

  void count_returnable(const std::vector<Index>& dropped, const Range& range) {
    std::uint64_t could_return = 0;
    for (const Index f : dropped) {
      features_.set_present(f, true);
      const std::vector<Element> elements = features_.elements_of(f);
      could_return += std::none_of(elements.begin(), elements.end(), [&](const Element& e) {
        return !features_.near(e, range).empty();
      });
      features_.set_present(f, false);
    }
    report_.figures.emplace_back("dropped that could return", could_return);
  }

  // The first step of the paper: a facet is dropped exactly if an element of the whole surface is
  // too close to it.
  void check_all_pairs(const std::vector<Index>& dropped, double low, double high) {
    for (const Index f : dropped) features_.set_present(f, true);
    for (Index f = 0; f < surface_.facets().size(); ++f) {
      ++report_.checked;
      const bool gone = std::find(dropped.begin(), dropped.end(), f) != dropped.end();
      const Range range = below(gone ? high : low);
      std::string pair;
      for (const Element& e : features_.elements_of(f)) {
        if (pair.empty()) pair = features_.near(e, range);
      }
      if (gone && pair.empty()) report_.fail(name(f) + " was dropped and was near nothing");
      if (!gone && !pair.empty()) report_.fail(pair + " are too close, and one side was kept");
    }
  }

  // The mesher drops facets whose chamfers are smaller than a sixteenth of the tolerance, and those
  // at gaps narrower than the tolerance that fit 500 times along both edges. As the paper does it,
  // chamfers may be as small as the tolerance. Simplified bridges and the placement of points
  // change a distance by less than a factor of 2.
  bool is_too_small(const ChamferFeatures::Feature& feature, double tolerance) const {
    constexpr double kShare = 1.0 / 16, kLongGap = 500;
    if (feature.size < 2 * tolerance * (both_sides_ ? 1 : kShare)) return true;
    return feature.size < 2 * tolerance && feature.times >= kLongGap / 2;
  }

  // The mesher measures between rounded points, which may be two roundings nearer to each other
  // than the exact ones.
  bool is_within_roundings(const ChamferFeatures::Feature& feature) const {
    return feature.size < 0x1p-51 * surface_.largest_coordinate();
  }

  // The second step, read backwards: the facet dropped last was dropped from the present surface,
  // so chamfering has to make too small a feature of that facet, and so on. Where both sides of a
  // feature go, one of them may be all facets at a vertex, so that any feature near them will do.
  void check_second_step(std::vector<Index> dropped, double tolerance) {
    const AcuteCorners::Present present = [this](Index f) { return features_.present(f); };
    const auto put_back = [&](Index f) {
      features_.set_present(f, true);
      for (const Index v : features_.vertices_of(f, both_sides_)) {
        auto features = chamfers_.at(v, present);
        if (!both_sides_) std::erase_if(features, [&](const auto& x) { return !x.is_of(f); });
        const auto any = [&](auto is_small) { return std::ranges::any_of(features, is_small); };
        if (any([&](const auto& x) { return is_too_small(x, tolerance); })) return true;
        if (any([&](const auto& x) { return is_within_roundings(x); })) {
          ++within_roundings_;
          return true;
        }
      }
      features_.set_present(f, false);
      return false;
    };
    report_.checked += dropped.size();
    for (std::size_t before = dropped.size() + 1; dropped.size() < before;) {
      before = dropped.size();
      std::erase_if(dropped, put_back);
      // Both sides of a feature go at once, so that neither may be small without the other.
      if (both_sides_ && dropped.size() == before) put_back_together(dropped, put_back);
    }
    for (const Index f : dropped) {
      report_.fail(name(f) + " was dropped for its chamfers, and none of them is too small");
    }
  }

  // Puts back those of the facets that have a reason when all of them are there, and whose reasons
  // are not only those without.
  template <class PutBack>
  void put_back_together(std::vector<Index>& dropped, PutBack put_back) {
    for (const Index f : dropped) features_.set_present(f, true);
    std::vector<Index> without;
    for (const Index f : dropped) {
      if (!put_back(f)) without.push_back(f);
    }
    for (const Index f : without) features_.set_present(f, false);
    dropped = std::move(without);
  }

  // The first step, read backwards: the facet dropped last was close to a kept one, the facet
  // before it to one that was kept or dropped later, and so on.
  void check_first_step(const std::vector<Index>& dropped, const Range& range) {
    std::vector<Element> candidates;
    for (const Index f : dropped) {
      for (const Element& element : features_.elements_of(f)) {
        if (features_.absent(element)) candidates.push_back(element);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    for (std::size_t before = candidates.size() + 1; candidates.size() < before;) {
      before = candidates.size();
      std::erase_if(candidates, [&](const Element& element) { return put_back(element, range); });
    }
    for (const Index f : dropped) {
      ++report_.checked;
      if (!features_.present(f)) report_.fail(name(f) + " was dropped and was near nothing");
    }
  }

  // Is the element back, with all its facets? Puts it back if it makes a pair that is too close.
  bool put_back(const Element& element, const Range& range) {
    std::vector<Index> missing = features_.facets_of(element);
    std::erase_if(missing, [&](Index f) { return features_.present(f); });
    if (missing.empty()) return true;
    for (const Index f : missing) features_.set_present(f, true);
    if (!features_.near(element, range).empty()) return true;
    for (const Index f : missing) features_.set_present(f, false);
    return false;
  }

  std::string name(Index facet) const {
    return "facet " + std::to_string(surface_.facets()[facet].id);
  }

  const ExactRecord& record_;
  const InputSurface& surface_;
  const FacetIndex facets_;
  const AcuteCorners corners_;
  Features features_;
  long exponent_;
  const CornerThresholds thresholds_;
  ChamferFeatures chamfers_;
  bool pairs_, both_sides_;
  OracleReport report_{"filter", "vertices, edges and dropped facets"};
  double within_roundings_ = 0;  // facets
};

}  // namespace

OracleReport check_filter(const RefinedMesh& mesh) {
  return FilterCheck(mesh).run();
}

}  // namespace tetproof::oracles
