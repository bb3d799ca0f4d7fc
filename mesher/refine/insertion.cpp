// Insertion into the tetrahedrization with its subsegments and subfacets.
#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/epoch.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

// Edges (bits of kEdge) that do not use vertex i.
constexpr std::uint8_t kEdgesWithout[4] = {0b111000, 0b100110, 0b010101, 0b001011};

}  // namespace

Refiner::Refiner(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                 Predicates& predicates, const RefineOptions& options, Control& control)
    : plc_(plc),
      topology_(topology),
      points_(points),
      predicates_(predicates),
      options_(options),
      control_(control),
      dt_(predicates),
      solid_(topology, predicates, options.removed),
      removed_(options.removed),
      segment_facets_(plc),
      steiner_(plc, segment_facets_, topology, points, predicates, options),
      bad_(dt_, points),
      goal_(options.delta, options.slivers, options.max_edge) {}

void Refiner::queue_subsegment(std::uint32_t s) {
  if (subsegments_[s].queued || !subsegments_[s].alive) return;
  subsegments_[s].queued = true;
  subsegment_queue_.push_back(s);
}

void Refiner::queue_subfacet(std::uint32_t s) {
  if (subfacets_[s].queued || !subfacets_[s].alive) return;
  subfacets_[s].queued = true;
  subfacet_queue_.push_back(s);
}

void Refiner::drain() {
  while (!subsegment_queue_.empty() || !subfacet_queue_.empty()) {
    control_.poll(points_.size());
    if (!subsegment_queue_.empty()) {
      const std::uint32_t s = subsegment_queue_.front();
      subsegment_queue_.pop_front();
      subsegments_[s].queued = false;
      if (subsegments_[s].alive) split_subsegment(s);
    } else {
      const std::uint32_t s = subfacet_queue_.front();
      subfacet_queue_.pop_front();
      subfacets_[s].queued = false;
      if (subfacets_[s].alive) split_subfacet(s);
    }
    compact_subfacets();
  }
}

// Lists the subsegments and subfacets in and on the cavity: the only ones that its new vertex can
// encroach upon, because the diametral ball of an edge or face is covered by the circumballs of the
// tetrahedra around it (unless the centres of two are on one side, which without the Gabriel
// property may be so).
void Refiner::begin_constraints() {
  next_epoch(stamp_, subfacet_stamp_, subsegment_stamp_);
  subfacet_stamp_.resize(subfacets_.size(), 0);
  subsegment_stamp_.resize(subsegments_.size(), 0);
  found_subfacets_.clear();
  found_subsegments_.clear();
}

void Refiner::collect_constraints_of(TetId t) {
  const std::uint8_t edges = note(t, kEdges);
  if ((edges | note(t, kFaces)) == 0) return;
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t s = subfacet_on(t, i);
    if (s == kNone || !subfacets_[s].alive) continue;
    if (subfacet_stamp_[s] == stamp_) {
      for (FoundSubfacet& found : found_subfacets_) found.internal |= found.id == s;
      continue;
    }
    subfacet_stamp_[s] = stamp_;
    found_subfacets_.push_back({s, false});
  }
  for (int e = 0; e < 6; ++e) {
    if ((edges >> e & 1) == 0) continue;
    const std::uint32_t s = find_subsegment(dt_.vertex(t, kEdge[e][0]), dt_.vertex(t, kEdge[e][1]));
    if (s == kNone || subsegment_stamp_[s] == stamp_) continue;
    subsegment_stamp_[s] = stamp_;
    found_subsegments_.push_back(s);
  }
}

void Refiner::find_cavity(VertexId v, TetId start) {
  begin_constraints();
  dt_.grow_cavity(v, start, [&](TetId t) {
    collect_constraints_of(t);
    return true;
  });
}

// The same for a point that must not encroach: stops at the nearest constraint that it does
// encroach and queues it, because the whole cavity of a point far outside can be most of the mesh.
bool Refiner::find_free_cavity(VertexId v, TetId start, bool spare_subfacets) {
  begin_constraints();
  return dt_.grow_cavity(v, start, [&](TetId t) {
    const std::size_t subsegments = found_subsegments_.size();
    const std::size_t subfacets = found_subfacets_.size();
    collect_constraints_of(t);
    if (queue_encroached_subsegments(v, subsegments)) return false;
    return !spare_subfacets ||
           !(queue_lost_subfacets(t) || queue_encroached_subfacets(v, subfacets));
  });
}

