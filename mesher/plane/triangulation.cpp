#include "mesher/plane/triangulation.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "mesher/base/check.h"
#include "mesher/base/numbering.h"

namespace delmesher::plane {
namespace {

// The other two edges of the triangle of e, as seen when entering through e: counter-clockwise from
// the origin of the twin of e.
EdgeId after(EdgeId e) {
  return edge_of(triangle_of(e), next(index_of(e)));
}
EdgeId before(EdgeId e) {
  return edge_of(triangle_of(e), previous(index_of(e)));
}

// Turns around a vertex. A spoke is the edge opposite the vertex in a triangle there.
class Fan {
 public:
  Fan(const Triangulation& mesh, VertexId v) : mesh_(mesh) {
    const TriangleId t = mesh.around(v);
    for (int i = 0; i < 3; ++i) {
      if (mesh[t].vertex[static_cast<std::size_t>(i)] == v) first_ = edge_of(t, i);
    }
    DELMESHER_CHECK(first_ != kNone, "around() names a triangle that is not at its vertex");
    spoke_ = first_;
  }
  EdgeId spoke() const { return spoke_; }
  // False if there are no more.
  bool advance() {
    if (!clockwise_) {
      const EdgeId f = mesh_.twin(after(spoke_));
      if (f != kNone) {
        spoke_ = after(f);
        return spoke_ != first_;
      }
      clockwise_ = true;  // at the border: the other way from the start
      spoke_ = first_;
    }
    const EdgeId f = mesh_.twin(before(spoke_));
    if (f == kNone) return false;
    spoke_ = before(f);
    return true;
  }
  // The edge between the vertex and b in the present triangle, or kNone.
  EdgeId edge_to(VertexId b) const {
    if (mesh_.origin(spoke_) == b) return before(spoke_);
    if (mesh_.target(spoke_) != b) return kNone;
    const EdgeId e = after(spoke_);  // from b to the vertex
    const EdgeId f = mesh_.twin(e);
    return f != kNone ? f : e;
  }

