// TetGen's .poly and .smesh (TetGen manual, "File formats"). Facet markers become labels. A facet
// of several polygons is the union of those polygons, less the ones that a hole point lies in.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mesher/io/projected_face.h"
#include "mesher/io/readers.h"
#include "mesher/io/text.h"
#include "mesher/io/triangulate.h"

namespace delmesher::io {
namespace {

class TetgenReader {
 public:
  TetgenReader(std::string_view text, SurfaceBuilder& builder)
      : in_(text, Comments::anywhere, ','), builder_(builder) {}

  void read_nodes(bool own_file);
  // False if the file leaves the points to a .node file.
  bool read_point_header();
  void set_base(std::uint64_t base) { base_ = base; }
  std::uint64_t base() const { return base_; }
  void read_facets(TetgenKind kind);
  void read_holes_and_regions();

 private:
  Position here() const { return at_line(in_.line()); }
  void need_line(const char* what) {
    if (!in_.next_line()) fail(here(), std::string("the file ends where ") + what + " is expected");
  }
  template <typename T>
  T need_integer(const char* what) {
    std::string_view token;
    if (!in_.next_token(token)) fail(here(), std::string(what) + " is missing");
    T value{};
    if (!parse_integer(token, value))
      fail(here(), "bad " + std::string(what) + " " + quoted(token));
    return value;
  }
  template <typename T>
  T integer_or(T fallback, const char* what) {
    std::string_view token;
    if (!in_.next_token(token)) return fallback;
    T value{};
    if (!parse_integer(token, value))
      fail(here(), "bad " + std::string(what) + " " + quoted(token));
    return value;
  }
  Point3 need_point();
  void check_count(std::uint64_t count, std::uint64_t limit, const char* what) const;
  void read_corners(std::uint64_t count, Loop& loop);
  void read_smesh_facet();
  void read_poly_facet();
  void add_loops(std::vector<Loop> loops, const std::vector<Point3>& holes, std::int32_t label,
                 Position position);

