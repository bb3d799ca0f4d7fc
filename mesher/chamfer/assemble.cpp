#include "mesher/chamfer/assemble.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/chamfer/boundary_distance.h"
#include "mesher/chamfer/closest.h"

namespace delmesher::chamfer {

namespace {

class Assembler {
 public:
  Assembler(const KeptSurface& surface, const Acuteness& acute, const Bridges& bridges, Plc& plc)
      : surface_(surface),
        topology_(surface.topology()),
        acute_(acute),
        bridges_(bridges),
        plc_(plc),
        segment_of_edge_(topology_.edge_count(), kNone) {}

  PlcFacet facet(FacetId f) {
    PlcFacet result;
    result.input_facet = f;
    const auto& frame = topology_.triangles[surface_.frame(f).triangle];
    result.frame = {frame[0], frame[1], frame[2]};
    result.axis = topology_.facet_axis[f];
    result.axis_sign = topology_.facet_axis_sign[f];
    for (std::uint32_t c = surface_.first_corner(f); c < surface_.first_corner(f + 1); ++c) {
      cross_corner(c, result);
      follow_edge(c, result);
    }
    return result;
  }

 private:
  // The chain around the corner's vertex, from its incoming to its outgoing edge.
  void cross_corner(std::uint32_t c, PlcFacet& facet) {
    const std::vector<VertexId>& chain = bridges_.chain[c];
    for (std::size_t i = chain.size(); i-- > 1;) add_artificial(chain[i], chain[i - 1], facet);
  }

  void follow_edge(std::uint32_t c, PlcFacet& facet) {
    const Corner& corner = surface_.corners()[c];
    const std::uint32_t e = topology_.edge_of[corner.outgoing];
    if (acute_.edge[e]) {
      add_artificial(bridges_.chain[c].front(), bridges_.chain[corner.next].back(), facet);
      return;
    }
    if (segment_of_edge_[e] == kNone) {
      segment_of_edge_[e] = static_cast<std::uint32_t>(plc_.segments.size());
      plc_.segments.push_back({{bridges_.edge_end[2 * e], bridges_.edge_end[2 * e + 1]}, e});
    }
    const bool reversed = topology_.from(corner.outgoing) > topology_.to(corner.outgoing);
    facet.boundary.push_back({segment_of_edge_[e], reversed});
  }

  void add_artificial(VertexId a, VertexId b, PlcFacet& facet) {
    DELMESHER_CHECK(a != b, "two neighbouring points of a bridge are the same");
    facet.boundary.push_back({static_cast<std::uint32_t>(plc_.segments.size()), false});
    plc_.segments.push_back({{a, b}, kNone});
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Acuteness& acute_;
  const Bridges& bridges_;
  Plc& plc_;
  std::vector<std::uint32_t> segment_of_edge_;
};

// The flat vertices inside a facet. Left out are those too near to a chamfer and, with a clearance,
// those too near to the boundary or to each other.
class IsolatedVertices {
 public:
  IsolatedVertices(const KeptSurface& surface, const Cuts& cuts, const ChamferResult& result,
                   double clearance)
      : surface_(surface),
        topology_(surface.topology()),
        cuts_(cuts),
        result_(result),
        clearance_(clearance),
        boundary_(surface),
        flat_of_facet_(topology_.facet_triangles.size()) {
    std::vector<std::uint8_t> has_constraint(surface.vertex_count());
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (topology_.edge_is_flat[e]) continue;
      for (VertexId v : topology_.edge_vertices(e)) has_constraint[v] = 1;
    }
    for (VertexId v = 0; v < surface.vertex_count(); ++v) {
      const std::uint32_t h = topology_.vertex_half_edge[v];
      if (h == kNone || has_constraint[v]) continue;
      flat_of_facet_[topology_.facet_of_half_edge(h)].push_back(v);
    }
  }

  std::vector<VertexId> of_facet(FacetId f) {
    std::vector<VertexId> result;
    if (flat_of_facet_[f].empty()) return result;
    find_influences(f);
    for (VertexId v : flat_of_facet_[f]) {
      if (!near_chamfer(v) && !near_boundary(f, v)) result.push_back(v);
    }
    if (clearance_ > 0) keep_clearance(result);
    return result;
  }