 private:
  const Triangulation& mesh_;
  EdgeId first_ = kNone, spoke_ = kNone;
  bool clockwise_ = false;
};

}  // namespace

void Triangulation::reserve(std::size_t vertices) {
  triangles_.reserve(2 * vertices + 16);
  around_.reserve(vertices + 16);
}

void Triangulation::link(EdgeId e, EdgeId f) {
  if (e != kNone) triangles_[triangle_of(e)].neighbor[static_cast<std::size_t>(index_of(e))] = f;
  if (f != kNone) triangles_[triangle_of(f)].neighbor[static_cast<std::size_t>(index_of(f))] = e;
}

void Triangulation::grow_around(VertexId v) {
  if (v >= around_.size()) around_.resize(std::size_t{v} + 1, kNone);
}

void Triangulation::start(const std::array<VertexId, 4>& c, const std::array<PieceId, 4>& pieces) {
  triangles_.assign(2, {});
  triangles_[0] = {{c[0], c[1], c[2]}, {kNone, kNone, kNone}, {pieces[1], kNone, pieces[0]}};
  triangles_[1] = {{c[0], c[2], c[3]}, {kNone, kNone, kNone}, {pieces[2], pieces[3], kNone}};
  link(edge_of(0, 1), edge_of(1, 2));
  for (std::size_t i = 0; i < 4; ++i) {
    grow_around(c[i]);
    around_[c[i]] = i == 3 ? 1 : 0;
  }
}

void Triangulation::renumber() {
  const auto smallest = [](const Triangle& t) {
    return std::min(t.vertex[0], std::min(t.vertex[1], t.vertex[2]));
  };
  std::vector<TriangleId> next_number(around_.size() + 1, 0), number(triangles_.size());
  for (const Triangle& t : triangles_) ++next_number[std::size_t{smallest(t)} + 1];
  for (std::size_t v = 1; v < next_number.size(); ++v) next_number[v] += next_number[v - 1];
  for (std::size_t t = 0; t < number.size(); ++t)
    number[t] = next_number[smallest(triangles_[t])]++;
  std::vector<Triangle> ordered;
  ordered.reserve(triangles_.capacity());
  ordered.resize(triangles_.size());
  for (std::size_t t = 0; t < number.size(); ++t) {
    Triangle& moved = ordered[number[t]];
    moved = triangles_[t];
    for (EdgeId& f : moved.neighbor) {
      if (f != kNone) f = edge_of(number[triangle_of(f)], index_of(f));
    }
  }
  triangles_ = std::move(ordered);
  for (TriangleId& t : around_) {
    if (t != kNone) t = number[t];
  }
}

EdgeId Triangulation::find_edge(VertexId a, VertexId b) const {
  // Around both at once, so that it takes as long as the smaller of the two degrees.
  Fan at_a(*this, a), at_b(*this, b);
  for (;;) {
    if (const EdgeId e = at_a.edge_to(b); e != kNone) return e;
    if (const EdgeId e = at_b.edge_to(a); e != kNone) return twin(e) != kNone ? twin(e) : e;
    if (!at_a.advance() || !at_b.advance()) return kNone;
  }
}

void Triangulation::star(VertexId v, std::vector<EdgeId>& edges) const {
  edges.clear();
  Fan fan(*this, v);
  do {
    edges.push_back(fan.spoke());
  } while (fan.advance());
}

void Triangulation::set_piece(EdgeId e, PieceId piece) {
  triangles_[triangle_of(e)].piece[static_cast<std::size_t>(index_of(e))] = piece;
  const EdgeId f = twin(e);
  if (f != kNone) triangles_[triangle_of(f)].piece[static_cast<std::size_t>(index_of(f))] = piece;
}

void Triangulation::rename(VertexId from, VertexId to) {
  std::vector<EdgeId> spokes;
  star(from, spokes);
  for (const EdgeId e : spokes) {
    triangles_[triangle_of(e)].vertex[static_cast<std::size_t>(index_of(e))] = to;
  }
  grow_around(to);
  around_[to] = around_[from];
  around_[from] = kNone;
}

// ---------------------------------------------------------------------------------- location

Location Triangulation::locate(VertexId p, TriangleId from) {
  TriangleId t = from;
  EdgeId entered = kNone;
  for (;;) {
    const Triangle& triangle = triangles_[t];
    // The visibility walk ends in a Delaunay triangulation whatever side comes first; with
    // constraints it could run in circles if the choice were always the same (Devillers et al.).
    random_ = random_ * 1664525U + 1013904223U;
    int i = static_cast<int>((random_ >> 16) % 3);
    unsigned zeros = 0;
    bool moved = false;
    for (int k = 0; k < 3 && !moved; ++k, i = next(i)) {
      const EdgeId e = edge_of(t, i);
      if (e == entered) continue;
      const int s = predicates_->orient(triangle.vertex[static_cast<std::size_t>(next(i))],
                                        triangle.vertex[static_cast<std::size_t>(previous(i))], p);
      if (s == 0) zeros |= 1U << i;
      if (s >= 0) continue;
      entered = triangle.neighbor[static_cast<std::size_t>(i)];
      DELMESHER_CHECK(entered != kNone, "a point is located outside the rectangle");
      t = triangle_of(entered);
      moved = true;
    }
    if (!moved) return {t, zeros};
  }
}

Location Triangulation::locate_here(VertexId p, TriangleId t) {
  const Triangle& triangle = triangles_[t];
  unsigned zeros = 0;
  for (int i = 0; i < 3; ++i) {
    const int s = predicates_->orient(triangle.vertex[static_cast<std::size_t>(next(i))],
                                      triangle.vertex[static_cast<std::size_t>(previous(i))], p);
    if (s < 0) return {kNone, static_cast<unsigned>(i)};
    if (s == 0) zeros |= 1U << i;
  }
  return {t, zeros};
}

Triangulation::Sight Triangulation::look(VertexId p, TriangleId from) {
  const Location here = locate_here(p, from);
  if (here.triangle != kNone) return {here, kNone};
  EdgeId e = edge_of(from, static_cast<int>(here.zeros));
  const VertexId a = opposite(e);
  // Along the ray from a; where p is not in the sector of a that e spans, to the next triangle.
  const bool in_sector =
      predicates_->orient(a, origin(e), p) >= 0 && predicates_->orient(a, target(e), p) <= 0;
  for (;;) {
    if (piece(e) != kNone || twin(e) == kNone) return {{triangle_of(e), 0}, e};
    const EdgeId f = twin(e);
    if (!in_sector) return look(p, triangle_of(f));
    // The ray leaves the next triangle on the side of its opposite corner where it does not pass.
    e = predicates_->orient(a, p, opposite(f)) >= 0 ? after(f) : before(f);
    if (predicates_->orient(origin(e), target(e), p) >= 0) {
      const Location found = locate_here(p, triangle_of(f));
      if (found.triangle != kNone) return {found, kNone};
      return look(p, triangle_of(f));
    }
  }
}

// ---------------------------------------------------------------------------------- insertion

// Depth first, entering triangles so that boundary_ comes out counter-clockwise: the cavity has no
// vertex inside, so its triangles form a tree.
void Triangulation::add_to_cavity(VertexId p, EdgeId crossing) {
  stack_.clear();
  stack_.push_back(crossing);
  while (!stack_.empty()) {
    const EdgeId e = stack_.back();
    stack_.pop_back();
    const EdgeId f = twin(e);
    if (piece(e) == kNone && f != kNone) {
      const auto& v = triangle(f).vertex;
      if (predicates_->in_circle_perturbed(v[0], v[1], v[2], p) > 0) {
        cavity_.push_back(triangle_of(f));
        stack_.push_back(before(f));
        stack_.push_back(after(f));
        continue;
      }
    }
    boundary_.push_back({origin(e), target(e), f, piece(e), triangle_of(e)});
  }
}

void Triangulation::find_cavity(VertexId p, TriangleId at, EdgeId split) {
  cavity_.clear();
  boundary_.clear();
  split_ = split;
  if (split == kNone) {
    cavity_.push_back(at);
    for (int i = 0; i < 3; ++i) add_to_cavity(p, edge_of(at, i));
    return;
  }
  split_from_ = origin(split);
  split_to_ = target(split);
  split_piece_ = piece(split);
  const EdgeId f = twin(split);
  cavity_.push_back(triangle_of(split));
  if (f != kNone) cavity_.push_back(triangle_of(f));
  add_to_cavity(p, after(split));
  add_to_cavity(p, before(split));
  if (f != kNone) {
    add_to_cavity(p, after(f));
    add_to_cavity(p, before(f));
  }
}

void Triangulation::fill_cavity(VertexId p) {
  const std::size_t n = boundary_.size();
  const bool open = split_ != kNone && twin(split_) == kNone;
  created_.assign(cavity_.begin(), cavity_.end());
  grow_around(p);
  while (created_.size() < n) {
    created_.push_back(static_cast<TriangleId>(triangles_.size()));
    triangles_.emplace_back();
  }
  DELMESHER_CHECK(created_.size() == n, "a cavity has more triangles than its boundary has edges");
  if (triangles_.size() >= std::size_t{1} << 30) {  // edges have no more numbers
    stop_at_size(std::size_t{1} << 30, "triangles");
  }
  for (std::size_t k = 0; k < n; ++k) {
    const BoundaryEdge& b = boundary_[k];
    const TriangleId t = created_[k];
    Triangle& triangle = triangles_[t];
    triangle.vertex = {p, b.from, b.to};
    triangle.piece = {b.piece, kNone, kNone};
    triangle.neighbor = {b.outer, kNone, kNone};
    if (b.outer != kNone) {
      triangles_[triangle_of(b.outer)].neighbor[static_cast<std::size_t>(index_of(b.outer))] =
          edge_of(t, 0);
    }
    triangle.neighbor[1] = edge_of(created_[k + 1 < n ? k + 1 : 0], 2);
    triangle.neighbor[2] = edge_of(created_[k > 0 ? k - 1 : n - 1], 1);
    around_[b.from] = t;
    if (split_ != kNone) {
      if (b.to == split_from_ || b.to == split_to_) triangle.piece[1] = split_piece_;
      if (b.from == split_from_ || b.from == split_to_) triangle.piece[2] = split_piece_;
    }
  }
  if (open) {
    triangles_[created_[0]].neighbor[2] = kNone;
    triangles_[created_[n - 1]].neighbor[1] = kNone;
    around_[boundary_[n - 1].to] = created_[n - 1];
  }
  around_[p] = created_[0];
}

VertexId Triangulation::insert(VertexId p, TriangleId from) {
  const Location at = locate(p, from);
  const auto& v = triangles_[at.triangle].vertex;
  EdgeId split = kNone;
  for (int i = 0; i < 3; ++i) {
    const unsigned others = 7U & ~(1U << i);
    if (at.zeros == others) return v[static_cast<std::size_t>(i)];
    const EdgeId e = edge_of(at.triangle, i);
    if ((at.zeros >> i & 1) != 0 && piece(e) != kNone) split = e;
  }
  find_cavity(p, at.triangle, split);
  fill_cavity(p);
  return p;
}

// ---------------------------------------------------------------------------------- segments

// From t = (p, q, r) and n = (x, r, q) to t = (p, q, x) and n = (x, r, p); e is the edge qr of t.
void Triangulation::flip(EdgeId e) {
  const EdgeId f = twin(e);
  const TriangleId t = triangle_of(e), n = triangle_of(f);
  const Triangle old_t = triangles_[t], old_n = triangles_[n];
  const auto i = static_cast<std::size_t>(index_of(e)), j = static_cast<std::size_t>(index_of(f));
  const std::size_t i1 = next_index(e), i2 = previous_index(e);
  const std::size_t j1 = next_index(f), j2 = previous_index(f);
  const VertexId p = old_t.vertex[i], q = old_t.vertex[i1], r = old_t.vertex[i2],
                 x = old_n.vertex[j];
  triangles_[t].vertex = {p, q, x};
  triangles_[n].vertex = {x, r, p};
  triangles_[t].piece = {old_n.piece[j1], kNone, old_t.piece[i2]};
  triangles_[n].piece = {old_t.piece[i1], kNone, old_n.piece[j2]};
  link(edge_of(t, 0), old_n.neighbor[j1]);
  link(edge_of(t, 2), old_t.neighbor[i2]);
  link(edge_of(n, 0), old_t.neighbor[i1]);
  link(edge_of(n, 2), old_n.neighbor[j2]);
  link(edge_of(t, 1), edge_of(n, 1));
  around_[p] = around_[q] = around_[x] = t;
  around_[r] = n;
}

bool Triangulation::convex(EdgeId e) {
  const VertexId p = opposite(e), x = opposite(twin(e));
  return predicates_->orient(p, origin(e), x) > 0 && predicates_->orient(x, target(e), p) > 0;
}

void Triangulation::legalize(std::vector<TriangleId>& stack) {
  while (!stack.empty()) {
    const TriangleId t = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i);
      const EdgeId f = twin(e);
      if (piece(e) != kNone || f == kNone) continue;
      const auto& v = triangles_[t].vertex;
      if (predicates_->in_circle_perturbed(v[0], v[1], v[2], opposite(f)) <= 0) continue;
      flip(e);
      stack.push_back(t);
      stack.push_back(triangle_of(f));
      break;
    }
  }
}

