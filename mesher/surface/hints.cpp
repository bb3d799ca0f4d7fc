#include "mesher/surface/hints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/face_key.h"
#include "mesher/geometry/projected_face.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/surface/inner_walls.h"
#include "mesher/surface/repair.h"

namespace delmesher::surface {
namespace {

using Kind = Defect::Kind;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

std::string point(const std::array<double, 3>& p) {
  return "(" + number(p[0]) + ", " + number(p[1]) + ", " + number(p[2]) + ")";
}

std::string counted(std::uint64_t count, const std::string& name) {
  if (count == 1) return "1 " + name;
  if (name == "inconsistent orientation")
    return std::to_string(count) + " inconsistent orientations";
  return std::to_string(count) + " " +
         (name.ends_with("ex") ? name.substr(0, name.size() - 2) + "ices" : name + "s");
}

std::uint64_t count_of(const SurfaceReport& report, Kind kind) {
  return report.defect_counts[static_cast<std::size_t>(kind)];
}

// Is the ring so thin that it is not a hole: do vertices on one side lie on an edge of the other?
bool is_slit(const Surface& surface, const Hole& hole) {
  const Point3 normal = doubled_area(surface.vertices, hole.corners);
  const double area2 = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  return std::sqrt(area2) <= 1e-9 * hole.width * hole.width;
}

std::string list_of(const Surface& surface, const std::vector<const Hole*>& holes,
                    const char* name) {
  std::string line = counted(holes.size(), name) + (holes.size() == 1 ? ": " : ", the widest: ");
  for (std::size_t i = 0; i < holes.size() && i < 3; ++i) {
    const Hole& hole = *holes[i];
    line += (i > 0 ? "; " : "") + std::to_string(hole.corners.size()) + " edges, " +
            number(hole.width) + " wide, at " + point(surface.vertices[hole.corners[0]]);
  }
  return line;
}

// The components, if each of them is in one plane; else 0.
std::uint64_t flat_sheets(const Surface& surface) {
  DisjointSets components(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles) {
    components.join(a, b);
    components.join(b, c);
  }
  std::map<std::uint32_t, std::array<std::uint32_t, 3>> first;  // triangle
  const auto at = [&](std::uint32_t v) { return surface.vertices[v]; };
  for (const auto& corners : surface.triangles) {
    const auto& [a, b, c] =
        first.try_emplace(components.smallest(corners[0]), corners).first->second;
    for (const std::uint32_t v : corners) {
      if (orient3d_sign(at(a), at(b), at(c), at(v)) != 0) return 0;
    }
  }
  return first.size();
}

std::vector<std::string> hints_of_holes(const Surface& surface) {
  const Holes all = holes_of(surface);
  std::vector<const Hole*> holes, slits;
  for (const Hole& hole : all.holes) {
    (is_slit(surface, hole) ? slits : holes).push_back(&hole);
  }
  for (auto* list : {&holes, &slits}) {
    std::stable_sort(list->begin(), list->end(),
                     [](const Hole* a, const Hole* b) { return a->width > b->width; });
  }
  std::vector<std::string> lines;
  if (!holes.empty()) {
    lines.push_back(list_of(surface, holes, "hole") +
                    "; `delmesher repair --fill` closes planar and small ones");
  }
  if (!slits.empty()) {
    lines.push_back(list_of(surface, slits, "T-junction") +
                    "; vertices of one side lie on an edge of the other: `tetproof union` splits "
                    "the triangles there");
  }
  return lines;
}

const std::vector<std::array<std::uint32_t, 2>>& places_of(const SurfaceReport& report, Kind kind) {
  return report.places[static_cast<std::size_t>(kind)];
}

// Pairs of triangles with the same vertices that look in opposite directions: faces of two bodies.
std::uint64_t opposite_duplicates(const Surface& surface, const SurfaceReport& report) {
  const auto side = [&](std::uint32_t triangle) {
    return base::directed_face(surface.triangles[triangle]);
  };
  const auto& pairs = places_of(report, Kind::duplicate_triangle);
  return static_cast<std::uint64_t>(std::count_if(
      pairs.begin(), pairs.end(), [&](const auto& p) { return side(p[0]) != side(p[1]); }));
}

// Whether triangles of a pair that meets lie on both sides of each other.
bool any_cross(const Surface& surface, const SurfaceReport& report) {
  const auto corner = [&](std::uint32_t triangle, std::size_t k) {
    return surface.vertices[surface.triangles[triangle][k]];
  };
  const auto on_both_sides = [&](std::uint32_t plane, std::uint32_t triangle) {
    bool above = false, below = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const int sign =
          orient3d_sign(corner(plane, 0), corner(plane, 1), corner(plane, 2), corner(triangle, k));
      above |= sign > 0;
      below |= sign < 0;
    }
    return above && below;
  };
  const auto& pairs = places_of(report, Kind::self_intersection);
  return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return on_both_sides(pair[0], pair[1]) && on_both_sides(pair[1], pair[0]);
  });
}

