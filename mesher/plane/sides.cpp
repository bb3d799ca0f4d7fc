#include "mesher/plane/sides.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"

namespace delmesher::plane {
namespace {

constexpr std::uint8_t kMixed = static_cast<std::uint8_t>(Side::mixed);
constexpr std::uint8_t kUnknown = 3;

}  // namespace

// The separating axis of two convex sets in the plane is normal to an edge of one of them.
Sides::Contact Sides::contact(TriangleId t, const Gap& gap) {
  const auto& v = mesh_[t].vertex;
  int sign[3], zeros = 0, sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sign[i] = predicates_.orient(gap.a, gap.b, v[i]);
    zeros += sign[i] == 0;
    sum += sign[i];
  }
  if (sum == 3 || sum == -3) return Contact::none;
  if (zeros == 2) {  // an edge on the line of the gap
    const std::size_t i = sign[0] != 0 ? 0 : sign[1] != 0 ? 1 : 2;
    const VertexId u = v[(i + 1) % 3], w = v[(i + 2) % 3];
    if ((u == gap.a && w == gap.b) || (u == gap.b && w == gap.a)) return Contact::proper;
    const int between[] = {predicates_.dot(gap.a, u, gap.b), predicates_.dot(gap.a, w, gap.b),
                           predicates_.dot(u, gap.a, w), predicates_.dot(u, gap.b, w)};
    const int least = *std::min_element(std::begin(between), std::end(between));
    return least < 0 ? Contact::proper : least == 0 ? Contact::point : Contact::none;
  }
  if (zeros == 1 && (sum == 2 || sum == -2)) {  // a corner on the line
    const std::size_t i = sign[0] == 0 ? 0 : sign[1] == 0 ? 1 : 2;
    return predicates_.dot(gap.a, v[i], gap.b) <= 0 ? Contact::point : Contact::none;
  }
  Contact result = Contact::proper;
  for (std::size_t i = 0; i < 3; ++i) {
    const int a = predicates_.orient(v[i], v[(i + 1) % 3], gap.a);
    const int b = predicates_.orient(v[i], v[(i + 1) % 3], gap.b);
    if (a < 0 && b < 0) return Contact::none;
    if (a <= 0 && b <= 0) result = Contact::point;
  }
  return result;
}

// Finds the triangles that a gap runs through, from one of its ends.
void Sides::trace(std::uint32_t gap) {
  const Gap& g = gaps_[gap];
  const TriangleId hint = mesh_.has_vertex(g.b) ? mesh_.around(g.b) : mesh_.around(graph_.vertices);
  std::vector<TriangleId> found = {mesh_.locate(g.a, hint).triangle};
  seen_[found[0]] = gap + 1;
  for (std::size_t k = 0; k < found.size(); ++k) {  // grows
    const TriangleId t = found[k];
    const Contact c = contact(t, g);
    if (c == Contact::none) continue;
    if (c == Contact::proper) {
      if (list_of_[t] == kNone) {
        list_of_[t] = static_cast<std::uint32_t>(lists_.size());
        lists_.emplace_back();
      }
      lists_[list_of_[t]].push_back(gap);
      side_[t] = kMixed;
    }
    for (const EdgeId f : mesh_[t].neighbor) {
      if (f == kNone) continue;
      if (seen_[triangle_of(f)] == gap + 1) continue;
      seen_[triangle_of(f)] = gap + 1;
      found.push_back(triangle_of(f));
    }
  }
}

// The side of the triangle of e, which lies along a piece.
Side Sides::beside(EdgeId e) {
  const Piece& piece = graph_.pieces[mesh_.piece(e)];
  const bool along =
      spatial_.dot_difference_sign(mesh_.origin(e), mesh_.target(e), piece.a, piece.b) > 0;
  return (along ? piece.inside_left : piece.inside_right) ? Side::inside : Side::outside;
}

// A vertex of the input that is not far, to begin a search from.
VertexId Sides::near(TriangleId t) const {
  if (!list_of_.empty() && list_of_[t] != kNone) return gaps_[lists_[list_of_[t]].front()].a;
  for (const VertexId v : mesh_[t].vertex) {
    if (v < graph_.vertices) return v;
    if (!points_.is_explicit(v)) return points_.definition(v).corner[0];
  }
  return graph_.vertices;  // a corner of the box
}

