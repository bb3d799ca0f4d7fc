#include "mesher/chamfer/acuteness.h"

#include "mesher/base/parallel.h"

namespace delmesher::chamfer {

namespace {

class AcuteFinder {
 public:
  AcuteFinder(const KeptSurface& surface, const PointStore& points, const Thresholds& thresholds)
      : surface_(surface),
        topology_(surface.topology()),
        predicates_(points),
        thresholds_(thresholds) {}

  // The dihedral angle of two kept facets.
  bool edge_is_acute(std::uint32_t e) {
    if (topology_.edge_is_flat[e]) return false;
    const auto [h, g] = topology_.edge_half_edges(e);
    if (!surface_.facet_is_kept(topology_.facet_of_half_edge(h)) ||
        !surface_.facet_is_kept(topology_.facet_of_half_edge(g))) {
      return false;
    }
    const auto [c, d] = topology_.edge_vertices(e);
    return predicates_.dihedral_below(topology_.to(SurfaceTopology::next(h)),
                                      topology_.to(SurfaceTopology::next(g)), c, d,
                                      thresholds_.with_facets);
  }

  bool vertex_is_acute(VertexId v, const std::vector<std::uint8_t>& edge_is_acute) {
    apex_ = false;
    const std::vector<std::uint32_t> spokes = surface_.live_half_edges(v);
    for (std::uint32_t h : spokes) {
      if (edge_is_acute[topology_.edge_of[h]]) return true;
    }
    return two_edges_are_acute(v, spokes) || edge_and_facet_are_acute(v, spokes);
  }

  bool apex() const { return apex_; }  // of the last vertex
  const PredicateCounters& counters() const { return predicates_.counters; }

 private:
  // Few directions fit into space without a pair below the threshold of corners, so this ends soon
  // even at a vertex of many edges, unless that threshold is small: with --corner 0 it asks all
  // pairs.
  bool two_edges_are_acute(VertexId v, const std::vector<std::uint32_t>& spokes) {
    const double limit = thresholds_.with_facets;
    for (std::size_t i = 1; i < spokes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const VertexId p = topology_.to(spokes[i]);
        const VertexId q = topology_.to(spokes[j]);
        if (!predicates_.angle_below(p, v, q, limit)) continue;
        if (predicates_.angle_below(p, v, q, thresholds_.of_edges)) return true;
        apex_ = true;
      }
    }
    return false;
  }

  bool edge_and_facet_are_acute(VertexId v, const std::vector<std::uint32_t>& spokes) {
    for (std::uint32_t spoke : spokes) {
      const std::uint32_t index = surface_.corner_of_outgoing(spoke);
      if (index == kNone) continue;
      const Corner& corner = surface_.corners()[index];
      const std::vector<std::uint32_t> fan = surface_.fan(corner);
      for (std::uint32_t other : spokes) {
        if (topology_.edge_of[other] == topology_.edge_of[corner.outgoing] ||
            topology_.edge_of[other] == topology_.edge_of[corner.incoming]) {
          continue;
        }
        if (acute_with_fan(v, topology_.to(other), fan)) return true;
      }
    }
    return false;
  }

  bool acute_with_fan(VertexId v, VertexId q, const std::vector<std::uint32_t>& fan) {
    const double limit = thresholds_.with_facets;
    for (std::uint32_t h : fan) {
      const std::uint32_t last = SurfaceTopology::previous(h);
      const VertexId b = topology_.to(h), c = topology_.from(last);
      if (projects_into_wedge(predicates_, q, v, b, c, topology_.edge_is_flat[topology_.edge_of[h]],
                              topology_.edge_is_flat[topology_.edge_of[last]]) &&
          predicates_.edge_plane_angle_below(q, v, b, c, limit)) {
        return true;
      }
    }
    return false;
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  Predicates predicates_;
  const Thresholds& thresholds_;
  bool apex_ = false;
};

}  // namespace

bool projects_into_wedge(Predicates& predicates, VertexId q, VertexId a, VertexId b, VertexId c,
                         bool with_ab, bool with_ac) {
  const int inside_ab = predicates.dihedral_sign(q, c, a, b);
  if (inside_ab < 0 || (inside_ab == 0 && !with_ab)) return false;
  const int inside_ac = predicates.dihedral_sign(q, b, a, c);
  if (inside_ac < 0 || (inside_ac == 0 && !with_ac)) return false;
  return inside_ab > 0 || inside_ac > 0;
}

Acuteness find_acute(const KeptSurface& surface, Predicates& predicates,
                     const Thresholds& thresholds, const std::vector<std::uint8_t>& active,
                     Control& control) {
  constexpr std::size_t kChunk = 256;
  PerWorker<AcuteFinder> finders(control, surface, predicates.points(), thresholds);
  const auto is_active = [&active](VertexId v) { return active.empty() || active[v] != 0; };
  Acuteness result;
  result.edge.resize(surface.topology().edge_count());
  for_items(control, result.edge.size(), kChunk, [&](Worker& worker, std::size_t n) {
    const auto e = static_cast<std::uint32_t>(n);
    const auto [v, w] = surface.topology().edge_vertices(e);
    if (is_active(v) && is_active(w)) result.edge[e] = finders[worker].edge_is_acute(e);
  });
  result.vertex.resize(surface.vertex_count());
  result.apex.resize(surface.vertex_count());
  for_items(control, result.vertex.size(), kChunk, [&](Worker& worker, std::size_t n) {
    const auto v = static_cast<VertexId>(n);
    if (!is_active(v)) return;
    AcuteFinder& finder = finders[worker];
    result.vertex[v] = finder.vertex_is_acute(v, result.edge);
    result.apex[v] = result.vertex[v] == 0 && finder.apex();
  });
  finders.for_each([&](const AcuteFinder& f) { predicates.counters += f.counters(); });
  return result;
}

}  // namespace delmesher::chamfer
