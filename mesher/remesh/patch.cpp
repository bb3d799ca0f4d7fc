#include "mesher/remesh/patch.h"

#include <algorithm>

namespace delmesher::remesh {
namespace {

bool repeats(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::ranges::sort(t);
  std::ranges::sort(triangles);
  return std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end();
}

// The ends of the edge have no neighbours in common but those of its triangles, and no edges
// opposite them.
bool links_allow(const TriangleMesh& mesh, VertexId a, VertexId b) {
  std::vector<VertexId> apexes;
  for (const std::uint32_t t : mesh.triangles_at(a, b)) {
    apexes.push_back(third(mesh.triangle(t), a, b));
  }
  std::ranges::sort(apexes);
  std::vector<VertexId> common;
  const std::vector<VertexId> of_a = mesh.neighbours(a), of_b = mesh.neighbours(b);
  std::ranges::set_intersection(of_a, of_b, std::back_inserter(common));
  return common == apexes && std::ranges::none_of(mesh.star(a), [&](std::uint32_t t) {
           const Triangle& triangle = mesh.triangle(t);
           if (contains(triangle, b)) return false;
           const Triangle other = with(triangle, a, b);
           const VertexId u = other[0] == b ? other[1] : other[0], v = third(other, b, u);
           return std::ranges::any_of(mesh.star(b), [&](std::uint32_t s) {
             return contains(mesh.triangle(s), u) && contains(mesh.triangle(s), v);
           });
         });
}

// The triangles and lines at v get p in its place, but for those that have `gone`.
void replace_vertex(const TriangleMesh& mesh, VertexId v, VertexId p, VertexId gone, Patch& patch) {
  for (const std::uint32_t t : mesh.star(v)) {
    const Triangle& triangle = mesh.triangle(t);
    if (std::ranges::find(patch.removed, t) == patch.removed.end()) patch.removed.push_back(t);
    if (contains(triangle, gone)) continue;
    patch.added.push_back(with(triangle, v, p));
    patch.labels.push_back(mesh.label(t));
    patch.swept.push_back({triangle[0], triangle[1], triangle[2], p});
  }
  for (const std::uint32_t l : mesh.lines_at(v)) {
    const Line& line = mesh.line(l);
    if (std::ranges::find(patch.removed_lines, l) == patch.removed_lines.end()) {
      patch.removed_lines.push_back(l);
    }
    const VertexId other = line[0] == v ? line[1] : line[0];
    if (other != gone) patch.added_lines.push_back({p, other});
  }
  for (const VertexId u : mesh.neighbours(v)) {
    if (u != gone && u != p) patch.between.push_back({v, p, u});
  }
}

}  // namespace

std::optional<Patch> collapse_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId p) {
  if (!links_allow(mesh, a, b)) return std::nullopt;
  Patch patch;
  replace_vertex(mesh, a, p, b, patch);
  if (p != b) {
    replace_vertex(mesh, b, p, a, patch);
    for (const std::uint32_t t : mesh.triangles_at(a, b)) {
      const Triangle& triangle = mesh.triangle(t);
      patch.swept.push_back({triangle[0], triangle[1], triangle[2], p});
    }
    patch.between.push_back({a, b, p});
  }
  if (repeats(patch.added)) return std::nullopt;
  // Lines beside each other may become one.
  std::vector<Line> lines;
  for (const auto& [v, w] : patch.added_lines) {
    const bool there = (p == b && mesh.line_at(b, w) != kNone) ||
                       std::ranges::any_of(lines, [&, w = w](const Line& l) { return l[1] == w; });
    if (!there) lines.push_back({v, w});
  }
  patch.added_lines = std::move(lines);
  return patch;
}

Patch move_patch(const TriangleMesh& mesh, VertexId v, VertexId p) {
  Patch patch;
  replace_vertex(mesh, v, p, kNone, patch);
  return patch;
}

std::optional<Patch> flip_patch(const TriangleMesh& mesh, VertexId a, VertexId b) {
  const std::vector<std::uint32_t> at = mesh.triangles_at(a, b);
  if (at.size() != 2 || mesh.line_at(a, b) != kNone || mesh.label(at[0]) != mesh.label(at[1])) {
    return std::nullopt;
  }
  const VertexId c = third(mesh.triangle(at[0]), a, b), d = third(mesh.triangle(at[1]), a, b);
  if (c == d || !mesh.triangles_at(c, d).empty()) return std::nullopt;
  Patch patch;
  patch.removed = at;
  patch.added = {with(mesh.triangle(at[0]), b, d), with(mesh.triangle(at[0]), a, d)};
  patch.labels = {mesh.label(at[0]), mesh.label(at[1])};
  patch.swept = {{a, b, c, d}};
  return patch;
}

std::optional<Patch> bypass_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId v) {
  const std::vector<std::uint32_t> at = mesh.triangles_at(a, b);
  if (at.size() != 2) return std::nullopt;
  const std::size_t flat = contains(mesh.triangle(at[0]), v) ? 0 : 1;
  const Triangle& other = mesh.triangle(at[1 - flat]);
  const VertexId w = third(other, a, b);
  if (w == v || !mesh.triangles_at(v, w).empty()) return std::nullopt;
  Patch patch;
  patch.removed = at;
  patch.added = {with(other, b, v), with(other, a, v)};
  patch.labels = {mesh.label(at[1 - flat]), mesh.label(at[1 - flat])};
  patch.swept = {{a, b, v, w}};
  patch.removed_lines = {mesh.line_at(a, b)};
  for (const VertexId end : {a, b}) {
    if (mesh.line_at(end, v) == kNone) patch.added_lines.push_back({end, v});
  }
  return patch;
}

Patch split_patch(const TriangleMesh& mesh, VertexId a, VertexId b, VertexId p) {
  Patch patch;
  for (const std::uint32_t t : mesh.triangles_at(a, b)) {
    const Triangle& triangle = mesh.triangle(t);
    patch.removed.push_back(t);
    for (const VertexId gone : {a, b}) {
      patch.added.push_back(with(triangle, gone, p));
      patch.labels.push_back(mesh.label(t));
    }
    patch.swept.push_back({triangle[0], triangle[1], triangle[2], p});
  }
  if (const std::uint32_t l = mesh.line_at(a, b); l != kNone) {
    patch.removed_lines.push_back(l);
    patch.added_lines = {{a, p}, {p, b}};
  }
  patch.between.push_back({a, b, p});
  return patch;
}

}  // namespace delmesher::remesh
