#include "mesher/cdt/segment_recovery.h"

#include <array>
#include <span>
#include <utility>

#include "mesher/base/check.h"
#include "mesher/base/validating.h"
#include "mesher/cdt/missing_subsegments.h"
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

// Splits missing subsegments until none is left. Invariant between two steps, apart from that of
// MissingSubsegments: the rule's centre is known for every subsegment.
class SegmentRecovery {
 public:
  SegmentRecovery(Tetrahedrization& mesh, Chains& chains, PointStore& points, Control& control)
      : mesh_(mesh),
        chains_(chains),
        points_(points),
        control_(control),
        splitter_(chains, points, mesh.predicates()),
        rule_(chains, points),
        references_(mesh, points, control),
        missing_(mesh, chains) {}

  std::vector<VertexId> run() {
    missing_.find_all(control_);
    if (kValidating) missing_.validate();
    if (missing_.empty()) return {};
    const std::vector<std::uint8_t> acute =
        find_vertices_below_90_degrees(chains_.topology(), mesh_.predicates());
    for (std::uint32_t n = 0; n < chains_.size(); ++n) {
      centre_.push_back(initial_centre(acute, chains_.node(n).edge));
    }
    while (!missing_.empty()) {
      control_.poll(points_.size());
      recover(missing_.take());
    }
    if (kValidating) missing_.validate();
    return std::move(added_);
  }

 private:
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
    const VertexId v = chains_.node(m).vertex;
    added_.push_back(v);
    DELMESHER_CHECK(mesh_.insert(v, mesh_.incident(a)),
                    "a vertex lies where a subsegment is split");
    missing_.follow_split(n, m);
  }

  Tetrahedrization& mesh_;
  Chains& chains_;
  PointStore& points_;
  Control& control_;
  SubsegmentSplitter splitter_;
  SplitRule rule_;
  ReferenceFinder references_;
  MissingSubsegments missing_;
  std::vector<Centre> centre_;  // per node, of the subsegment behind it
  std::vector<VertexId> added_;
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