// The edge that the line from a to b crosses first, seen from the triangle at a; or, if the line
// runs through a neighbour of a, that vertex and the edge `along` to it.
EdgeId Triangulation::first_crossing(VertexId a, VertexId b, VertexId& on_line, EdgeId& along) {
  Fan fan(*this, a);
  do {
    const EdgeId e = fan.spoke();
    const VertexId u = origin(e), w = target(e);
    const int su = predicates_->orient(a, b, u);
    if (su == 0 && predicates_->dot(b, a, u) > 0) {
      on_line = u;
      along = before(e);
      return kNone;
    }
    if (su < 0 && predicates_->orient(a, b, w) > 0 && predicates_->orient(a, u, w) > 0 &&
        predicates_->orient(u, w, b) < 0) {
      return e;
    }
  } while (fan.advance());
  DELMESHER_CHECK(false, "no triangle around a vertex is on the way to another one");
  return kNone;
}

// Flips the edges that the line from a crosses until the line from a to `end` (b, or the first
// vertex on the way) is an edge (Sloan 1993).
Triangulation::Obstacle Triangulation::cross(VertexId a, VertexId b, EdgeId first, VertexId& end) {
  crossed_.clear();
  std::vector<TriangleId> strip = {triangle_of(first)};
  for (EdgeId e = first;;) {
    if (piece(e) != kNone) return {Obstacle::Kind::crossing, piece(e)};
    crossed_.push_back(e);
    const EdgeId f = twin(e);
    strip.push_back(triangle_of(f));
    end = opposite(f);
    const int s = end == b ? 0 : predicates_->orient(a, b, end);
    if (s == 0) break;
    e = s > 0 ? after(f) : before(f);
  }
  // The crossed edges in the order along the line, as a linked list: a flip moves the handle of the
  // one that follows.
  const std::size_t n = crossed_.size();
  std::vector<std::size_t> following(n), queue(n);
  for (std::size_t k = 0; k < n; ++k) {
    following[k] = k + 1;
    queue[k] = k;
  }
  std::vector<std::size_t> preceding(n + 1);
  for (std::size_t k = 0; k < n; ++k) preceding[k + 1] = k;
  preceding[0] = n;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::size_t k = queue[head];
    const EdgeId e = crossed_[k];
    if (!convex(e)) {
      queue.push_back(k);
      continue;
    }
    const TriangleId t = triangle_of(e), other = triangle_of(twin(e));
    const VertexId p = opposite(e), x = opposite(twin(e));
    const int sp = p == a ? 0 : predicates_->orient(a, b, p);
    const int sx = x == end ? 0 : predicates_->orient(a, b, x);
    flip(e);
    // With x on the left the line goes on across (q, x), now edge 0 of t, else across (x, r).
    if (following[k] < n) crossed_[following[k]] = sx > 0 ? edge_of(t, 0) : edge_of(other, 2);
    if (sp * sx < 0) {
      crossed_[k] = sp > 0 ? edge_of(t, 1) : edge_of(other, 1);
      queue.push_back(k);
    } else {
      if (preceding[k] < n) following[preceding[k]] = following[k];
      preceding[following[k]] = preceding[k];
    }
  }
  const EdgeId made = find_edge(a, end);
  DELMESHER_CHECK(made != kNone,
                  "two vertices have no edge after all edges between them were flipped");
  set_piece(made, kNone - 1);  // fixed while its surroundings are made Delaunay
  legalize(strip);
  return {};
}

