#include "mesher/chamfer/filter_chamfered.h"

#include <algorithm>
#include <tuple>

#include "mesher/base/parallel.h"
#include "mesher/chamfer/closest.h"
#include "mesher/geometry/box_tree.h"

namespace delmesher::chamfer {

namespace {

// A point, segment or facet of the chamfered surface, as one side of a violation.
struct Culprit {
  std::vector<FacetId> facets;     // to be dropped to get rid of it
  std::vector<VertexId> made_for;  // input vertices whose chamfers shape it
};

struct Violation {
  double squared_distance;
  Culprit first, second;  // second empty for a short segment
};

class FeatureFinder {
 public:
  FeatureFinder(const KeptSurface& surface, const PointStore& points,
                const ChamferResult& chamfered, const TooSmall& too_small, const FacetSet& facets,
                const std::vector<std::uint8_t>& changed)
      : surface_(surface),
        topology_(surface.topology()),
        points_(points),
        chamfered_(chamfered),
        plc_(chamfered.plc),
        bound_(too_small.tolerance * too_small.tolerance),
        gap_bound_(std::max(bound_, too_small.gap_tolerance * too_small.gap_tolerance)),
        long_gap_(too_small.long_gap),
        facets_(facets),
        changed_(changed),
        facet_of_segment_(plc_.segments.size(), kNone),
        facet_of_point_(points.size(), kNone),
        is_vertex_(points.size(), 0) {
    for (const PlcFacet& facet : plc_.facets) {
      for (const PlcFacet::Side& side : facet.boundary) {
        const PlcSegment& segment = plc_.segments[side.segment];
        if (segment.input_edge != kNone) continue;
        facet_of_segment_[side.segment] = facet.input_facet;
        for (VertexId v : segment.vertex) facet_of_point_[v] = facet.input_facet;
      }
    }
    std::vector<Box> boxes;
    for (const PlcSegment& segment : plc_.segments) {
      for (VertexId v : segment.vertex) is_vertex_[v] = 1;
      boxes.push_back(Box::around(ends(segment)));
    }
    segment_tree_ = ShrinkingBoxTree(boxes);
    find_triangles();
  }

  std::vector<Violation> run(Control& control) {
    constexpr std::size_t kChunk = 256;
    using Violations = std::vector<Violation>;
    Violations found = gather<Violation>(control, plc_.segments.size(), kChunk,
                                         [this](Worker&, std::size_t n, Violations& list) {
                                           const auto s = static_cast<std::uint32_t>(n);
                                           if (is_changed(segment_vertices(s)))
                                             check_segment(s, list);
                                         });
    Violations of_points = gather<Violation>(control, is_vertex_.size(), kChunk,
                                             [this](Worker&, std::size_t n, Violations& list) {
                                               const auto v = static_cast<VertexId>(n);
                                               if (is_vertex_[v] && changed_[made_for(v)])
                                                 check_point(v, list);
                                             });
    std::move(of_points.begin(), of_points.end(), std::back_inserter(found));
    std::stable_sort(found.begin(), found.end(), [](const Violation& a, const Violation& b) {
      return a.squared_distance < b.squared_distance;
    });
    return found;
  }

 private:
  Vec3 position(VertexId v) const {
    return v < surface_.vertex_count() ? surface_.position(v) : surface_.place(points_, v);
  }
  std::array<Vec3, 2> ends(const PlcSegment& segment) const {
    return {position(segment.vertex[0]), position(segment.vertex[1])};
  }
  VertexId made_for(VertexId point) const {
    return point < chamfered_.first_new_point
               ? point
               : chamfered_.new_point_vertex[point - chamfered_.first_new_point];
  }
  std::vector<VertexId> segment_vertices(std::uint32_t s) const {
    const PlcSegment& segment = plc_.segments[s];
    return {made_for(segment.vertex[0]), made_for(segment.vertex[1])};
  }
  bool is_changed(const std::vector<VertexId>& vertices) const {
    return std::any_of(vertices.begin(), vertices.end(),
                       [this](VertexId v) { return changed_[v] != 0; });
  }

  Culprit segment_culprit(std::uint32_t s) const {
    const std::uint32_t e = plc_.segments[s].input_edge;
    return {e == kNone ? std::vector<FacetId>{facet_of_segment_[s]}
                       : facets_.facets({Element::Kind::edge, e}),
            segment_vertices(s)};
  }
  Culprit point_culprit(VertexId v) const {
    if (v < chamfered_.first_new_point) return {facets_.facets_at(v), {v}};
    if (!points_.lines(v).empty()) {
      return {facets_.facets({Element::Kind::edge, points_.lines(v)[0]}), {made_for(v)}};
    }
    return {{facet_of_point_[v]}, {made_for(v)}};
  }

  // Triangles of the facets that are in the Plc.
  void find_triangles() {
    std::vector<Box> boxes;
    for (std::uint32_t t = 0; t < topology_.triangles.size(); ++t) {
      if (chamfered_.plc_facet[topology_.facet_of[t]] == kNone) continue;
      std::array<Vec3, 3> corner;
      for (int k = 0; k < 3; ++k) corner[k] = surface_.position(topology_.triangles[t][k]);
      boxes.push_back(Box::around(corner));
      triangles_.push_back(t);
    }
    triangle_tree_ = ShrinkingBoxTree(boxes);
  }

