// Segment recovery and splitting (section 5.2).
#include "mesher/base/check.h"
#include "mesher/base/numbering.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
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
  const VertexId v = steiner_.on_segment(subsegments_[s].segment, a, b);
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