Triangulation::Obstacle Triangulation::insert_segment(VertexId a, VertexId b, PieceId piece_id,
                                                      std::vector<VertexId>& chain) {
  chain.assign(1, a);
  // From the end with fewer triangles.
  bool reversed = false;
  {
    Fan at_a(*this, a), at_b(*this, b);
    for (;;) {
      if (at_a.edge_to(b) != kNone || at_b.edge_to(a) != kNone) break;
      if (!at_a.advance()) break;
      if (!at_b.advance()) {
        reversed = true;
        break;
      }
    }
  }
  if (reversed) std::swap(a, b);
  chain[0] = a;
  while (a != b) {
    EdgeId e = find_edge(a, b);
    VertexId end = b;
    if (e == kNone) {
      const EdgeId first = first_crossing(a, b, end, e);
      if (first != kNone) {
        const Obstacle obstacle = cross(a, b, first, end);
        if (obstacle.kind != Obstacle::Kind::none) return obstacle;
        e = find_edge(a, end);
        set_piece(e, kNone);
      }
    }
    if (piece(e) != kNone) return {Obstacle::Kind::overlap, piece(e)};
    set_piece(e, piece_id);
    chain.push_back(end);
    a = end;
  }
  if (reversed) std::reverse(chain.begin(), chain.end());
  return {};
}

