// Algorithm 1 of the paper, in its order.
#include "mesher/refine/refine.h"

#include <algorithm>

#include "mesher/base/sort_unique.h"
#include "mesher/refine/refiner.h"

namespace delmesher::refine {

void Refiner::begin(RefineStep step) const {
  if (options_.on_step) options_.on_step(step);
}

void Refiner::run() {
  begin(RefineStep::delaunay);
  triangulate_vertices();
  begin(RefineStep::segments);
  recover_segments();
  if (options_.validate) validate();
  begin(RefineStep::facets);
  recover_facets();
  if (options_.validate) validate();
  begin(RefineStep::tetrahedra);
  refine_tetrahedra();
  if (options_.validate) validate();
}

void Refiner::triangulate_vertices() {
  std::vector<VertexId> vertices;
  for (const PlcSegment& segment : plc_.segments) {
    vertices.insert(vertices.end(), segment.vertex.begin(), segment.vertex.end());
  }
  for (const PlcFacet& facet : plc_.facets) {
    vertices.insert(vertices.end(), facet.isolated.begin(), facet.isolated.end());
  }
  sort_unique(vertices);
  dt_.build(vertices, control_);
}

void Refiner::recover_segments() {
  const std::uint32_t count = subsegments_.size();
  for (std::uint32_t s = 0; s < count; ++s) {
    subsegments_.settle(s, dt_.find_edge(subsegments_[s].a, subsegments_[s].b));
  }
  drain();
}

void Refiner::recover_facets() {
  subfacets_.build(control_);
  result_.on_facet.resize(plc_.facets.size());
  const std::uint32_t count = subfacets_.size();
  for (std::uint32_t s = 0; s < count; ++s) {
    control_.poll(points_.size());
    const auto& v = subfacets_[s].v;
    subfacets_.settle(s, dt_.find_face(v[0], v[1], v[2]));
  }
  drain();
}

// First the goal whose refinement is guaranteed to end; then, with a cap on insertions, the goals
// that are not: slivers and angles above the bound. Where a cap strikes, the guaranteed goal is
// reached once more, so that it holds in any case.
void Refiner::refine_tetrahedra() {
  refining_ = true;
  constexpr std::size_t kUnlimited = ~std::size_t{0};
  constexpr std::size_t kCapFactor = 4;
  const Goal guaranteed(std::min(options_.delta, kGuaranteedDelta), false, options_.max_edge,
                        options_.sizes);
  const Goal wanted(options_.delta, options_.slivers, options_.max_edge, options_.sizes);
  reach(guaranteed, kUnlimited);
  if (!options_.slivers && options_.delta <= kGuaranteedDelta) return;
  result_.capped = !reach(wanted, kCapFactor * points_.size());
  if (result_.capped) reach(guaranteed, kUnlimited);
}

bool Refiner::reach(const Goal& goal, std::size_t cap) {
  goal_ = goal;
  bad_.start();
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    control_.poll(points_.size());
    if (!dt_.alive(t)) continue;
    const std::uint8_t level = badness(t);
    if (level != 0) bad_.add(t, level);
  }
  for (;;) {
    control_.poll(points_.size());
    drain();
    bad_.judge_fresh([&](TetId t) { return badness(t); });
    const TetId t = bad_.next();
    if (t == kNone) return true;
    if (points_.size() > cap) return false;
    if (options_.region == Region::interior && sides_.of(t) == Side::outside) {
      bad_.dismiss(t);
    } else {
      split_tetrahedron(t);
    }
  }
}

std::uint8_t Refiner::badness(TetId t) const {
  if (dt_.is_ghost(t)) return 0;
  if (options_.region == Region::interior && sides_.known_outside(t)) return 0;
  return goal_.badness(points_, dt_.vertices(t));
}

RefineResult Refiner::result() {
  sides_.classify_near_removed(control_);
  std::size_t count = 0;
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || dt_.is_ghost(t)) continue;
    control_.poll(points_.size());
    sides_.of(t);
    ++count;
  }
  // The memory of the queues and marks goes before that of the result comes.
  bad_.release();
  subfacets_.release_marks();
  subsegments_.release_lookup();
  RefineResult r = std::move(result_);
  r.tetrahedra.reserve(count);
  r.side.reserve(count);
  r.repeated_faces.reserve(count);
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || dt_.is_ghost(t)) continue;
    const VertexId* v = dt_.vertices(t);
    r.tetrahedra.push_back({v[0], v[1], v[2], v[3]});
    r.side.push_back(sides_.of(t));
    const bool inside = sides_.known_inside(t);
    r.repeated_faces.push_back(
        dt_.repeated_faces(t, [&](TetId u) { return sides_.known_inside(u) == inside; }));
  }
  for (const Subfacet& f : subfacets_.planar()) {
    if (f.alive) r.faces.push_back({f.v, f.facet});
  }
  for (std::uint32_t n = 0; n < plc_.segments.size(); ++n) {
    r.chain.push_back(subsegments_.chain(n));
  }
  r.delaunay = std::make_unique<Tetrahedrization>(std::move(dt_));
  return r;
}

RefineResult refine(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                    Predicates& predicates, const RefineOptions& options, Control& control) {
  Refiner refiner(plc, topology, points, predicates, options, control);
  try {
    refiner.run();
  } catch (const Runaway&) {
    RefineResult stopped;
    stopped.runaway = true;
    return stopped;
  }
  return refiner.result();
}

}  // namespace delmesher::refine
