#include "oracles/tolerance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "oracles/base/box.h"
#include "oracles/base/edge_key.h"
#include "oracles/base/triangle_distance.h"
#include "oracles/base/triangle_sums.h"
#include "oracles/base/union_find.h"
#include "oracles/envelope.h"

namespace tetproof::oracles {
namespace {

constexpr double kMargin = 1e-6;     // degrees
constexpr double kUncertain = 1.01;  // of the tolerance: the bounds of distances are so certain

// A side of two triangles, one of which it goes around from `a` to `b`.
struct Edge {
  Index a, b;
  std::array<Index, 2> triangles;
  double least = 0, most = 180;  // that it bends, in degrees
  bool border = false;           // of labels
};

// Of a closed surface.
std::vector<Edge> edges_of(const Polyhedron& surface) {
  std::vector<std::tuple<std::uint64_t, Index, Index, Index>> sides;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
      sides.emplace_back(edge_key(a, b), t, a, b);
    }
  }
  std::ranges::sort(sides);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    const auto& [key, t, a, b] = sides[i];
    edges.push_back({a, b, {t, std::get<1>(sides[i + 1])}});
  }
  return edges;
}

// Bends, where vertices are known within `slab` and what roundings take.
void measure(const Polyhedron& surface, double slab, std::vector<Edge>& edges) {
  const double reach = slab + 8 * 0x1p-52 * box_of(surface.vertices).largest();
  std::vector<std::pair<Position, double>> normals;  // with what they may be turned by
  for (const auto& [a, b, c] : surface.triangles) {
    const Position &p = surface.vertices[a], &q = surface.vertices[b], &r = surface.vertices[c];
    Position normal = cross(minus(q, p), minus(r, p));
    const double size = length(normal);
    const double longest =
        std::max({quick_distance(p, q), quick_distance(q, r), quick_distance(r, p)});
    const double height = size / longest;
    const double turned = 2 * (reach + 8 * 0x1p-52 * longest) / height;
    for (double& x : normal) x /= size;
    normals.emplace_back(normal, turned * 180 / std::numbers::pi);
  }
  for (Edge& edge : edges) {
    const auto& [m, m_turned] = normals[edge.triangles[0]];
    const auto& [n, n_turned] = normals[edge.triangles[1]];
    const double bend = std::atan2(length(cross(m, n)), dot(m, n)) * 180 / std::numbers::pi;
    const double turned = m_turned + n_turned + kMargin;
    if (turned < 180) {
      edge.least = std::max(0.0, bend - turned);
      edge.most = std::min(180.0, bend + turned);
    }
    edge.border = !surface.labels.empty() &&
                  surface.labels[edge.triangles[0]] != surface.labels[edge.triangles[1]];
  }
}

// Segments as triangles of a corner that they have twice.
template <class Which>
Polyhedron segments_of(const Polyhedron& surface, const std::vector<Edge>& edges, Which which) {
  Polyhedron result;
  result.vertices = surface.vertices;
  for (const Edge& edge : edges) {
    if (which(edge)) result.triangles.push_back({edge.a, edge.b, edge.b});
  }
  return result;
}

// Nothing is near nothing.
void compare(const Polyhedron& from, const Polyhedron& to, const WithinTolerance& s,
             const std::string& what, const std::string& of_what, OracleReport& report) {
  report.checked += from.triangles.size();
  if (from.triangles.empty()) return;
  if (to.triangles.empty()) {
    const Position at = in_units(from.vertices[from.triangles[0][0]], s.exponent);
    report.fail_at(at, what + place_name(at) + ", and there are no " + of_what);
    return;
  }
  Position place{};
  const double far = farthest(from, to, s.allowed / 100, s.allowed, &place);
  report.figures.emplace_back(what + " from " + of_what + ", at most", far);
  if (far <= kUncertain * s.allowed) return;
  const Position at = in_units(place, s.exponent);
  report.fail_at(at, what + ": as far as " + std::to_string(far / s.allowed) + " tolerances from " +
                         of_what + place_name(at));
}

// Solid shells and cavities, by genus.
using Shells = std::multiset<std::pair<bool, std::int64_t>>;

// Vertices count once for each fan of triangles around them.
Shells shells_of(const Polyhedron& surface) {
  const std::size_t triangles = surface.triangles.size();
  UnionFind shell(triangles), fan(3 * triangles);
  const auto corner = [&](Index t, Index v) {
    const auto& c = surface.triangles[t];
    return static_cast<Index>(3 * t + (std::ranges::find(c, v) - c.begin()));
  };
  for (const Edge& edge : edges_of(surface)) {
    const auto [t, u] = edge.triangles;
    shell.unite(t, u);
    for (const Index v : {edge.a, edge.b}) fan.unite(corner(t, v), corner(u, v));
  }
  struct Shell {
    std::vector<std::array<Index, 3>> triangles;
    std::int64_t vertices = 0;
  };
  std::map<Index, Shell> found;
  for (Index t = 0; t < triangles; ++t) {
    Shell& of = found[shell.find(t)];
    of.triangles.push_back(surface.triangles[t]);
    for (Index c = 3 * t; c < 3 * t + 3; ++c) of.vertices += fan.find(c) == c;
  }
  ExactPoints points;
  points.assign(surface.vertices);
  Shells shells;
  for (const auto& [first, of] : found) {
    const auto faces = static_cast<std::int64_t>(of.triangles.size());
    shells.emplace(sum_from_origin6(points, of.triangles).sign() > 0,
                   (2 - (of.vertices - faces / 2)) / 2);
  }
  return shells;
}

