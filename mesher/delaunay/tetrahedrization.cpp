// Incremental Delaunay tetrahedrization by cavities (Bowyer 1981, Watson 1981) with ghost
// tetrahedra, visibility walk and spatially sorted bulk insertion. Cavities are star-shaped without
// repair because the perturbation acts on lifted heights: a point coplanar with a face is judged
// alike by the face's two tetrahedra.
#include "mesher/delaunay/tetrahedrization.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/epoch.h"
#include "mesher/base/numbering.h"
#include "mesher/base/spatial_sort.h"
#include "mesher/base/validating.h"

namespace delmesher::delaunay {

Tetrahedrization::Tetrahedrization(Predicates& predicates, std::uint32_t most)
    : predicates_(predicates), most_(std::min(most, kMostTetrahedra)) {}

// ------------------------------------------------------------------------------------- building

std::vector<VertexId> Tetrahedrization::in_spatial_order(std::span<const VertexId> vertices) const {
  std::vector<std::array<double, 3>> coordinates(vertices.size());
  std::vector<std::uint32_t> position(vertices.size());
  for (std::uint32_t n = 0; n < vertices.size(); ++n) {
    coordinates[n] = predicates_.points().nearest(vertices[n]);
    position[n] = n;
  }
  spatial_sort(position, coordinates);
  std::vector<VertexId> order(vertices.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = vertices[position[n]];
  return order;
}

void Tetrahedrization::build(std::span<const VertexId> vertices, Control& control) {
  DELMESHER_CHECK(cell_.empty(), "a tetrahedrization is built that is not empty");
  std::vector<VertexId> order = in_spatial_order(vertices);
  cell_.reserve(order.size() * 7);
  first_tetrahedron(order);
  insert_in_order(std::span(order).subspan(4), 0, control);
  if (kValidating) validate(true);
}

void Tetrahedrization::insert_in_order(std::span<const VertexId> order, TetId hint,
                                       Control& control) {
  for (std::size_t n = 0; n < order.size(); ++n) {
    control.poll(order.size(), static_cast<double>(n) / static_cast<double>(order.size()));
    DELMESHER_CHECK(insert(order[n], hint), "two vertices of a tetrahedrization coincide");
    hint = incident_[order[n]];
  }
}

// Moves four points that are not coplanar to the front and makes the first tetrahedron of them.
void Tetrahedrization::first_tetrahedron(std::span<VertexId> order) {
  const auto bring = [&](std::size_t slot, auto&& suits) {
    for (std::size_t n = slot; n < order.size(); ++n) {
      if (suits(order[n])) {
        // Rotated, not swapped, so that the rest stays in spatial order.
        std::rotate(order.begin() + static_cast<std::ptrdiff_t>(slot),
                    order.begin() + static_cast<std::ptrdiff_t>(n),
                    order.begin() + static_cast<std::ptrdiff_t>(n) + 1);
        return true;
      }
    }
    return false;
  };
  const bool found =
      order.size() >= 4 &&
      bring(1, [&](VertexId v) { return predicates_.compare_xyz(order[0], v) != 0; }) &&
      bring(2,
            [&](VertexId v) {
              for (int axis = 0; axis < 3; ++axis) {
                if (predicates_.orient2d(axis, order[0], order[1], v) != 0) return true;
              }
              return false;
            }) &&
      bring(3,
            [&](VertexId v) { return predicates_.orient3d(order[0], order[1], order[2], v) != 0; });
  DELMESHER_CHECK(found, "all vertices of a tetrahedrization are in one plane");
  VertexId a = order[0];
  VertexId b = order[1];
  if (predicates_.orient3d(a, b, order[2], order[3]) < 0) std::swap(a, b);
  const TetId t = create(a, b, order[2], order[3]);
  TetId ghost[4];
  for (int i = 0; i < 4; ++i) {
    // The infinite vertex takes the place of vertex i on the other side of face i: two other
    // vertices change places to keep the orientation positive.
    std::array<VertexId, 4> w = {vertex(t, 0), vertex(t, 1), vertex(t, 2), vertex(t, 3)};
    w[i] = kInfinite;
    std::swap(w[(i + 1) & 3], w[(i + 2) & 3]);
    ghost[i] = create(w[0], w[1], w[2], w[3]);
    glue(t, i, ghost[i], i);
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      // Ghosts i and j share the two vertices other than i and j; each is glued by its face
      // opposite the vertex that the other lacks.
      glue(ghost[i], index_of(ghost[i], vertex(t, j)), ghost[j], index_of(ghost[j], vertex(t, i)));
    }
  }
  for (int i = 0; i < 4; ++i) incident_[vertex(t, i)] = t;
}

TetId Tetrahedrization::allocate() {
  if (!free_.empty()) {
    const TetId t = free_.back();
    free_.pop_back();
    state_[t].mark = 0;
    return t;
  }
  if (cell_.size() >= most_) stop_at_size(most_, "tetrahedra");
  const auto t = static_cast<TetId>(cell_.size());
  state_.push_back({});
  star_mark_.push_back(0);
  cell_.push_back({});
  return t;
}

TetId Tetrahedrization::create(VertexId a, VertexId b, VertexId c, VertexId d) {
  const TetId t = allocate();
  VertexId* v = cell_[t].vertex;
  v[0] = a;
  v[1] = b;
  v[2] = c;
  v[3] = d;
  for (const VertexId w : {a, b, c, d}) {
    if (w != kInfinite && w >= incident_.size()) incident_.resize(std::size_t{w} + 1, kNone);
  }
  return t;
}

void Tetrahedrization::destroy(TetId t) {
  state_[t].mark = kDead;
  free_.push_back(t);
}

void Tetrahedrization::glue(TetId t, int i, TetId u, int j) {
  cell_[t].neighbor[i] = {u, j};
  cell_[u].neighbor[j] = {t, i};
}

// -------------------------------------------------------------------------------------- queries

std::size_t Tetrahedrization::tetrahedra() const {
  std::size_t count = 0;
  for (TetId t = 0; t < capacity(); ++t) count += (alive(t) && !is_ghost(t)) ? 1 : 0;
  return count;
}

template <class Visit>
void Tetrahedrization::walk_star(VertexId v, Visit&& visit) {
  star_.clear();
  const TetId first = incident(v);
  if (first == kNone) return;
  next_epoch(star_epoch_, star_mark_);
  star_mark_[first] = star_epoch_;
  star_.push_back(first);
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const TetId t = star_[n];
    if (!visit(t)) return;
    const int own = index_of(t, v);
    for (int i = 0; i < 4; ++i) {
      const TetId u = neighbor(t, i);
      if (i == own || star_mark_[u] == star_epoch_) continue;
      star_mark_[u] = star_epoch_;
      star_.push_back(u);
    }
  }
}

