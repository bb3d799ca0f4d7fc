#include "mesher/chamfer/filter.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "mesher/base/parallel.h"
#include "mesher/chamfer/chamfer_surface.h"
#include "mesher/chamfer/closest.h"
#include "mesher/chamfer/facet_set.h"
#include "mesher/chamfer/filter_chamfered.h"
#include "mesher/geometry/box_tree.h"

namespace delmesher::chamfer {

namespace {

// Two elements without a common point that are too close.
struct ClosePair {
  double squared_distance;
  Element first, second;
};

// The filter's first step. Every vertex and constrained edge knows the closest element it does not
// touch, as far as that is closer than the tolerance; the closest pairs are resolved first, and
// only elements whose partner disappeared are queried again.
class InputFilter {
 public:
  InputFilter(const KeptSurface& surface, double tolerance, Control& control)
      : surface_(surface),
        topology_(surface.topology()),
        bound_(tolerance * tolerance),
        facets_(surface) {
    for_items(control, 2, 1, [this](Worker&, std::size_t n) {
      n == 0 ? build_edge_tree() : build_triangle_tree();
    });
  }

  FilterResult run(Control& control) {
    ask_all(Element::Kind::vertex, surface_.vertex_count(), control);
    ask_all(Element::Kind::edge, topology_.edge_count(), control);
    FilterResult result;
    while (!queue_.empty()) {
      control.poll();
      const ClosePair pair = queue_.top();
      queue_.pop();
      if (!facets_.alive(pair.first)) continue;
      if (facets_.alive(pair.second)) {
        result.dropped_triangles += resolve(pair);
        ++result.rounds;
      }
      if (const auto next = closest_to(pair.first)) queue_.push(*next);
    }
    result.facet_kept = result.kept_at_first = facets_.kept();
    return result;
  }

  FilterResult run_all_pairs(Control& control) {
    std::vector<std::uint8_t> responsible(facets_.kept().size());
    const auto mark = [&](Element::Kind kind, std::size_t count) {
      const auto ask = [&](Worker&, std::size_t n, std::vector<FacetId>& found) {
        for_each_close({kind, static_cast<std::uint32_t>(n)}, [&](const ClosePair& pair) {
          for (const Element& side : {pair.first, pair.second}) {
            const std::vector<FacetId> facets = facets_.facets(side);
            found.insert(found.end(), facets.begin(), facets.end());
          }
        });
      };
      for (const FacetId f : gather<FacetId>(control, count, kChunk, ask)) responsible[f] = 1;
    };
    mark(Element::Kind::vertex, surface_.vertex_count());
    mark(Element::Kind::edge, topology_.edge_count());
    FilterResult result;
    for (FacetId f = 0; f < responsible.size(); ++f) {
      if (responsible[f] == 0) continue;
      result.dropped_triangles += topology_.facet_triangles[f].size();
      result.rounds = 1;
    }
    result.facet_kept.resize(responsible.size());
    std::transform(responsible.begin(), responsible.end(), result.facet_kept.begin(),
                   [](std::uint8_t r) { return static_cast<std::uint8_t>(r == 0); });
    result.kept_at_first = result.facet_kept;
    return result;
  }

 private:
  static constexpr std::size_t kChunk = 256;

  struct Later {
    static auto key(const ClosePair& p) {
      return std::tuple(p.squared_distance, p.first.kind, p.first.id);
    }
    bool operator()(const ClosePair& a, const ClosePair& b) const { return key(a) > key(b); }
  };

  std::array<Vec3, 3> triangle(std::uint32_t t) const {
    const auto& corner = topology_.triangles[t];
    return {surface_.position(corner[0]), surface_.position(corner[1]),
            surface_.position(corner[2])};
  }
  Box vertex_box(VertexId v) const {
    const std::array<Vec3, 1> query = {surface_.position(v)};
    return Box::around(query);
  }
  Box edge_box(std::uint32_t e) const {
    const auto [v, w] = topology_.edge_vertices(e);
    const std::array<Vec3, 2> ends = {surface_.position(v), surface_.position(w)};
    return Box::around(ends);
  }

