#include "mesher/improve/diagonals.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "mesher/base/sort_unique.h"
#include "mesher/improve/edge_removal.h"
#include "mesher/improve/smoothing.h"
#include "mesher/improve/state.h"
#include "mesher/surface/facet_locator.h"
#include "mesher/tetmesh/insert_point.h"
#include "mesher/tetmesh/numbering.h"

namespace delmesher::improve {
namespace {

// Which input vertices are corners of a facet.
class FacetCorners {
 public:
  explicit FacetCorners(const SurfaceTopology& topology)
      : topology_(topology), corners_(topology.facet_triangles.size()) {}

  // Is a Steiner point of the surface given by corners of this facet, so that it is in its plane
  // wherever these are?
  bool have(const PointDefinition& d, FacetId facet) {
    std::vector<VertexId>& corners = corners_[facet];
    if (corners.empty()) {
      for (const std::uint32_t t : topology_.facet_triangles[facet]) {
        corners.insert(corners.end(), topology_.triangles[t].begin(), topology_.triangles[t].end());
      }
      sort_unique(corners);
    }
    return std::ranges::all_of(d.corner, [&](VertexId corner) {
      return corner == kNone || std::ranges::binary_search(corners, corner);
    });
  }

 private:
  const SurfaceTopology& topology_;
  std::vector<std::vector<VertexId>> corners_;  // ascending; empty until somebody asks
};

struct Diagonal {
  std::array<VertexId, 2> end;  // of the surface
  FacetId facet;                // of the planarized surface
  std::uint32_t edge;           // of the surface as given
};

// A facet's edge across a diagonal, and the third vertices of its two faces there.
struct Crossing {
  std::array<VertexId, 2> end;
  VertexId before, after;
};

class Entry {
  // Tells whether the point of a crossing sees a face.
  struct Judge {
    using Value = bool;
    State& state;
    const Place& place;

    static bool in_plane() { return true; }
    bool value_of(TetId t, int i) const {
      return state.is_positive_with(state.mesh.tet(t), i, place);
    }
  };
  using Cavity = InsertPoint<Judge>;

 public:
  Entry(State& state, std::span<const VertexId> number, const SurfaceTopology& planarized,
        const SurfaceTopology& as_given, Predicates& predicates, Control& control)
      : state_(state),
        number_(number),
        planarized_(planarized),
        as_given_(as_given),
        predicates_(predicates),
        control_(control),
        edges_(state),
        smoothing_(state),
        move_(state),
        corners_(as_given),
        stays_(as_given.edge_count(), 0),
        cavity_(state.mesh) {}

  // The short ones first: they are in the way of fewer others' repairs. Sheets outside of all
  // regions have no faces, and so no diagonals.
  std::vector<Diagonal> diagonals(std::span<const std::uint8_t> facet_has_faces) const {
    std::vector<std::pair<double, Diagonal>> sorted;
    for (std::uint32_t e = 0; e < as_given_.edge_count(); ++e) {
      const auto [h, g] = as_given_.edge_half_edges(e);
      const FacetId facet = planarized_.facet_of_half_edge(h);
      if (as_given_.edge_is_flat[e] != 0 || facet != planarized_.facet_of_half_edge(g)) continue;
      if (facet_has_faces[facet] == 0) continue;
      const std::array<VertexId, 2> end = as_given_.edge_vertices(e);
      sorted.emplace_back(
          distance(state_.points().nearest(end[0]), state_.points().nearest(end[1])),
          Diagonal{end, facet, e});
    }
    std::ranges::stable_sort(sorted, {}, [](const auto& item) { return item.first; });
    std::vector<Diagonal> result;
    for (const auto& [length, diagonal] : sorted) result.push_back(diagonal);
    return result;
  }

  // False if it cannot be done.
  bool enter(const Diagonal& diagonal) {
    diagonal_ = diagonal;
    stays_[diagonal.edge] = 1;
    axis_ = planarized_.facet_axis[diagonal.facet];
    to_ = number_[diagonal.end[1]];
    VertexId at = number_[diagonal.end[0]];
    int rooms = 8;  // at most: a point of the facet that moves may make a crossing more
    bool made_room = false;
    while (at != to_) {
      control_.poll();
      const VertexId next = neighbour_on_diagonal(at);
      if (next != kNone) {
        if (!is_on_diagonal(next) && !snap(next)) return false;
        at = next;
        made_room = false;
      } else if (find_crossings(at) && uncross(at)) {
        made_room = false;
      } else if (made_room || rooms-- == 0 || !make_room()) {
        return false;
      } else {
        made_room = true;
      }
    }
    return true;
  }