  void check_segment(std::uint32_t s, std::vector<Violation>& found) const {
    const PlcSegment& segment = plc_.segments[s];
    const std::array<Vec3, 2> here = ends(segment);
    const double length = squared_norm(subtract(here[0], here[1]));
    if (length < bound_) found.push_back({length, segment_culprit(s), {}});
    segment_tree_.for_each_within(Box::around(here), gap_bound_, [&](std::uint32_t other) {
      const auto [a, b] = segment.vertex;
      const auto [c, d] = plc_.segments[other].vertex;
      if (a == c || a == d || b == c || b == d) return;
      // Pairs are found from both sides if both are changed.
      if (other < s && is_changed(segment_vertices(other))) return;
      const std::array<Vec3, 2> there = ends(plc_.segments[other]);
      const ClosestOfSegments closest = closest_of_segments(here[0], here[1], there[0], there[1]);
      if (!(closest.squared_distance < bound_) && !is_long_gap(here, there, closest)) return;
      found.push_back(
          {closest.squared_distance, side_culprit(s, closest.s), side_culprit(other, closest.t)});
    });
  }

  bool is_long_gap(const std::array<Vec3, 2>& here, const std::array<Vec3, 2>& there,
                   const ClosestOfSegments& at) const {
    const auto [a, b] = here;
    const auto [c, d] = there;
    return at.squared_distance < gap_bound_ &&
           length_of_gap(a, b, at.s, c, d, long_gap_) >= long_gap_ &&
           length_of_gap(c, d, at.t, a, b, long_gap_) >= long_gap_;
  }

  // An end of a segment, or the segment, whichever needs more to disappear.
  Culprit side_culprit(std::uint32_t s, double parameter) const {
    if (parameter == 0) return point_culprit(plc_.segments[s].vertex[0]);
    if (parameter == 1) return point_culprit(plc_.segments[s].vertex[1]);
    return segment_culprit(s);
  }

  void check_point(VertexId v, std::vector<Violation>& found) const {
    const Vec3 p = position(v);
    const std::array<Vec3, 1> query = {p};
    triangle_tree_.for_each_within(Box::around(query), bound_, [&](std::uint32_t item) {
      const std::uint32_t t = triangles_[item];
      const FacetId f = topology_.facet_of[t];
      const auto& corner = topology_.triangles[t];
      const ClosestOnTriangle closest =
          closest_on_triangle(p, {surface_.position(corner[0]), surface_.position(corner[1]),
                                  surface_.position(corner[2])});
      if (!(closest.squared_distance < bound_) || closest.feature < 6) return;
      Culprit culprit = point_culprit(v);
      if (std::binary_search(culprit.facets.begin(), culprit.facets.end(), f)) return;
      if (cut_off(f, p)) return;
      std::vector<VertexId> vertices = {made_for(v)};
      found.push_back({closest.squared_distance, std::move(culprit), {{f}, std::move(vertices)}});
    });
  }

  // Is the projection of p onto facet f outside the chamfered facet? Decided by the number of
  // crossings of a ray with the boundary; near the boundary either answer will do.
  bool cut_off(FacetId f, const Vec3& p) const {
    bool inside = false;
    const PlcFacet& facet = plc_.facets[chamfered_.plc_facet[f]];
    for (const PlcFacet::Side& side : facet.boundary) {
      const std::array<Vec3, 2> at = ends(plc_.segments[side.segment]);
      const Vec2 a = surface_.planar(f, subtract(at[0], p));
      const Vec2 b = surface_.planar(f, subtract(at[1], p));
      if ((a.y > 0) == (b.y > 0)) continue;
      if ((cross(a, b) > 0) == (b.y > a.y)) inside = !inside;
    }
    return !inside;
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const PointStore& points_;
  const ChamferResult& chamfered_;
  const Plc& plc_;
  double bound_, gap_bound_, long_gap_;  // the bounds are squares
  const FacetSet& facets_;
  const std::vector<std::uint8_t>& changed_;
  std::vector<FacetId> facet_of_segment_;  // of artificial segments
  std::vector<FacetId> facet_of_point_;    // of points inside facets
  std::vector<std::uint8_t> is_vertex_;
  ShrinkingBoxTree segment_tree_, triangle_tree_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace

std::vector<FacetId> drop_for_chamfered_features(
    const KeptSurface& surface, const PointStore& points, const ChamferResult& chamfered,
    const TooSmall& too_small, const std::vector<std::uint8_t>& changed, bool both_sides,
    FacetSet& facets, Control& control) {
  const SurfaceTopology& topology = surface.topology();
  const std::vector<Violation> found =
      FeatureFinder(surface, points, chamfered, too_small, facets, changed).run(control);
  std::vector<FacetId> dropped;
  std::vector<std::uint8_t> touched(surface.vertex_count());
  const auto is_touched = [&](const Culprit& culprit) {
    return std::any_of(culprit.made_for.begin(), culprit.made_for.end(),
                       [&](VertexId v) { return touched[v] != 0; });
  };
  const auto drop = [&](const Culprit& culprit) {
    for (const FacetId f : culprit.facets) {
      if (!facets.kept()[f]) continue;
      facets.drop(f, [](std::uint32_t) {});
      dropped.push_back(f);
      for (std::uint32_t t : topology.facet_triangles[f]) {
        for (VertexId v : topology.triangles[t]) touched[v] = 1;
      }
    }
  };
  for (const Violation& violation : found) {
    const Culprit &first = violation.first, &second = violation.second;
    if (both_sides) {
      drop(first);
      drop(second);
      continue;
    }
    if (is_touched(first) || is_touched(second)) continue;
    const bool drop_first =
        second.facets.empty() || facets.cost(first.facets) < facets.cost(second.facets);
    drop(drop_first ? first : second);
  }
  return dropped;
}

}  // namespace delmesher::chamfer
