// Segment recovery and splitting (section 5.2).
#include <algorithm>
#include <string>

#include "mesher/base/check.h"
#include "mesher/base/numbering.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

// Split points keep within this fraction of the subsegment of its midpoint. On input lines a point
// is exactly on the line wherever it is, so a coarse tolerance gives short parameters; a point of
// an artificial edge bends it, so it is placed finely: a point of the n-th generation adds at most
// (2/3)^n of the tolerance to what its neighbours are off the segment, all of them together at most
// 3 times the tolerance, which is below 2^-20 of the segment.
constexpr double kLineTolerance = 1.0 / 256;
constexpr double kBendTolerance = 1.0 / (1 << 22);

template <typename T>
std::vector<T> intersection(std::span<const T> a, std::span<const T> b) {
  std::vector<T> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common;
}

}  // namespace

void Refiner::collect_segment_facets() {
  segment_facets_.assign(plc_.segments.size(),
                         std::array<FacetUse, 2>{FacetUse{kNone, false}, FacetUse{kNone, false}});
  for (std::uint32_t f = 0; f < plc_.facets.size(); ++f) {
    for (const PlcFacet::Side& side : plc_.facets[f].boundary) {
      auto& uses = segment_facets_[side.segment];
      FacetUse& use = uses[0].facet == kNone ? uses[0] : uses[1];
      DELMESHER_CHECK(use.facet == kNone, "segment of three facets");
      use = {f, side.reversed};
    }
  }
}

std::uint32_t Refiner::new_subsegment(VertexId a, VertexId b, std::uint32_t segment) {
  if (subsegments_.size() >= kNone) stop_at_size(kNone, "subsegments");
  const auto s = static_cast<std::uint32_t>(subsegments_.size());
  subsegments_.push_back({a, b, segment, kNone, {kNone, kNone}});
  edge_map_.set(pair_key(a, b), s);
  return s;
}

std::uint32_t Refiner::find_subsegment(VertexId a, VertexId b) const {
  return edge_map_.get(pair_key(a, b), kNone);
}

void Refiner::recover_segments() {
  collect_segment_facets();
  find_shells();
  first_subsegment_.resize(plc_.segments.size());
  for (std::uint32_t n = 0; n < plc_.segments.size(); ++n) {
    first_subsegment_[n] =
        new_subsegment(plc_.segments[n].vertex[0], plc_.segments[n].vertex[1], n);
  }
  for (std::uint32_t s = 0; s < plc_.segments.size(); ++s) {
    check_subsegment(s, dt_.find_edge(subsegments_[s].a, subsegments_[s].b));
  }
  drain();
}

void Refiner::mark_edge(std::uint32_t s, TetId having_edge) {
  const VertexId a = subsegments_[s].a;
  const VertexId b = subsegments_[s].b;
  dt_.edge_ring(having_edge, a, b, ring_);
  for (const TetId t : ring_) {
    for (int e = 0; e < 6; ++e) {
      const VertexId x = dt_.vertex(t, kEdge[e][0]);
      const VertexId y = dt_.vertex(t, kEdge[e][1]);
      if ((x == a && y == b) || (x == b && y == a)) note(t, kEdges) |= std::uint8_t(1U << e);
    }
  }
}

// For an edge of a Delaunay tetrahedrization only the vertices around it (its link) can be in its
// diametral ball without one of them being there.
bool Refiner::subsegment_encroached(std::uint32_t s, TetId having_edge) {
  const VertexId a = subsegments_[s].a;
  const VertexId b = subsegments_[s].b;
  dt_.edge_ring(having_edge, a, b, ring_);
  for (const TetId t : ring_) {
    for (int i = 0; i < 4; ++i) {
      const VertexId v = dt_.vertex(t, i);
      if (v == a || v == b || v == kInfinite) continue;
      if (predicates_.dot_sign(a, v, b) < 0) return true;
    }
  }
  return false;
}

// Marks the subsegment in the tetrahedrization, where t has its edge; queues it if it is missing
// there (t is kNone) or encroached.
void Refiner::check_subsegment(std::uint32_t s, TetId t) {
  if (t == kNone) {
    queue_subsegment(s);
    return;
  }
  mark_edge(s, t);
  if (options_.gabriel && subsegment_encroached(s, t)) queue_subsegment(s);
}

// The shells around an apex have the radius of its shortest segment, halved again and again.
void Refiner::find_shells() {
  shell_.assign(options_.apex.size(), 0);
  for (const PlcSegment& segment : plc_.segments) {
    const Vec3 d = relative(segment.vertex[1], points_.nearest(segment.vertex[0]));
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (const VertexId v : segment.vertex) {
      if (v >= shell_.size() || options_.apex[v] == 0) continue;
      if (shell_[v] == 0 || length < shell_[v]) shell_[v] = length;
    }
  }
}

