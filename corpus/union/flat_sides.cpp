#include "corpus/union/flat_sides.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "corpus/union/plane_triangulation.h"
#include "corpus/union/unite.h"
#include "oracles/base/union_find.h"

namespace tetproof::unite {
namespace {

using Doubles = CGAL::Exact_predicates_inexact_constructions_kernel;
using Segment = std::array<Index, 2>;  // the flat side is on its left

// A flat side, from its border.
class FlatSide {
 public:
  FlatSide(const Points& points, const Piece& some)
      : points_(points), parent_(some.parent), axis_(axis_across(points, some.corners)) {
    const auto& [a, b, c] = some.corners;
    upwards_ = CGAL::orientation(at(a), at(b), at(c)) == CGAL::POSITIVE;
  }
  void add(const Segment& segment);
  void append_to(std::vector<Piece>& pieces);

 private:
  using Triangulation =
      PlaneTriangulation<Index, bool, CGAL::No_constraint_intersection_requiring_constructions_tag>;

  Exact::Point_2 at(Index point) const { return projected(points_[point], axis_); }
  Triangulation::Vertex_handle vertex(Index point);

  const Points& points_;
  Index parent_;
  int axis_;
  bool upwards_ = true;  // does its normal point along the axis?
  Triangulation triangulation_;
  std::map<Index, Triangulation::Vertex_handle> vertices_;
  std::vector<Segment> segments_;
};

FlatSide::Triangulation::Vertex_handle FlatSide::vertex(Index point) {
  const auto [handle, fresh] = vertices_.try_emplace(point);
  if (fresh) {
    handle->second = triangulation_.insert(at(point));
    handle->second->info() = point;
  }
  return handle->second;
}

void FlatSide::add(const Segment& segment) {
  for (const Index v : segment) vertex(v);
  segments_.push_back(segment);
}

// From the faces on the left of the border over all edges not on the border.
void FlatSide::append_to(std::vector<Piece>& pieces) {
  for (const auto& [from, to] : segments_) {
    triangulation_.insert_constraint(vertex(from), vertex(to));
  }
  for (const auto face : triangulation_.all_face_handles()) face->info() = false;
  std::vector<Triangulation::Face_handle> faces;
  const auto enter = [&](const Triangulation::Face_handle& face) {
    if (triangulation_.is_infinite(face)) throw InternalError("a flat side has a gap");
    if (!face->info()) faces.push_back(face);
    face->info() = true;
  };
  for (const auto& [from, to] : segments_) {
    const Index right = upwards_ ? to : from, left = upwards_ ? from : to;
    Triangulation::Face_handle face;
    int edge = 0;
    if (!triangulation_.is_edge(vertex(right), vertex(left), face, edge)) {
      throw InternalError("the border of a flat side is interrupted");
    }
    enter(face);
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto face = faces[i];
    for (int k = 0; k < 3; ++k) {
      if (!face->is_constrained(k)) enter(face->neighbor(k));
    }
    Triangle corners;
    for (int k = 0; k < 3; ++k) corners[k] = face->vertex(k)->info();
    if (!upwards_) std::swap(corners[1], corners[2]);
    pieces.push_back({corners, 1, parent_, true});
  }
}

class FlatSides {
 public:
  FlatSides(const Soup& soup, const Points& points, const std::vector<Piece>& pieces, Poll& poll)
      : soup_(soup),
        points_(points),
        pieces_(pieces),
        poll_(poll),
        sides_(pieces.size()),
        vertices_(points.size()) {}

  // The pieces, and how many vertices went.
  std::pair<std::vector<Piece>, std::uint64_t> run();

 private:
  struct Vertex {
    bool shared = false;  // several bodies have an edge here
    bool fixed = false;   // a piece here is as it was given, and stays so
    bool gone = false;
    std::uint32_t borders = 0;
    Segment ends{};  // of the first two
  };

  bool may_change(const Piece& piece) const;
  bool one_side(Index a, Index b) const;
  void find_shared();
  void find_borders();
  void find_gone();
  Segment without_gone(Segment border) const;

  const Soup& soup_;
  const Points& points_;
  const std::vector<Piece>& pieces_;
  Poll& poll_;
  oracles::UnionFind sides_;
  std::vector<Vertex> vertices_;
  std::vector<std::pair<Index, Segment>> borders_;  // of pieces
  std::uint64_t gone_ = 0;
};

bool FlatSides::may_change(const Piece& piece) const {
  return piece.cut || std::any_of(piece.corners.begin(), piece.corners.end(),
                                  [&](Index v) { return vertices_[v].shared; });
}

// Where bodies have a whole side in common, those around it were not cut.
void FlatSides::find_shared() {
  Edges(soup_.triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() > 2) vertices_[uses[0].low].shared = vertices_[uses[0].high].shared = true;
  });
}