  // Places Steiner points of facets anew that are given by a triangle of another facet as given.
  // False if there is no room for one.
  bool anchor_all() {
    FacetLocator locator(planarized_, state_.points());
    for (VertexId v = 0; v < state_.mesh.vertices(); ++v) {
      control_.poll();
      if (state_.mobility(v) != Mobility::in_plane || state_.mesh.incident(v) == kNone) continue;
      if (!anchor(v, locator)) return false;
    }
    return true;
  }

 private:
  int side(VertexId a, VertexId b, VertexId c) {
    return predicates_.orient2d(axis_, state_.point(a), state_.point(b), state_.point(c));
  }
  // A point of the segment itself, not just near it.
  bool is_on_diagonal(VertexId v) const {
    if (v == to_) return true;
    const PointDefinition d = state_.points().definition(state_.point(v));
    if (d.kind != PointKind::on_segment) return false;
    const auto [p, q] = diagonal_.end;
    return (d.corner[0] == p && d.corner[1] == q) || (d.corner[0] == q && d.corner[1] == p);
  }

  // The faces of the facet at a vertex, as its other two vertices, counter-clockwise.
  std::vector<std::array<VertexId, 2>> faces_at(VertexId v) {
    std::vector<std::array<VertexId, 2>> faces;
    const MeshTopology& mesh = state_.mesh;
    mesh.star(v, star_);
    for (const TetId t : star_) {
      for (int k = 0; k < 4; ++k) {
        if (mesh.facet(t, k) != diagonal_.facet || mesh.tet(t)[k] == v ||
            !mesh.is_told_from(t, k)) {
          continue;
        }
        std::array<VertexId, 2> other{};
        int n = 0;
        for (const int j : kFace[k]) {
          if (mesh.tet(t)[j] != v) other[n++] = mesh.tet(t)[j];
        }
        if (side(v, other[0], other[1]) < 0) std::swap(other[0], other[1]);
        faces.push_back(other);
      }
    }
    return faces;
  }
  // The vertex that an edge of the facet joins to `at`, on the diagonal; kNone if there is none.
  VertexId neighbour_on_diagonal(VertexId at) {
    faces_ = faces_at(at);
    for (const auto& face : faces_) {
      for (const VertexId v : face) {
        if (v == to_) return v;
        if (side(at, to_, v) == 0 &&
            predicates_.dot_difference_sign(state_.point(at), state_.point(v), state_.point(at),
                                            state_.point(to_)) > 0) {
          return v;
        }
      }
    }
    return kNone;
  }
  // The edges between `at` and the next vertex on the diagonal. False if there are none.
  bool find_crossings(VertexId at) {
    const auto first = std::ranges::find_if(faces_, [&](const auto& face) {
      return side(at, face[0], to_) > 0 && side(at, to_, face[1]) > 0;
    });
    crossings_.clear();
    if (first == faces_.end()) return false;
    auto [right, left] = *first;
    VertexId before = at;
    while (true) {
      const VertexId after = beyond(right, left, before);
      if (after == kNone) return false;
      crossings_.push_back({{right, left}, before, after});
      const int s = after == to_ ? 0 : side(at, to_, after);
      if (s == 0) return true;
      VertexId& replaced = s > 0 ? left : right;
      before = replaced;
      replaced = after;
    }
  }
  VertexId beyond(VertexId x, VertexId y, VertexId before) {
    for (const auto& [v, w] : faces_at(x)) {
      const VertexId other = v == y ? w : w == y ? v : kNone;
      if (other != kNone && other != before) return other;
    }
    return kNone;
  }

  // Leaves a crossing less. False if that cannot be.
  bool uncross(VertexId at) { return flip_one(at) || snap_one() || split_one(); }

  // Moves vertices to where the tetrahedra are thicker at the edges across. False if none moves.
  bool make_room() {
    std::vector<VertexId> mobile;
    for (const Crossing& c : crossings_) {
      find_ring(c.end);
      for (const TetId t : ring_) {
        std::ranges::copy_if(state_.mesh.tet(t), std::back_inserter(mobile),
                             [&](VertexId v) { return state_.mobility(v) != Mobility::fixed; });
      }
    }
    sort_unique(mobile);
    bool any = false;
    for (const VertexId v : mobile) any = smoothing_.improve_worst(v) || any;
    return any;
  }
  // The tetrahedra at an edge.
  void find_ring(const std::array<VertexId, 2>& edge) {
    ring_.clear();
    state_.mesh.star(edge[0], star_);
    std::ranges::copy_if(star_, std::back_inserter(ring_),
                         [&](TetId t) { return state_.mesh.index_of(t, edge[1]) >= 0; });
  }

