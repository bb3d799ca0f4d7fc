// The invariants stated in refiner.h, checked on the whole state.
#include <algorithm>
#include <string>

#include "mesher/base/check.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

bool same_ends(VertexId a, VertexId b, VertexId x, VertexId y) {
  return (a == x && b == y) || (a == y && b == x);
}

}  // namespace

void Refiner::validate() {
  const PredicateCounters counters = predicates_.counters;
  dt_.validate(true);
  validate_queues();
  validate_chains();
  for (std::uint32_t s = 0; s < subsegments_.size(); ++s) {
    control_.poll(points_.size());
    if (subsegments_[s].alive && !subsegments_[s].queued) validate_subsegment(s);
  }
  for (std::uint32_t s = 0; s < subfacets_.size(); ++s) {
    control_.poll(points_.size());
    if (!subfacets_[s].alive) continue;
    validate_in_facet(s);
    if (!subfacets_[s].queued) validate_subfacet(s);
  }
  bad_.validate();
  predicates_.counters = counters;
}

// An element that is said to wait does so once, and no other does.
void Refiner::validate_queues() const {
  const auto check = [](const auto& elements, const std::deque<std::uint32_t>& queue) {
    std::size_t flagged = 0;
    for (const auto& element : elements) flagged += element.queued ? 1 : 0;
    DELMESHER_CHECK(flagged == queue.size(), "a queued element waits in no queue, or twice");
    for (const std::uint32_t s : queue) {
      DELMESHER_CHECK(s < elements.size() && elements[s].queued, "a waiting element is not queued");
    }
  };
  check(subsegments_, subsegment_queue_);
  check(subfacets_, subfacet_queue_);
}

// The subsegments of a segment follow each other from end to end, each is found by its ends, and
// those of a facet's sides are the sides of its subfacets.
void Refiner::validate_chains() const {
  std::size_t chained = 0;
  for (std::uint32_t n = 0; n < first_subsegment_.size(); ++n) {
    VertexId at = plc_.segments[n].vertex[0];
    for (std::uint32_t s = first_subsegment_[n]; s != kNone; s = subsegments_[s].next) {
      const Subsegment& sub = subsegments_[s];
      DELMESHER_CHECK(++chained <= subsegments_.size(), "a chain of subsegments does not end");
      DELMESHER_CHECK(sub.alive && sub.segment == n && sub.a == at, "a chain of subsegments broke");
      DELMESHER_CHECK(find_subsegment(sub.a, sub.b) == s, "a subsegment is not found by its ends");
      int sides = 0;
      for (const std::uint32_t side : sub.side) sides += side != kNone ? 1 : 0;
      DELMESHER_CHECK(!facets_built_ || sides == segment_facets_.count(n),
                      "a subsegment lacks a subfacet beside it");
      for (const std::uint32_t side : sub.side) {
        if (side == kNone) continue;
        DELMESHER_CHECK(side / 3 < subfacets_.size() && subfacets_[side / 3].alive &&
                            subfacets_[side / 3].subsegment[side % 3] == s,
                        "a subsegment and the subfacet beside it disagree");
      }
      at = sub.b;
    }
    DELMESHER_CHECK(at == plc_.segments[n].vertex[1], "a chain of subsegments ends too soon");
  }
  const auto alive = std::count_if(subsegments_.begin(), subsegments_.end(),
                                   [](const Subsegment& s) { return s.alive; });
  DELMESHER_CHECK(static_cast<std::size_t>(alive) == chained && edge_map_.size() == chained,
                  "a live subsegment is in no chain");
}

// In the tetrahedrization, on every tetrahedron around it, and with an empty ball if that is asked.
void Refiner::validate_subsegment(std::uint32_t s) {
  const Subsegment& sub = subsegments_[s];
  const TetId t = dt_.find_edge(sub.a, sub.b);
  DELMESHER_CHECK(t != kNone, "a subsegment is no edge");
  std::vector<TetId> ring;
  dt_.edge_ring(t, sub.a, sub.b, ring);
  for (const TetId u : ring) {
    for (int e = 0; e < 6; ++e) {
      const VertexId x = dt_.vertex(u, kEdge[e][0]), y = dt_.vertex(u, kEdge[e][1]);
      DELMESHER_CHECK(!same_ends(x, y, sub.a, sub.b) || (note(u, kEdges) >> e & 1) != 0,
                      "a tetrahedron does not know of its subsegment");
    }
    if (!options_.gabriel) continue;
    for (int i = 0; i < 4; ++i) {
      const VertexId v = dt_.vertex(u, i);
      if (v == sub.a || v == sub.b || v == kInfinite) continue;
      DELMESHER_CHECK(predicates_.dot_sign(sub.a, v, sub.b) >= 0, "a subsegment is encroached");
    }
  }
}

// In the tetrahedrization, known on both sides, and with an empty ball if that is asked.
void Refiner::validate_subfacet(std::uint32_t s) {
  const auto& c = subfacets_[s].v;
  const std::uint32_t face = dt_.find_face(c[0], c[1], c[2]);
  DELMESHER_CHECK(face != kNone, "a subfacet is no face");
  const int i = static_cast<int>(face & 3U);
  const TetId t[2] = {face >> 2, dt_.neighbor(face >> 2, i)};
  const int opposite[2] = {i, dt_.mirror(face >> 2, i)};
  for (int k = 0; k < 2; ++k) {
    DELMESHER_CHECK(subfacet_on(t[k], opposite[k]) == s,
                    "a tetrahedron does not know of its subfacet");
    const VertexId v = dt_.vertex(t[k], opposite[k]);
    if (!options_.gabriel || v == kInfinite) continue;
    DELMESHER_CHECK(predicates_.in_diametral_ball(c[0], c[1], c[2], v) <= 0,
                    "a subfacet is encroached");
  }
}

// Counter-clockwise, with a subfacet or a subsegment across each edge, and Delaunay in its plane.
void Refiner::validate_in_facet(std::uint32_t s) {
  const Subfacet& f = subfacets_[s];
  DELMESHER_CHECK(orient(f.facet, f.v[0], f.v[1], f.v[2]) > 0, "a subfacet is turned over");
  for (std::uint32_t i = 0; i < 3; ++i) {
    const VertexId x = f.v[(i + 1) % 3], y = f.v[(i + 2) % 3];
    DELMESHER_CHECK((f.neighbor[i] == kNone) != (f.subsegment[i] == kNone),
                    "an edge of a subfacet has no other side, or two");
    if (f.subsegment[i] != kNone) {
      const Subsegment& sub = subsegments_[f.subsegment[i]];
      DELMESHER_CHECK(sub.alive && same_ends(sub.a, sub.b, x, y) &&
                          (sub.side[0] == 3 * s + i || sub.side[1] == 3 * s + i),
                      "a subfacet and its subsegment disagree");
      continue;
    }
    const std::uint32_t n = f.neighbor[i] / 3, j = f.neighbor[i] % 3;
    DELMESHER_CHECK(n < subfacets_.size(), "a subfacet has no such neighbour");
    const Subfacet& g = subfacets_[n];
    DELMESHER_CHECK(g.alive && g.facet == f.facet && g.neighbor[j] == 3 * s + i &&
                        g.v[(j + 1) % 3] == y && g.v[(j + 2) % 3] == x,
                    "two subfacets disagree about their common edge");
    DELMESHER_CHECK(!in_circle(f, g.v[j]), "a facet is not Delaunay");
  }
}

}  // namespace delmesher
