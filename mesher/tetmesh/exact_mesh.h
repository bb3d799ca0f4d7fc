// A mesh whose vertices move to new points of the store, and get others beside them: exactly within
// the facets and edges of the surface that they are on.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesher/surface/facet_locator.h"
#include "mesher/surface/topology.h"
#include "mesher/tetmesh/placed_mesh.h"

namespace delmesher::tetmesh {

class ExactMesh : public PlacedMesh {
 public:
  const PointStore& points() const { return points_; }
  // Of a vertex within a facet.
  FacetId facet(VertexId v) const { return facet_[v]; }

  // How many vertices there are more than at the beginning.
  std::int64_t vertices_gained() const { return gained_; }

  // --- places
  // The point of a place is the last of the store, until it is forgotten, a vertex is moved to it,
  // or it becomes a vertex whose star replaces tetrahedra.
  void forget(const Place& place);
  // Where v goes if it moves by `offset`, within about `tolerance`; and any place in the volume.
  Place moved(VertexId v, const Vec3& offset, double tolerance);
  Place new_place(const Vec3& x, double tolerance);
  // Places near x, in a facet and on an edge of the surface. Without a surface there are none.
  bool has_places_on_surface() const { return surface_ != nullptr; }
  Place place_in_facet(FacetId facet, const Vec3& x, double tolerance);
  Place place_on_input_edge(std::uint32_t edge, const Vec3& x, double tolerance);
  // The edge of the surface that the edge a-b between two of its facets is a piece of; kNone where
  // its points are given by two parameters.
  std::uint32_t input_edge_of(VertexId a, VertexId b) const;
  // Near x, on what is to become an edge of the surface, in the planes of both of its ends; and
  // near v, in the plane of a triangle of its facet.
  Place place_on_edge(const std::array<VertexId, 2>& end, const Vec3& x, double tolerance);
  Place place_in_triangle(VertexId v, const std::array<VertexId, 3>& corners, double tolerance);

  // --- changes
  void contract(VertexId v, VertexId w, std::span<const TetId> star);
  void move(VertexId v, const Place& place, std::span<const TetId> star);
  // v was in a facet, where there is an edge of the surface now.
  void move_to_edge(VertexId v, const Place& place, std::span<const TetId> star);
  // `created` and `faces` have kNone where the new vertex is: in the volume, or in this facet or on
  // an edge of it. `faces`: those at it, on the surface.
  void insert(const Place& place, std::span<const TetId> removed, std::span<CreatedTet> created) {
    insert_on_surface(place, Mobility::free, kNone, removed, created, {});
  }
  void insert_on_surface(const Place& place, Mobility mobility, FacetId facet,
                         std::span<const TetId> removed, std::span<CreatedTet> created,
                         std::span<SurfaceFace> faces);
  // Several in the volume at once: kNone - n in `created` is the n-th. `faces`: on the surface, of
  // vertices that are there already.
  void insert_in_volume(std::span<const Place> places, std::span<const TetId> removed,
                        std::span<CreatedTet> created, std::span<const SurfaceFace> faces);

 protected:
  // `surface`: null if no vertex of it may move. `given`: its vertices as given, where it is
  // planarized; else empty. `as_given`: changes are positive with these vertices, too. Arguments
  // passed by reference or pointer must outlive the mesh.
  ExactMesh(NumberedMesh numbered, const SurfaceTopology* surface, std::span<const Vec3> given,
            bool as_given, PointStore& points, Predicates& predicates);
  ~ExactMesh() = default;

  void put_at(VertexId v, const Place& place);

 private:
  // The points with the vertices of the surface as given, by the same numbers.
  struct GivenPoints {
    PointStore points;
    Predicates predicates{points};
  };

  void find_mobility();
  bool is_on_free_edge(VertexId v) const;
  VertexId add_vertex(const Place& place, Mobility mobility, FacetId facet);
  void replace_swallowing(std::span<const TetId> removed, std::span<const CreatedTet> created,
                          std::span<const SurfaceFace> faces);
  Place place_of(const PointDefinition& d, std::span<const PlaneId> planes,
                 std::span<const std::uint32_t> lines);

  PointStore& points_;
  const SurfaceTopology* surface_;
  std::span<const Vec3> given_;
  std::unique_ptr<GivenPoints> as_given_;  // null: nobody asks
  std::size_t first_new_;                  // point of the store
  std::optional<FacetLocator> locator_;
  std::vector<FacetId> facet_;  // per vertex: if in_plane
  std::vector<VertexId> swallowed_;
  std::int64_t gained_ = 0;
};

}  // namespace delmesher::tetmesh
