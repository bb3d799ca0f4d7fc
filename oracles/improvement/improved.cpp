#include "oracles/improvement/improved.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <tuple>
#include <vector>

#include "oracles/base/vectors.h"
#include "oracles/files/edge_nodes.h"
#include "oracles/improvement/local_operations.h"
#include "oracles/record/ordinary_units.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {
namespace {

// The number of a region, and whether the file calls it inside (2 where that is not compared).
using Part = std::pair<std::int64_t, std::uint8_t>;
constexpr Part kNothing = {std::numeric_limits<std::int64_t>::min(), 3};

// A face with something else on either side; on the first side it is seen as an even permutation of
// its ascending corners.
struct Wall {
  Face corners;
  Part first, second;
  auto operator<=>(const Wall&) const = default;
};

struct Listed {
  Face corners;
  bool even = true;  // the permutation of these that the file has
  std::int32_t label = 0;
  Index facet = kNone;
  auto operator<=>(const Listed&) const = default;
};

// One of the two files.
struct Cells {
  TetComplex complex;
  Neighbours neighbours;
  std::vector<Part> parts;  // per tetrahedron
  std::uint64_t inverted = 0, flat = 0;
};

class Improved {
 public:
  Improved(const MeshFile& given, const MeshFile& mesh, const VerifyOptions& options,
           VerifyReport& report)
      : given_(given), mesh_(mesh), options_(options), report_(report) {}

  std::string run() {
    if (std::string why = read_given(); !why.empty()) return why;
    if (!read_mesh()) return {};
    unite_points();
    check_orientation();
    check_walls();
    if (!mesh_.lists_boundary) {
      if (!given_.boundary.empty())
        report_.unproven.emplace_back("triangles and labels of the mesh given (the file has none)");
    } else if (!given_.boundary.empty() || !mesh_.boundary.empty()) {
      check_list();
    }
    if (options_.promised.names) report_.unproven.emplace_back(kOtherNames);
    check_nodes();
    if (options_.promised.max_vertices > 0) {
      add(check_written(options_.promised, mesh_.vertices.size(), mesh_.tetrahedra.size()));
    }
    check_angles();
    return {};
  }

 private:
  std::string read_given();
  bool read_mesh();
  void unite_points();
  void check_orientation();
  void check_walls();
  void check_names(OracleReport& report) const;
  void check_list();
  void check_nodes();
  void check_angles();

  void add(OracleReport report) {
    if (options_.progress) options_.progress(report);
    report_.oracles.push_back(std::move(report));
  }
  void take_tetrahedra(const MeshFile& file, Index offset, Cells& cells) const;
  static void count_signs(Cells& cells);
  void name_parts();
  // By the numbers of the points that both files have.
  Face united(const Face& face) const {
    return {point_[face[0]], point_[face[1]], point_[face[2]]};
  }
  std::vector<Wall> walls(const Cells& cells) const;
  std::vector<Face> faces(const Cells& cells) const;
  std::vector<Listed> listed(const MeshFile& file, Index offset, OracleReport& report) const;
  // Where it is, as numbers differ from file to file.
  std::string name(const Face& face) const;

