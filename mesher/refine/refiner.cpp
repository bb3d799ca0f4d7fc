// Insertion of points, and the updates of the parts that it causes.
#include "mesher/refine/refiner.h"

#include <algorithm>
#include <string>

#include "mesher/base/check.h"
#include "mesher/geometry/vector.h"

namespace delmesher::refine {

Refiner::Refiner(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                 Predicates& predicates, const RefineOptions& options, Control& control)
    : plc_(plc),
      topology_(topology),
      points_(points),
      predicates_(predicates),
      options_(options),
      control_(control),
      dt_(predicates),
      segment_facets_(plc),
      steiner_(plc, segment_facets_, topology, points, predicates, options),
      subsegments_(plc, dt_, options.gabriel),
      subfacets_(plc, points, dt_, subsegments_, options.gabriel),
      constraints_(dt_, subsegments_, subfacets_),
      sides_(plc, topology, points, dt_, subfacets_, options.removed),
      bad_(dt_, points, options.largest_ratio_first),
      goal_(options.delta, options.slivers, options.max_edge, options.sizes) {}

void Refiner::drain() {
  for (;;) {
    if (const std::uint32_t s = subsegments_.take_queued(); s != kNone) {
      control_.poll(points_.size());
      split_subsegment(s);
    } else if (const std::uint32_t f = subfacets_.take_queued(); f != kNone) {
      control_.poll(points_.size());
      split_subfacet(f);
    } else {
      return;
    }
    subfacets_.renumber_if_sparse();
  }
}

void Refiner::find_cavity(VertexId v, TetId start) {
  constraints_.begin();
  dt_.grow_cavity(v, start, [&](TetId t) {
    constraints_.collect(t);
    return true;
  });
}

// For a point that must not encroach: stops at the nearest constraint that it does encroach,
// because the whole cavity of a point far outside can be most of the mesh.
bool Refiner::find_free_cavity(VertexId v, TetId start, bool spare_subfacets) {
  constraints_.begin();
  return dt_.grow_cavity(v, start, [&](TetId t) {
    const CavityConstraints::Count before = constraints_.count();
    constraints_.collect(t);
    if (constraints_.queue_encroached_subsegments(v, before)) return false;
    return !spare_subfacets || !(constraints_.queue_lost_subfacets(t) ||
                                 constraints_.queue_encroached_subfacets(v, before));
  });
}

// Fills the cavity. The new tetrahedra inherit the notes of the old ones.
void Refiner::commit(VertexId v) {
  const Sides::State side = sides_.common_of_cavity();
  dt_.fill_cavity(v);
  subfacets_.begin_insertion();
  const auto created = dt_.created();
  const auto boundary = dt_.cavity_boundary();
  for (std::size_t n = 0; n < created.size(); ++n) {
    const auto [inner, face] = boundary[n];
    subsegments_.inherit(created[n], inner, face);
    subfacets_.inherit(created[n], inner, face);
    sides_.inherit(created[n], side);
  }
}

// When the subsegments and subfacets of the new point are there: finds the subfacets among the new
// tetrahedra, requeues the ones that were lost, has the new tetrahedra judged.
void Refiner::after_insertion() {
  subfacets_.settle_created();
  constraints_.requeue_lost();
  if (refining_) bad_.add_fresh(dt_.created());
}

// A tetrahedron that the last insertion created, all of which have its vertex, with the edge from
// there to v; or kNone.
TetId Refiner::created_with(VertexId v) const {
  for (const TetId t : dt_.created()) {
    if (dt_.index_of(t, v) >= 0) return t;
  }
  return kNone;
}

// Where a split point falls on a vertex, a size field wants lengths whose powers are no doubles.
void Refiner::check_room(VertexId duplicate, VertexId a, VertexId b) const {
  if (duplicate == kNone) return;
  constexpr double kShortest = 1e-50;  // the diagonal is about 1
  DELMESHER_CHECK(norm(points_.difference(a, b)) < kShortest, "a split point is a vertex");
  stop_at_precision(duplicate < topology_.vertex_half_edge.size()
                        ? "vertex " + std::to_string(duplicate)
                        : "an edge of 1e-50 of the diagonal");
}

void Refiner::split_subsegment(std::uint32_t s) {
  const VertexId a = subsegments_[s].a;
  const VertexId b = subsegments_[s].b;
  const VertexId v = steiner_.on_segment(subsegments_[s].segment, a, b);
  VertexId duplicate = kNone;
  const TetId start = dt_.locate(v, dt_.incident(a), &duplicate);
  check_room(duplicate, a, b);
  ++result_.on_segments;
  find_cavity(v, start);
  if (options_.gabriel) {
    constraints_.queue_encroached_subsegments(v, {}, s);
    constraints_.queue_encroached_subfacets(v, {});
  }
  commit(v);
  const SubfacetEdge sides[2] = {subsegments_[s].side[0], subsegments_[s].side[1]};
  const std::uint32_t half = subsegments_.split(s, v);
  for (const SubfacetEdge side : sides) {
    if (side.exists()) subfacets_.planar().insert_on_edge(v, side, s, half);
  }
  subsegments_.settle(s, created_with(a));
  subsegments_.settle(half, created_with(b));
  after_insertion();
}

void Refiner::split_subfacet(std::uint32_t s) {
  const std::uint32_t facet = subfacets_[s].facet;
  const VertexId v = steiner_.in_facet(facet, subfacets_[s].v);
  const auto [container, blocked] = subfacets_.planar().locate(v, s);
  if (container == kNone) {
    // Only possible while a subsegment of the facet is encroached or bent: it goes first.
    points_.pop_back();
    subsegments_.queue(blocked);
    subfacets_.queue(s);
    return;
  }
  VertexId duplicate = kNone;
  const TetId start = dt_.locate(v, dt_.incident(subfacets_[container].v[0]), &duplicate);
  check_room(duplicate, subfacets_[s].v[0], subfacets_[s].v[1]);
  if (!find_free_cavity(v, start, false)) {
    points_.pop_back();
    subfacets_.queue(s);
    return;
  }
  ++result_.on_facets;
  result_.on_facet[facet].push_back(v);
  if (options_.gabriel) constraints_.queue_encroached_subfacets(v, {});
  commit(v);
  subfacets_.planar().insert(v, container);
  after_insertion();
}

void Refiner::split_tetrahedron(TetId t) {
  const VolumeTargets targets = steiner_.in_tetrahedron(dt_.vertices(t), goal_);
  for (std::size_t n = 0; n < targets.count; ++n) {
    if (try_volume_point(t, steiner_.in_volume(targets.place[n], targets.grid))) return;
  }
  // No double is in the circumball: the solid is a few roundings thick there.
  const VertexId* v = dt_.vertices(t);
  const VertexId* corner =
      std::find_if(v, v + 4, [&](VertexId w) { return w < topology_.vertex_half_edge.size(); });
  stop_at_precision(corner != v + 4 ? "vertex " + std::to_string(*corner) : "a tetrahedron inside");
}

// Inserts the point, the last of the store, unless it encroaches; then the encroached elements are
// queued and t waits on. False if the point is not inside the circumball.
bool Refiner::try_volume_point(TetId t, VertexId v) {
  const VertexId* w = dt_.vertices(t);
  if (predicates_.insphere_perturbed(w[0], w[1], w[2], w[3], v) <= 0) {
    points_.pop_back();
    return false;
  }
  if (!find_free_cavity(v, t, true)) {
    points_.pop_back();
    return true;
  }
  result_.in_volume.push_back(v);
  if (options_.want_balls) result_.ball.push_back({w[0], w[1], w[2], w[3]});
  commit(v);
  after_insertion();
  return true;
}

// ------------------------------------------------------------------------------------ validation

void Refiner::validate() {
  const PredicateCounters counters = predicates_.counters;
  DELMESHER_CHECK(subsegments_.queue_empty() && subfacets_.queue_empty(),
                  "subsegments or subfacets wait to be split");
  dt_.validate(true);
  subsegments_.validate(control_);
  subfacets_.validate(control_);
  validate_links();
  sides_.validate();
  bad_.validate();
  if (refining_) validate_goal();
  predicates_.counters = counters;
}

void Refiner::validate_goal() const {
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t)) continue;
    const std::uint8_t level = badness(t);
    DELMESHER_CHECK(level == 0 || bad_.waits(t, level), "a bad tetrahedron does not wait");
  }
}

