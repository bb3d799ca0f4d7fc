#include "mesher/cdt/segment_recovery.h"

#include <algorithm>
#include <array>
#include <deque>
#include <span>

#include "mesher/base/check.h"
#include "mesher/base/flat_map.h"
#include "mesher/cdt/reference_point.h"
#include "mesher/cdt/split_rule.h"

namespace delmesher::cdt {
namespace {

// Vertices at which two constrained edges meet at less than 90 degrees. Seven directions always
// contain such a pair.
std::vector<std::uint8_t> find_vertices_below_90_degrees(const SurfaceTopology& s,
                                                         Predicates& predicates) {
  std::vector<std::vector<std::uint32_t>> others(s.vertex_half_edge.size());
  std::vector<std::uint8_t> acute(others.size(), 0);
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] != 0) continue;
    const std::array<VertexId, 2> end = s.edge_vertices(e);
    for (int k = 0; k < 2; ++k) {
      if (acute[end[k]] != 0) continue;
      others[end[k]].push_back(end[1 - k]);
      if (others[end[k]].size() == 7) acute[end[k]] = 1;
    }
  }
  for (VertexId v = 0; v < others.size(); ++v) {
    const std::vector<std::uint32_t>& o = others[v];
    for (std::size_t i = 0; i < o.size() && acute[v] == 0; ++i) {
      for (std::size_t j = 0; j < i && acute[v] == 0; ++j) {
        acute[v] = predicates.dot_sign(o[i], v, o[j]) > 0 ? 1 : 0;
      }
    }
  }
  return acute;
}

// The queue of subsegments. Invariant between two steps: every subsegment that is not in the queue
// is an edge of the tetrahedrization (validate_segments checks it when the queue is empty), and
// subsegments_ finds every subsegment by its ends; any other subsegment that it finds has been
// split.
class SegmentRecovery {
 public:
  SegmentRecovery(Tetrahedrization& mesh, Chains& chains, PointStore& points, Control& control)
      : mesh_(mesh),
        chains_(chains),
        points_(points),
        control_(control),
        splitter_(chains, points, mesh.predicates()),
        rule_(chains, points),
        references_(mesh, points, control) {}

  std::vector<VertexId> run() {
    find_missing();
    if (queue_.empty()) return {};
    const std::vector<std::uint8_t> acute =
        find_vertices_below_90_degrees(chains_.topology(), mesh_.predicates());
    for (std::uint32_t n = 0; n < chains_.size(); ++n) {
      centre_.push_back(initial_centre(acute, chains_.node(n).edge));
      if (chains_.is_subsegment(n)) remember(n);
    }
    while (!queue_.empty()) {
      control_.poll(points_.size());
      const std::uint32_t n = queue_.front();
      queue_.pop_front();
      recover(n);
    }
    return std::move(added_);
  }

 private:
  void remember(std::uint32_t n) {
    subsegments_.set(pair_key(chains_.node(n).vertex, chains_.next(n).vertex), n);
  }

  // Puts all missing subsegments in the queue: each is looked for around the end that has fewer
  // subsegments, so that no vertex of high degree is visited more than a few times.
  void find_missing() {
    std::vector<std::array<std::uint32_t, 2>> by_vertex;  // vertex, node
    for (std::uint32_t n = 0; n < chains_.size(); ++n) {
      if (!chains_.is_subsegment(n)) continue;
      const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
      by_vertex.push_back({chains_.valence(b) < chains_.valence(a) ? b : a, n});
    }
    std::sort(by_vertex.begin(), by_vertex.end());
    std::vector<std::uint32_t> seen(points_.size(), kNone);  // vertex -> whose neighbour it is
    VertexId around = kNone;
    for (const auto& [v, n] : by_vertex) {
      control_.poll(points_.size());
      if (v != around) {
        around = v;
        for (const TetId t : mesh_.star(v)) {
          for (int i = 0; i < 4; ++i) {
            if (mesh_.vertex(t, i) != kInfinite) seen[mesh_.vertex(t, i)] = v;
          }
        }
      }
      const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
      if (seen[a == v ? b : a] != v) queue_.push_back(n);
    }
    std::sort(queue_.begin(), queue_.end());
  }