  const MeshFile &given_, &mesh_;
  const VerifyOptions& options_;
  VerifyReport& report_;
  ExactPoints written_;  // of the file given, then of the other one
  Cells before_, after_;
  bool is_manifold_ = true;   // the mesh given
  std::vector<Index> point_;  // per written vertex its number in points_
  ExactPoints points_;        // without repetition
};

void Improved::take_tetrahedra(const MeshFile& file, Index offset, Cells& cells) const {
  cells.complex.points = &written_;
  cells.complex.tetrahedra = file.tetrahedra;
  cells.complex.inside.assign(file.tetrahedra.size(), 1);
  for (Tet& tet : cells.complex.tetrahedra) {
    for (Index& v : tet) v = v < file.vertices.size() ? v + offset : kNone;
  }
}

void Improved::count_signs(Cells& cells) {
  cells.inverted = cells.flat = 0;
  for (const auto& [a, b, c, d] : cells.complex.tetrahedra) {
    const int sign = exact::orient3d(*cells.complex.points, a, b, c, d);
    cells.inverted += sign < 0 ? 1 : 0;
    cells.flat += sign == 0 ? 1 : 0;
  }
}

// A mesh all of which is turned is meant the other way round. Vertices that nothing uses are
// dropped.
std::string Improved::read_given() {
  if (!std::ranges::all_of(given_.vertices, [](const Position& p) { return is_finite(p); })) {
    return "a vertex of the mesh given is not finite";
  }
  std::vector<Position> positions = given_.vertices;
  for (const Position& p : mesh_.vertices) {
    positions.push_back(is_finite(p) ? p : Position{});  // reported later
  }
  if (std::string why = written_.assign(positions); !why.empty()) return why;
  take_tetrahedra(given_, 0, before_);
  TetComplex& complex = before_.complex;
  OracleReport shape = check_complex(complex, before_.neighbours);
  is_manifold_ = shape.passed();
  if (!is_manifold_) shape = check_complex(complex, before_.neighbours, true);
  if (!shape.passed() || complex.tetrahedra.empty()) {
    return "the mesh given is not conforming: " +
           (shape.findings.empty() ? "it has no tetrahedra" : shape.findings[0]);
  }
  count_signs(before_);
  if (before_.inverted + before_.flat == complex.tetrahedra.size()) {
    for (Tet& tet : complex.tetrahedra) std::swap(tet[2], tet[3]);
    check_complex(complex, before_.neighbours, true);
    count_signs(before_);
  }
  if (before_.inverted == 0) return {};
  return "the mesh given is not conforming: tetrahedra of either orientation";
}

// False if the other oracles would make no sense of it.
bool Improved::read_mesh() {
  const auto offset = static_cast<Index>(given_.vertices.size());
  take_tetrahedra(mesh_, offset, after_);
  after_.complex.first_vertex = offset;
  after_.complex.last_vertex = static_cast<Index>(written_.size());
  OracleReport shape = check_complex(after_.complex, after_.neighbours, !is_manifold_);
  if (after_.complex.tetrahedra.empty() && !is_manifold_) shape.fail("there are no tetrahedra");
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    if (!is_finite(mesh_.vertices[v])) shape.fail("vertex " + std::to_string(v) + " is not finite");
  }
  const bool usable = shape.passed();
  add(std::move(shape));
  return usable;
}

void Improved::unite_points() {
  std::vector<Index> order(written_.size());
  for (Index v = 0; v < order.size(); ++v) order[v] = v;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tie(written_.nearest(a), a) < std::tie(written_.nearest(b), b);
  });
  point_.assign(order.size(), kNone);
  std::vector<Position> positions;
  for (const Index v : order) {
    if (positions.empty() || positions.back() != written_.nearest(v)) {
      positions.push_back(written_.nearest(v));
    }
    point_[v] = static_cast<Index>(positions.size() - 1);
  }
  points_.assign(positions);  // as the written ones could be
}

void Improved::check_orientation() {
  count_signs(after_);
  OracleReport report("orientation", "tetrahedra");
  report.checked = after_.complex.tetrahedra.size();
  report.figures = {{"inverted", static_cast<double>(after_.inverted)},
                    {"flat", static_cast<double>(after_.flat)},
                    {"flat before", static_cast<double>(before_.flat)}};
  if (after_.inverted > 0) {
    report.fail(std::to_string(after_.inverted) + " tetrahedra are inverted");
  }
  if (after_.flat > before_.flat) report.fail("more tetrahedra are flat than were");
  report_.inverted = after_.inverted;
  report_.flat = after_.flat;
  add(std::move(report));
}

