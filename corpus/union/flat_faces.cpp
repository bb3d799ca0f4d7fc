#include "corpus/union/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corpus/union/unite.h"

namespace tetproof::unite {

FlatFaces::VertexHandle FlatFaces::vertex(Index v) {
  const auto [entry, fresh] = vertices_.try_emplace(v);
  if (fresh) {
    entry->second = triangulation_.insert(seen(v));
    entry->second->info().number = v;
  }
  return entry->second;
}

bool FlatFaces::triangulate(const std::function<void(const Segment&, Index, double)>& bend,
                            const std::function<Index(const Segment&, double)>& vertex_at) {
  for (const BentFace& face : faces_) {
    for (const auto& [from, to] : face.boundary) segments_.insert(std::minmax(from, to));
  }
  for (const Index v : extra_) vertex(v);
  for (const auto& [from, to] : segments_) {
    vertex(from);
    vertex(to);
  }
  if (triangulation_.number_of_vertices() != vertices_.size()) return false;
  for (const auto& [from, to] : segments_) {
    triangulation_.insert_constraint(vertices_[from], vertices_[to]);
  }
  bool whole = true;
  for (const Segment& s : segments_) {
    const VertexHandle a = vertices_[s.first], b = vertices_[s.second];
    if (triangulation_.is_edge(a, b)) continue;
    whole = false;
    VertexHandle best;
    double share = 2;
    FaceHandle beside;
    int side = 0;
    for (VertexHandle v = a, next; v != b; v = next) {
      if (!triangulation_.includes_edge(v, b, next, beside, side)) {
        throw InternalError("a side is not in the triangulation of flat faces");
      }
      if (next == b) break;
      const double here =
          std::sqrt(CGAL::to_double(CGAL::squared_distance(a->point(), next->point()) /
                                    CGAL::squared_distance(a->point(), b->point())));
      if (std::fabs(here - 0.5) >= std::fabs(share - 0.5)) continue;
      share = here;
      best = next;
    }
    Index& number = best->info().number;
    if (number == kNone) number = vertex_at(s, share);
    bend(s, number, share);
  }
  return whole;
}

bool FlatFaces::faces_up(const BentFace& face) const {
  Exact::FT twice = 0;
  const Exact::Point_2 origin = seen(face.boundary[0].first);
  for (const auto& [from, to] : face.boundary) {
    twice += CGAL::determinant(seen(from) - origin, seen(to) - origin);
  }
  return twice > 0;
}

FlatFaces::FaceHandle FlatFaces::left_of(Index from, Index to) const {
  FaceHandle face;
  int i = 0;
  triangulation_.is_edge(vertices_.at(from), vertices_.at(to), face, i);
  return face->vertex(Triangulation::ccw(i))->info().number == from ? face : face->neighbor(i);
}

// From the faces along the boundary, over all edges that are not on it.
bool FlatFaces::cover(const BentFace& face, Poll& poll) {
  const bool up = faces_up(face);
  std::set<Segment> sides;
  std::vector<FaceHandle> open;
  for (const auto& [from, to] : face.boundary) {
    if (!sides.insert(std::minmax(from, to)).second) return false;
    open.push_back(up ? left_of(from, to) : left_of(to, from));
  }
  while (!open.empty()) {
    poll();
    const FaceHandle here = open.back();
    open.pop_back();
    if (triangulation_.is_infinite(here)) return false;
    if (std::exchange(here->info().seen, face.triangle) == face.triangle) continue;
    here->info().members.emplace_back(face.triangle, up);
    for (int i = 0; i < 3; ++i) {
      const Segment side = std::minmax(here->vertex(Triangulation::cw(i))->info().number,
                                       here->vertex(Triangulation::ccw(i))->info().number);
      if (!sides.contains(side)) open.push_back(here->neighbor(i));
    }
  }
  return true;
}

bool FlatFaces::append_to(std::vector<Piece>& pieces, Poll& poll) {
  for (const BentFace& face : faces_) {
    if (!cover(face, poll)) return false;
  }
  for (auto face = triangulation_.finite_faces_begin(); face != triangulation_.finite_faces_end();
       ++face) {
    const auto& members = face->info().members;
    if (members.empty()) continue;
    Piece piece = {{}, 1, members[0].first, true, {}};
    for (int k = 0; k < 3; ++k) piece.corners[k] = face->vertex(k)->info().number;
    if (!members[0].second) std::swap(piece.corners[1], piece.corners[2]);
    for (const auto& [member, up] : members) piece.parents.push_back(member);
    pieces.push_back(std::move(piece));
  }
  return true;
}

}  // namespace tetproof::unite
