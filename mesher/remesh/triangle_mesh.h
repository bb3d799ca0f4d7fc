// A complex of triangles that changes, with its lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/ids.h"

namespace delmesher::remesh {

using Triangle = std::array<VertexId, 3>;
using Line = std::array<VertexId, 2>;

// Triangles in the place of others, and lines in the place of others.
struct Patch {
  std::vector<std::uint32_t> removed;  // triangles
  std::vector<Triangle> added;
  std::vector<std::int32_t> labels;  // of those added
  std::vector<std::uint32_t> removed_lines;
  std::vector<Line> added_lines;
  // Tetrahedra, flat ones among them, that the surface passes through on its way, and those faces
  // of them that are on the surface neither before nor afterwards.
  std::vector<std::array<VertexId, 4>> swept;
  std::vector<Triangle> between;
};

// Triangles and lines keep their numbers as long as they exist.
class TriangleMesh {
 public:
  // `lines` are edges of the triangles.
  TriangleMesh(std::span<const Triangle> triangles, std::span<const std::int32_t> labels,
               std::span<const Line> lines, std::size_t vertices);

  const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
  std::int32_t label(std::uint32_t t) const { return labels_[t]; }
  const Line& line(std::uint32_t l) const { return lines_[l]; }
  std::uint32_t triangles() const { return static_cast<std::uint32_t>(triangles_.size()); }
  std::uint32_t lines() const { return static_cast<std::uint32_t>(lines_.size()); }
  bool has_triangle(std::uint32_t t) const { return triangles_[t][0] != kNone; }
  std::size_t count() const { return count_; }

  // The triangles and lines at a vertex, in the order in which they came.
  std::span<const std::uint32_t> star(VertexId v) const { return star_[v]; }
  std::span<const std::uint32_t> lines_at(VertexId v) const { return lines_at_[v]; }
  std::size_t vertices() const { return star_.size(); }

  // Those at an edge.
  std::vector<std::uint32_t> triangles_at(VertexId a, VertexId b) const;
  // kNone if the edge is not a line.
  std::uint32_t line_at(VertexId a, VertexId b) const;
  // The vertices that share an edge with v, sorted.
  std::vector<VertexId> neighbours(VertexId v) const;

  // Numbers of the added triangles and lines are the next free ones, in order.
  void apply(const Patch& patch);

 private:
  void add_triangle(const Triangle& t, std::int32_t label);
  void add_line(const Line& line);

  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> labels_;
  std::vector<Line> lines_;
  std::vector<std::vector<std::uint32_t>> star_, lines_at_;
  std::size_t count_ = 0;
};

bool contains(const Triangle& t, VertexId v);
// Can one get from each triangle at v to each other one by edges at v?
bool hangs_together(const TriangleMesh& mesh, VertexId v);
// The corner that is neither a nor b.
VertexId third(const Triangle& t, VertexId a, VertexId b);
// With b in the place of a.
Triangle with(Triangle t, VertexId a, VertexId b);

}  // namespace delmesher::remesh