std::span<const TetId> Tetrahedrization::star(VertexId v) {
  walk_star(v, [](TetId) { return true; });
  return star_;
}

TetId Tetrahedrization::find_edge(VertexId a, VertexId b) {
  TetId found = kNone;
  walk_star(a, [&](TetId t) {
    if (index_of(t, b) >= 0) found = t;
    return found == kNone;
  });
  return found;
}

FaceHandle Tetrahedrization::find_face(VertexId a, VertexId b, VertexId c) {
  FaceHandle found;
  walk_star(a, [&](TetId t) {
    const int j = index_of(t, b);
    const int k = j < 0 ? -1 : index_of(t, c);
    if (k < 0) return true;
    found = {t, 6 - index_of(t, a) - j - k};
    return is_ghost(t);
  });
  return found;
}

void Tetrahedrization::edge_ring(TetId t, VertexId a, VertexId b, std::vector<TetId>& ring) const {
  ring.clear();
  // Leave through the face opposite `out`, keeping the other vertex off the edge as the pivot.
  int out = 0;
  while (vertex(t, out) == a || vertex(t, out) == b) ++out;
  TetId current = t;
  do {
    ring.push_back(current);
    int stay = 0;
    while (stay == out || vertex(current, stay) == a || vertex(current, stay) == b) ++stay;
    const VertexId pivot = vertex(current, stay);
    current = neighbor(current, out);
    out = index_of(current, pivot);
  } while (current != t);
}

