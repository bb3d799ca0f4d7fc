#include "mesher/plane/subsegments.h"

#include <algorithm>
#include <utility>

#include "mesher/base/check.h"

namespace delmesher::plane {

EdgeId Subsegments::find(const Subsegment& s) const {
  if (mesh_.origin(s.edge) == s.a && mesh_.target(s.edge) == s.b) return s.edge;
  return mesh_.find_edge(s.a, s.b);
}

bool Subsegments::encroached_from(EdgeId e) {
  return encroached_by(mesh_.opposite(e), mesh_.origin(e), mesh_.target(e), triangle_of(e));
}

bool Subsegments::encroached(EdgeId e) {
  for (const EdgeId f : {e, mesh_.twin(e)}) {
    if (f != kNone && encroached_from(f)) return true;
  }
  return false;
}

void Subsegments::queue_all() {
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i), f = mesh_.twin(e);
      if (mesh_.piece(e) == kNone || (f != kNone && f < e)) continue;
      if (encroached(e)) queue_.push_back({mesh_.origin(e), mesh_.target(e), e});
    }
  }
}

void Subsegments::queue_if_encroached_from(EdgeId e) {
  if (mesh_.piece(e) == kNone || !encroached_from(e)) return;
  queue_.push_back({mesh_.origin(e), mesh_.target(e), e});
}

void Subsegments::queue_at_created() {
  for (const TriangleId t : mesh_.created()) {
    for (int i = 0; i < 3; ++i) queue_if_encroached_from(edge_of(t, i));
  }
}

// The point itself encroaches none beside a triangle that counted. But gaps may make triangles
// count that did not before: their subsegments were not asked about.
void Subsegments::queue_around_created() {
  for (const TriangleId t : mesh_.created()) queue_if_encroached_from(edge_of(t, 0));
}

EdgeId Subsegments::take() {
  while (head_ < queue_.size()) {
    const EdgeId e = find(queue_[head_++]);
    if (e != kNone && mesh_.piece(e) != kNone && encroached(e)) return e;
  }
  clear();
  return kNone;
}

void Subsegments::clear() {
  queue_.clear();
  head_ = 0;
}

void Subsegments::validate() {
  const PlaneCounters counters = predicates_.counters;
  std::vector<std::pair<VertexId, VertexId>> waiting;
  for (std::size_t k = head_; k < queue_.size(); ++k) {
    waiting.push_back(std::minmax(queue_[k].a, queue_[k].b));
  }
  std::sort(waiting.begin(), waiting.end());
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i);
      if (mesh_.piece(e) == kNone || !encroached_from(e)) continue;
      const std::pair<VertexId, VertexId> ends = std::minmax(mesh_.origin(e), mesh_.target(e));
      DELMESHER_CHECK(std::binary_search(waiting.begin(), waiting.end(), ends),
                      "an encroached subsegment does not wait");
    }
  }
  predicates_.counters = counters;
}

}  // namespace delmesher::plane