  void build_edge_tree() {
    std::vector<Box> boxes(topology_.edge_count());
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) boxes[e] = edge_box(e);
    edge_tree_ = ShrinkingBoxTree(boxes);
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (!facets_.alive({Element::Kind::edge, e})) edge_tree_.remove(e);
    }
  }

  void build_triangle_tree() {
    std::vector<Box> boxes(topology_.triangles.size());
    for (std::uint32_t t = 0; t < topology_.triangles.size(); ++t) {
      boxes[t] = Box::around(triangle(t));
    }
    triangle_tree_ = ShrinkingBoxTree(boxes);
    for (std::uint32_t t = 0; t < topology_.triangles.size(); ++t) {
      if (!facets_.kept()[topology_.facet_of[t]]) triangle_tree_.remove(t);
    }
  }

  // Queues every element of a kind together with the element closest to it.
  void ask_all(Element::Kind kind, std::size_t count, Control& control) {
    const auto ask = [&](Worker&, std::size_t n, std::vector<ClosePair>& found) {
      if (const auto pair = closest_to({kind, static_cast<std::uint32_t>(n)})) {
        found.push_back(*pair);
      }
    };
    for (const ClosePair& pair : gather<ClosePair>(control, count, kChunk, ask)) queue_.push(pair);
  }

  // The element and the one closest to it, if their distance is below the bound.
  std::optional<ClosePair> closest_to(const Element& element) const {
    if (!facets_.alive(element)) return {};
    ClosePair closest{bound_, element, {}};
    const auto keep_closer = [&closest](const ClosePair& pair) {
      if (pair.squared_distance < closest.squared_distance) closest = pair;
      return closest.squared_distance;
    };
    if (element.kind == Element::Kind::vertex) {
      const VertexId x = element.id;
      const Box query = vertex_box(x);
      edge_tree_.nearest(query, closest.squared_distance,
                         [&](std::uint32_t e) { return keep_closer(vertex_and_edge(x, e)); });
      const std::vector<FacetId> incident = facets_.facets_at(x);
      triangle_tree_.nearest(query, closest.squared_distance, [&](std::uint32_t t) {
        return keep_closer(vertex_and_triangle(x, t, incident));
      });
    } else {
      edge_tree_.nearest(edge_box(element.id), closest.squared_distance, [&](std::uint32_t e) {
        return keep_closer(edge_and_edge(element.id, e));
      });
    }
    if (closest.second.id == kNone) return {};
    return closest;
  }

  // Calls visit(pair) for the element and each other one that is closer to it than the bound.
  template <class Visit>
  void for_each_close(const Element& element, Visit visit) const {
    if (!facets_.alive(element)) return;
    const auto judge = [&](const ClosePair& pair) {
      if (pair.squared_distance < bound_) visit(pair);
    };
    if (element.kind == Element::Kind::edge) {
      edge_tree_.for_each_within(edge_box(element.id), bound_,
                                 [&](std::uint32_t e) { judge(edge_and_edge(element.id, e)); });
      return;
    }
    const VertexId x = element.id;
    const Box query = vertex_box(x);
    edge_tree_.for_each_within(query, bound_,
                               [&](std::uint32_t e) { judge(vertex_and_edge(x, e)); });
    const std::vector<FacetId> incident = facets_.facets_at(x);
    triangle_tree_.for_each_within(
        query, bound_, [&](std::uint32_t t) { judge(vertex_and_triangle(x, t, incident)); });
  }

  // Two elements with their distance, infinite if another pair has it.
  static ClosePair no_pair() { return {std::numeric_limits<double>::infinity(), {}, {}}; }

  ClosePair vertex_and_edge(VertexId x, std::uint32_t e) const {
    const auto [v, w] = topology_.edge_vertices(e);
    ClosestOnSegment there =
        closest_on_segment(surface_.position(x), surface_.position(v), surface_.position(w));
    // An edge at the vertex counts with its other end: it may be too short.
    if (v == x || w == x) {
      there.s = v == x ? 1 : 0;
      there.squared_distance = squared_norm(subtract(surface_.position(v), surface_.position(w)));
    }
    ClosePair pair{there.squared_distance, {Element::Kind::vertex, x}, {Element::Kind::edge, e}};
    if (there.s == 0) pair.second = {Element::Kind::vertex, v};
    if (there.s == 1) pair.second = {Element::Kind::vertex, w};
    return pair;
  }

