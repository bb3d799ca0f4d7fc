// TetGen's .poly and .smesh (TetGen manual, "File formats"). Facet markers become labels. A facet
// of several polygons is the union of those polygons, less the ones that a hole point lies in.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "mesher/geometry/projected_face.h"
#include "mesher/geometry/triangulate.h"
#include "mesher/io/numbered_lists.h"
#include "mesher/io/readers.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

class TetgenReader {
 public:
  TetgenReader(std::string_view text, SurfaceBuilder& builder) : in_(text), builder_(builder) {}

  void read_nodes(bool own_file);
  // False if the file leaves the points to a .node file.
  bool read_point_header();
  void set_base(std::uint64_t base) { in_.set_base(base); }
  std::uint64_t base() const { return in_.base(); }
  void read_facets(TetgenKind kind);
  void read_holes_and_regions();

 private:
  Point3 need_point();
  RegionPoint read_region();
  void read_corners(std::uint64_t count, Loop& loop);
  void read_smesh_facet();
  void read_poly_facet();
  void add_loops(std::vector<Loop> loops, const std::vector<Point3>& holes, std::int32_t label,
                 Position position);

  NumberedLists in_;
  SurfaceBuilder& builder_;
  std::uint64_t points_ = 0;
  bool markers_ = false;
};

Point3 TetgenReader::need_point() {
  Point3 point;
  for (double& x : point) {
    std::string_view token;
    if (!in_.lines().next_token(token)) fail(in_.here(), "fewer than 3 coordinates");
    const NumberStatus status = parse_double(token, x);
    if (status == NumberStatus::malformed) fail(in_.here(), "bad number " + in_quotes(token));
    if (status == NumberStatus::not_finite) {
      fail(in_.here(), "non-finite coordinate " + in_quotes(token));
    }
  }
  return point;
}

bool TetgenReader::read_point_header() {
  in_.need_line("the number of points");
  points_ = in_.need_integer<std::uint64_t>("number of points");
  const auto dimension = in_.integer_or<std::int64_t>(3, "dimension");
  if (dimension != 3) {
    fail(in_.here(), "points of dimension " + std::to_string(dimension) + ", a surface needs 3");
  }
  return points_ != 0;
}

void TetgenReader::read_nodes(bool own_file) {
  in_.check_count(points_, kMaxVertices, "points");
  builder_.expect(points_, 0, in_.lines().remaining());
  for (std::uint64_t i = 0; i < points_; ++i) {
    in_.need_line("a point");
    in_.need_number_of_item(i, "point", "points");
    const Point3 p = need_point();
    builder_.add_vertex(p[0], p[1], p[2], in_.here());
  }
  if (own_file && in_.lines().next_line()) builder_.warn("lines after the last point ignored");
}

void TetgenReader::read_corners(std::uint64_t count, Loop& loop) {
  if (count > kMaxPolygonCorners) {
    fail(in_.here(), "a face with " + std::to_string(count) + " corners (the limit is " +
                         std::to_string(kMaxPolygonCorners) + ")");
  }
  loop.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string_view token;
    if (!in_.lines().next_token_anywhere(token)) fail(in_.here(), "the file ends in a face");
    loop.push_back(in_.vertex(token, builder_.vertex_count()));
  }
}

void TetgenReader::read_smesh_facet() {
  in_.need_line("a facet");
  const Position position = in_.here();
  const auto count = in_.need_integer<std::uint64_t>("number of corners");
  Loop loop;
  read_corners(count, loop);
  const auto marker = markers_ ? in_.integer_or<std::int32_t>(0, "marker") : 0;
  add_loops({loop}, {}, marker, position);
}

void TetgenReader::read_poly_facet() {
  in_.need_line("a facet");
  const Position position = in_.here();
  const auto polygons = in_.need_integer<std::uint64_t>("number of polygons");
  const auto holes = in_.integer_or<std::uint64_t>(0, "number of holes");
  const auto marker = markers_ ? in_.integer_or<std::int32_t>(0, "marker") : 0;
  in_.check_count(polygons, kMaxTriangles, "polygons");
  std::vector<Loop> loops;
  std::size_t corners = 0;
  for (std::uint64_t i = 0; i < polygons; ++i) {
    in_.need_line("a polygon");
    Loop loop;
    read_corners(in_.need_integer<std::uint64_t>("number of corners"), loop);
    corners += loop.size();
    if (holes > 0 && corners > kMaxPolygonCorners) {
      fail(in_.here(),
           "a facet with holes and more than " + std::to_string(kMaxPolygonCorners) + " corners");
    }
    loops.push_back(std::move(loop));
  }
  in_.check_count(holes, kMaxPolygonCorners, "holes");
  std::vector<Point3> hole_points;
  for (std::uint64_t i = 0; i < holes; ++i) {
    in_.need_line("a hole of a facet");
    in_.need_integer<std::int64_t>("hole number");
    hole_points.push_back(need_point());
  }
  add_loops(std::move(loops), hole_points, marker, position);
}

double projected_area(const std::vector<Point3>& vertices, const Loop& loop, int axis) {
  double area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto a = project(vertices[loop[i]], axis);
    const auto b = project(vertices[loop[(i + 1) % loop.size()]], axis);
    area += (a[0] - b[0]) * (a[1] + b[1]) / 2;
  }
  return std::fabs(area);
}