  TextLines in_;
  SurfaceBuilder& builder_;
  std::uint64_t points_ = 0;
  std::uint64_t base_ = 0;
  bool markers_ = false;
};

Point3 TetgenReader::need_point() {
  Point3 point;
  for (double& x : point) {
    std::string_view token;
    if (!in_.next_token(token)) fail(here(), "fewer than 3 coordinates");
    const NumberStatus status = parse_double(token, x);
    if (status == NumberStatus::malformed) fail(here(), "bad number " + quoted(token));
    if (status == NumberStatus::not_finite) {
      fail(here(), "non-finite coordinate " + quoted(token));
    }
  }
  return point;
}

// Every item takes a line of at least two bytes.
void TetgenReader::check_count(std::uint64_t count, std::uint64_t limit, const char* what) const {
  if (count > limit || count > in_.remaining() / 2 + 1) {
    fail(here(), "the file is too short for " + std::to_string(count) + " " + what);
  }
}

bool TetgenReader::read_point_header() {
  need_line("the number of points");
  points_ = need_integer<std::uint64_t>("number of points");
  const auto dimension = integer_or<std::int64_t>(3, "dimension");
  if (dimension != 3) {
    fail(here(), "points of dimension " + std::to_string(dimension) + ", a surface needs 3");
  }
  return points_ != 0;
}

void TetgenReader::read_nodes(bool own_file) {
  check_count(points_, kMaxVertices, "points");
  builder_.expect(points_, 0, in_.remaining());
  for (std::uint64_t i = 0; i < points_; ++i) {
    need_line("a point");
    const auto number = need_integer<std::uint64_t>("point number");
    if (i == 0) base_ = number;
    if (base_ > 1) fail(here(), "points have to be numbered from 0 or 1");
    if (number != base_ + i) {
      fail(here(), "point number " + std::to_string(number) + " where " +
                       std::to_string(base_ + i) + " is expected");
    }
    const Point3 p = need_point();
    builder_.add_vertex(p[0], p[1], p[2], here());
  }
  if (own_file && in_.next_line()) builder_.warn("lines after the last point ignored");
}

void TetgenReader::read_corners(std::uint64_t count, Loop& loop) {
  if (count > kMaxPolygonCorners) {
    fail(here(), "a face with " + std::to_string(count) + " corners (the limit is " +
                     std::to_string(kMaxPolygonCorners) + ")");
  }
  loop.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string_view token;
    if (!in_.next_token_anywhere(token)) fail(here(), "the file ends in a face");
    std::uint64_t corner = 0;
    if (!parse_integer(token, corner)) fail(here(), "bad vertex index " + quoted(token));
    if (corner < base_ || corner - base_ >= builder_.vertex_count()) {
      fail(here(), "vertex index out of range: " + std::string(token) + " of " +
                       std::to_string(builder_.vertex_count()) + " (numbered from " +
                       std::to_string(base_) + ")");
    }
    loop.push_back(static_cast<std::uint32_t>(corner - base_));
  }
}

void TetgenReader::read_smesh_facet() {
  need_line("a facet");
  const Position position = here();
  const auto count = need_integer<std::uint64_t>("number of corners");
  Loop loop;
  read_corners(count, loop);
  const auto marker = markers_ ? integer_or<std::int32_t>(0, "marker") : 0;
  add_loops({loop}, {}, marker, position);
}

void TetgenReader::read_poly_facet() {
  need_line("a facet");
  const Position position = here();
  const auto polygons = need_integer<std::uint64_t>("number of polygons");
  const auto holes = integer_or<std::uint64_t>(0, "number of holes");
  const auto marker = markers_ ? integer_or<std::int32_t>(0, "marker") : 0;
  check_count(polygons, kMaxTriangles, "polygons");
  std::vector<Loop> loops;
  std::size_t corners = 0;
  for (std::uint64_t i = 0; i < polygons; ++i) {
    need_line("a polygon");
    Loop loop;
    read_corners(need_integer<std::uint64_t>("number of corners"), loop);
    corners += loop.size();
    if (holes > 0 && corners > kMaxPolygonCorners) {
      fail(here(),
           "a facet with holes and more than " + std::to_string(kMaxPolygonCorners) + " corners");
    }
    loops.push_back(std::move(loop));
  }
  check_count(holes, kMaxPolygonCorners, "holes");
  std::vector<Point3> hole_points;
  for (std::uint64_t i = 0; i < holes; ++i) {
    need_line("a hole of a facet");
    need_integer<std::int64_t>("hole number");
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
  need_line("the number of facets");
  const auto facets = need_integer<std::uint64_t>("number of facets");
  markers_ = integer_or<std::int64_t>(0, "marker flag") != 0;
  check_count(facets, kMaxTriangles, "facets");
  builder_.expect(0, facets, in_.remaining());
  for (std::uint64_t i = 0; i < facets; ++i) {
    if (kind == TetgenKind::smesh) {
      read_smesh_facet();
    } else {
      read_poly_facet();
    }
  }
}

// Volume holes and regions say nothing that parity does not, or ask for more than a surface.
void TetgenReader::read_holes_and_regions() {
  for (const char* what : {"hole", "region"}) {
    if (!in_.next_line()) return;
    const auto count =
        need_integer<std::uint64_t>((std::string("number of ") + what + "s").c_str());
    check_count(count, std::numeric_limits<std::uint64_t>::max(), what);
    for (std::uint64_t i = 0; i < count; ++i) {
      need_line(what);
      need_integer<std::int64_t>((std::string(what) + " number").c_str());
      need_point();
    }
    if (count > 0) {
      builder_.warn(std::to_string(count) + " " + what +
                    " points ignored: what is inside is decided by parity");
    }
  }
  if (in_.next_line()) builder_.warn("lines after the region list ignored");
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
