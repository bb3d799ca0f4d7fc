#include "mesher/tetmesh/exact_mesh.h"

#include <algorithm>
#include <iterator>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/geometry/placement.h"
#include "mesher/geometry/vector.h"
#include "mesher/surface/given_place.h"

namespace delmesher::tetmesh {

ExactMesh::ExactMesh(NumberedMesh numbered, const SurfaceTopology* surface,
                     std::span<const Vec3> given, bool as_given, PointStore& points,
                     Predicates& predicates)
    : PlacedMesh(std::move(numbered)),
      points_(points),
      surface_(surface),
      given_(given),
      first_new_(points.size()),
      facet_(point_.size(), kNone) {
  if (surface != nullptr) locator_.emplace(*surface, points);
  PointStore scratch;
  position_.reserve(point_.size());
  for (const VertexId p : point_) position_.push_back(given_place(points, p, given, scratch));
  exact_.push_back(&predicates);
  if (as_given && !given.empty()) {
    as_given_ = std::make_unique<GivenPoints>();
    append_as_given(points, given, as_given_->points);
    exact_.push_back(&as_given_->predicates);
  }
  find_mobility();
}

// A Steiner point of the surface is on a segment or on a triangle; explicit points there are of the
// input. A point on an edge that is given by two parameters (SplitTarget::low) stays where it is,
// and so does a vertex of the input in the volume.
void ExactMesh::find_mobility() {
  if (surface_ != nullptr) {
    for (VertexId v = 0; v < point_.size(); ++v) {
      const bool is_given = point_[v] < surface_->vertex_half_edge.size();
      if (is_given && surface_->vertex_half_edge[point_[v]] == kNone)
        mobility_[v] = Mobility::fixed;
    }
  }
  for (TetId t = 0; t < mesh.slots(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const FacetId facet = mesh.facet(t, i);
      const bool hull = mesh.neighbor(t, i) == kNone;
      if (facet == kNone && !hull) continue;
      for (const int k : kFace[i]) {
        const VertexId v = mesh.tet(t)[k];
        Mobility& m = mobility_[v];
        if (facet == kNone) {
          if (m == Mobility::free) m = Mobility::fixed;  // unless it is on the surface, too
        } else if (points_.is_corner(point_[v]) || surface_ == nullptr) {
          m = Mobility::fixed;
        } else if (facet_[v] == kNone) {
          m = is_on_free_edge(v) ? Mobility::on_line : Mobility::in_plane;
          facet_[v] = facet;
        } else if (facet_[v] != facet) {
          const bool on_edge = points_.definition(point_[v]).kind == PointKind::on_segment;
          m = on_edge ? Mobility::on_line : Mobility::fixed;
        }
      }
    }
  }
}

bool ExactMesh::is_on_free_edge(VertexId v) const {
  const PointDefinition d = points_.definition(point_[v]);
  if (surface_->outgoing.empty() || d.kind != PointKind::on_segment) return false;
  const std::uint32_t edge = edge_between(*surface_, d.corner[0], d.corner[1]);
  return edge != kNone && surface_->is_free(edge);
}

void ExactMesh::contract(VertexId v, VertexId w, std::span<const TetId> star) {
  --gained_;
  PlacedMesh::contract(v, w, star);
}

Place ExactMesh::moved(VertexId v, const Vec3& offset, double tolerance) {
  const VertexId p = point_[v];
  const Vec3 target = geometry::add(points_.nearest(p), offset);
  if (mobility_[v] == Mobility::free) return new_place(target, tolerance);
  DELMESHER_CHECK(mobility_[v] != Mobility::fixed, "a fixed vertex is to move");
  PointDefinition d = points_.definition(p);
  if (mobility_[v] == Mobility::on_line) {
    d = place_on_segment(points_, d.corner[0], d.corner[1], target, tolerance);
  } else {
    const auto& corner = surface_->triangles[locator_->triangle_at(facet_[v], target)];
    d = place_on_triangle(points_, corner[0], corner[1], corner[2], target, tolerance);
  }
  const std::vector<PlaneId> planes(points_.planes(p).begin(), points_.planes(p).end());
  const std::vector<std::uint32_t> lines(points_.lines(p).begin(), points_.lines(p).end());
  return place_of(d, planes, lines);
}

Place ExactMesh::place_of(const PointDefinition& d, std::span<const PlaneId> planes,
                          std::span<const std::uint32_t> lines) {
  const VertexId v = points_.add(d);
  points_.set_supports(v, planes, lines);
  if (as_given_) as_given_->points.add(d);
  PointStore scratch;
  return {v, given_place(points_, v, given_, scratch)};
}

Place ExactMesh::place_on_edge(const std::array<VertexId, 2>& end, const Vec3& x,
                               double tolerance) {
  std::vector<PlaneId> planes;
  std::ranges::set_intersection(points_.planes(end[0]), points_.planes(end[1]),
                                std::back_inserter(planes));
  return place_of(place_on_segment(points_, end[0], end[1], x, tolerance), planes, {});
}

Place ExactMesh::place_in_triangle(VertexId v, const std::array<VertexId, 3>& corners,
                                   double tolerance) {
  const VertexId p = point_[v];
  const std::vector<PlaneId> planes(points_.planes(p).begin(), points_.planes(p).end());
  return place_of(
      place_on_triangle(points_, corners[0], corners[1], corners[2], points_.nearest(p), tolerance),
      planes, {});
}

Place ExactMesh::place_in_facet(FacetId facet, const Vec3& x, double tolerance) {
  const auto& corner = surface_->triangles[locator_->triangle_at(facet, x)];
  const PlaneId plane = surface_->facet_plane[facet];
  return place_of(place_on_triangle(points_, corner[0], corner[1], corner[2], x, tolerance),
                  {&plane, 1}, {});
}

Place ExactMesh::place_on_input_edge(std::uint32_t edge, const Vec3& x, double tolerance) {
  const std::array<VertexId, 2> end = surface_->edge_vertices(edge);
  return place_of(place_on_segment(points_, end[0], end[1], x, tolerance),
                  surface_->edge_planes(edge), {&edge, 1});
}

std::uint32_t ExactMesh::input_edge_of(VertexId a, VertexId b) const {
  std::array<VertexId, 2> end = {point_[a], point_[b]};
  for (const VertexId p : {point_[a], point_[b]}) {
    if (points_.is_corner(p)) continue;
    const PointDefinition d = points_.definition(p);
    if (d.kind != PointKind::on_segment) return kNone;
    end = {d.corner[0], d.corner[1]};
  }
  return edge_between(*surface_, end[0], end[1]);
}

void ExactMesh::move_to_edge(VertexId v, const Place& place, std::span<const TetId> star) {
  mobility_[v] = Mobility::on_line;
  move(v, place, star);
}

Place ExactMesh::new_place(const Vec3& x, double tolerance) {
  const Vec3 at = snap_to_grid(x, tolerance);
  if (as_given_) as_given_->points.add_explicit(at[0], at[1], at[2]);
  return {points_.add_explicit(at[0], at[1], at[2]), at};
}

void ExactMesh::forget(const Place& place) {
  DELMESHER_CHECK(place.point + 1 == points_.size(),
                  "a point is to be forgotten that is not the last one");
  points_.pop_back();
  if (as_given_) as_given_->points.pop_back();
}

void ExactMesh::move(VertexId v, const Place& place, std::span<const TetId> star) {
  put_at(v, place);
  for (const TetId t : star) changed(t);
}

void ExactMesh::put_at(VertexId v, const Place& place) {
  ++clock_;
  if (mobility_[v] == Mobility::free && point_[v] >= first_new_) {
    // Nobody else has seen where it was.
    forget(place);
    points_.move_explicit(point_[v], place.position);
    if (as_given_) as_given_->points.move_explicit(point_[v], place.position);
  } else {
    point_[v] = place.point;
  }
  position_[v] = place.position;
}

VertexId ExactMesh::add_vertex(const Place& place, Mobility mobility, FacetId facet) {
  ++gained_;
  point_.push_back(place.point);
  position_.push_back(place.position);
  mobility_.push_back(mobility);
  facet_.push_back(facet);
  changed_at_.push_back(clock_);
  return mesh.add_vertex();
}

// Some vertices may have no tetrahedra any more.
void ExactMesh::replace_swallowing(std::span<const TetId> removed,
                                   std::span<const CreatedTet> created,
                                   std::span<const SurfaceFace> faces) {
  swallowed_.clear();
  for (const TetId t : removed) {
    swallowed_.insert(swallowed_.end(), mesh.tet(t).begin(), mesh.tet(t).end());
  }
  sort_unique(swallowed_);
  replace(removed, created, faces);
  for (const VertexId w : swallowed_) gained_ -= mesh.incident(w) == kNone ? 1 : 0;
}

// The new vertex takes the place of kNone.
void ExactMesh::insert_on_surface(const Place& place, Mobility mobility, FacetId facet,
                                  std::span<const TetId> removed, std::span<CreatedTet> created,
                                  std::span<SurfaceFace> faces) {
  const VertexId v = add_vertex(place, mobility, facet);
  for (CreatedTet& tet : created) {
    std::replace(tet.vertices.begin(), tet.vertices.end(), kNone, v);
  }
  for (SurfaceFace& face : faces) {
    std::replace(face.vertices.begin(), face.vertices.end(), kNone, v);
  }
  replace_swallowing(removed, created, faces);
}

void ExactMesh::insert_in_volume(std::span<const Place> places, std::span<const TetId> removed,
                                 std::span<CreatedTet> created,
                                 std::span<const SurfaceFace> faces) {
  VertexId name = kNone;
  for (const Place& place : places) {
    const VertexId v = add_vertex(place, Mobility::free, kNone);
    for (CreatedTet& tet : created) {
      std::replace(tet.vertices.begin(), tet.vertices.end(), name, v);
    }
    --name;
  }
  replace_swallowing(removed, created, faces);
}

}  // namespace delmesher::tetmesh
