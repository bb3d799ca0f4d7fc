// Algorithm 1 of the paper, in its order.
#include "mesher/refine/refine.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/refine/refiner.h"

namespace delmesher {

void Refiner::begin(RefineStep step) const {
  if (options_.on_step) options_.on_step(step);
}

void Refiner::run() {
  begin(RefineStep::delaunay);
  std::vector<VertexId> vertices = plc_.free_vertices;
  for (const PlcSegment& segment : plc_.segments) {
    vertices.insert(vertices.end(), segment.vertex.begin(), segment.vertex.end());
  }
  for (const PlcFacet& facet : plc_.facets) {
    vertices.insert(vertices.end(), facet.isolated.begin(), facet.isolated.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  dt_.build(vertices, control_);
  subfacet_.resize(dt_.capacity());

  begin(RefineStep::segments);
  recover_segments();
  if (options_.validate) validate();
  begin(RefineStep::facets);
  build_facets();
  recover_facets();
  if (options_.validate) validate();
  begin(RefineStep::tetrahedra);
  refine_tetrahedra();
  if (options_.validate) validate();
}

RefineResult Refiner::result() {
  RefineResult r;
  classify_near_removed();
  std::size_t count = 0;
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || dt_.is_ghost(t)) continue;
    control_.poll(points_.size());
    side_of(t);
    ++count;
  }
  // The memory of the queues and marks goes before that of the result comes.
  bad_.release();
  subfacet_.release();
  edge_map_ = {};
  r.tetrahedra.reserve(count);
  r.side.reserve(count);
  r.repeated_faces.reserve(count);
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || dt_.is_ghost(t)) continue;
    const VertexId* v = dt_.vertices(t);
    r.tetrahedra.push_back({v[0], v[1], v[2], v[3]});
    r.side.push_back(note(t, kSide) == kInside    ? Side::inside
                     : note(t, kSide) == kOutside ? Side::outside
                                                  : Side::straddling);
    const bool inside = note(t, kSide) == kInside;
    r.repeated_faces.push_back(
        dt_.repeated_faces(t, [&](TetId u) { return (note(u, kSide) == kInside) == inside; }));
  }
  for (const Subfacet& f : subfacets_) {
    if (f.alive) r.faces.push_back({f.v, f.facet});
  }
  r.chain.resize(plc_.segments.size());
  for (std::size_t n = 0; n < plc_.segments.size(); ++n) {
    r.chain[n].push_back(plc_.segments[n].vertex[0]);
    for (std::uint32_t s = first_subsegment_[n]; s != kNone; s = subsegments_[s].next) {
      r.chain[n].push_back(subsegments_[s].b);
    }
  }
  r.delaunay = std::make_unique<Tetrahedrization>(std::move(dt_));
  r.on_facet = std::move(on_facet_);
  r.in_volume = std::move(in_volume_);
  r.ball = std::move(ball_);
  r.on_segments = on_segments_;
  r.on_facets = on_facets_;
  return r;
}

RefineResult refine(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                    Predicates& predicates, const RefineOptions& options, Control& control) {
  Refiner refiner(plc, topology, points, predicates, options, control);
  try {
    refiner.run();
  } catch (const Runaway& runaway) {
    RefineResult stopped;
    stopped.runaway = runaway.place;
    return stopped;
  }
  return refiner.result();
}

}  // namespace delmesher