  // Only where the closest point is inside a facet that the vertex is not on: else it is on an
  // edge.
  ClosePair vertex_and_triangle(VertexId x, std::uint32_t t,
                                const std::vector<FacetId>& incident) const {
    const FacetId f = topology_.facet_of[t];
    if (std::binary_search(incident.begin(), incident.end(), f)) return no_pair();
    const ClosestOnTriangle there = closest_on_triangle(surface_.position(x), triangle(t));
    if (!inside_facet(t, there.feature)) return no_pair();
    return {there.squared_distance, {Element::Kind::vertex, x}, {Element::Kind::facet, f}};
  }

  bool inside_facet(std::uint32_t t, int feature) const {
    if (feature == 6) return true;
    if (feature >= 3) return topology_.edge_is_flat[topology_.edge_of[3 * t + feature - 3]];
    return !facets_.alive({Element::Kind::vertex, topology_.triangles[t][feature]});
  }

  // Only where both closest points are inside the edges: else a vertex is involved.
  ClosePair edge_and_edge(std::uint32_t first, std::uint32_t second) const {
    const auto [a, b] = topology_.edge_vertices(first);
    const auto [c, d] = topology_.edge_vertices(second);
    if (a == c || a == d || b == c || b == d) return no_pair();
    const ClosestOfSegments there = closest_of_segments(surface_.position(a), surface_.position(b),
                                                        surface_.position(c), surface_.position(d));
    const bool inside = there.s > 0 && there.s < 1 && there.t > 0 && there.t < 1;
    if (!inside) return no_pair();
    return {there.squared_distance, {Element::Kind::edge, first}, {Element::Kind::edge, second}};
  }

  // Drops all facets of one of the two elements: the element whose facets cost less. Returns the
  // number of triangles lost.
  std::uint64_t resolve(const ClosePair& pair) {
    const std::vector<FacetId> first = facets_.facets(pair.first);
    const std::vector<FacetId> second = facets_.facets(pair.second);
    const bool drop_first = facets_.cost(first) < facets_.cost(second);
    std::uint64_t lost = 0;
    for (FacetId f : drop_first ? first : second) {
      lost += topology_.facet_triangles[f].size();
      for (std::uint32_t t : topology_.facet_triangles[f]) triangle_tree_.remove(t);
      facets_.drop(f, [this](std::uint32_t e) { edge_tree_.remove(e); });
    }
    return lost;
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  double bound_;
  FacetSet facets_;
  ShrinkingBoxTree edge_tree_, triangle_tree_;
  std::priority_queue<ClosePair, std::vector<ClosePair>, Later> queue_;
};

FilterResult nothing_dropped(const SurfaceTopology& topology) {
  const std::vector<std::uint8_t> all(topology.facet_triangles.size(), 1);
  return {all, all, 0, 0};
}

}  // namespace

FilterResult filter_input(const SurfaceTopology& topology, const PointStore& points,
                          double tolerance, Control& control) {
  if (!(tolerance > 0)) return nothing_dropped(topology);
  const KeptSurface surface(topology, points, {});
  return InputFilter(surface, tolerance * surface.scale(), control).run(control);
}

FilterResult filter_all_pairs(const SurfaceTopology& topology, const PointStore& points,
                              double tolerance, Control& control) {
  if (!(tolerance > 0)) return nothing_dropped(topology);
  const KeptSurface surface(topology, points, {});
  return InputFilter(surface, tolerance * surface.scale(), control).run_all_pairs(control);
}

namespace {

// Adds the neighbours of all marked vertices.
void mark_neighbours(const SurfaceTopology& topology, std::vector<std::uint8_t>& marked) {
  const std::vector<std::uint8_t> before = marked;
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    const auto [v, w] = topology.edge_vertices(e);
    if (before[v] || before[w]) marked[v] = marked[w] = 1;
  }
}

}  // namespace

