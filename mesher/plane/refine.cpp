// The refinement in its order.
#include "mesher/plane/refine.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/plane/refiner.h"
#include "mesher/plane/spatial_order.h"

namespace delmesher::plane {
namespace {

// The vertices of the chamfered graph: those of the input as they come, cut points where their
// corners would be.
std::vector<VertexId> along_curve(const InputGraph& graph, const Chamfered& chamfered) {
  std::vector<std::pair<VertexId, VertexId>> cuts;
  for (const Gap& gap : chamfered.gaps) {
    if (gap.b >= graph.vertices) cuts.emplace_back(gap.a, gap.b);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<VertexId> order;
  auto cut = cuts.begin();
  for (VertexId v = 0; v < graph.vertices; ++v) {
    if (chamfered.vertex_kept[v] != 0) order.push_back(v);
    for (; cut != cuts.end() && cut->first == v; ++cut) order.push_back(cut->second);
  }
  return order;
}

}  // namespace

void Refiner::begin(RefineStep step) const {
  if (options_.on_step) options_.on_step(step);
}

void Refiner::run() {
  begin(RefineStep::delaunay);
  triangulate_graph();
  begin(RefineStep::segments);
  split_segments();
  if (options_.validate) validate();
  begin(RefineStep::triangles);
  refine_triangles();
}

// The chamfered graph, triangulated.
void Refiner::triangulate_graph() {
  const bool unchanged =
      chamfered_.gaps.empty() &&
      std::count(chamfered_.vertex_kept.begin(), chamfered_.vertex_kept.end(), 0) == 0;
  if (unchanged) {
    mesh_ = graph_.base;
    return;
  }
  std::vector<VertexId> order = along_curve(graph_, chamfered_);
  mesh_.reserve(2 * points_.size());
  const VertexId c = graph_.vertices;
  mesh_.start({c, c + 1, c + 2, c + 3}, {0, 1, 2, 3});
  arrange_in_rounds(order);
  TriangleId hint = 0;
  for (const VertexId v : order) {
    control_.poll(points_.size());
    DELMESHER_CHECK(mesh_.insert(v, hint) == v, "chamfering made vertices coincide");
    hint = mesh_.around(v);
  }
  mesh_.renumber();
  std::vector<VertexId> chain;
  for (PieceId id = kBoxPieces; id < graph_.pieces.size(); ++id) {
    const auto [a, b] = chamfered_.ends[id];
    if (a == kNone) continue;
    control_.poll(points_.size());
    const auto obstacle = mesh_.insert_segment(a, b, id, chain);
    DELMESHER_CHECK(obstacle.kind == Triangulation::Obstacle::Kind::none && chain.size() == 2,
                    "two chamfered segments meet outside their ends");
  }
}

void Refiner::split_segments() {
  sides_.start();
  subsegments_.queue_all();
  drain();
}

// First for the bound that is proven to end, then for the one asked for beyond it.
void Refiner::refine_triangles() {
  result_.delta = std::min(options_.delta, kProvenDelta);
  refine_to(result_.delta, 0);
  if (options_.delta > kProvenDelta) try_for(options_.delta);
}

bool Refiner::refine_to(double degrees, std::uint64_t most) {
  goal_ = Goal(degrees, options_.max_edge);
  drain();
  judging_ = true;
  bad_.gather();
  for (TriangleId t = 0; t < mesh_.size(); ++t) judge(t);
  bad_.sort();
  if (options_.validate) validate();
  const std::size_t limit = points_.size() + most;
  BadTriangles::Entry entry;
  while (!crowding_.hopeless() && bad_.pop(entry)) {
    if (mesh_[entry.triangle].vertex != entry.vertex) continue;
    if (most > 0 && points_.size() > limit) {
      bad_.clear();
      return false;
    }
    split_triangle(entry.triangle);
    drain();
  }
  if (options_.validate) validate();
  return true;
}

// Beyond the proven bound: with at most a multiple of the points that the proven bound took. That
// bound is kept where it ends there; but the points made by then may have crowded each other.
void Refiner::try_for(double degrees) {
  result_.delta = degrees;
  if (crowding_.any()) return;
  const std::uint64_t most = 8 * points_.size() + 1000;
  const bool reached = refine_to(degrees, most);
  if (!reached && !crowding_.any()) {
    result_.delta = kProvenDelta;
    refine_to(kProvenDelta, 0);
  }
  result_.crowded_beyond = crowding_.any();
}

RefinedMesh Refiner::result() {
  if (!crowding_.hopeless()) sides_.settle();
  result_.side.resize(mesh_.size());
  for (TriangleId t = 0; t < mesh_.size(); ++t) result_.side[t] = sides_.of(t);
  result_.mesh = std::move(mesh_);
  result_.carrier = steiner_.carrier();
  result_.carrier.resize(points_.size(), kNone);
  result_.crowded = crowding_.any();
  result_.crowded_pieces = crowding_.pieces();
  result_.crowded_vertices = crowding_.vertices();
  return std::move(result_);
}

RefinedMesh refine(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
                   PlanePredicates& predicates, const RefineOptions& options, Control& control) {
  const std::size_t points_before = points.size();
  const auto refined_to = [&](double delta) {
    RefineOptions these = options;
    these.delta = delta;
    Refiner refiner(graph, chamfered, points, predicates, these, control);
    refiner.run();
    return refiner.result();
  };
  RefinedMesh result = refined_to(options.delta);
  if (!result.crowded_beyond) return result;
  points.truncate(points_before);
  return refined_to(kProvenDelta);
}

}  // namespace delmesher::plane