// ------------------------------------------------------------------------------------ insertion

TetId Tetrahedrization::locate(VertexId v, TetId hint, VertexId* duplicate) {
  if (duplicate != nullptr) *duplicate = kNone;
  TetId t = hint;
  for (int i = 0; i < 4; ++i) {
    if (vertex(t, i) == kInfinite) {
      t = neighbor(t, i);
      break;
    }
  }
  int entered = -1;
  for (;;) {
    const VertexId* w = vertices(t);
    const std::uint32_t first = next_random() >> 30;
    int zeros = 0;
    int leave = -1;
    for (std::uint32_t n = 0; n < 4; ++n) {
      const int i = static_cast<int>((first + n) & 3U);
      if (i == entered) continue;
      const int side = predicates_.orient3d(w[kFace[i][0]], w[kFace[i][1]], w[kFace[i][2]], v);
      if (side > 0) {
        leave = i;
        break;
      }
      if (side == 0) ++zeros;
    }
    if (leave < 0) {
      if (duplicate != nullptr && zeros == 3) {
        for (int i = 0; i < 4; ++i) {
          if (predicates_.compare_xyz(w[i], v) == 0) *duplicate = w[i];
        }
      }
      return t;
    }
    entered = mirror(t, leave);
    t = neighbor(t, leave);
    if (vertex(t, entered) == kInfinite) return t;
  }
}

bool Tetrahedrization::conflicts(TetId t, VertexId v) {
  const VertexId* w = vertices(t);
  for (int i = 0; i < 4; ++i) {
    if (w[i] != kInfinite) continue;
    VertexId x[4] = {w[0], w[1], w[2], w[3]};
    x[i] = v;
    const int side = predicates_.orient3d(x[0], x[1], x[2], x[3]);
    if (side != 0) return side > 0;
    w = vertices(neighbor(t, i));
    break;
  }
  return predicates_.insphere_perturbed(w[0], w[1], w[2], w[3], v) > 0;
}

void Tetrahedrization::begin_cavity(TetId start) {
  epoch_ += 2;
  if (epoch_ >= 0xfffffff0U) {
    for (State& state : state_) state.mark = state.mark == kDead ? kDead : 0;
    epoch_ = 2;
  }
  cavity_.assign(1, start);
  boundary_.clear();
  state_[start].mark = epoch_;
}

void Tetrahedrization::grow_across(TetId t, VertexId v) {
  const PointStore& points = predicates_.points();
  for (const FaceHandle across : cell_[t].neighbor) {
    const VertexId beyond = opposite(across);
    if (beyond != kInfinite) points.prefetch(beyond);
  }
  for (int i = 0; i < 4; ++i) {
    const TetId u = neighbor(t, i);
    if (state_[u].mark == epoch_) continue;
    if (state_[u].mark != epoch_ + 1) {
      if (conflicts(u, v)) {
        state_[u].mark = epoch_;
        cavity_.push_back(u);
        // Their turn comes when u's does; by then they have arrived from memory.
        for (const FaceHandle next : cell_[u].neighbor) {
          prefetch(next.tet());
        }
        continue;
      }
      state_[u].mark = epoch_ + 1;
    }
    boundary_.push_back({t, i});
  }
}

TetId Tetrahedrization::cone(const BoundaryFace& boundary, VertexId v) {
  const TetId t = allocate();
  Cell& inner = cell_[boundary.inner];
  Cell& cell = cell_[t];
  const int face = boundary.face;
  bool ghost = false;
  for (int i = 0; i < 4; ++i) {
    cell.vertex[i] = i == face ? v : inner.vertex[i];
    cell.neighbor[i] = {};
    ghost = ghost || cell.vertex[i] == kInfinite;
  }
  if (!ghost) {
    for (int i = 0; i < 4; ++i) {
      incident_[cell.vertex[i]] = t;
    }
  }
  const FaceHandle own(t, face);
  const FaceHandle outside = inner.neighbor[face];
  cell.neighbor[face] = outside;
  cell_[outside.tet()].neighbor[outside.face()] = own;
  // The dead tetrahedron's slot now leads to the new one: glue_around looks it up there.
  inner.neighbor[face] = own;
  return t;
}

