#include "mesher/improve/state.h"

#include <algorithm>
#include <iterator>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/geometry/placement.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/surface/given_place.h"

namespace delmesher::improve {

State::State(MeshTopology tetrahedra, std::vector<VertexId> point, const SurfaceTopology* topology,
             std::span<const Vec3> given, PointStore& points, Predicates& predicates,
             const Goals& goals)
    : mesh(std::move(tetrahedra)),
      points_(points),
      predicates_(predicates),
      topology_(topology),
      given_(given),
      goals_(goals),
      first_new_(points.size()),
      point_(std::move(point)),
      mobility_(point_.size(), Mobility::free),
      facet_(point_.size(), kNone),
      changed_at_(point_.size(), 0) {
  measure_by(Measure::shape);
  if (topology != nullptr) locator_.emplace(*topology, points);
  PointStore scratch;
  position_.reserve(point_.size());
  for (const VertexId p : point_) position_.push_back(given_place(points, p, given, scratch));
  if (goals.as_given && !given.empty()) {
    as_given_ = std::make_unique<GivenPoints>();
    append_as_given(points, given, as_given_->points);
  }
  find_mobility();
  quality_.resize(mesh.slots());
  for (TetId t = 0; t < mesh.slots(); ++t) measure(t);
}

void State::measure_by(Measure measure) {
  // Better than every value that counts, so that what is not measured is never the worst.
  constexpr float kIgnored = 1e30F;
  // However flat, tetrahedra are not to lose all of their volume.
  constexpr float kLeastGamma = 0.01F;
  measure_ = measure;
  target_ = goals_.target;
  per_target_ = {1 / target_.dihedral, 1 / target_.face, 1 / target_.gamma};
  least_score_ = least_gamma_ = 0;
  if (measure == Measure::shape) return;
  least_score_ = kMended;
  least_gamma_ = kLeastGamma;
  target_.gamma = 0;
  per_target_.gamma = kIgnored;
  target_.face = 0;
  per_target_.face = kIgnored;
}

// A Steiner point of the surface is on a segment or on a triangle; explicit points there are of the
// input. A point on an edge that is given by two parameters (SplitTarget::low) stays where it is.
void State::find_mobility() {
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
        } else if (points_.is_corner(point_[v]) || topology_ == nullptr) {
          m = Mobility::fixed;
        } else if (facet_[v] == kNone) {
          m = Mobility::in_plane;
          facet_[v] = facet;
        } else if (facet_[v] != facet) {
          const bool on_edge = points_.definition(point_[v]).kind == PointKind::on_segment;
          m = on_edge ? Mobility::on_line : Mobility::fixed;
        }
      }
    }
  }
}

void State::measure(TetId t) {
  quality_[t] = counts(t) ? quality_of(mesh.tet(t)) : kNotCounted;
}

Quality State::worst_of(std::span<const TetId> tets) const {
  Quality worst = kNotCounted;
  for (const TetId t : tets) worst = worse(worst, quality_[t]);
  return worst;
}

bool State::is_positive(const Tet& t) {
  return is_positive_with(t, 0, {point_[t[0]], position_[t[0]]});
}

bool State::is_positive_with(const Tet& t, int i, const Place& place) {
  const auto point = [&](int k) { return k == i ? place.point : point_[t[k]]; };
  const auto at = [&](int k) -> const Vec3& { return k == i ? place.position : position_[t[k]]; };
  const auto is_positive_by = [&](Predicates& predicates) {
    return predicates.orient3d(point(0), point(1), point(2), point(3)) > 0;
  };
  return is_positive_by(predicates_) && orient3d_sign(at(0), at(1), at(2), at(3)) > 0 &&
         (!as_given_ || is_positive_by(as_given_->predicates));
}

void State::note(TetId t) {
  measure(t);
  note_change(t);
}

void State::note_change(TetId t) {
  for (const VertexId v : mesh.tet(t)) changed_at_[v] = clock_;
}

bool State::accept(const Change& change) {
  for (const CreatedTet& tet : change.created) {
    if (!is_positive(tet.vertices)) return false;
  }
  replace(change.removed, change.created, change.faces);
  return true;
}

void State::replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
                    std::span<const SurfaceFace> faces) {
  ++clock_;
  mesh.replace(removed, created, faces);
  quality_.resize(mesh.slots());
  for (const TetId t : mesh.created()) note(t);
}

void State::contract(VertexId v, VertexId w, std::span<const TetId> star) {
  ++clock_;
  --gained_;
  mesh.contract(v, w, star);
  for (const TetId t : star) {
    if (mesh.alive(t)) note(t);
  }
}

Place State::moved(VertexId v, const Vec3& offset, double tolerance) {
  const VertexId p = point_[v];
  const Vec3 target = add(points_.nearest(p), offset);
  if (mobility_[v] == Mobility::free) return new_place(target, tolerance);
  DELMESHER_CHECK(mobility_[v] != Mobility::fixed, "a fixed vertex is to move");
  PointDefinition d = points_.definition(p);
  if (mobility_[v] == Mobility::on_line) {
    d = place_on_segment(points_, d.corner[0], d.corner[1], target, tolerance);
  } else {
    const auto& corner = topology_->triangles[locator_->triangle_at(facet_[v], target)];
    d = place_on_triangle(points_, corner[0], corner[1], corner[2], target, tolerance);
  }
  const std::vector<PlaneId> planes(points_.planes(p).begin(), points_.planes(p).end());
  const std::vector<std::uint32_t> lines(points_.lines(p).begin(), points_.lines(p).end());
  return place_of(d, planes, lines);
}

