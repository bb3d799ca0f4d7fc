#include <algorithm>

#include "mesher/io/exact_file.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

bool is_corner(const ExactPoint& p) {
  return p.kind == ExactPoint::Kind::explicit_point || p.kind == ExactPoint::Kind::on_planes;
}

class ExactReader {
 public:
  explicit ExactReader(std::string_view text) : in_(text, Comments::anywhere) {}

  ExactRecord read();

 private:
  Position here() const { return at_line(in_.line()); }
  void line() {
    if (!in_.next_line()) fail(here(), "the file ends before its 'end'");
  }
  std::string_view token() {
    std::string_view out;
    if (!in_.next_token(out)) fail(here(), "the line is too short");
    return out;
  }
  template <typename T>
  T integer() {
    const std::string_view t = token();
    T value{};
    if (!parse_integer(t, value)) fail(here(), "bad integer " + in_quotes(t));
    return value;
  }
  std::uint32_t point() {
    const auto index = integer<std::uint32_t>();
    if (index >= record_.points.size()) fail(here(), "a point index out of range");
    return index;
  }
  bool flag() {
    const auto value = integer<int>();
    if (value != 0 && value != 1) fail(here(), "a flag that is neither 0 nor 1");
    return value == 1;
  }
  double number() {
    const std::string_view t = token();
    double value = 0;
    if (parse_hex_double(t, value) != NumberStatus::ok) {
      fail(here(), "bad hexadecimal number " + in_quotes(t));
    }
    return value;
  }
  void line_end() {
    std::string_view t;
    if (in_.next_token(t)) fail(here(), "unexpected " + in_quotes(t));
  }
  std::uint64_t section(std::string_view name);
  template <typename Read>
  void items(std::string_view name, Read read) {
    const std::uint64_t count = section(name);
    for (std::uint64_t i = 0; i < count; ++i) {
      line();
      read();
      line_end();
    }
  }
  void read_parameters(std::uint64_t version);
  void read_plane();
  void read_triangle();
  void read_point();
  void read_facet();
  void read_segment();
  void read_corner(std::uint64_t version);
  void read_chamfer_point();
  void read_ball();
  void check_references();
  std::vector<std::uint32_t> list(bool of_points);
  void tets(std::string_view name, std::vector<ExactRecord::Tet>& out);
  void triangles(std::string_view name, std::vector<std::array<std::uint32_t, 4>>& out);

  TextLines in_;
  ExactRecord record_;
};

std::uint64_t ExactReader::section(std::string_view name) {
  line();
  const std::string_view found = token();
  if (found != name) fail(here(), in_quotes(found) + " instead of " + in_quotes(name));
  const auto count = integer<std::uint64_t>();
  line_end();
  return count;
}

void ExactReader::read_parameters(std::uint64_t version) {
  auto& p = record_.parameters;
  for (double* value : {&p.delta, &p.acute, &p.corner, &p.tolerance}) *value = number();
  p.region = flag() ? Region::hull : Region::interior;
  p.gabriel = flag();
  if (version >= 4) p.planar = number();
}

void ExactReader::read_triangle() {
  std::array<std::uint32_t, 3> corners{};
  for (std::uint32_t& v : corners) v = integer<std::uint32_t>();
  record_.triangles.push_back(corners);
}

void ExactReader::read_point() {
  const std::string_view kind = token();
  ExactPoint p;
  if (kind == "E") {
    p.x = number();
    p.y = number();
    p.z = number();
  } else if (kind == "S") {
    p.kind = ExactPoint::Kind::on_segment;
    p.i = integer<std::uint32_t>();
    p.j = integer<std::uint32_t>();
    p.x = number();
  } else if (kind == "T") {
    p.kind = ExactPoint::Kind::on_triangle;
    p.i = integer<std::uint32_t>();
    p.j = integer<std::uint32_t>();
    p.k = integer<std::uint32_t>();
    p.x = number();
    p.y = number();
  } else if (kind == "P") {
    p.kind = ExactPoint::Kind::on_planes;
    p.i = integer<std::uint32_t>();
    p.j = integer<std::uint32_t>();
    p.k = integer<std::uint32_t>();
  } else {
    fail(here(), "unknown kind of point " + in_quotes(kind));
  }
  record_.points.push_back(p);
}

void ExactReader::read_plane() {
  const std::string_view kind = token();
  ExactRecord::Plane plane;
  plane.spanned = kind == "T";
  if (!plane.spanned && kind != "N") fail(here(), "unknown kind of plane " + in_quotes(kind));
  const auto numbers = [&](std::array<double, 3>& x) {
    for (double& value : x) value = number();
  };
  if (!plane.spanned) numbers(plane.normal);
  numbers(plane.through[0]);
  if (plane.spanned) {
    numbers(plane.through[1]);
    numbers(plane.through[2]);
  }
  record_.planes.push_back(plane);
}

