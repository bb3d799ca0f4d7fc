#include "corpus/generators/certify.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace tetproof {
namespace {

using delmesher::Surface;
using Kind = delmesher::Defect::Kind;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Index = std::uint32_t;

Kernel::Point_3 point(const std::array<double, 3>& p) {
  return {p[0], p[1], p[2]};
}

bool all_finite(const Surface& surface) {
  return std::all_of(surface.vertices.begin(), surface.vertices.end(), [](const auto& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
}

bool indices_in_range(const Surface& surface) {
  return std::all_of(surface.triangles.begin(), surface.triangles.end(), [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return v < surface.vertices.size(); });
  });
}

bool is_degenerate(const Surface& surface, const std::array<Index, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ||
         CGAL::collinear(point(surface.vertices[t[0]]), point(surface.vertices[t[1]]),
                         point(surface.vertices[t[2]]));
}

// How often each edge is used, from its lower to its higher vertex and back.
using EdgeUses = std::map<std::pair<Index, Index>, std::array<int, 2>>;

EdgeUses edge_uses(const Surface& surface) {
  EdgeUses uses;
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3];
      ++uses[std::minmax(a, b)][a < b ? 0 : 1];
    }
  }
  return uses;
}

// Do the triangles around every vertex form one fan? Each edge has two triangles.
bool vertices_manifold(const Surface& surface) {
  std::vector<std::map<Index, Index>> next(surface.vertices.size());  // around each vertex
  for (const auto& [a, b, c] : surface.triangles) {
    next[a][b] = c;
    next[b][c] = a;
    next[c][a] = b;
  }
  return std::all_of(next.begin(), next.end(), [](const std::map<Index, Index>& link) {
    if (link.empty()) return true;
    std::size_t length = 0;
    Index v = link.begin()->first;
    do {
      const auto at = link.find(v);
      if (at == link.end()) return false;
      v = at->second;
      ++length;
    } while (v != link.begin()->first && length <= link.size());
    return length == link.size();
  });
}

// Not every release of CGAL calls two triangles with the same corners an intersection.
bool covers_one_twice(const Surface& surface) {
  std::set<std::array<Index, 3>> seen;
  return !std::ranges::all_of(surface.triangles, [&seen](std::array<Index, 3> t) {
    std::ranges::sort(t);
    return seen.insert(t).second;
  });
}

bool self_intersects(const Surface& surface) {
  if (covers_one_twice(surface)) return true;
  Mesh mesh;
  std::vector<Mesh::Vertex_index> ids;
  std::vector<bool> used(surface.vertices.size(), false);
  for (const auto& t : surface.triangles) used[t[0]] = used[t[1]] = used[t[2]] = true;
  for (std::size_t v = 0; v < used.size(); ++v) {
    ids.push_back(used[v] ? mesh.add_vertex(point(surface.vertices[v])) : Mesh::Vertex_index());
  }
  for (const auto& [a, b, c] : surface.triangles) {
    if (mesh.add_face(ids[a], ids[b], ids[c]) == Mesh::null_face()) return true;
  }
  return CGAL::Polygon_mesh_processing::does_self_intersect(mesh);
}

}  // namespace

std::optional<Kind> first_defect(const Surface& surface) {
  if (!all_finite(surface)) return Kind::non_finite;
  if (!indices_in_range(surface)) return Kind::index_out_of_range;
  if (surface.triangles.empty()) return Kind::empty;
  for (const auto& t : surface.triangles) {
    if (is_degenerate(surface, t)) return Kind::degenerate_triangle;
  }
  const EdgeUses uses = edge_uses(surface);
  for (const auto& [edge, use] : uses) {
    if (use[0] + use[1] == 1) return Kind::open_edge;
  }
  for (const auto& [edge, use] : uses) {
    if (use[0] + use[1] > 2) return Kind::non_manifold_edge;
  }
  for (const auto& [edge, use] : uses) {
    if (use[0] != 1) return Kind::inconsistent_orientation;
  }
  if (!vertices_manifold(surface)) return Kind::non_manifold_vertex;
  if (self_intersects(surface)) return Kind::self_intersection;
  return {};
}

namespace {

// A convex polygon from its directed edges, beginning at `first`.
std::vector<Index> loop_of(const std::map<Index, Index>& next, Index first) {
  std::vector<Index> loop = {first};
  for (Index v = next.at(first); v != first && loop.size() <= next.size(); v = next.at(v)) {
    loop.push_back(v);
  }
  return loop;
}

// Adds the triangles of a convex polygon around a corner: the first in the order of `vertices` for
// which no triangle is degenerate.
void add_fan(const std::map<Index, Index>& next, Surface& surface) {
  for (const auto& [first, second] : next) {
    const std::vector<Index> loop = loop_of(next, first);
    std::vector<std::array<Index, 3>> fan;
    for (std::size_t i = 2; i < loop.size(); ++i) fan.push_back({first, loop[i - 1], loop[i]});
    const bool good = std::none_of(fan.begin(), fan.end(),
                                   [&](const auto& t) { return is_degenerate(surface, t); });
    if (!good) continue;
    surface.triangles.insert(surface.triangles.end(), fan.begin(), fan.end());
    return;
  }
}

}  // namespace

// CGAL's hull depends on addresses where points are coplanar. Only its facets, which are unique,
// are taken from it, and triangulated in the order of the points.
Surface convex_hull(const std::vector<std::array<double, 3>>& points) {
  std::vector<Kernel::Point_3> input;
  for (const auto& p : points) input.push_back(point(p));
  Mesh mesh;
  CGAL::convex_hull_3(input.begin(), input.end(), mesh);
  std::set<Kernel::Point_3> left;
  for (const auto v : mesh.vertices()) left.insert(mesh.point(v));
  Surface surface;
  for (const auto& p : points) {
    if (left.erase(point(p)) > 0) surface.vertices.push_back(p);
  }
  std::map<Kernel::Point_3, Index> number;
  for (Index v = 0; v < surface.vertices.size(); ++v) number[point(surface.vertices[v])] = v;
  const auto corner = [&](Mesh::Halfedge_index h) { return number.at(mesh.point(mesh.target(h))); };
  const auto is_flat = [&](Mesh::Halfedge_index h) {
    const auto other = mesh.opposite(h);
    return CGAL::coplanar(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)),
                          mesh.point(mesh.target(mesh.next(h))),
                          mesh.point(mesh.target(mesh.next(other))));
  };
  std::vector<std::map<Index, Index>> facets;  // border edges of each, from corner to corner
  std::vector<bool> seen(mesh.number_of_faces(), false);
  for (const auto start : mesh.faces()) {
    if (seen[start]) continue;
    seen[start] = true;
    facets.emplace_back();
    std::vector<Mesh::Face_index> queue = {start};
    while (!queue.empty()) {
      const auto f = queue.back();
      queue.pop_back();
      for (const auto h : mesh.halfedges_around_face(mesh.halfedge(f))) {
        const auto beyond = mesh.face(mesh.opposite(h));
        if (!is_flat(h)) {
          facets.back()[corner(mesh.opposite(h))] = corner(h);
        } else if (!seen[beyond]) {
          seen[beyond] = true;
          queue.push_back(beyond);
        }
      }
    }
  }
  std::sort(facets.begin(), facets.end());
  for (const auto& facet : facets) add_fan(facet, surface);
  return surface;
}

}  // namespace tetproof
