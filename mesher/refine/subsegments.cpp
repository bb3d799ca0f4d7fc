#include "mesher/refine/subsegments.h"

#include "mesher/base/check.h"
#include "mesher/base/numbering.h"

namespace delmesher::refine {
namespace {

bool same_ends(VertexId a, VertexId b, VertexId x, VertexId y) {
  return (a == x && b == y) || (a == y && b == x);
}

}  // namespace

Subsegments::Subsegments(const Plc& plc, Tetrahedrization& dt, bool gabriel)
    : plc_(plc), dt_(dt), gabriel_(gabriel) {
  for (std::uint32_t n = 0; n < plc.segments.size(); ++n) {
    add(plc.segments[n].vertex[0], plc.segments[n].vertex[1], n);
  }
}

std::uint32_t Subsegments::add(VertexId a, VertexId b, std::uint32_t segment) {
  if (list_.size() >= kNone) stop_at_size(kNone, "subsegments");
  const std::uint32_t s = size();
  list_.push_back({a, b, segment, kNone, {}});
  by_ends_.set(pair_key(a, b), s);
  return s;
}

std::vector<VertexId> Subsegments::chain(std::uint32_t segment) const {
  std::vector<VertexId> vertices = {plc_.segments[segment].vertex[0]};
  for (std::uint32_t s = segment; s != kNone; s = list_[s].next) vertices.push_back(list_[s].b);
  return vertices;
}

std::uint32_t Subsegments::split(std::uint32_t s, VertexId v) {
  const VertexId a = list_[s].a, b = list_[s].b;
  by_ends_.erase(pair_key(a, b));
  by_ends_.set(pair_key(a, v), s);
  const std::uint32_t half = add(v, b, list_[s].segment);
  list_[half].next = list_[s].next;
  list_[s].next = half;
  list_[s].b = v;
  return half;
}

void Subsegments::settle(std::uint32_t s, TetId t) {
  if (t == kNone) {
    queue(s);
    return;
  }
  mark(s, t);
  if (gabriel_ && encroached(s, t)) queue(s);
}

void Subsegments::mark(std::uint32_t s, TetId having_edge) {
  const VertexId a = list_[s].a, b = list_[s].b;
  dt_.edge_ring(having_edge, a, b, ring_);
  for (const TetId t : ring_) {
    for (int e = 0; e < 6; ++e) {
      const VertexId x = dt_.vertex(t, kEdge[e][0]), y = dt_.vertex(t, kEdge[e][1]);
      if (same_ends(x, y, a, b)) note(dt_, t, Note::edges) |= std::uint8_t(1U << e);
    }
  }
}

// If the diametral ball of an edge of a Delaunay tetrahedrization contains any vertex, it contains
// one of those of the tetrahedra around the edge. So it checks only these.
bool Subsegments::encroached(std::uint32_t s, TetId having_edge) {
  const VertexId a = list_[s].a, b = list_[s].b;
  dt_.edge_ring(having_edge, a, b, ring_);
  for (const TetId t : ring_) {
    for (int i = 0; i < 4; ++i) {
      const VertexId v = dt_.vertex(t, i);
      if (v == a || v == b || v == kInfinite) continue;
      if (encroached_by(s, v)) return true;
    }
  }
  return false;
}

void Subsegments::attach(std::uint32_t s, SubfacetEdge side) {
  auto& sides = list_[s].side;
  DELMESHER_CHECK(!sides[0].exists() || !sides[1].exists(), "a subsegment beside three subfacets");
  (sides[0].exists() ? sides[1] : sides[0]) = side;
}

void Subsegments::replace_side(std::uint32_t s, SubfacetEdge from, SubfacetEdge to) {
  for (SubfacetEdge& side : list_[s].side) {
    if (side == from) side = to;
  }
}

// ------------------------------------------------------------------------------------ validation

void Subsegments::validate(Control& control) {
  queue_.validate(size());
  validate_chains();
  for (std::uint32_t s = 0; s < size(); ++s) {
    control.poll();
    if (!queue_.waits(s)) validate_in_mesh(s);
  }
}

void Subsegments::validate_chains() const {
  std::size_t chained = 0;
  for (std::uint32_t n = 0; n < plc_.segments.size(); ++n) {
    VertexId at = plc_.segments[n].vertex[0];
    for (std::uint32_t s = n; s != kNone; s = list_[s].next) {
      DELMESHER_CHECK(s < list_.size(), "a chain of subsegments leads nowhere");
      const Subsegment& sub = list_[s];
      DELMESHER_CHECK(++chained <= list_.size(), "a chain of subsegments does not end");
      DELMESHER_CHECK(sub.segment == n && sub.a == at,
                      "a subsegment of a chain is of another segment, or begins elsewhere than the "
                      "last one ends");
      DELMESHER_CHECK(find(sub.a, sub.b) == s, "a subsegment is not found by its ends");
      at = sub.b;
    }
    DELMESHER_CHECK(at == plc_.segments[n].vertex[1], "a chain of subsegments ends too soon");
  }
  DELMESHER_CHECK(chained == list_.size(), "a subsegment is in no chain");
  DELMESHER_CHECK(by_ends_.size() == chained,
                  "ends are remembered that are those of no subsegment");
}

void Subsegments::validate_in_mesh(std::uint32_t s) {
  const Subsegment& sub = list_[s];
  const TetId t = dt_.find_edge(sub.a, sub.b);
  DELMESHER_CHECK(t != kNone, "a subsegment is not an edge");
  std::vector<TetId> ring;
  dt_.edge_ring(t, sub.a, sub.b, ring);
  for (const TetId u : ring) {
    for (int e = 0; e < 6; ++e) {
      const VertexId x = dt_.vertex(u, kEdge[e][0]), y = dt_.vertex(u, kEdge[e][1]);
      DELMESHER_CHECK(!same_ends(x, y, sub.a, sub.b) || (note(dt_, u, Note::edges) >> e & 1) != 0,
                      "a tetrahedron does not know of its subsegment");
    }
    if (!gabriel_) continue;
    for (int i = 0; i < 4; ++i) {
      const VertexId v = dt_.vertex(u, i);
      if (v == sub.a || v == sub.b || v == kInfinite) continue;
      DELMESHER_CHECK(!encroached_by(s, v), "a subsegment is encroached");
    }
  }
}

}  // namespace delmesher::refine
