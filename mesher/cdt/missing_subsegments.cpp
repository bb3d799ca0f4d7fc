#include "mesher/cdt/missing_subsegments.h"

#include <algorithm>
#include <array>

#include "mesher/base/check.h"

namespace delmesher::cdt {

void MissingSubsegments::remember(std::uint32_t n) {
  by_ends_.set(pair_key(chains_.node(n).vertex, chains_.next(n).vertex), n);
}

// Each is looked for around the end that has fewer subsegments, so that no vertex of high degree is
// visited more than a few times.
void MissingSubsegments::find_all(Control& control) {
  const PointStore& points = mesh_.predicates().points();
  std::vector<std::array<std::uint32_t, 2>> by_vertex;  // vertex, node
  for (std::uint32_t n = 0; n < chains_.size(); ++n) {
    if (!chains_.is_subsegment(n)) continue;
    const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
    by_vertex.push_back({chains_.valence(b) < chains_.valence(a) ? b : a, n});
  }
  std::sort(by_vertex.begin(), by_vertex.end());
  std::vector<std::uint32_t> seen(points.size(), kNone);  // vertex -> whose neighbour it is
  VertexId around = kNone;
  for (const auto& [v, n] : by_vertex) {
    control.poll(points.size());
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
  if (queue_.empty()) return;
  for (std::uint32_t n = 0; n < chains_.size(); ++n) {
    if (chains_.is_subsegment(n)) remember(n);
  }
}

std::uint32_t MissingSubsegments::take() {
  const std::uint32_t n = queue_.front();
  queue_.pop_front();
  return n;
}

void MissingSubsegments::follow_split(std::uint32_t first, std::uint32_t second) {
  for (const std::uint32_t n : {first, second}) {
    remember(n);
    queue_.push_back(n);
  }
  queue_destroyed(chains_.node(second).vertex);
}

// Queues the subsegments that are edges of the last cavity, but not of its skin.
void MissingSubsegments::queue_destroyed(VertexId v) {
  kept_.clear();
  for (const TetId t : mesh_.created()) {
    const int f = mesh_.index_of(t, v);
    for (int k = 0; k < 3; ++k) {
      // Each edge of the boundary has two faces, which traverse it in both directions.
      const VertexId a = mesh_.vertex(t, kFace[f][k]), b = mesh_.vertex(t, kFace[f][(k + 1) % 3]);
      if (a < b && find(a, b) != kNone) kept_.push_back(pair_key(a, b));
    }
  }
  std::sort(kept_.begin(), kept_.end());
  for (const TetId t : mesh_.cavity()) {
    for (const auto& e : kEdge) {
      const VertexId a = mesh_.vertex(t, e[0]), b = mesh_.vertex(t, e[1]);
      const std::uint32_t n = find(a, b);
      if (n == kNone || std::binary_search(kept_.begin(), kept_.end(), pair_key(a, b))) continue;
      if (queue_.back() != n) queue_.push_back(n);
    }
  }
}

void MissingSubsegments::validate() const {
  std::vector<std::uint8_t> waits(chains_.size(), 0);
  for (const std::uint32_t n : queue_) {
    DELMESHER_CHECK(n < chains_.size() && chains_.is_subsegment(n),
                    "a node that waits names no subsegment");
    waits[n] = 1;
  }
  const bool some_missing = by_ends_.size() > 0;
  for (std::uint32_t n = 0; n < chains_.size(); ++n) {
    if (!chains_.is_subsegment(n)) continue;
    const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
    DELMESHER_CHECK(waits[n] != 0 || find_edge(mesh_, chains_, a, b) != kNone,
                    "a missing subsegment does not wait");
    DELMESHER_CHECK(some_missing || waits[n] == 0,
                    "a subsegment waits and none is found by its ends");
    DELMESHER_CHECK(!some_missing || by_ends_.get(pair_key(a, b), kNone) == n,
                    "a subsegment is not found by its ends");
  }
}

}  // namespace delmesher::cdt