Place State::place_of(const PointDefinition& d, std::span<const PlaneId> planes,
                      std::span<const std::uint32_t> lines) {
  const VertexId v = points_.add(d);
  points_.set_supports(v, planes, lines);
  if (as_given_) as_given_->points.add(d);
  PointStore scratch;
  return {v, given_place(points_, v, given_, scratch)};
}

Place State::place_on_edge(const std::array<VertexId, 2>& end, const Vec3& x, double tolerance) {
  std::vector<PlaneId> planes;
  std::ranges::set_intersection(points_.planes(end[0]), points_.planes(end[1]),
                                std::back_inserter(planes));
  return place_of(place_on_segment(points_, end[0], end[1], x, tolerance), planes, {});
}

Place State::place_in_triangle(VertexId v, const std::array<VertexId, 3>& corners,
                               double tolerance) {
  const VertexId p = point_[v];
  const std::vector<PlaneId> planes(points_.planes(p).begin(), points_.planes(p).end());
  return place_of(
      place_on_triangle(points_, corners[0], corners[1], corners[2], points_.nearest(p), tolerance),
      planes, {});
}

Place State::place_in_facet(FacetId facet, const Vec3& x, double tolerance) {
  const auto& corner = topology_->triangles[locator_->triangle_at(facet, x)];
  const PlaneId plane = topology_->facet_plane[facet];
  return place_of(place_on_triangle(points_, corner[0], corner[1], corner[2], x, tolerance),
                  {&plane, 1}, {});
}

Place State::place_on_input_edge(std::uint32_t edge, const Vec3& x, double tolerance) {
  const std::array<VertexId, 2> end = topology_->edge_vertices(edge);
  return place_of(place_on_segment(points_, end[0], end[1], x, tolerance),
                  topology_->edge_planes(edge), {&edge, 1});
}

std::uint32_t State::input_edge_of(VertexId a, VertexId b) const {
  std::array<VertexId, 2> end = {point_[a], point_[b]};
  for (const VertexId p : {point_[a], point_[b]}) {
    if (points_.is_corner(p)) continue;
    const PointDefinition d = points_.definition(p);
    if (d.kind != PointKind::on_segment) return kNone;
    end = {d.corner[0], d.corner[1]};
  }
  return edge_between(*topology_, end[0], end[1]);
}

void State::move_to_edge(VertexId v, const Place& place, std::span<const TetId> star) {
  mobility_[v] = Mobility::on_line;
  move(v, place, star);
}

Place State::new_place(const Vec3& x, double tolerance) {
  const Vec3 at = snap_to_grid(x, tolerance);
  if (as_given_) as_given_->points.add_explicit(at[0], at[1], at[2]);
  return {points_.add_explicit(at[0], at[1], at[2]), at};
}

void State::forget(const Place& place) {
  DELMESHER_CHECK(place.point + 1 == points_.size(),
                  "a point is to be forgotten that is not the last one");
  points_.pop_back();
  if (as_given_) as_given_->points.pop_back();
}

void State::move(VertexId v, const Place& place, std::span<const TetId> star) {
  put_at(v, place);
  for (const TetId t : star) note(t);
}

void State::move(VertexId v, const Place& place, std::span<const TetId> star,
                 std::span<const Quality> quality) {
  put_at(v, place);
  for (std::size_t n = 0; n < star.size(); ++n) {
    quality_[star[n]] = quality[n];
    note_change(star[n]);
  }
}

void State::put_at(VertexId v, const Place& place) {
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

VertexId State::add_vertex(const Place& place, Mobility mobility, FacetId facet) {
  ++gained_;
  point_.push_back(place.point);
  position_.push_back(place.position);
  mobility_.push_back(mobility);
  facet_.push_back(facet);
  changed_at_.push_back(clock_);
  return mesh.add_vertex();
}

// The new vertex takes the place of kNone.
void State::put_in(const Place& place, Mobility mobility, FacetId facet,
                   std::span<const TetId> removed, std::span<CreatedTet> created,
                   std::span<SurfaceFace> faces) {
  const VertexId v = add_vertex(place, mobility, facet);
  for (CreatedTet& tet : created) {
    std::replace(tet.vertices.begin(), tet.vertices.end(), kNone, v);
  }
  for (SurfaceFace& face : faces) {
    std::replace(face.vertices.begin(), face.vertices.end(), kNone, v);
  }
  swallowed_.clear();
  for (const TetId t : removed) {
    swallowed_.insert(swallowed_.end(), mesh.tet(t).begin(), mesh.tet(t).end());
  }
  sort_unique(swallowed_);
  replace(removed, created, faces);
  for (const VertexId w : swallowed_) gained_ -= mesh.incident(w) == kNone ? 1 : 0;
}

void State::insert_on_edge(const Place& place, std::span<const TetId> removed,
                           std::span<CreatedTet> created, std::span<SurfaceFace> faces) {
  put_in(place, Mobility::on_line, faces.front().facet, removed, created, faces);
}

void State::insert_on_surface(const Place& place, Mobility mobility, FacetId facet,
                              std::span<const TetId> removed, std::span<CreatedTet> created,
                              std::span<SurfaceFace> faces) {
  put_in(place, mobility, facet, removed, created, faces);
}

void State::insert(const Place& place, std::span<const TetId> removed,
                   std::span<CreatedTet> created) {
  put_in(place, Mobility::free, kNone, removed, created, {});
}

}  // namespace delmesher::improve