// By location of a point inside it, where no neighbour tells.
Side Sides::resolve(TriangleId t, VertexId from) {
  const auto& v = mesh_[t].vertex;
  double x = 0, y = 0;
  for (const VertexId corner : v) {
    x += points_.approximation(corner).x / 3;
    y += points_.approximation(corner).y / 3;
  }
  const VertexId p = points_.add_explicit(x, y, 0);
  Side side = Side::mixed;
  if (predicates_.orient(v[0], v[1], p) > 0 && predicates_.orient(v[1], v[2], p) > 0 &&
      predicates_.orient(v[2], v[0], p) > 0) {
    const Location at = graph_.base.locate(p, graph_.base.around(from));
    side = graph_.inside[at.triangle] != 0 ? Side::inside : Side::outside;
  }
  points_.pop_back();
  return side;
}

void Sides::start() {
  side_.assign(mesh_.size(), kUnknown);
  if (!gaps_.empty()) {
    list_of_.assign(mesh_.size(), kNone);
    seen_.assign(mesh_.size(), 0);
    for (std::uint32_t g = 0; g < gaps_.size(); ++g) trace(g);
    seen_ = {};
  }
  flood();
}

void Sides::spread(TriangleId t, std::vector<TriangleId>& stack) {
  stack.push_back(t);
  while (!stack.empty()) {
    const TriangleId u = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(u, i), f = mesh_.twin(e);
      if (f == kNone || mesh_.piece(e) != kNone || side_[triangle_of(f)] != kUnknown) continue;
      side_[triangle_of(f)] = side_[u];
      stack.push_back(triangle_of(f));
    }
  }
}

void Sides::flood() {
  std::vector<TriangleId> stack;
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    for (int i = 0; i < 3 && side_[t] == kUnknown; ++i) {
      const EdgeId e = edge_of(t, i);
      if (mesh_.piece(e) == kNone) continue;
      side_[t] = static_cast<std::uint8_t>(beside(e));
      spread(t, stack);
    }
  }
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    if (side_[t] != kUnknown) continue;
    side_[t] = static_cast<std::uint8_t>(resolve(t, near(t)));
    if (side_[t] != kMixed) spread(t, stack);
  }
}

void Sides::before_fill() {
  old_sides_.clear();
  for (const auto& edge : mesh_.boundary()) old_sides_.push_back(side_[edge.inner]);
  any_mixed_ = false;
  candidates_.clear();
  for (const TriangleId t : mesh_.cavity()) {
    if (side_[t] != kMixed) continue;
    any_mixed_ = true;
    if (list_of_.empty() || list_of_[t] == kNone) continue;
    std::vector<std::uint32_t>& list = lists_[list_of_[t]];
    candidates_.insert(candidates_.end(), list.begin(), list.end());
    list.clear();
    free_lists_.push_back(list_of_[t]);
    list_of_[t] = kNone;
  }
  sort_unique(candidates_);
}

void Sides::after_fill() {
  const auto& created = mesh_.created();
  side_.resize(mesh_.size());
  if (!gaps_.empty()) list_of_.resize(mesh_.size(), kNone);
  if (!any_mixed_) {
    for (std::size_t k = 0; k < created.size(); ++k) side_[created[k]] = old_sides_[k];
    return;
  }
  for (const TriangleId t : created) side_[t] = kMixed;
  for (std::size_t k = 0; k < created.size(); ++k) {
    const TriangleId t = created[k];
    for (const std::uint32_t g : candidates_) {
      if (contact(t, gaps_[g]) != Contact::proper) continue;
      if (list_of_[t] == kNone) {
        if (free_lists_.empty()) {
          free_lists_.push_back(static_cast<std::uint32_t>(lists_.size()));
          lists_.emplace_back();
        }
        list_of_[t] = free_lists_.back();
        free_lists_.pop_back();
      }
      lists_[list_of_[t]].push_back(g);
    }
    if (list_of_[t] != kNone) continue;
    // In one face: that of the old triangle, or of the one beyond the edge between them.
    const EdgeId e = edge_of(t, 0), f = mesh_.twin(e);
    if (old_sides_[k] != kMixed) {
      side_[t] = old_sides_[k];
    } else if (mesh_.piece(e) != kNone) {
      side_[t] = static_cast<std::uint8_t>(beside(e));
    } else if (side_[triangle_of(f)] != kMixed) {
      side_[t] = side_[triangle_of(f)];
    } else {
      const VertexId from = candidates_.empty() ? near(t) : gaps_[candidates_[0]].a;
      side_[t] = static_cast<std::uint8_t>(resolve(t, from));
    }
  }
}

