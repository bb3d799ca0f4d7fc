#include "mesher/remesh/triangle_mesh.h"

#include <algorithm>

namespace delmesher::remesh {

bool contains(const Triangle& t, VertexId v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

VertexId third(const Triangle& t, VertexId a, VertexId b) {
  return *std::ranges::find_if(t, [&](VertexId v) { return v != a && v != b; });
}

Triangle with(Triangle t, VertexId a, VertexId b) {
  std::ranges::replace(t, a, b);
  return t;
}

TriangleMesh::TriangleMesh(std::span<const Triangle> triangles,
                           std::span<const std::int32_t> labels, std::span<const Line> lines,
                           std::size_t vertices)
    : star_(vertices), lines_at_(vertices) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    add_triangle(triangles[t], labels.empty() ? 0 : labels[t]);
  }
  for (const Line& line : lines) add_line(line);
}

void TriangleMesh::add_triangle(const Triangle& t, std::int32_t label) {
  for (const VertexId v : t) {
    if (v >= star_.size()) {
      star_.resize(v + 1);
      lines_at_.resize(v + 1);
    }
    star_[v].push_back(triangles());
  }
  triangles_.push_back(t);
  labels_.push_back(label);
  ++count_;
}

void TriangleMesh::add_line(const Line& line) {
  for (const VertexId v : line) lines_at_[v].push_back(lines());
  lines_.push_back(line);
}

std::vector<std::uint32_t> TriangleMesh::triangles_at(VertexId a, VertexId b) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : star_[a]) {
    if (contains(triangles_[t], b)) found.push_back(t);
  }
  return found;
}

std::uint32_t TriangleMesh::line_at(VertexId a, VertexId b) const {
  for (const std::uint32_t l : lines_at_[a]) {
    if (lines_[l][0] == b || lines_[l][1] == b) return l;
  }
  return kNone;
}

std::vector<VertexId> TriangleMesh::neighbours(VertexId v) const {
  std::vector<VertexId> found;
  for (const std::uint32_t t : star_[v]) {
    for (const VertexId w : triangles_[t]) {
      if (w != v) found.push_back(w);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void TriangleMesh::apply(const Patch& patch) {
  for (const std::uint32_t t : patch.removed) {
    for (const VertexId v : triangles_[t]) std::erase(star_[v], t);
    triangles_[t][0] = kNone;
    --count_;
  }
  for (const std::uint32_t l : patch.removed_lines) {
    for (const VertexId v : lines_[l]) std::erase(lines_at_[v], l);
    lines_[l][0] = kNone;
  }
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    add_triangle(patch.added[i], patch.labels[i]);
  }
  for (const Line& line : patch.added_lines) add_line(line);
}

bool hangs_together(const TriangleMesh& mesh, VertexId v) {
  std::vector<std::uint32_t> left(mesh.star(v).begin(), mesh.star(v).end());
  if (left.empty()) return true;
  std::vector<std::uint32_t> seen = {left.back()};
  left.pop_back();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (const VertexId w : mesh.triangle(seen[i])) {
      if (w == v) continue;
      std::erase_if(left, [&](std::uint32_t t) {
        const bool beside = contains(mesh.triangle(t), w);
        if (beside) seen.push_back(t);
        return beside;
      });
    }
  }
  return left.empty();
}

}  // namespace delmesher::remesh