void Refiner::validate_links() const {
  for (std::uint32_t s = 0; s < subsegments_.size(); ++s) {
    int sides = 0;
    for (const SubfacetEdge side : subsegments_[s].side) {
      if (!side.exists()) continue;
      ++sides;
      DELMESHER_CHECK(side.subfacet() < subfacets_.size() && subfacets_[side.subfacet()].alive &&
                          subfacets_[side.subfacet()].subsegment[side.edge()] == s,
                      "a subsegment and the subfacet beside it disagree");
    }
    DELMESHER_CHECK(
        !subfacets_.planar().built() || sides == segment_facets_.count(subsegments_[s].segment),
        "a subsegment lacks a subfacet beside it");
  }
  for (std::uint32_t f = 0; f < subfacets_.size(); ++f) {
    if (!subfacets_[f].alive) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t s = subfacets_[f].subsegment[i];
      if (s == kNone) continue;
      const auto& side = subsegments_[s].side;
      const auto [x, y] = subfacets_.planar().ends({f, i});
      DELMESHER_CHECK(subsegments_.find(x, y) == s &&
                          (side[0] == SubfacetEdge(f, i) || side[1] == SubfacetEdge(f, i)),
                      "a subfacet and its subsegment disagree");
    }
  }
}

}  // namespace delmesher::refine