// How far from its end v a subsegment of that length crosses a shell in its middle third, as a
// fraction of the length; 0 if v is no apex.
double Refiner::shell_fraction(VertexId v, double length) const {
  if (v >= shell_.size() || shell_[v] == 0) return 0;
  const double ratio = shell_[v] / length;
  return std::ldexp(ratio, -1 - std::ilogb(ratio * 1.5));
}

// Where to split a subsegment of that length, as a fraction from its first end: in the middle, or
// where it crosses an apex's shell.
double Refiner::split_fraction(const Subsegment& s, double length) const {
  const double from_a = shell_fraction(s.a, length), from_b = shell_fraction(s.b, length);
  if (from_a == 0 && from_b == 0) return 0.5;
  const bool at_a =
      from_b == 0 || (from_a != 0 && std::abs(from_a - 0.5) <= std::abs(from_b - 0.5));
  return at_a ? from_a : 1 - from_b;
}

VertexId Refiner::place_on(const Subsegment& s) {
  const PlcSegment& segment = plc_.segments[s.segment];
  const Vec3 a = points_.nearest(s.a);
  const Vec3 d = points_.difference(s.a, s.b);
  const double length2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  guard(length2, a);
  const double length = std::sqrt(length2);
  const double fraction = split_fraction(s, length);
  const Vec3 offset = {d[0] * fraction, d[1] * fraction, d[2] * fraction};
  const std::uint32_t facet = segment_facets_[s.segment][0].facet;
  const bool box = segment.input_edge == kNone && plc_.facets[facet].input_facet == kNone;
  if (segment.input_edge == kNone && !box) {
    return place_in(facet, s.a, offset, length * kBendTolerance);
  }
  const auto [middle, rest] = beside(s.a, offset);
  const std::array<VertexId, 2> line =
      box ? segment.vertex : topology_.edge_vertices(segment.input_edge);
  for (double tolerance = length * kLineTolerance; tolerance > 0; tolerance /= 1 << 12) {
    const PointDefinition p =
        place_on_segment(points_, line[0], line[1], middle, tolerance, true, rest);
    const VertexId v = points_.add_on_segment(p.corner[0], p.corner[1], p.u);
    if (predicates_.dot_difference_sign(s.a, v, s.a, s.b) > 0 &&
        predicates_.dot_difference_sign(v, s.b, s.a, s.b) > 0) {
      points_.set_supports(v, intersection(points_.planes(s.a), points_.planes(s.b)),
                           intersection(points_.lines(s.a), points_.lines(s.b)));
      return v;
    }
    points_.pop_back();
    if (tolerance < length * 1e-12) break;
  }
  stop_at_precision("edge " + std::to_string(line[0]) + "-" + std::to_string(line[1]));
}

// A tetrahedron that the last insertion created, all of which have its vertex, with the edge from
// there to v; or kNone.
TetId Refiner::created_with(VertexId v) const {
  for (const TetId t : dt_.created()) {
    if (dt_.index_of(t, v) >= 0) return t;
  }
  return kNone;
}

void Refiner::split_subsegment(std::uint32_t s) {
  const VertexId a = subsegments_[s].a;
  const VertexId b = subsegments_[s].b;
  const VertexId v = place_on(subsegments_[s]);
  VertexId duplicate = kNone;
  const TetId start = dt_.locate(v, dt_.incident(a), &duplicate);
  DELMESHER_CHECK(duplicate == kNone, "split point of a subsegment coincides with a vertex");
  ++on_segments_;
  find_cavity(v, start);
  edge_map_.erase(pair_key(a, b));
  subsegments_[s].alive = false;
  if (options_.gabriel) {
    queue_encroached_subsegments(v);
    queue_encroached_subfacets(v);
  }
  commit(v);

  subsegments_[s].alive = true;
  subsegments_[s].b = v;
  edge_map_.set(pair_key(a, v), s);
  const std::uint32_t half = new_subsegment(v, b, subsegments_[s].segment);
  subsegments_[half].next = subsegments_[s].next;
  subsegments_[s].next = half;
  const std::uint32_t sides[2] = {subsegments_[s].side[0], subsegments_[s].side[1]};
  new_subfacets_.clear();
  for (int k = 0; k < 2; ++k) {
    if (sides[k] == kNone) continue;
    subsegments_[s].side[k] = kNone;
    insert_in_facet(v, sides[k] / 3, sides[k], s, half);
  }
  check_subsegment(s, created_with(a));
  check_subsegment(half, created_with(b));
  after_insertion();
}

}  // namespace delmesher
