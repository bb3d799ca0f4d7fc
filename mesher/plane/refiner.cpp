#include "mesher/plane/refiner.h"

#include <algorithm>
#include <bit>

#include "mesher/base/check.h"

namespace delmesher::plane {
namespace {

SpatialKey box(const InputGraph& graph, const PointStore& points) {
  const Vec3 low = points.nearest(graph.vertices), high = points.nearest(graph.vertices + 2);
  return {{low[0], low[1]}, {high[0], high[1]}};
}

}  // namespace

Refiner::Refiner(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
                 PlanePredicates& predicates, const RefineOptions& options, Control& control)
    : graph_(graph),
      chamfered_(chamfered),
      points_(points),
      predicates_(predicates),
      options_(options),
      control_(control),
      mesh_(predicates),
      sides_(graph, mesh_, points, predicates, chamfered.gaps, options.everywhere),
      steiner_(graph, chamfered, mesh_, points, predicates, options.circumcentres),
      subsegments_(mesh_, sides_, predicates),
      bad_(points, box(graph, points)),
      crowding_(graph, steiner_.carrier(), options.most_splits),
      goal_(std::min(options.delta, kProvenDelta), options.max_edge),
      result_{.mesh = Triangulation(predicates),
              .side = {},
              .carrier = {},
              .crowded_pieces = {},
              .crowded_vertices = {}} {}

void Refiner::drain() {
  while (!crowding_.hopeless()) {
    const EdgeId e = subsegments_.take();
    if (e == kNone) break;
    split_subsegment(e);
  }
  subsegments_.clear();
}

bool Refiner::split_subsegment(EdgeId e) {
  const VertexId p = steiner_.on_subsegment(e);
  if (p == kNone) {
    crowding_.at(mesh_.origin(e));
    crowding_.at(mesh_.target(e));
    return false;
  }
  crowding_.count_split(mesh_.piece(e));
  ++result_.on_segments;
  mesh_.find_cavity(p, triangle_of(e), e);
  fill(p);
  subsegments_.queue_at_created();
  return true;
}

// Inserts the triangle's off-centre or circumcentre, or splits the segments that it encroaches
// upon, or notes that there is no room for either.
void Refiner::split_triangle(TriangleId t) {
  const std::array<VertexId, 3> v = mesh_[t].vertex;
  const SteinerPoints::Candidate candidate = steiner_.in_triangle(v, goal_);
  if (candidate.vertex == kNone) return crowd(t);
  const Triangulation::Sight sight = mesh_.look(candidate.vertex, t);
  const bool coincides = sight.blocked == kNone && std::popcount(sight.location.zeros) > 1;
  const Encroached encroached = coincides ? Encroached{} : find_encroached(candidate.vertex, sight);
  const bool free = encroached.cavity_found && encroached.upon.empty();
  if (coincides || (free && !in_cavity(t))) {
    steiner_.take_back(candidate);
    return crowd(t);
  }
  if (free) {
    if (!candidate.restored) ++result_.in_faces;
    fill(candidate.vertex);
    return subsegments_.queue_around_created();
  }
  steiner_.take_back(candidate);
  const bool progress = split_all(encroached.upon);
  if (mesh_[t].vertex != v) return;
  if (progress) {
    judge(t);
  } else {
    crowd(t);
  }
}

// The subsegment that hides p from the triangle or on which p lies, or else, with the cavity of p,
// the ones whose open diametral disc contains p.
Refiner::Encroached Refiner::find_encroached(VertexId p, const Triangulation::Sight& sight) {
  Encroached encroached;
  EdgeId blocked = sight.blocked;
  for (int i = 0; blocked == kNone && i < 3; ++i) {
    const EdgeId e = edge_of(sight.location.triangle, i);
    if ((sight.location.zeros >> i & 1) != 0 && mesh_.piece(e) != kNone) blocked = e;
  }
  if (blocked != kNone) {
    encroached.upon.push_back({mesh_.origin(blocked), mesh_.target(blocked), blocked});
    return encroached;
  }
  mesh_.find_cavity(p, sight.location.triangle, kNone);
  encroached.cavity_found = true;
  for (const auto& edge : mesh_.boundary()) {
    if (edge.piece != kNone && subsegments_.encroached_by(p, edge.from, edge.to, edge.inner)) {
      // For the sides of the box, any edge will do: they are looked up.
      const EdgeId inner = edge.outer != kNone ? mesh_.twin(edge.outer) : 0;
      encroached.upon.push_back({edge.from, edge.to, inner});
    }
  }
  return encroached;
}

// Has one of them been split, or is it gone?
bool Refiner::split_all(const std::vector<Subsegment>& subsegments) {
  bool progress = false;
  for (const Subsegment& s : subsegments) {
    const EdgeId e = subsegments_.find(s);
    if (e == kNone || split_subsegment(e)) progress = true;
  }
  return progress;
}

void Refiner::fill(VertexId p) {
  sides_.before_fill();
  mesh_.fill_cavity(p);
  sides_.after_fill();
  if (judging_) {
    for (const TriangleId t : mesh_.created()) judge(t);
  }
  control_.poll(points_.size());
}

void Refiner::judge(TriangleId t) {
  if (!sides_.counts(t)) return;
  const auto& v = mesh_[t].vertex;
  const std::optional<double> badness = goal_.badness(shape_of(points_, v[0], v[1], v[2]));
  if (badness) bad_.push(*badness, {t, v});
}

bool Refiner::in_cavity(TriangleId t) const {
  const auto& cavity = mesh_.cavity();
  return std::find(cavity.begin(), cavity.end(), t) != cavity.end();
}

void Refiner::crowd(TriangleId t) {
  for (const VertexId v : mesh_[t].vertex) crowding_.at(v);
}

void Refiner::validate() {
  const PlaneCounters counters = predicates_.counters;
  mesh_.validate(true);
  sides_.validate();
  predicates_.counters = counters;
  bad_.validate();
  crowding_.validate();
  if (crowding_.any()) return;
  subsegments_.validate();
  if (judging_) validate_bad_triangles();
}

void Refiner::validate_bad_triangles() {
  std::vector<std::uint8_t> waits(mesh_.size(), 0);
  bad_.for_each([&](const BadTriangles::Entry& entry) {
    if (mesh_[entry.triangle].vertex == entry.vertex) waits[entry.triangle] = 1;
  });
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    if (waits[t] != 0 || !sides_.counts(t)) continue;
    const auto& v = mesh_[t].vertex;
    DELMESHER_CHECK(!goal_.badness(shape_of(points_, v[0], v[1], v[2])),
                    "a bad triangle does not wait");
  }
}

}  // namespace delmesher::plane