void Sides::settle() {
  if (gaps_.empty()) return;
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    if (side_[t] != kMixed) continue;
    const std::span<const std::uint32_t> here = gaps_at(t);
    const bool crossed =
        std::ranges::any_of(here, [&](std::uint32_t g) { return !is_along_edge(t, gaps_[g]); });
    if (crossed) continue;
    Side side = told_at_edges(t);
    if (side == Side::mixed) side = resolve(t, near(t));
    side_[t] = static_cast<std::uint8_t>(side);
  }
}

bool Sides::is_along_edge(TriangleId t, const Gap& gap) {
  return std::ranges::count_if(mesh_[t].vertex, [&](VertexId corner) {
           return predicates_.orient(gap.a, gap.b, corner) == 0;
         }) == 2;
}

// The side of a triangle in one face, from the pieces and gaps at its edges, or from neighbours if
// there are none. In a triangle as small as an ulp there may be no point to locate.
Side Sides::told_at_edges(TriangleId t) {
  for (int i = 0; i < 3; ++i) {
    if (mesh_.piece(edge_of(t, i)) != kNone) return beside(edge_of(t, i));
  }
  if (!gaps_at(t).empty()) return beside(t, gaps_[gaps_at(t).front()]);
  for (const EdgeId f : mesh_[t].neighbor) {
    if (f != kNone && of(triangle_of(f)) != Side::mixed) return of(triangle_of(f));
  }
  return Side::mixed;
}

// The side of a triangle that a gap is along an edge of.
Side Sides::beside(TriangleId t, const Gap& gap) {
  const Piece& piece = graph_.pieces[gap.piece];
  int sum = 0;  // of the corner that is not on the line alone
  for (const VertexId corner : mesh_[t].vertex) sum += predicates_.orient(gap.a, gap.b, corner);
  const bool along = spatial_.dot_difference_sign(gap.a, gap.b, piece.a, piece.b) > 0;
  return (along == (sum > 0) ? piece.inside_left : piece.inside_right) ? Side::inside
                                                                       : Side::outside;
}

// ------------------------------------------------------------------------------------ validation

void Sides::validate() {
  DELMESHER_CHECK(side_.size() == mesh_.size(), "not every triangle has a side");
  for (TriangleId t = 0; t < mesh_.size(); ++t) {
    DELMESHER_CHECK(side_[t] != kUnknown, "a triangle has no side");
    validate_gaps(t);
  }
  for (TriangleId t = 0; t < mesh_.size(); ++t) validate_neighbours(t);
  for (const std::uint32_t free : free_lists_) {
    DELMESHER_CHECK(lists_[free].empty(), "a free list has gaps");
  }
}

void Sides::validate_neighbours(TriangleId t) {
  if (side_[t] == kMixed) return;
  for (int i = 0; i < 3; ++i) {
    const EdgeId e = edge_of(t, i), f = mesh_.twin(e);
    if (mesh_.piece(e) != kNone) {
      DELMESHER_CHECK(of(t) == beside(e), "a triangle and a piece beside it disagree");
    } else if (f != kNone && side_[triangle_of(f)] != kMixed) {
      DELMESHER_CHECK(side_[t] == side_[triangle_of(f)], "two triangles of a face disagree");
    }
  }
}

std::span<const std::uint32_t> Sides::gaps_at(TriangleId t) const {
  if (list_of_.empty() || list_of_[t] == kNone) return {};
  return lists_[list_of_[t]];
}

void Sides::validate_gaps(TriangleId t) {
  const std::span<const std::uint32_t> here = gaps_at(t);
  DELMESHER_CHECK(here.empty() || side_[t] == kMixed, "a triangle with gaps is not mixed");
  DELMESHER_CHECK(!here.empty() || list_of_.empty() || list_of_[t] == kNone,
                  "a triangle has a list of gaps without any");
  for (const std::uint32_t g : here) {
    DELMESHER_CHECK(contact(t, gaps_[g]) == Contact::proper, "a gap is not where it is listed");
  }
  for (const EdgeId f : mesh_[t].neighbor) {
    if (f == kNone) continue;
    for (const std::uint32_t g : gaps_at(triangle_of(f))) {
      const bool listed = std::ranges::find(here, g) != here.end();
      DELMESHER_CHECK(listed || contact(t, gaps_[g]) != Contact::proper, "a gap is not listed");
    }
  }
}

}  // namespace delmesher::plane