// A file without regions has one, of any number. What a format calls inside is compared if both
// files say it.
void Improved::name_parts() {
  const bool sides = !given_.inside.empty() && !mesh_.inside.empty();
  const bool numbered = !given_.regions.empty() && !mesh_.regions.empty();
  const auto region_of = [&](const MeshFile& file, std::size_t t) -> std::int64_t {
    if (file.regions.empty()) return 0;
    const std::int64_t region = file.regions[t], first = file.regions[0];
    if (numbered || (region != 0 && region != first)) return region;
    return region == first ? 0 : first;  // the first one is 0, as where there are none
  };
  const auto name = [&](const MeshFile& file, Cells& cells) {
    for (std::size_t t = 0; t < file.tetrahedra.size(); ++t) {
      cells.parts.emplace_back(region_of(file, t), sides ? file.inside[t] : std::uint8_t{2});
    }
  };
  name(given_, before_);
  name(mesh_, after_);
}

std::vector<Wall> Improved::walls(const Cells& cells) const {
  std::vector<Wall> list;
  for (Index i = 0; i < cells.neighbours.across.size(); ++i) {
    const Index j = cells.neighbours.across[i];
    if (j != kNone && (j < i || cells.parts[j / 4] == cells.parts[i / 4])) continue;
    Face face = united(face_of(cells.complex.tetrahedra[i / 4], static_cast<int>(i % 4)));
    const bool even = sort_face(face);
    const Part mine = cells.parts[i / 4], other = j == kNone ? kNothing : cells.parts[j / 4];
    list.push_back(even ? Wall{face, mine, other} : Wall{face, other, mine});
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<Face> Improved::faces(const Cells& cells) const {
  std::vector<Face> list;
  for (const Tet& tet : cells.complex.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      Face face = united(face_of(tet, i));
      sort_face(face);
      list.push_back(face);
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::string Improved::name(const Face& face) const {
  std::string text = "face";
  for (const Index v : face) {
    const Position& p = points_.nearest(v);
    char place[100];
    std::snprintf(place, sizeof place, " (%.17g %.17g %.17g)", p[0], p[1], p[2]);
    text += place;
  }
  return text;
}

void Improved::check_walls() {
  name_parts();
  OracleReport report("kept-faces", "faces");
  const std::vector<Wall> before = walls(before_), after = walls(after_);
  report.checked = before.size();
  std::vector<Wall> lost, made;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                      std::back_inserter(lost));
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::back_inserter(made));
  const std::string between = " of the hull or between regions ";
  for (const Wall& wall : lost) report.fail(name(wall.corners) + between + "is not kept");
  for (const Wall& wall : made) report.fail(name(wall.corners) + between + "was not given");
  if (given_.regions.empty() && !mesh_.regions.empty() &&
      std::any_of(mesh_.regions.begin(), mesh_.regions.end(),
                  [&](std::int64_t region) { return region != mesh_.regions[0]; })) {
    report.fail("there are several regions, and none were given");
  }
  const std::vector<Face> all = given_.boundary.empty() ? std::vector<Face>{} : faces(after_);
  for (Face face : given_.boundary) {
    ++report.checked;
    face = united(face);
    sort_face(face);
    if (!std::binary_search(all.begin(), all.end(), face)) {
      report.fail("listed " + name(face) + " is not kept");
    }
  }
  add(std::move(report));
}

// Where a file says nothing about labels, they are 0; facets are compared if both files have them.
std::vector<Listed> Improved::listed(const MeshFile& file, Index offset,
                                     OracleReport& report) const {
  const bool facets = given_.facets.size() == given_.boundary.size() &&
                      mesh_.facets.size() == mesh_.boundary.size();
  std::vector<Listed> list;
  for (std::size_t n = 0; n < file.boundary.size(); ++n) {
    Face face = file.boundary[n];
    if (*std::max_element(face.begin(), face.end()) >= file.vertices.size()) {
      report.fail("triangle " + std::to_string(n) + " has a corner out of range");
      continue;
    }
    for (Index& v : face) v += offset;
    face = united(face);
    const bool even = sort_face(face);
    list.push_back(
        {face, even, n < file.labels.size() ? file.labels[n] : 0, facets ? file.facets[n] : kNone});
  }
  std::sort(list.begin(), list.end());
  return list;
}

// If both formats have them.
void Improved::check_names(OracleReport& report) const {
  if (!given_.has_names || !mesh_.has_names || options_.promised.names) return;
  compare_names(given_.names, mesh_.names, 2, {given_.labels.begin(), given_.labels.end()}, report);
  std::vector<std::int64_t> named;  // others are called by their side in one format alone
  for (const std::int64_t region : given_.regions) {
    if (given_.names.contains({3, region})) named.push_back(region);
  }
  compare_names(given_.names, mesh_.names, 3, named, report);
}

void Improved::check_list() {
  OracleReport report("boundary-list", "triangles");
  const std::vector<Listed> before = listed(given_, 0, report),
                            after =
                                listed(mesh_, static_cast<Index>(given_.vertices.size()), report);
  report.checked = before.size() + after.size();
  std::vector<Listed> lost, made;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                      std::back_inserter(lost));
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::back_inserter(made));
  for (const Listed& l : lost) {
    report.fail(name(l.corners) + " with label " + std::to_string(l.label) + " is not listed");
  }
  for (const Listed& l : made) {
    report.fail(name(l.corners) + " with label " + std::to_string(l.label) + " was not listed");
  }
  if (mesh_.labels_contradict) report.fail("the names of labels contradict them");
  check_names(report);
  // Other programs that improve a mesh write none where there were none.
  if (mesh_.groups_differ && given_.has_names && !given_.groups_differ)
    report.fail("elements are in no physical group, or in several");
  if (mesh_.tags_shared && !given_.tags_shared)
    report.fail("groups of triangles and of tetrahedra have one tag");
  if (mesh_.comments_within) report.fail("comments are where some take them for entries");
  if (mesh_.more_than_single) report.fail("coordinates are said to be of single precision");
  add(std::move(report));
}

