#include "mesher/chamfer/simplify.h"

#include <algorithm>
#include <limits>

namespace delmesher::chamfer {

namespace {

// Smallest distance of a simplified bridge from the vertex it cuts off, relative to the chamfer
// distance. It is met only at corners of more than 179.1 degrees, and there by few: split points of
// artificial edges are rounded by a millionth of their length, and must not leave the facet where
// its boundary is straight or nearly so.
constexpr double kLeastDistance = 0x1p-7;

class Simplifier {
 public:
  Simplifier(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
             const Thresholds& thresholds, Predicates& predicates, Bridges& bridges)
      : surface_(surface),
        topology_(surface.topology()),
        acute_(acute),
        cuts_(cuts),
        thresholds_(thresholds),
        predicates_(predicates),
        bridges_(bridges),
        original_(bridges.chain) {}

  void run(Control& control) {
    struct Entry {
      double shortest;
      std::uint32_t corner;
    };
    std::vector<Entry> order;
    for (std::uint32_t c = 0; c < bridges_.chain.size(); ++c) {
      const std::vector<VertexId>& chain = bridges_.chain[c];
      if (chain.size() <= 2) continue;
      double shortest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 1; i < chain.size(); ++i) {
        shortest = std::min(shortest, length(chain[i - 1], chain[i]));
      }
      order.push_back({shortest, c});
    }
    std::sort(order.begin(), order.end(), [](const Entry& a, const Entry& b) {
      return a.shortest != b.shortest ? a.shortest < b.shortest : a.corner < b.corner;
    });
    for (const Entry& entry : order) {
      control.poll();
      simplify(entry.corner);
    }
  }