 private:
  // A chamfer or strip of size r keeps free a zone of that much more, so that no feature is much
  // smaller than the chamfer itself.
  static constexpr double kFreeZone = 1.5;

  struct Influence {
    Vec3 a, b;  // segment; a == b for a vertex
    double radius;
  };

  void find_influences(FacetId f) {
    influences_.clear();
    std::vector<Box> boxes;
    const auto add = [&](const Vec3& a, const Vec3& b, double radius) {
      if (!(radius > 0)) return;
      const std::array<Vec3, 2> ends = {a, b};
      Box box = Box::around(ends);
      for (int i = 0; i < 3; ++i) {
        box.lo[i] -= radius;
        box.hi[i] += radius;
      }
      influences_.push_back({a, b, radius});
      boxes.push_back(box);
    };
    for (std::uint32_t c = surface_.first_corner(f); c < surface_.first_corner(f + 1); ++c) {
      const Corner& corner = surface_.corners()[c];
      const Vec3& p = surface_.position(corner.vertex);
      add(p, p, kFreeZone * surface_.scale() * result_.vertex_radius[corner.vertex]);
      add(p, surface_.position(topology_.to(corner.outgoing)),
          kFreeZone * cuts_.height[corner.outgoing]);
    }
    tree_ = ShrinkingBoxTree(boxes);
  }

  bool near_chamfer(VertexId v) const {
    const Vec3& p = surface_.position(v);
    bool near = false;
    const std::array<Vec3, 1> query = {p};
    tree_.for_each_within(Box::around(query), 0, [&](std::uint32_t i) {
      const Influence& zone = influences_[i];
      const double there = closest_on_segment(p, zone.a, zone.b).squared_distance;
      near = near || there < zone.radius * zone.radius;
    });
    return near;
  }

  bool near_boundary(FacetId f, VertexId v) {
    return clearance_ > 0 && boundary_.from_point(f, surface_.position(v)) < clearance_;
  }

  // Among vertices closer than the clearance, the one with the smallest id stays.
  void keep_clearance(std::vector<VertexId>& vertices) const {
    std::vector<Box> boxes;
    for (VertexId v : vertices) {
      const std::array<Vec3, 1> point = {surface_.position(v)};
      boxes.push_back(Box::around(point));
    }
    const ShrinkingBoxTree tree(boxes);
    std::vector<std::uint8_t> dropped(vertices.size());
    std::vector<VertexId> stay;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      tree.for_each_within(boxes[i], clearance_ * clearance_, [&](std::uint32_t j) {
        if (j < i && !dropped[j]) dropped[i] = 1;
      });
      if (!dropped[i]) stay.push_back(vertices[i]);
    }
    vertices = std::move(stay);
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Cuts& cuts_;
  const ChamferResult& result_;
  double clearance_;
  BoundaryDistance boundary_;
  std::vector<std::vector<VertexId>> flat_of_facet_;
  std::vector<Influence> influences_;
  ShrinkingBoxTree tree_;
};

}  // namespace

void assemble_plc(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                  const Bridges& bridges, const std::vector<std::uint8_t>& active,
                  double isolated_clearance, ChamferResult& result) {
  Assembler assembler(surface, acute, bridges, result.plc);
  const auto facet_count = static_cast<FacetId>(surface.topology().facet_triangles.size());
  result.plc_facet.assign(facet_count, kNone);
  for (FacetId f = 0; f < facet_count; ++f) {
    if (!surface.facet_is_kept(f)) continue;
    bool wanted = active.empty();
    for (std::uint32_t c = surface.first_corner(f); c < surface.first_corner(f + 1); ++c) {
      wanted = wanted || active[surface.corners()[c].vertex] != 0;
    }
    if (!wanted) continue;
    result.plc_facet[f] = static_cast<std::uint32_t>(result.plc.facets.size());
    result.plc.facets.push_back(assembler.facet(f));
  }
  if (!active.empty()) return;
  IsolatedVertices isolated(surface, cuts, result, isolated_clearance * surface.scale());
  for (PlcFacet& facet : result.plc.facets) facet.isolated = isolated.of_facet(facet.input_facet);
}

}  // namespace delmesher::chamfer