  // Removes an edge whose two vertices beside it are not on different sides of the diagonal: what
  // replaces it does not cross that.
  bool flip_one(VertexId at) {
    return std::ranges::any_of(crossings_, [&](const Crossing& c) {
      if (side(at, to_, c.before) * side(at, to_, c.after) < 0) return false;
      find_ring(c.end);
      const TetId t = ring_.front();
      return edges_.flip(t, state_.mesh.index_of(t, c.end[0]), state_.mesh.index_of(t, c.end[1]));
    });
  }
  bool snap_one() {
    return std::ranges::any_of(crossings_,
                               [&](const Crossing& c) { return snap(c.end[0]) || snap(c.end[1]); });
  }
  // Moves a Steiner point of the facet onto the diagonal, unless that makes an edge too long.
  bool snap(VertexId v) {
    constexpr double kTolerance = 0x1p-10;  // of the shortest edge
    if (state_.mobility(v) != Mobility::in_plane) return false;
    move_.begin(v);
    const Place place =
        state_.place_on_edge(diagonal_.end, state_.position(v), move_.shortest_edge() * kTolerance);
    if (!move_.fits(place) || becomes_too_long(place)) {
      state_.forget(place);
      return false;
    }
    state_.move_to_edge(v, place, move_.star());
    return true;
  }
  // An edge at the vertex that moves.
  bool becomes_too_long(const Place& place) const {
    const VertexId v = move_.vertex();
    return std::ranges::any_of(move_.star(), [&](TetId t) {
      const RegionId region = state_.mesh.region(t);
      return std::ranges::any_of(state_.mesh.tet(t), [&](VertexId w) {
        const Vec3& end = state_.position(w);
        return w != v && state_.too_long(place.position, end, region) &&
               !state_.too_long(state_.position(v), end, region);
      });
    });
  }
  // Splits the edge in the middle, or the next one behind it that can be split, then those before
  // it.
  bool split_one() {
    const std::size_t n = crossings_.size();
    for (std::size_t k = 0; k < n; ++k) {
      if (split(crossings_[(n / 2 + k) % n])) return true;
    }
    return false;
  }
  // The new point is on the diagonal, and near the edge: within a smaller and smaller fraction of
  // it, until tetrahedra are thicker than that. Where the vertices that were moved take the edge
  // along, the crossing is elsewhere on the planarized surface than as given.
  bool split(const Crossing& c) {
    const double length = distance(state_.position(c.end[0]), state_.position(c.end[1]));
    const Vec3 on_planarized = crossing_point(
                   c, [&](VertexId v) { return state_.points().nearest(state_.point(v)); }),
               as_given = crossing_point(c, [&](VertexId v) { return state_.position(v); });
    for (double tolerance = 0x1p-10; tolerance > 0x1p-50; tolerance *= 0x1p-12) {
      for (const double share : {0.0, 1.0, 0.5}) {
        const Vec3 x = add_scaled(on_planarized, share, subtract(as_given, on_planarized));
        const Place place = state_.place_on_edge(diagonal_.end, x, length * tolerance);
        if (find_cavity(c, place)) {
          state_.insert_on_surface(place, Mobility::on_line, diagonal_.facet, cavity_.cavity(),
                                   cavity_.created(), cavity_.faces());
          return true;
        }
        state_.forget(place);
      }
    }
    return false;
  }
  // Where the diagonal crosses the edge, if `at` tells where vertices are; as a point of the
  // diagonal on the planarized surface.
  template <class At>
  Vec3 crossing_point(const Crossing& c, At&& at) const {
    const std::size_t i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    const VertexId p = number_[diagonal_.end[0]], q = number_[diagonal_.end[1]];
    const Vec3 a = at(p), b = at(q), x = at(c.end[0]), y = at(c.end[1]);
    const Vec3 u = subtract(b, a), v = subtract(y, x), w = subtract(x, a);
    double t = (w[i] * v[j] - w[j] * v[i]) / (u[i] * v[j] - u[j] * v[i]);
    if (!std::isfinite(t)) t = 0.5;  // in doubles they are parallel
    const Vec3 &from = state_.points().nearest(state_.point(p)),
               &to = state_.points().nearest(state_.point(q));
    return add_scaled(from, t, subtract(to, from));
  }