// The triangles of open components that meet closed ones. What has a vertex in common is one
// component; one with few open edges for its size is a body with holes: a sheet of n triangles has
// more of them than the root of n.
std::uint64_t triangles_of_sheets(const Surface& surface, const SurfaceReport& report) {
  DisjointSets components(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles) {
    components.join(a, b);
    components.join(b, c);
  }
  std::map<std::uint32_t, std::uint64_t> open, size;
  for (const auto& edge : places_of(report, Kind::open_edge)) ++open[components.smallest(edge[0])];
  for (const auto& corners : surface.triangles) ++size[components.smallest(corners[0])];
  std::set<std::uint32_t> sheets;
  for (const auto& [one, other] : places_of(report, Kind::self_intersection)) {
    const std::uint32_t a = components.smallest(surface.triangles[one][0]),
                        b = components.smallest(surface.triangles[other][0]);
    if (open.contains(a) == open.contains(b)) continue;
    const std::uint32_t sheet = open.contains(a) ? a : b;
    if (open[sheet] * open[sheet] >= size[sheet]) sheets.insert(sheet);
  }
  return static_cast<std::uint64_t>(std::count_if(
      surface.triangles.begin(), surface.triangles.end(),
      [&](const auto& corners) { return sheets.contains(components.smallest(corners[0])); }));
}

constexpr const char* kMoveApart =
    "`tetproof union --separate 1e-4` moves them apart, or `delmesher mesh --regions all` meshes "
    "each as a region";

// What has more than two triangles at an edge.
Contact contact_at_edges(const Surface& surface, const SurfaceReport& report) {
  const std::optional<Enclosed> enclosed =
      count_of(report, Kind::index_out_of_range) == 0 && count_of(report, Kind::non_finite) == 0
          ? enclosed_by(surface)
          : std::nullopt;
  if (!enclosed) {
    return {
        "more than two triangles at an edge",
        "an inner wall, or bodies that share an edge: `delmesher mesh --regions all` meshes each "
        "part as a region"};
  }
  if (enclosed->walls.empty()) {
    return {"bodies, or parts of one, touch along " +
                counted(count_of(report, Kind::non_manifold_edge), "edge"),
            kMoveApart};
  }
  const std::uint32_t first = enclosed->walls[0];
  return {(enclosed->sheets == 1 ? "an inner wall of "
                                 : std::to_string(enclosed->sheets) + " inner walls of ") +
              counted(enclosed->walls.size(), "triangle"),
          "triangle " + std::to_string(first) + " at " +
              point(surface.vertices[surface.triangles[first][0]]) + " is the first; with " +
              counted(enclosed->parts, "part") +
              " inside this is not one solid: `delmesher mesh --regions all` meshes each as a "
              "region, " +
              (enclosed->closes ? "or `tetproof union --separate 1e-4` unites them"
                                : "or leave walls out")};
}

}  // namespace

std::string defects_line(const SurfaceReport& report) {
  std::uint64_t total = 0;
  std::string list;
  int kinds = 0;
  for (std::size_t kind = 0; kind < report.defect_counts.size(); ++kind) {
    const std::uint64_t count = report.defect_counts[kind];
    if (count == 0) continue;
    total += count;
    list += (kinds++ > 0 ? ", " : "") + counted(count, defect_name(static_cast<Kind>(kind)));
  }
  if (kinds < 2) return list;
  return std::to_string(total) + " defects of " + std::to_string(kinds) + " kinds (" + list + ")";
}