void Improved::check_nodes() {
  if (mesh_.edge_nodes.empty() && !(options_.promised.second_order && mesh_.has_second_order)) {
    if (options_.promised.second_order) report_.unproven.emplace_back(kLinearOnly);
    return;
  }
  double diagonal2 = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Position& p : given_.vertices) {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    diagonal2 += (high - low) * (high - low);
  }
  add(check_edge_nodes(mesh_, options_.declared_deviation * std::sqrt(diagonal2)));
}

void Improved::check_angles() {
  Promise promise = options_.promised;
  promise.region = delmesher::Region::hull;
  delmesher::ExactRecord record;
  const auto take = [&](const Cells& cells, std::vector<delmesher::ExactRecord::Tet>& list) {
    for (const Tet& tet : cells.complex.tetrahedra) {
      list.push_back({{point_[tet[0]], point_[tet[1]], point_[tet[2]], point_[tet[3]]}, true});
    }
  };
  take(before_, record.unrepaired);
  take(after_, record.final);
  add(check_improvement(record, points_, promise));
}

}  // namespace

std::string verify_improved(const MeshFile& given, const MeshFile& mesh,
                            const VerifyOptions& options, VerifyReport& report) {
  report = {};
  VerifyOptions known = options;
  std::string why;
  if (const auto scaled =
          in_ordinary_units({given.vertices, {}, {}, {}}, mesh, nullptr, options.promised)) {
    MeshFile in_units = given;
    in_units.vertices = scaled->input.vertices;
    known.promised = scaled->promise;
    why = Improved(in_units, scaled->mesh, known, report).run();
    for (OracleReport& oracle : report.oracles) {
      oracle.notes.push_back("lengths are in units of 2^" + std::to_string(scaled->exponent));
    }
  } else {
    why = Improved(given, mesh, known, report).run();
  }
  if (why.empty()) conclude(0, report);
  return why;
}

}  // namespace tetproof::oracles