  // Does the point of a crossing fit into a cavity? That has the tetrahedra at the edge, and then
  // those beyond faces that cannot be seen from it, with the faces of the facet among theirs. False
  // if another face of the surface cannot be seen, if an edge or a vertex would go that stays, or
  // if they are too many.
  bool find_cavity(const Crossing& c, const Place& place) {
    find_ring(c.end);
    const Judge judge{state_, place};
    cavity_.begin({diagonal_.facet, kNone}, {kNone, kNone});
    for (const TetId t : ring_) cavity_.add(t, judge);
    const auto is_hidden = [&](const Cavity::Face& face) {
      const bool is_between =
          cavity_.is_own(face.tet, face.face) && state_.mesh.neighbor(face.tet, face.face) != kNone;
      return is_between || !face.value;
    };
    for (auto face = cavity_.skin().begin();
         (face = std::ranges::find_if(cavity_.skin(), is_hidden)) != cavity_.skin().end();) {
      if (!may_cross(*face, place)) return false;
      cavity_.add(state_.mesh.neighbor(face->tet, face->face), judge);
    }
    const auto is_free = [&](VertexId v) { return state_.mobility(v) == Mobility::free; };
    return cavity_.find_change(is_free) &&
           std::ranges::none_of(cavity_.inner(),
                                [&](const auto& e) {
                                  return !std::ranges::is_permutation(e.ends, c.end) &&
                                         stays(e.ends);
                                }) &&
           std::ranges::all_of(cavity_.outline(), [&](const auto& e) { return sees(e, place); });
  }
  bool may_cross(const Cavity::Face& face, const Place& place) const {
    constexpr std::size_t kMost = 32;
    const auto& [t, i, visible] = face;
    const TetId next = state_.mesh.neighbor(t, i);
    if (next == kNone || cavity_.cavity().size() >= kMost) return false;
    if (state_.mesh.facet(t, i) != kNone && !cavity_.is_own(t, i)) return false;
    const Vec3& apex = state_.position(state_.mesh.tet(next)[state_.mesh.mirror(t, i)]);
    return !state_.too_long(place.position, apex, state_.mesh.region(next));
  }
  // Is the point on that side of the edge where the face is that goes?
  bool sees(const Cavity::FaceEdge& edge, const Place& place) {
    const VertexId a = edge.ends[0], b = edge.ends[1];
    return side(a, b, state_.mesh.tet(edge.tet)[edge.corner]) *
               predicates_.orient2d(axis_, state_.point(a), state_.point(b), place.point) >
           0;
  }
  // Is it part of a diagonal that has come back?
  bool stays(const std::array<VertexId, 2>& edge) const {
    std::vector<VertexId> ends;
    for (const VertexId v : edge) {
      const PointDefinition d = state_.points().definition(state_.point(v));
      if (d.kind == PointKind::on_triangle) return false;
      if (d.kind != PointKind::on_segment) {
        ends.push_back(state_.point(v));
      } else {
        ends.insert(ends.end(), {d.corner[0], d.corner[1]});
      }
    }
    sort_unique(ends);
    if (ends.size() != 2) return false;
    const std::uint32_t e = edge_between(as_given_, ends[0], ends[1]);
    return e != kNone && stays_[e] != 0;
  }

  bool anchor(VertexId v, FacetLocator& locator) {
    constexpr double kTolerance = 0x1p-30;  // of the shortest edge
    move_.begin(v);
    const FacetId facet = state_.facet(v);
    const Vec3 place = state_.points().nearest(state_.point(v));
    const std::uint32_t triangle = locator.triangle_at(facet, place);
    const FacetId wanted = as_given_.facet_of[triangle];
    if (corners_.have(state_.points().definition(state_.point(v)), wanted)) return true;
    const Place anew = state_.place_in_triangle(v, as_given_.triangles[triangle],
                                                move_.shortest_edge() * kTolerance);
    if (move_.fits(anew)) {
      state_.move(v, anew, move_.star());
      return true;
    }
    state_.forget(anew);
    return false;
  }

