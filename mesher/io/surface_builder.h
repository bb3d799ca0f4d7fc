// Collects the vertices and faces that a reader finds, and makes a Surface of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesher/base/polling.h"
#include "mesher/delmesher_files.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {

// Counts beyond these are rejected: indices are 32 bits and so are half-edges.
inline constexpr std::uint64_t kMaxVertices = 0xfffffff0ULL;
inline constexpr std::uint64_t kMaxTriangles = 0xffffffffULL / 3;

class SurfaceBuilder {
 public:
  // ReadOptions::go_on; every function may throw ReadingStopped.
  explicit SurfaceBuilder(const std::function<bool()>& go_on) : polling_(go_on) {}

  // Room for so many elements as a file of `bytes` more bytes can hold at most.
  void expect(std::uint64_t vertices, std::uint64_t polygons, std::uint64_t bytes);

  // Coordinates must be finite.
  void add_vertex(double x, double y, double z, Position position);
  std::uint64_t vertex_count() const { return surface_.vertices.size(); }
  const std::vector<std::array<double, 3>>& vertices() const { return surface_.vertices; }

  // At least three corners; they may refer to vertices that are added later.
  void add_polygon(std::span<const std::uint32_t> corners, std::int32_t label, Position position);
  // loops[0] with the other loops as holes; all vertices must have been added.
  void add_polygon_with_holes(std::span<const std::vector<std::uint32_t>> loops, std::int32_t label,
                              Position position);

  // The faces may go round either way; what is inside is said by hole points (orient_facets).
  void take_either_orientation(std::vector<std::array<double, 3>> holes) {
    holes_ = std::move(holes);
  }

  void add_region_point(RegionPoint point) { region_points_.push_back(std::move(point)); }
  const std::vector<RegionPoint>& region_points() const { return region_points_; }

  // An edge between vertices that have been added: for outlines in the plane, not of the surface.
  void add_line(const std::array<std::uint32_t, 2>& ends) { lines_.push_back(ends); }
  const std::vector<std::array<std::uint32_t, 2>>& lines() const { return lines_; }

  // Something the user should know; each text once.
  void warn(const std::string& text);
  // Something worth telling in a log.
  void note(const std::string& text) { notes_.push_back(text); }

  // The name of a label; an empty one is none.
  void name_label(std::int32_t label, std::string_view name) {
    if (!name.empty()) names_[label] = as_utf8(name);
  }
  const LabelNames& names() const { return names_; }
  // Makes one label of all, without a name: the file has told only one apart.
  void forget_labels();

  // Replaces vertices of equal coordinates by the first of them (-0 = +0, written as +0).
  void weld();

  // Asks finish() to join vertices at the same place where that closes the surface: formats repeat
  // them along seams of textures and normals.
  void weld_seams() { seams_ = true; }

  // Triangulates and checks; throws ParseError, also if there are neither faces nor lines.
  Surface finish();
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Polygon {
    std::uint64_t end;  // in corners_
    std::int32_t label;
    Position position;
  };

  void check_corners(std::span<const std::uint32_t> corners, Position position) const;
  void triangulate(std::span<const std::vector<std::uint32_t>> loops, std::int32_t label,
                   Position position);
  void add_triangle(const std::array<std::uint32_t, 3>& triangle, std::int32_t label);
  void join_seams();
  void report_polygons();
  void report_unused_vertices();

  Polling polling_;
  Surface surface_;
  bool labelled_ = false, seams_ = false;
  std::vector<std::uint32_t> corners_;
  std::vector<Polygon> polygons_;
  std::vector<std::array<std::uint32_t, 2>> lines_;
  std::vector<std::string> warnings_, notes_;
  LabelNames names_;
  std::vector<RegionPoint> region_points_;
  std::optional<std::vector<std::array<double, 3>>> holes_;

  std::uint64_t triangulated_ = 0, non_planar_ = 0, non_simple_ = 0;
  double deviation_ = 0;
  Position first_non_planar_, first_non_simple_;
};

}  // namespace delmesher::io