 private:
  void simplify(std::uint32_t index) {
    std::vector<VertexId>& chain = bridges_.chain[index];
    if (can_join(index, 0, chain.size() - 1)) {
      chain = {chain.front(), chain.back()};
      return;
    }
    // Drops single points, the ones with the shortest edges first, until none can go.
    for (bool changed = true; changed && chain.size() > 2;) {
      changed = false;
      std::vector<std::pair<double, std::size_t>> candidates;
      for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
        candidates.push_back(
            {std::min(length(chain[i - 1], chain[i]), length(chain[i], chain[i + 1])), i});
      }
      std::sort(candidates.begin(), candidates.end());
      for (const auto& [shortest, i] : candidates) {
        if (!can_join(index, i - 1, i + 1)) continue;
        chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(i));
        changed = true;
        break;
      }
    }
  }

  // May chain[from] and chain[to] be joined by an edge?
  bool can_join(std::uint32_t index, std::size_t from, std::size_t to) {
    const Corner& corner = surface_.corners()[index];
    const std::vector<VertexId>& chain = bridges_.chain[index];
    const VertexId x = chain[from], y = chain[to];
    // The vertex stays on the side that is cut off.
    const int side = predicates_.orient2d(topology_.facet_axis[corner.facet], x, y, corner.vertex) *
                     topology_.facet_axis_sign[corner.facet];
    if (side <= 0) return false;
    if (edge_distance(corner, x, y) < kLeastDistance * cuts_.distance[corner.vertex]) return false;
    return allows(index, x, y, from, true) && allows(index, y, x, to, false);
  }

  // May the chain go on from x = chain[at] to y, in the direction of the chain or against it?
  bool allows(std::uint32_t index, VertexId x, VertexId y, std::size_t at, bool forward) {
    const std::vector<VertexId>& chain = bridges_.chain[index];
    const Corner& corner = surface_.corners()[index];
    const bool is_end = forward ? at == 0 : at + 1 == chain.size();
    if (!is_end) {
      return !predicates_.angle_below(chain[forward ? at - 1 : at + 1], x, y,
                                      thresholds_.with_facets);
    }
    const std::uint32_t away = forward ? corner.outgoing : topology_.opposite[corner.incoming];
    const std::uint32_t e = topology_.edge_of[away];
    const double limit = thresholds_.with_facets;
    if (acute_.edge[e]) {
      const VertexId strip_end =
          forward ? bridges_.chain[corner.next].back() : bridges_.chain[corner.previous].front();
      return !predicates_.angle_below(strip_end, x, y, limit);
    }
    return allows_at_edge(index, forward, x, y, limit);
  }

  // A facet's sector at a cut point x: from the rest of the edge, past the orthogonal direction of
  // the original bridge, to the present neighbour of x in the chain. As the whole may be straight,
  // it is examined in two wedges.
  struct CutSector {
    VertexId orthogonal = kNone, neighbour = kNone;
  };

  // The sector beyond the edge at the end of a chain; no neighbour if that facet is not kept.
  CutSector across(const Corner& corner, bool forward) const {
    const std::uint32_t beyond =
        forward ? surface_.corner_of_incoming(topology_.opposite[corner.outgoing])
                : surface_.corner_of_outgoing(topology_.opposite[corner.incoming]);
    if (beyond == kNone) return {};
    const std::vector<VertexId>&chain = bridges_.chain[beyond], &original = original_[beyond];
    if (forward) return {original[original.size() - 2], chain[chain.size() - 2]};
    return {original[1], chain[1]};
  }

  // All angles at a cut point x between a new edge towards y and its neighbours there: the rest of
  // the edge, the other facet's bridge, and that facet.
  bool allows_at_edge(std::uint32_t index, bool forward, VertexId x, VertexId y, double limit) {
    const Corner& corner = surface_.corners()[index];
    const std::uint32_t toward = forward ? topology_.opposite[corner.outgoing] : corner.incoming;
    const VertexId rest = bridges_.edge_end_at_tail(topology_, toward);
    if (predicates_.angle_below(rest, x, y, limit)) return false;
    const CutSector other = across(corner, forward);
    if (other.neighbour == kNone) return true;
    if (predicates_.angle_below(other.neighbour, x, y, limit)) return false;
    const std::vector<VertexId>& original = original_[index];
    const CutSector here = {forward ? original[1] : original[original.size() - 2], y};
    return !acute_with_sector(y, x, rest, other, limit) &&
           !acute_with_sector(other.neighbour, x, rest, here, limit);
  }

  bool acute_with_sector(VertexId q, VertexId x, VertexId rest, const CutSector& sector,
                         double limit) {
    const auto [orthogonal, neighbour] = sector;
    const bool split = orthogonal != neighbour;
    if (projects_into_wedge(predicates_, q, x, rest, orthogonal, false, split)) {
      return predicates_.edge_plane_angle_below(q, x, rest, orthogonal, limit);
    }
    return split && projects_into_wedge(predicates_, q, x, orthogonal, neighbour, true, false) &&
           predicates_.edge_plane_angle_below(q, x, orthogonal, neighbour, limit);
  }

  double edge_distance(const Corner& corner, VertexId x, VertexId y) const {
    const Vec2 a = relative(corner, x), b = relative(corner, y);
    const Vec2 edge = b - a;
    const double along = -dot(a, edge) / dot(edge, edge);
    return norm(a + std::clamp(along, 0.0, 1.0) * edge);
  }
  Vec2 relative(const Corner& corner, VertexId x) const {
    return surface_.planar(corner.facet, subtract(scaled(x), surface_.position(corner.vertex)));
  }
  Vec3 scaled(VertexId v) const { return surface_.place(predicates_.points(), v); }
  double length(VertexId a, VertexId b) const { return distance(scaled(a), scaled(b)); }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Acuteness& acute_;
  const Cuts& cuts_;
  const Thresholds& thresholds_;
  Predicates& predicates_;
  Bridges& bridges_;
  std::vector<std::vector<VertexId>> original_;  // the chains before any simplification
};

}  // namespace

void simplify_bridges(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                      const Thresholds& thresholds, Predicates& predicates, Bridges& bridges,
                      Control& control) {
  Simplifier(surface, acute, cuts, thresholds, predicates, bridges).run(control);
}

}  // namespace delmesher::chamfer