std::vector<Contact> contacts(const Surface& surface, const SurfaceReport& report) {
  std::vector<Contact> found;
  const std::uint64_t opposite = opposite_duplicates(surface, report);
  if (opposite > 0 && 2 * opposite == surface.triangles.size()) {
    found.push_back({"a double-sided surface: each triangle is there twice, once from each side",
                     "`delmesher repair` keeps one of them"});
  } else if (opposite > 0) {
    found.push_back(
        {"bodies, or parts of one, touch in " + counted(opposite, "triangle"),
         "`delmesher repair` makes one of them, or `delmesher mesh --regions all` meshes "
         "each as a region"});
  }
  // Triangles without area, and doubled ones, make such edges themselves: first things first.
  if (count_of(report, Kind::degenerate_triangle) > 0 ||
      count_of(report, Kind::duplicate_triangle) > 0) {
    return found;
  }
  if (count_of(report, Kind::non_manifold_edge) > 0) {
    found.push_back(contact_at_edges(surface, report));
  } else if (count_of(report, Kind::self_intersection) > 0) {
    if (count_of(report, Kind::open_edge) > 0) {
      const std::uint64_t sheet = triangles_of_sheets(surface, report);
      if (sheet > 0) {
        found.push_back(
            {"a sheet of " + counted(sheet, "triangle") + " meets a closed body",
             "an inner wall, or what sticks out: `tetproof union --walls` cuts them for "
             "--regions all; of a solid it is no part, `delmesher repair --fill` "
             "removes it"});
      }
    } else if (report.components > 1 && !any_cross(surface, report)) {
      found.push_back({"bodies touch, and do not cross",
                       "`tetproof union` makes one of them, `tetproof union --walls` parts for "
                       "--regions all; or mesh them one by one"});
    }
  } else if (count_of(report, Kind::non_manifold_vertex) > 0 &&
             count_of(report, Kind::open_edge) == 0) {
    const std::uint64_t vertices = count_of(report, Kind::non_manifold_vertex);
    found.push_back({"bodies, or parts of one, touch at " +
                         (vertices == 1 ? "a vertex" : std::to_string(vertices) + " vertices"),
                     kMoveApart});
  }
  return found;
}

namespace {

std::vector<std::string> hints_of(const Surface& surface, const SurfaceReport& report) {
  std::vector<std::string> lines;
  const bool indices = count_of(report, Kind::index_out_of_range) == 0;
  const bool finite = count_of(report, Kind::non_finite) == 0;
  const bool open = count_of(report, Kind::open_edge) > 0;
  std::uint64_t sheets = 0;
  if (indices && finite && open) {
    const WeldHint hint = weld_hint(surface);
    if (hint.closed > 0) {
      lines.push_back((hint.distance == 0 ? "vertices coincide: `delmesher repair"
                                          : "vertices nearly coincide: `delmesher repair --weld " +
                                                number(hint.distance)) +
                      "` would close " + std::to_string(hint.closed) + " of " +
                      std::to_string(count_of(report, Kind::open_edge)) + " open edges");
    }
    sheets = hint.closed == 0 ? flat_sheets(surface) : 0;
    if (sheets > 0) {
      lines.push_back(counted(sheets, "flat sheet") +
                      (sheets == 1 ? ", which encloses nothing" : ", which enclose nothing") +
                      ": there is no solid; OFF and OBJ with z = 0 are for `delmesher plane`");
    } else {
      for (std::string& line : hints_of_holes(surface)) lines.push_back(std::move(line));
    }
  }
  const std::vector<Contact> touching = contacts(surface, report);
  const bool all_opposite =
      count_of(report, Kind::duplicate_triangle) > 0 &&
      opposite_duplicates(surface, report) == count_of(report, Kind::duplicate_triangle);
  const bool more_first = count_of(report, Kind::degenerate_triangle) > 0 ||
                          (count_of(report, Kind::duplicate_triangle) > 0 && !all_opposite);
  if (more_first || count_of(report, Kind::inconsistent_orientation) > 0) {
    lines.push_back("`delmesher repair` mends triangles without area, duplicates and orientation");
  }
  if (count_of(report, Kind::non_manifold_edge) > 0 && more_first) {
    lines.push_back("that may make the edges manifold as well: check the mended surface");
  }
  for (const Contact& contact : touching) lines.push_back(contact.what + ": " + contact.advice);
  // What is open is closed first; then there are other hints.
  if (touching.empty() && !more_first && count_of(report, Kind::self_intersection) > 0 && !open) {
    lines.push_back(
        report.components > 1
            ? "triangles meet: if bodies overlap, `tetproof union` makes one of them, `tetproof "
              "union --walls` parts for --regions all; or mesh them one by one"
            : "triangles meet: `tetproof union` cuts them there and keeps the outside");
  }
  return lines;
}

}  // namespace

}  // namespace delmesher::surface

namespace delmesher {

std::vector<std::string> surface_hints(const Surface& surface, const SurfaceReport& report) {
  return surface::hints_of(surface, report);
}

}  // namespace delmesher