FilteredSurface::FilteredSurface(const SurfaceTopology& topology, PointStore& points,
                                 Predicates& predicates, ChamferOptions options,
                                 const FilterOptions& filter, Control& control)
    : topology_(topology),
      points_(points),
      predicates_(predicates),
      control_(control),
      options_(std::move(options)),
      filter_(filter),
      first_point_(points.size()),
      changed_(topology.vertex_half_edge.size(), 1) {
  options_.isolated_clearance = std::max(options_.isolated_clearance, filter.tolerance);
}

void FilteredSurface::raise(double tolerance) {
  filter_.tolerance = tolerance;
  options_.isolated_clearance = std::max(options_.isolated_clearance, tolerance);
}

// Nothing was dropped, and no flat vertex may be too near to something.
bool FilteredSurface::is_as_chamfered() const {
  return result_.filter.dropped_triangles == 0 &&
         result_.filter.facet_kept == options_.facet_kept &&
         std::ranges::all_of(result_.chamfer.plc.facets,
                             [](const PlcFacet& facet) { return facet.isolated.empty(); });
}

void FilteredSurface::drop_close() {
  result_.filter = filter_.all_pairs
                       ? filter_all_pairs(topology_, points_, filter_.tolerance, control_)
                       : filter_input(topology_, points_, filter_.tolerance, control_);
  if (is_chamfered_ && is_as_chamfered()) return;
  options_.facet_kept = result_.filter.facet_kept;
  kept_.reset();
  forget_chamfer();
  changed_.assign(changed_.size(), 1);
  active_.clear();
}

const KeptSurface& FilteredSurface::kept() {
  if (!kept_) kept_.emplace(topology_, points_, options_.facet_kept);
  return *kept_;
}

const Acuteness& FilteredSurface::acute() {
  if (!acute_) {
    acute_ = find_acute(kept(), predicates_, Thresholds(options_), active_, control_);
  }
  return *acute_;
}

double FilteredSurface::crowded_corners() {
  double count = -3.0 * static_cast<double>(std::ranges::count(acute().vertex, 1));
  for (const Corner& corner : kept().corners()) count += acute().vertex[corner.vertex];
  return count;
}

void FilteredSurface::chamfer() {
  if (is_chamfered_) return;
  result_.chamfer =
      chamfer_surface(kept(), acute(), points_, predicates_, options_, active_, control_);
  is_chamfered_ = active_.empty();
  ++times_chamfered_;
}

bool FilteredSurface::drop_small() {
  if (!(filter_.tolerance > 0)) return false;
  FacetSet facets(kept());
  const double tolerance = filter_.tolerance * kept().scale();
  const TooSmall too_small{filter_.chamfered_fraction * tolerance, tolerance, kLongGap};
  const std::vector<FacetId> dropped = drop_for_chamfered_features(
      kept(), points_, result_.chamfer, too_small, changed_, filter_.both_sides, facets, control_);
  if (dropped.empty()) return false;
  mark_changed(dropped);
  FilterResult& filter = result_.filter;
  ++filter.rounds;
  for (const FacetId f : dropped) filter.dropped_triangles += topology_.facet_triangles[f].size();
  options_.facet_kept = filter.facet_kept = facets.kept();
  kept_.reset();
  forget_chamfer();
  return true;
}

void FilteredSurface::mark_changed(const std::vector<FacetId>& dropped) {
  changed_.assign(changed_.size(), 0);
  for (const FacetId f : dropped) {
    for (const std::uint32_t t : topology_.facet_triangles[f]) {
      for (const VertexId v : topology_.triangles[t]) changed_[v] = 1;
    }
  }
  // The height of a strip depends on both ends of its edge, a chamfer on its neighbours' strips.
  mark_neighbours(topology_, changed_);
  active_ = changed_;
  mark_neighbours(topology_, active_);
}

void FilteredSurface::forget_chamfer() {
  points_.truncate(first_point_);
  acute_.reset();
  is_chamfered_ = false;
}

const ChamferedSurface& FilteredSurface::finish() {
  if (!active_.empty()) {
    forget_chamfer();
    active_.clear();
    chamfer();
  }
  return result_;
}

ChamferedSurface FilteredSurface::result() {
  finish();
  return std::move(result_);
}

}  // namespace delmesher::chamfer