// ---------------------------------------------------------------------------------- removal

bool Triangulation::is_ear(std::size_t k) {
  const BoundaryEdge &e = boundary_[k], &f = boundary_[(k + 1) % boundary_.size()];
  if (predicates_->orient(e.from, e.to, f.to) <= 0) return false;
  return std::none_of(boundary_.begin(), boundary_.end(), [&](const BoundaryEdge& other) {
    const VertexId u = other.from;
    return u != e.from && u != e.to && u != f.to && predicates_->orient(e.from, e.to, u) >= 0 &&
           predicates_->orient(e.to, f.to, u) >= 0 && predicates_->orient(f.to, e.from, u) >= 0;
  });
}

// No other triangle may have it as a neighbour.
void Triangulation::drop(TriangleId t) {
  const auto last = static_cast<TriangleId>(triangles_.size() - 1);
  if (t != last) {
    triangles_[t] = triangles_[last];
    for (int i = 0; i < 3; ++i) {
      link(edge_of(t, i), triangles_[t].neighbor[static_cast<std::size_t>(i)]);
      around_[triangles_[t].vertex[static_cast<std::size_t>(i)]] = t;
    }
  }
  triangles_.pop_back();
}

// Cuts ears off the polygon around the vertex, in the place of its triangles.
void Triangulation::remove(VertexId v) {
  std::vector<EdgeId> spokes;
  star(v, spokes);
  boundary_.clear();
  std::vector<TriangleId> free, made;
  for (const EdgeId e : spokes) {
    DELMESHER_CHECK(piece(after(e)) == kNone, "a vertex on a segment is to be removed");
    boundary_.push_back({origin(e), target(e), twin(e), piece(e), triangle_of(e)});
    free.push_back(triangle_of(e));
  }
  while (boundary_.size() > 2) {
    std::size_t k = 0;
    while (k < boundary_.size() && !is_ear(k)) ++k;
    DELMESHER_CHECK(k < boundary_.size(), "the polygon around a vertex has no ear");
    const std::size_t following = (k + 1) % boundary_.size();
    const BoundaryEdge e = boundary_[k], f = boundary_[following];
    const TriangleId t = free.back();
    free.pop_back();
    made.push_back(t);
    triangles_[t] = {{e.from, e.to, f.to}, {kNone, kNone, kNone}, {f.piece, kNone, e.piece}};
    link(edge_of(t, 0), f.outer);
    link(edge_of(t, 2), e.outer);
    for (const VertexId u : {e.from, e.to, f.to}) around_[u] = t;
    boundary_[k] = {e.from, f.to, edge_of(t, 1), kNone, t};
    boundary_.erase(boundary_.begin() + static_cast<std::ptrdiff_t>(following));
  }
  // What is left are the two sides of one edge.
  link(boundary_[0].outer, boundary_[1].outer);
  set_piece(boundary_[0].outer, boundary_[1].piece);
  around_[v] = kNone;
  legalize(made);
  std::sort(free.begin(), free.end(), std::greater<>());
  for (const TriangleId t : free) drop(t);
}