void Tetrahedrization::glue_around(TetId created, const BoundaryFace& boundary) {
  for (int j = 0; j < 4; ++j) {
    if (cell_[created].neighbor[j].exists()) continue;  // done from the other side
    // Rotate inside the cavity around the edge that face j of the new tetrahedron shares with the
    // boundary face, until the boundary face on the other side.
    TetId c = boundary.inner;
    int cross = j;
    int stay = boundary.face;
    for (;;) {
      const FaceHandle next = cell_[c].neighbor[cross];
      const TetId u = next.tet();
      if (state_[u].mark != epoch_) {
        glue(created, j, u, stay);
        break;
      }
      const VertexId pivot = cell_[c].vertex[stay];
      stay = next.face();
      c = u;
      cross = index_of(c, pivot);
    }
  }
}

void Tetrahedrization::fill_cavity(VertexId v) {
  if (v >= incident_.size()) incident_.resize(std::size_t{v} + 1, kNone);
  created_.clear();
  for (const BoundaryFace& boundary : boundary_) created_.push_back(cone(boundary, v));
  for (std::size_t n = 0; n < boundary_.size(); ++n) glue_around(created_[n], boundary_[n]);
  for (const TetId t : cavity_) destroy(t);
}

bool Tetrahedrization::insert(VertexId v, TetId hint) {
  VertexId duplicate = kNone;
  const TetId t = locate(v, hint, &duplicate);
  if (duplicate != kNone) return false;
  find_cavity(v, t);
  fill_cavity(v);
  return true;
}

// ----------------------------------------------------------------------------------- validation

void Tetrahedrization::validate(bool delaunay) {
  const PredicateCounters counters = predicates_.counters;
  std::size_t dead = 0;
  for (TetId t = 0; t < capacity(); ++t) {
    if (!alive(t)) {
      ++dead;
      continue;
    }
    const VertexId* w = vertices(t);
    const bool ghost = is_ghost(t);
    DELMESHER_CHECK(ghost || predicates_.orient3d(w[0], w[1], w[2], w[3]) > 0,
                    "a tetrahedron is not positively oriented");
    for (int i = 0; i < 4; ++i) {
      const TetId u = neighbor(t, i);
      const int j = mirror(t, i);
      DELMESHER_CHECK(u < capacity() && alive(u), "a neighbour is dead");
      DELMESHER_CHECK(neighbor(u, j) == t && mirror(u, j) == i,
                      "neighbours do not name each other");
      const VertexId beyond = vertex(u, j);
      DELMESHER_CHECK(index_of(t, beyond) < 0, "neighbours share all vertices");
      for (int k = 0; k < 4; ++k) {
        DELMESHER_CHECK(k == i || index_of(u, w[k]) >= 0, "neighbours do not share a face");
      }
      if (w[i] != kInfinite) {
        const TetId s = incident(w[i]);
        DELMESHER_CHECK(s != kNone && alive(s) && index_of(s, w[i]) >= 0,
                        "incident() names a tetrahedron that is dead or not at its vertex");
      }
      if (delaunay && !ghost && !is_ghost(u)) {
        DELMESHER_CHECK(predicates_.insphere_perturbed(w[0], w[1], w[2], w[3], beyond) < 0,
                        "a face is not locally Delaunay");
      }
      if (delaunay && ghost && beyond != kInfinite) {
        DELMESHER_CHECK(!conflicts(t, beyond), "the hull is not convex");
      }
    }
  }
  DELMESHER_CHECK(dead == free_.size(), "a free slot is lost or used twice");
  for (const TetId t : free_) DELMESHER_CHECK(!alive(t), "a free slot is in use");
  predicates_.counters = counters;
}

}  // namespace delmesher::delaunay