std::string name_of(const Shells& shells) {
  std::string text;
  for (auto at = shells.begin(); at != shells.end(); at = shells.upper_bound(*at)) {
    if (!text.empty()) text += ", ";
    text += std::to_string(shells.count(*at)) + (at->first ? " solid" : " hollow") + " of genus " +
            std::to_string(at->second);
  }
  return text;
}

OracleReport check_topology(const WithinTolerance& s) {
  OracleReport report("envelope-topology", "shells");
  const Shells given = shells_of(s.input), made = shells_of(s.own);
  report.checked = given.size() + made.size();
  if (given != made) {
    report.fail("the mesh has other shells (" + name_of(made) + ") than the input (" +
                name_of(given) + ")");
  }
  return report;
}

std::map<std::int32_t, Polyhedron> by_label(const Polyhedron& surface) {
  std::map<std::int32_t, Polyhedron> parts;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Polyhedron& part = parts[surface.labels.empty() ? 0 : surface.labels[t]];
    for (const Index v : surface.triangles[t]) part.vertices.push_back(surface.vertices[v]);
    const auto end = static_cast<Index>(part.vertices.size());
    part.triangles.push_back({end - 3, end - 2, end - 1});
  }
  return parts;
}

OracleReport check_labels(const WithinTolerance& s) {
  OracleReport report("envelope-labels", "triangles");
  report.checked = 1;
  if (s.own.labels.empty()) {
    report.fail("the file does not list every boundary triangle");
    return report;
  }
  std::map<std::int32_t, Polyhedron> given = by_label(s.input), made = by_label(s.own);
  for (const auto& [label, part] : made) given.try_emplace(label);
  if (given.size() == 1 && made.size() == 1) {
    report.notes.emplace_back("one label: its distances are those of `envelope`");
    return report;
  }
  for (const auto& [label, part] : given) {
    const std::string name = " with label " + std::to_string(label);
    compare(made[label], part, s, "triangles of the mesh" + name, "those of the input", report);
    compare(part, made[label], s, "triangles of the input" + name, "those of the mesh", report);
  }
  return report;
}

// Where lines of the input certainly end, meet or bend.
Polyhedron corners_of(const WithinTolerance& s, const std::vector<Edge>& edges) {
  struct Lines {
    std::vector<Index> ends;
    std::size_t others = 0;  // that may be lines
  };
  std::map<Index, Lines> at;
  for (const Edge& edge : edges) {
    const bool certain = edge.border || edge.least > s.feature;
    if (!certain && edge.most < s.feature) continue;
    for (const auto& [v, end] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      if (certain) {
        at[v].ends.push_back(end);
      } else {
        ++at[v].others;
      }
    }
  }
  Polyhedron points;
  points.vertices = s.input.vertices;
  for (const auto& [v, lines] : at) {
    const auto& ends = lines.ends;
    bool is_corner = ends.size() > 2 || (ends.size() == 1 && lines.others == 0);
    if (ends.size() == 2 && lines.others == 0) {
      const Position& p = s.input.vertices[v];
      const Position to = minus(p, s.input.vertices[ends[0]]),
                     on = minus(s.input.vertices[ends[1]], p);
      const double bend = std::atan2(length(cross(to, on)), dot(to, on)) * 180 / std::numbers::pi;
      is_corner = bend > s.feature + kMargin;
    }
    if (is_corner) points.triangles.push_back({v, v, v});
  }
  return points;
}

OracleReport check_lines(const WithinTolerance& s) {
  OracleReport report("envelope-lines", "lines and corners");
  // What low triangles bend by is not a line: it may be none if their vertices move.
  std::vector<Edge> given = edges_of(s.input), lasting = given, made = edges_of(s.own);
  measure(s.input, 0, given);
  measure(s.input, s.allowed / 2, lasting);
  measure(s.own, s.slab, made);
  const auto is_line = [&](const Edge& e) { return e.border || e.least > s.feature; };
  const auto may_be_line = [&](const Edge& e) { return e.border || e.most >= s.feature; };
  const auto still_bends = [&](const Edge& e) { return e.border || e.most >= s.feature / 2; };
  compare(segments_of(s.own, made, is_line), segments_of(s.input, given, may_be_line), s,
          "lines of the mesh", "those of the input", report);
  compare(segments_of(s.input, lasting, is_line), segments_of(s.own, made, still_bends), s,
          "lines of the input", "edges of the mesh that bend", report);
  Polyhedron vertices;
  vertices.vertices = s.own.vertices;
  for (Index v = 0; v < s.own.vertices.size(); ++v) vertices.triangles.push_back({v, v, v});
  compare(corners_of(s, lasting), vertices, s, "corners of the input", "vertices of the mesh",
          report);
  if (report.checked == 0) {
    report.checked = 1;
    report.notes.emplace_back("there are no lines");
  }
  return report;
}

}  // namespace

std::vector<OracleReport> check_tolerance(const WithinTolerance& surfaces) {
  std::vector<OracleReport> reports = {check_topology(surfaces), check_lines(surfaces)};
  if (surfaces.labels_listed) reports.push_back(check_labels(surfaces));
  return reports;
}

}  // namespace tetproof::oracles