void ExactReader::check_references() {
  const auto& points = record_.points;
  for (const ExactPoint& p : points) {
    if (p.kind == ExactPoint::Kind::explicit_point) continue;
    if (p.kind == ExactPoint::Kind::on_planes) {
      if (std::max({p.i, p.j, p.k}) < record_.planes.size()) continue;
      fail(here(), "a point refers to a plane that does not exist");
    }
    const bool three = p.kind == ExactPoint::Kind::on_triangle;
    for (std::uint32_t r : {p.i, p.j, three ? p.k : p.j}) {
      if (r >= points.size() || !is_corner(points[r])) {
        fail(here(), "a point refers to one that is itself on others");
      }
    }
  }
  for (const auto& corners : record_.triangles) {
    for (const std::uint32_t v : corners) {
      if (v >= points.size()) fail(here(), "a triangle has a corner out of range");
    }
  }
}

void ExactReader::read_facet() {
  ExactRecord::Facet facet{};
  facet.id = integer<std::uint32_t>();
  facet.label = integer<std::int32_t>();
  const auto filtered = integer<std::uint32_t>();
  if (filtered > 2) fail(here(), "a facet is filtered in neither step");
  facet.filtered = static_cast<std::uint8_t>(filtered);
  facet.triangles = list(false);
  record_.facets.push_back(std::move(facet));
}

void ExactReader::read_segment() {
  ExactRecord::Chain chain{};
  const std::string_view kind = token();
  if (kind != "A" && kind != "I") fail(here(), "unknown kind of segment " + in_quotes(kind));
  chain.artificial = kind == "A";
  if (chain.artificial) {
    chain.facet = integer<std::uint32_t>();
  } else if (token() != "-") {
    fail(here(), "an input edge has no facet");
  }
  chain.vertices = list(true);
  record_.segments.push_back(std::move(chain));
}

void ExactReader::read_corner(std::uint64_t version) {
  ExactRecord::Corner corner{};
  corner.vertex = point();
  if (version < 7) number();  // a threshold
  corner.distance = number();
  record_.corners.push_back(corner);
}

void ExactReader::read_chamfer_point() {
  const std::uint32_t p = point();
  record_.chamfer_points.push_back({p, point()});
}

void ExactReader::read_ball() {
  ExactRecord::Ball ball{};
  ball.vertex = point();
  for (std::uint32_t& v : ball.tetrahedron) v = point();
  record_.balls.push_back(ball);
}

std::vector<std::uint32_t> ExactReader::list(bool of_points) {
  const auto count = integer<std::uint64_t>();
  std::vector<std::uint32_t> out;
  for (std::uint64_t i = 0; i < count; ++i) {
    out.push_back(of_points ? point() : integer<std::uint32_t>());
  }
  return out;
}

void ExactReader::tets(std::string_view name, std::vector<ExactRecord::Tet>& out) {
  items(name, [&] {
    ExactRecord::Tet tet{};
    for (std::uint32_t& v : tet.vertices) v = point();
    tet.inside = flag();
    out.push_back(tet);
  });
}

void ExactReader::triangles(std::string_view name, std::vector<std::array<std::uint32_t, 4>>& out) {
  items(name, [&] {
    const std::uint32_t a = point(), b = point(), c = point();
    out.push_back({a, b, c, integer<std::uint32_t>()});
  });
}

ExactRecord ExactReader::read() {
  const std::uint64_t version = section("delmesher-exact");
  if (version < 1 || version > kExactVersion) {
    fail(here(), "unknown version " + std::to_string(version));
  }
  if (version >= 2) items("parameters", [&] { read_parameters(version); });
  if (version >= 6) {
    items("origin", [&] {
      for (double& x : record_.origin) x = number();
    });
  }
  if (version >= 4) {
    items("planes", [&] { read_plane(); });
    items("triangles", [&] { read_triangle(); });
  }
  items("points", [&] { read_point(); });
  check_references();
  items("facets", [&] { read_facet(); });
  items("segments", [&] { read_segment(); });
  items("corners", [&] { read_corner(version); });
  tets("refined", record_.refined);
  triangles("refined_facets", record_.refined_facets);
  tets("final", record_.final);
  triangles("final_facets", record_.final_facets);
  items("mesh_vertices", [&] { record_.mesh_vertices.push_back(point()); });
  if (version >= 2) {
    items("chamfer_points", [&] { read_chamfer_point(); });
    items("balls", [&] { read_ball(); });
    tets("unrepaired", record_.unrepaired);
  }
  if (version >= 3) triangles("unrepaired_facets", record_.unrepaired_facets);
  line();
  if (token() != "end") fail(here(), "'end' missing");
  return std::move(record_);
}

}  // namespace

ExactResult parse_exact(std::string_view text, const std::string& path) {
  try {
    return {{}, ExactReader(text).read()};
  } catch (...) {
    return {end_of_reading(path).error, {}};
  }
}

ExactResult read_exact(const std::string& path) {
  try {
    return parse_exact(read_file(path), path);
  } catch (...) {
    return {end_of_reading(path).error, {}};
  }
}

}  // namespace delmesher::io