  Centre initial_centre(std::span<const std::uint8_t> acute, std::uint32_t edge) const {
    const auto [a, b] = chains_.topology().edge_vertices(edge);
    if (acute[a] != 0) return acute[b] != 0 ? Centre::both : Centre::end0;
    return acute[b] != 0 ? Centre::end1 : Centre::none;
  }

  void recover(std::uint32_t n) {
    VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
    if (find_edge(mesh_, chains_, a, b) != kNone) return;
    if (chains_.valence(b) < chains_.valence(a)) std::swap(a, b);
    const Centre centre = centre_[n];
    const bool both = centre == Centre::both;
    const VertexId reference = both ? kNone : references_.find(a, b);
    const std::uint32_t m = splitter_.split(n, rule_.target(n, centre, reference));
    centre_[n] = both ? Centre::end0 : centre;
    centre_.push_back(both ? Centre::end1 : centre);
    remember(n);
    remember(m);
    const VertexId v = chains_.node(m).vertex;
    added_.push_back(v);
    DELMESHER_CHECK(mesh_.insert(v, mesh_.incident(a)), "a vertex lies on a constrained edge");
    queue_.push_back(n);
    queue_.push_back(m);
    requeue_destroyed(v);
  }

  // Queues the subsegments that the last insertion has removed: edges of the cavity that are not
  // on its boundary.
  void requeue_destroyed(VertexId v) {
    kept_.clear();
    for (const TetId t : mesh_.created()) {
      const int f = mesh_.index_of(t, v);
      for (int k = 0; k < 3; ++k) {
        // Each edge of the boundary has two faces, which traverse it in both directions.
        const VertexId a = mesh_.vertex(t, kFace[f][k]), b = mesh_.vertex(t, kFace[f][(k + 1) % 3]);
        if (a < b) kept_.push_back(pair_key(a, b));
      }
    }
    std::sort(kept_.begin(), kept_.end());
    for (const TetId t : mesh_.cavity()) {
      for (const auto& e : kEdge) {
        const VertexId a = mesh_.vertex(t, e[0]), b = mesh_.vertex(t, e[1]);
        if (chains_.valence(a) == 0 || chains_.valence(b) == 0) continue;
        const std::uint64_t key = pair_key(a, b);
        if (std::binary_search(kept_.begin(), kept_.end(), key)) continue;
        const std::uint32_t n = subsegments_.get(key, kNone);
        if (n == kNone) continue;
        if (queue_.back() != n) queue_.push_back(n);
      }
    }
  }

  Tetrahedrization& mesh_;
  Chains& chains_;
  PointStore& points_;
  Control& control_;
  SubsegmentSplitter splitter_;
  SplitRule rule_;
  ReferenceFinder references_;
  FlatMap subsegments_;              // end vertices -> node
  std::vector<Centre> centre_;       // per node, of the subsegment behind it
  std::deque<std::uint32_t> queue_;  // nodes whose subsegment may be missing
  std::vector<VertexId> added_;
  std::vector<std::uint64_t> kept_;
};

}  // namespace

std::vector<VertexId> recover_segments(Tetrahedrization& mesh, Chains& chains, PointStore& points,
                                       Control& control) {
  return SegmentRecovery(mesh, chains, points, control).run();
}

VertexId split_in_the_middle(Chains& chains, std::uint32_t node, PointStore& points,
                             Predicates& predicates) {
  const SplitTarget middle = target_in_the_middle(chains.node(node), chains.next(node));
  return chains.node(SubsegmentSplitter(chains, points, predicates).split(node, middle)).vertex;
}

}  // namespace delmesher::cdt