// Pieces with a common edge. The planes are those of their parents, which doubles know.
bool FlatSides::one_side(Index a, Index b) const {
  const Piece &p = pieces_[a], &q = pieces_[b];
  if (!may_change(p) || !may_change(q) || soup_.labels[p.parent] != soup_.labels[q.parent])
    return false;
  const auto point = [&](Index v) {
    const Position& x = soup_.vertices[v];
    return Doubles::Point_3(x[0], x[1], x[2]);
  };
  const Triangle& t = soup_.triangles[p.parent];
  const Triangle& other = soup_.triangles[q.parent];
  return std::all_of(other.begin(), other.end(), [&](Index v) {
    return CGAL::coplanar(point(t[0]), point(t[1]), point(t[2]), point(v));
  });
}

void FlatSides::find_borders() {
  for (const Piece& piece : pieces_) {
    if (may_change(piece)) continue;
    for (const Index v : piece.corners) vertices_[v].fixed = true;
  }
  const auto enter = [&](Index v, Index end) {
    Vertex& vertex = vertices_[v];
    if (vertex.borders < 2) vertex.ends[vertex.borders] = end;
    ++vertex.borders;
  };
  Edges(triangles_of(pieces_)).for_each([&](std::span<const EdgeUse> uses) {
    poll_();
    if (uses.size() == 2 && one_side(uses[0].triangle, uses[1].triangle)) {
      sides_.unite(uses[0].triangle, uses[1].triangle);
      return;
    }
    enter(uses[0].low, uses[0].high);
    enter(uses[0].high, uses[0].low);
    for (const EdgeUse& use : uses) {
      borders_.push_back(
          {use.triangle, use.forward ? Segment{use.low, use.high} : Segment{use.high, use.low}});
    }
  });
}

// Two edges of an arrangement do not leave a vertex the same way, so that on one line they are
// opposite. Flat sides that both end there have that line in common.
void FlatSides::find_gone() {
  for (const Piece& piece : pieces_) {
    for (const Index v : piece.corners) {
      Vertex& vertex = vertices_[v];
      if (vertex.fixed || vertex.gone) continue;
      poll_();
      vertex.gone = vertex.borders == 0 ||
                    (vertex.borders == 2 &&
                     CGAL::collinear(points_[v], points_[vertex.ends[0]], points_[vertex.ends[1]]));
      vertex.fixed = !vertex.gone;
      gone_ += vertex.gone ? 1 : 0;
    }
  }
}

// The line that a border is a part of, up to a vertex that stays.
Segment FlatSides::without_gone(Segment border) const {
  Index before = border[0];
  while (vertices_[border[1]].gone) {
    const Segment& ends = vertices_[border[1]].ends;
    const Index next = ends[0] == before ? ends[1] : ends[0];
    before = std::exchange(border[1], next);
  }
  return border;
}

std::pair<std::vector<Piece>, std::uint64_t> FlatSides::run() {
  find_shared();
  find_borders();
  find_gone();
  if (gone_ == 0) return {pieces_, 0};
  std::vector<bool> anew(pieces_.size(), false);
  for (Index i = 0; i < pieces_.size(); ++i) {
    const Triangle& corners = pieces_[i].corners;
    if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return vertices_[v].gone; })) {
      anew[sides_.find(i)] = true;
    }
  }
  std::vector<Piece> result;
  std::map<Index, FlatSide> sides;
  for (Index i = 0; i < pieces_.size(); ++i) {
    if (!anew[sides_.find(i)]) result.push_back(pieces_[i]);
  }
  for (const auto& [piece, border] : borders_) {
    const Index side = sides_.find(piece);
    if (!anew[side] || vertices_[border[0]].gone) continue;
    poll_();
    sides.try_emplace(side, points_, pieces_[side]).first->second.add(without_gone(border));
  }
  for (auto& [side, flat] : sides) {
    poll_();
    flat.append_to(result);
  }
  return {std::move(result), gone_};
}

}  // namespace

std::uint64_t restore_flat_sides(const Soup& soup, const Points& points, std::vector<Piece>& pieces,
                                 Poll& poll) {
  auto [restored, gone] = FlatSides(soup, points, pieces, poll).run();
  pieces = std::move(restored);
  return gone;
}

}  // namespace tetproof::unite