// Index of the smallest loop with `wanted` that contains the point, or loops.size().
std::size_t innermost(const std::vector<Point3>& vertices, const std::vector<Loop>& loops,
                      const std::vector<std::uint8_t>& is_hole, bool wanted, int axis,
                      const std::array<double, 2>& q) {
  std::size_t best = loops.size();
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if ((is_hole[i] != 0) != wanted || !strictly_inside(vertices, loops[i], axis, q)) continue;
    const double area = projected_area(vertices, loops[i], axis);
    if (best == loops.size() || area < best_area) {
      best = i;
      best_area = area;
    }
  }
  return best;
}

void TetgenReader::add_loops(std::vector<Loop> loops, const std::vector<Point3>& holes,
                             std::int32_t label, Position position) {
  const std::size_t before = loops.size();
  std::erase_if(loops, [](const Loop& loop) { return loop.size() < 3; });
  if (loops.size() < before) builder_.warn("polygons of one or two corners ignored");
  if (holes.empty()) {
    for (const Loop& loop : loops) builder_.add_polygon(loop, label, position);
    return;
  }
  if (loops.empty()) fail(position, "holes in a facet without polygons");
  const auto& vertices = builder_.vertices();
  const int axis = dominating_axis(vertices, loops[0]);
  std::vector<std::uint8_t> is_hole(loops.size(), 0);
  for (const Point3& point : holes) {
    const std::size_t hole = innermost(vertices, loops, is_hole, false, axis, project(point, axis));
    if (hole == loops.size()) fail(position, "a hole point inside no polygon of its facet");
    is_hole[hole] = 1;
  }
  std::vector<std::vector<Loop>> groups(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (is_hole[i] == 0) groups[i].push_back(loops[i]);
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (is_hole[i] == 0) continue;
    const std::size_t outer =
        innermost(vertices, loops, is_hole, false, axis, project(vertices[loops[i][0]], axis));
    if (outer == loops.size()) fail(position, "a hole that is not inside a polygon of its facet");
    groups[outer].push_back(loops[i]);
  }
  for (const auto& group : groups) {
    if (!group.empty()) builder_.add_polygon_with_holes(group, label, position);
  }
}

void TetgenReader::read_facets(TetgenKind kind) {
  in_.need_line("the number of facets");
  const auto facets = in_.need_integer<std::uint64_t>("number of facets");
  markers_ = in_.integer_or<std::int64_t>(0, "marker flag") != 0;
  in_.check_count(facets, kMaxTriangles, "facets");
  builder_.expect(0, facets, in_.lines().remaining());
  for (std::uint64_t i = 0; i < facets; ++i) {
    if (kind == TetgenKind::smesh) {
      read_smesh_facet();
    } else {
      read_poly_facet();
    }
  }
}

// The attribute of a region is its name. Tetrahedra with edges no longer than that of the regular
// one of the largest volume are no larger.
RegionPoint TetgenReader::read_region() {
  RegionPoint region{need_point()};
  const auto number = [this](double& x) {
    std::string_view token;
    if (!in_.lines().next_token(token)) return false;
    if (parse_double(token, x) != NumberStatus::ok)
      fail(in_.here(), "bad number " + in_quotes(token));
    return true;
  };
  double attribute = 0, volume = 0;
  if (number(attribute)) append_double(region.name, attribute);
  if (number(volume) && volume > 0) region.max_edge = std::cbrt(volume * 6 * std::numbers::sqrt2);
  return region;
}

void TetgenReader::read_holes_and_regions() {
  std::vector<Point3> holes;
  for (const std::string what : {"hole", "region"}) {
    if (!in_.lines().next_line()) break;
    const auto count = in_.need_integer<std::uint64_t>("number of " + what + "s");
    in_.check_count(count, std::numeric_limits<std::uint64_t>::max(), what.c_str());
    for (std::uint64_t i = 0; i < count; ++i) {
      in_.need_line(what.c_str());
      in_.need_integer<std::int64_t>(what + " number");
      const bool is_hole = what == "hole";
      RegionPoint region = is_hole ? RegionPoint{need_point()} : read_region();
      if (is_hole) holes.push_back(region.point);
      region.is_hole = is_hole;
      builder_.add_region_point(std::move(region));
    }
  }
  builder_.take_either_orientation(std::move(holes));
  if (in_.lines().next_line()) builder_.warn("lines after the region list ignored");
}

}  // namespace

void read_tetgen(std::string_view text, TetgenKind kind, const NodeFile& node_file,
                 SurfaceBuilder& builder) {
  TetgenReader reader(text, builder);
  if (reader.read_point_header()) {
    reader.read_nodes(false);
  } else {
    const auto nodes = node_file ? node_file() : std::nullopt;
    if (!nodes) fail(at_line(1), "no points, and no .node file beside it");
    TetgenReader node_reader(*nodes, builder);
    try {
      if (node_reader.read_point_header()) node_reader.read_nodes(true);
    } catch (const ParseError& error) {
      fail(at_line(1), "in the .node file, " + describe(error.position) + ": " + error.reason);
    }
    reader.set_base(node_reader.base());
  }
  reader.read_facets(kind);
  reader.read_holes_and_regions();
}

}  // namespace delmesher::io