// ---------------------------------------------------------------------------------- checks

void Triangulation::validate(bool delaunay) const {
  constexpr std::size_t kRectangle = 2;
  for (TriangleId t = 0; t < triangles_.size(); ++t) {
    const auto& v = triangles_[t].vertex;
    DELMESHER_CHECK(predicates_->orient(v[0], v[1], v[2]) > 0,
                    "a triangle is not positively oriented");
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i);
      DELMESHER_CHECK(around_[v[static_cast<std::size_t>(i)]] != kNone,
                      "around() names no triangle at a vertex of one");
      const EdgeId f = twin(e);
      if (f == kNone) {
        DELMESHER_CHECK(piece(e) != kNone, "an edge of the border is on no piece");
        continue;
      }
      DELMESHER_CHECK(twin(f) == e, "neighbours do not name each other");
      DELMESHER_CHECK(origin(e) == target(f) && target(e) == origin(f), "neighbours share no edge");
      DELMESHER_CHECK(piece(e) == piece(f), "the two sides of an edge name different pieces");
      if (!delaunay || triangles_.size() <= kRectangle || piece(e) != kNone) continue;
      DELMESHER_CHECK(predicates_->in_circle_perturbed(v[0], v[1], v[2], opposite(f)) <= 0,
                      "an edge is not locally Delaunay");
    }
  }
  for (VertexId v = 0; v < around_.size(); ++v) {
    if (around_[v] == kNone) continue;
    const auto& corners = triangles_[around_[v]].vertex;
    DELMESHER_CHECK(std::find(corners.begin(), corners.end(), v) != corners.end(),
                    "around() names a triangle that is not at its vertex");
  }
}

}  // namespace delmesher::plane
