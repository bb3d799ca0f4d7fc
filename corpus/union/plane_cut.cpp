#include "corpus/union/plane_cut.h"

#include <algorithm>
#include <cstdlib>

#include "corpus/union/unite.h"

namespace tetproof::unite {

PlaneCut::PlaneCut(const Soup& soup, std::span<const Index> members, Cancelled cancelled,
                   Points& points)
    : soup_(soup),
      members_(members),
      cancelled_(cancelled),
      points_(points),
      axis_(axis_across(points, soup.triangles[members.front()])) {
  const Triangle& t = soup.triangles[members.front()];
  const Exact::Point_3 p = points[t[0]];
  const Exact::Vector_3 normal = CGAL::cross_product(points[t[1]] - p, points[t[2]] - p);
  for (int k = 0; k < 3; ++k) {
    origin_[k] = p.cartesian(k);
    normal_[k] = normal.cartesian(k);
  }
  for (const Index member : members) {
    for (const Index v : soup.triangles[member]) vertex(v);
  }
  for (const Index member : members) {
    const auto& [a, b, c] = soup.triangles[member];
    constrain(a, b);
    constrain(b, c);
    constrain(c, a);
  }
}

Exact::Point_3 PlaneCut::lifted(const Exact::Point_2& p) const {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  std::array<Exact::FT, 3> x;
  x[u] = p.x();
  x[v] = p.y();
  x[axis_] =
      origin_[axis_] -
      (normal_[u] * (p.x() - origin_[u]) + normal_[v] * (p.y() - origin_[v])) / normal_[axis_];
  return {x[0], x[1], x[2]};
}

PlaneCut::Triangulation::Vertex_handle PlaneCut::vertex(Index point) {
  const auto [entry, fresh] = vertices_.try_emplace(point);
  if (fresh) {
    const Triangulation::Face_handle start =
        near_ == Triangulation::Vertex_handle() ? Triangulation::Face_handle() : near_->face();
    near_ = entry->second = triangulation_.insert(at(point), start);
    near_->info().number = point;
  }
  return entry->second;
}

void PlaneCut::constrain(Index from, Index to) {
  triangulation_.insert_constraint(vertex(from), vertex(to));
}

// All points come before the first segment, since a point costs less where nothing has to be
// swapped.
void PlaneCut::add(const std::vector<Chord>& chords) {
  for (const Chord& chord : chords) {
    vertex(chord.from);
    vertex(chord.to);
  }
  for (const Chord& chord : chords) {
    if (chord.from != chord.to) constrain(chord.from, chord.to);
  }
}

PlaneCut::Corners PlaneCut::corners_of(Index member) const {
  const auto& [a, b, c] = soup_.triangles[member];
  return {at(a), at(b), at(c)};
}

void PlaneCut::number_crossings() {
  for (auto v = triangulation_.finite_vertices_begin(); v != triangulation_.finite_vertices_end();
       ++v) {
    if (v->info().number == kNone) v->info().number = points_.number_of(lifted(v->point()));
  }
}

bool PlaneCut::is_on_side(const Triangulation::Face_handle& face, int edge,
                          const Corners& corners) {
  const Exact::Point_2 &p = face->vertex(Triangulation::ccw(edge))->point(),
                       &q = face->vertex(Triangulation::cw(edge))->point();
  for (std::size_t k = 0; k < 3; ++k) {
    const Exact::Point_2 &a = corners[k], &b = corners[(k + 1) % 3];
    if (CGAL::collinear(a, b, p) && CGAL::collinear(a, b, q)) return true;
  }
  return false;
}

// From the face around the middle over all edges that are not on a side.
void PlaneCut::cover(Index member, Poll& poll) {
  const Corners corners = corners_of(member);
  const bool up = CGAL::orientation(corners[0], corners[1], corners[2]) == CGAL::POSITIVE;
  std::vector<Triangulation::Face_handle> faces = {
      triangulation_.locate(CGAL::centroid(corners[0], corners[1], corners[2]),
                            vertex(soup_.triangles[member][0])->face())};
  faces[0]->info().seen = member;
  while (!faces.empty()) {
    poll();
    const auto face = faces.back();
    faces.pop_back();
    FaceInfo& info = face->info();
    info.times += up ? 1 : -1;
    Index& first = up ? info.upwards : info.downwards;
    first = std::min(first, member);
    if (cancelled_ == Cancelled::kept) info.members.push_back(member);
    for (int i = 0; i < 3; ++i) {
      if (face->is_constrained(i) && is_on_side(face, i, corners)) continue;
      const auto beyond = face->neighbor(i);
      if (triangulation_.is_infinite(beyond)) throw InternalError("a triangle has a gap");
      if (beyond->info().seen == member) continue;
      beyond->info().seen = member;
      faces.push_back(beyond);
    }
  }
}

void PlaneCut::append(const Triangulation::Face_handle& face, std::vector<Piece>& pieces) const {
  const FaceInfo& info = face->info();
  const bool all = cancelled_ == Cancelled::kept;
  if (all ? info.members.empty() : info.times == 0) return;
  Triangle corners;
  for (int k = 0; k < 3; ++k) corners[k] = face->vertex(k)->info().number;
  const bool up = all ? info.upwards < info.downwards : info.times > 0;
  if (!up) std::swap(corners[1], corners[2]);
  pieces.push_back({corners, all ? 1 : std::abs(info.times), up ? info.upwards : info.downwards,
                    true, info.members});
}

void PlaneCut::append_to(std::vector<Piece>& pieces, Poll& poll) {
  number_crossings();
  for (const Index member : members_) cover(member, poll);
  for (auto face = triangulation_.finite_faces_begin(); face != triangulation_.finite_faces_end();
       ++face) {
    append(face, pieces);
  }
}

}  // namespace tetproof::unite