  State& state_;
  std::span<const VertexId> number_;  // of points of the store in the mesh
  const SurfaceTopology& planarized_;
  const SurfaceTopology& as_given_;
  Predicates& predicates_;
  Control& control_;
  EdgeRemoval edges_;
  Smoothing smoothing_;
  MoveVertex move_;
  FacetCorners corners_;
  std::vector<std::uint8_t> stays_;  // per edge of the surface as given
  Diagonal diagonal_{};
  int axis_ = 0;
  VertexId to_ = 0;
  std::vector<std::array<VertexId, 2>> faces_;  // at the vertex that was reached
  std::vector<Crossing> crossings_;
  std::vector<TetId> star_, ring_;
  Cavity cavity_;
};

// Gives the faces of the surface, on points of the store, their facets of the surface as given.
class Handover {
 public:
  Handover(const SurfaceTopology& planarized, const SurfaceTopology& as_given,
           Predicates& predicates)
      : planarized_(planarized),
        as_given_(as_given),
        predicates_(predicates),
        points_(predicates.points()),
        locator_(planarized, points_),
        corners_(as_given) {}

  // A face lies in one triangle, since all edges between them are chains of edges. False if a
  // vertex of it is not of that facet.
  bool run(std::vector<SurfaceFace>& faces) {
    return std::ranges::all_of(faces, [&](SurfaceFace& face) {
      face.facet = as_given_.facet_of[triangle_of(face)];
      return std::ranges::all_of(face.vertices, [&](VertexId v) {
        return points_.is_corner(v) || corners_.have(points_.definition(v), face.facet);
      });
    });
  }

 private:
  std::uint32_t triangle_of(const SurfaceFace& face) {
    Vec3 middle{0, 0, 0};
    for (const VertexId v : face.vertices) {
      middle = add_scaled(middle, 1.0 / 3, points_.nearest(v));
    }
    const std::uint32_t guess = locator_.triangle_at(face.facet, middle);
    if (lies_in(face, guess)) return guess;
    const auto& all = planarized_.facet_triangles[face.facet];
    const auto found = std::ranges::find_if(all, [&](std::uint32_t t) { return lies_in(face, t); });
    // A vertex that another facet defines may be beside all of them.
    return found != all.end() ? *found : guess;
  }
  // In doubles the middle of a face of a sliver may be in another triangle.
  bool lies_in(const SurfaceFace& face, std::uint32_t triangle) {
    const int axis = planarized_.facet_axis[face.facet];
    const auto& corner = planarized_.triangles[triangle];
    const int turn = predicates_.orient2d(axis, corner[0], corner[1], corner[2]);
    return std::ranges::all_of(face.vertices, [&](VertexId v) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (predicates_.orient2d(axis, corner[k], corner[(k + 1) % 3], v) * turn < 0) return false;
      }
      return true;
    });
  }

  const SurfaceTopology& planarized_;
  const SurfaceTopology& as_given_;
  Predicates& predicates_;
  const PointStore& points_;
  FacetLocator locator_;
  FacetCorners corners_;
};

}  // namespace

DiagonalsResult enter_diagonals(ConformingMesh mesh, const SurfaceTopology& planarized,
                                const SurfaceTopology& as_given, std::span<const Vec3> given,
                                const ImproveOptions& options, PointStore& points,
                                Predicates& predicates, Control& control) {
  Goals goals = goals_of(options);
  goals.everywhere = true;
  std::vector<std::uint8_t> facet_has_faces(planarized.facet_axis.size(), 0);
  for (const SurfaceFace& face : mesh.boundary) facet_has_faces[face.facet] = 1;
  State state(numbered(std::move(mesh), points), &planarized, given, points, predicates, goals);
  std::vector<VertexId> number(points.size(), kNone);
  for (VertexId v = 0; v < state.mesh.vertices(); ++v) number[state.point(v)] = v;
  Entry entry(state, number, planarized, as_given, predicates, control);
  std::vector<Diagonal> missing = entry.diagonals(facet_has_faces);
  DiagonalsResult result;
  result.diagonals = missing.size();
  // Where one finds no place, others may make some.
  for (std::size_t before = missing.size() + 1; missing.size() < before;) {
    before = missing.size();
    std::erase_if(missing, [&](const Diagonal& d) { return entry.enter(d); });
  }
  result.missing = missing.size();
  if (result.missing > 0) return result;
  const bool anchored = entry.anchor_all();
  result.mesh = state.conforming();
  Handover handover(planarized, as_given, predicates);
  if (!(anchored && handover.run(result.mesh.boundary))) result.missing = result.diagonals;
  return result;
}

}  // namespace delmesher::improve