// A subfacet with both its tetrahedra in the cavity would be lost: without the Gabriel property it
// may hide the new point from the tetrahedron that the point was made for. One that has a ghost
// there is a side of the box, which only rounding can put the point beyond.
bool Refiner::queue_lost_subfacets(TetId t) {
  if (note(t, kFaces) == 0) return false;
  const bool ghost = dt_.is_ghost(t);
  bool any = false;
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t s = subfacet_on(t, i);
    if (s == kNone || !subfacets_[s].alive) continue;
    if (!ghost && !dt_.in_cavity(dt_.neighbor(t, i))) continue;
    queue_subfacet(s);
    any = true;
  }
  return any;
}

bool Refiner::queue_encroached_subsegments(VertexId v, std::size_t first) {
  bool any = false;
  for (std::size_t n = first; n < found_subsegments_.size(); ++n) {
    const Subsegment& s = subsegments_[found_subsegments_[n]];
    if (!s.alive || predicates_.dot_sign(s.a, v, s.b) >= 0) continue;
    queue_subsegment(found_subsegments_[n]);
    any = true;
  }
  return any;
}

bool Refiner::queue_encroached_subfacets(VertexId v, std::size_t first) {
  bool any = false;
  for (std::size_t n = first; n < found_subfacets_.size(); ++n) {
    const auto& c = subfacets_[found_subfacets_[n].id].v;
    if (predicates_.in_diametral_ball(c[0], c[1], c[2], v) <= 0) continue;
    queue_subfacet(found_subfacets_[n].id);
    any = true;
  }
  return any;
}

// Fills the cavity and carries over what is known of its tetrahedra.
void Refiner::commit(VertexId v) {
  std::uint8_t side = kUnknown;
  bool first = true;
  for (const TetId t : dt_.cavity()) {
    if (dt_.is_ghost(t)) continue;
    const std::uint8_t known = note(t, kSide);
    if (first) side = known;
    if (known != side) side = kUnknown;
    first = false;
  }
  if (side == kStraddling) side = kUnknown;
  dt_.fill_cavity(v);
  if (dt_.capacity() > subfacet_.size()) subfacet_.resize(dt_.capacity());
  const auto created = dt_.created();
  const auto boundary = dt_.cavity_boundary();
  for (std::size_t n = 0; n < created.size(); ++n) {
    const TetId t = created[n];
    const int face = boundary[n].face;
    const TetId inner = boundary[n].inner;
    const auto face_bit = static_cast<std::uint8_t>(1U << face);
    note(t, kEdges) = note(inner, kEdges) & kEdgesWithout[face];
    note(t, kFaces) = note(inner, kFaces) & face_bit;
    if (note(t, kFaces) != 0) subfacet_[t][face] = subfacet_[inner][face];
    note(t, kSide) = side;
  }
}

// Queues the elements that the last commit() removed from the tetrahedrization although they are
// alive.
void Refiner::requeue_lost() {
  for (const FoundSubfacet& found : found_subfacets_) {
    if (found.internal) queue_subfacet(found.id);
  }
  next_epoch(stamp_, subfacet_stamp_, subsegment_stamp_);
  for (const TetId t : dt_.created()) {
    for (int e = 0; e < 6; ++e) {
      if ((note(t, kEdges) >> e & 1) == 0) continue;
      const std::uint32_t s =
          find_subsegment(dt_.vertex(t, kEdge[e][0]), dt_.vertex(t, kEdge[e][1]));
      if (s != kNone && s < subsegment_stamp_.size()) subsegment_stamp_[s] = stamp_;
    }
  }
  for (const std::uint32_t s : found_subsegments_) {
    if (subsegment_stamp_[s] != stamp_) queue_subsegment(s);
  }
}

void Refiner::after_insertion() {
  for (const std::uint32_t s : new_subfacets_) {
    // Every new subfacet has the new vertex first, which all created tetrahedra have too.
    const VertexId x = subfacets_[s].v[1];
    const VertexId y = subfacets_[s].v[2];
    std::uint32_t face = kNone;
    for (const TetId t : dt_.created()) {
      const int i = dt_.index_of(t, x);
      if (i < 0) continue;
      const int j = dt_.index_of(t, y);
      if (j < 0) continue;
      const int k = dt_.index_of(t, subfacets_[s].v[0]);
      face = 4 * t + static_cast<std::uint32_t>(6 - i - j - k);
      break;
    }
    check_subfacet(s, face);
  }
  requeue_lost();
  if (refining_) bad_.add_fresh(dt_.created());
}

}  // namespace delmesher
