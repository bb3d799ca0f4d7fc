#include "mesher/cli/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <set>
#include <span>

#include "mesher/base/sort_unique.h"
#include "mesher/delmesher/region_name.h"
#include "mesher/geometry/size_field.h"
#include "mesher/geometry/vector.h"

namespace delmesher::cli {
namespace {

constexpr double kDegrees = 57.29577951308232;  // per radian
constexpr double kSharp = 5;                    // degrees: dihedral angles below are a problem
constexpr double kRounding = 1e-6;              // of angles that meet a bound, in degrees
// An angle is forced by one of the input that is at most so many times as large: it cannot be
// shared among more than so many elements.
constexpr double kForced = 2;

double between(const Vec3& u, const Vec3& v) {
  return std::atan2(norm(cross(u, v)), dot(u, v)) * kDegrees;
}

// With some digits after the point, and at least the first two that are not 0.
std::string number(double value, int digits) {
  char text[40];
  const bool shown = value == 0 || std::fabs(value) >= std::pow(10.0, 1 - digits);
  std::snprintf(text, sizeof text, shown ? "%.*f" : "%.*g", shown ? digits : 2, value);
  return text;
}

std::string place(std::span<const double> p) {
  std::string out = "(";
  for (const double x : p) {
    char text[40];
    std::snprintf(text, sizeof text, "%s%.6g", out.size() > 1 ? ", " : "", x);
    out += text;
  }
  return out + ")";
}

Vec3 middle(const Vec3& a, const Vec3& b) {
  return {a[0] / 2 + b[0] / 2, a[1] / 2 + b[1] / 2, a[2] / 2 + b[2] / 2};
}

// Angles of the input that the written mesh has, measured from the mesh.
class InputAngles {
 public:
  explicit InputAngles(const TetMesh& mesh) : mesh_(mesh) {}

  // Between the two facets at this edge of a tetrahedron, on the side of the tetrahedron; 360 if it
  // is not an edge between facets.
  double wedge(const std::array<std::uint32_t, 4>& edge_first) const {
    const auto [a, b, c, d] = edge_first;
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      const auto& tet = mesh_.tetrahedra[t];
      if (has(tet, a) && has(tet, b) && has(tet, c) && has(tet, d)) {
        return wedges(a, b)[mesh_.inside[t] != 0 ? 1 : 0];
      }
    }
    return 360;
  }

  // The smallest one at the edges of this vertex, on any side.
  double wedge_at(std::uint32_t v) const {
    std::vector<std::uint32_t> ends;
    for (const auto& triangle : mesh_.boundary) {
      if (has(triangle, v)) ends.insert(ends.end(), triangle.begin(), triangle.end());
    }
    base::sort_unique(ends);
    double smallest = 360;
    for (const std::uint32_t end : ends) {
      if (end == v) continue;
      const auto [outside, inside] = wedges(v, end);
      smallest = std::min({smallest, outside, inside});
    }
    return smallest;
  }

  // The smallest corner of a facet at this vertex; 360 if it is at none.
  double corner(std::uint32_t v) const {
    struct Part {
      std::uint32_t from, to, facet;
      double angle;
    };
    std::vector<Part> parts;
    for (std::size_t t = 0; t < mesh_.boundary.size(); ++t) {
      const auto& triangle = mesh_.boundary[t];
      for (std::size_t i = 0; i < 3; ++i) {
        if (triangle[i] != v) continue;
        const std::uint32_t from = triangle[(i + 1) % 3], to = triangle[(i + 2) % 3];
        parts.push_back({from, to, mesh_.boundary_facets[t], between(edge(v, from), edge(v, to))});
      }
    }
    const auto next_to = [&](const Part& part, std::uint32_t Part::*mine,
                             std::uint32_t Part::*other) {
      return std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
        return p.facet == part.facet && p.*other == part.*mine;
      });
    };
    double smallest = 360;
    for (const Part& first : parts) {
      if (next_to(first, &Part::from, &Part::to) != parts.end()) continue;
      double sum = 0;
      for (auto p = next_to(first, &Part::from, &Part::from); p != parts.end();
           p = next_to(*p, &Part::to, &Part::from)) {
        sum += p->angle;
      }
      smallest = std::min(smallest, sum);
    }
    return smallest;
  }

  // Of a tetrahedron whose vertices are nearer to each other than a fifth of its longest edge, on
  // facets that do not touch: how near.
  std::string thin(const std::array<std::uint32_t, 4>& tet) const {
    std::array<std::set<std::uint32_t>, 4> facets, around;  // of a corner; the vertices of those
    for (std::size_t t = 0; t < mesh_.boundary.size(); ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (has(mesh_.boundary[t], tet[k])) facets[k].insert(mesh_.boundary_facets[t]);
      }
    }
    for (std::size_t t = 0; t < mesh_.boundary.size(); ++t) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (!facets[k].contains(mesh_.boundary_facets[t])) continue;
        around[k].insert(mesh_.boundary[t].begin(), mesh_.boundary[t].end());
      }
    }
    double longest = 0, nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double length = norm(edge(tet[i], tet[j]));
        longest = std::max(longest, length);
        const bool touch =
            std::ranges::any_of(around[i], [&](std::uint32_t v) { return around[j].contains(v); });
        if (!facets[i].empty() && !facets[j].empty() && !touch) nearest = std::min(nearest, length);
      }
    }
    if (nearest > longest / 5) return "";
    char text[64];
    std::snprintf(text, sizeof text, ", where the surface is %.2g from itself", nearest);
    return text;
  }

 private:
  template <class Cell>
  static bool has(const Cell& cell, std::uint32_t v) {
    return std::find(cell.begin(), cell.end(), v) != cell.end();
  }

  // Outside and inside, between the facets at this edge; 360 where there are no tetrahedra, or if
  // it is not an edge between facets.
  std::array<double, 2> wedges(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> facets;
    for (std::size_t t = 0; t < mesh_.boundary.size(); ++t) {
      if (has(mesh_.boundary[t], a) && has(mesh_.boundary[t], b)) {
        facets.push_back(mesh_.boundary_facets[t]);
      }
    }
    if (facets.size() != 2 || facets[0] == facets[1]) return {360, 360};
    std::array<double, 2> sum{};
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      const auto& tet = mesh_.tetrahedra[t];
      if (has(tet, a) && has(tet, b)) sum[mesh_.inside[t] != 0 ? 1 : 0] += dihedral(tet, a, b);
    }
    for (double& angle : sum) {
      if (angle == 0) angle = 360;
    }
    return sum;
  }

  Vec3 edge(std::uint32_t a, std::uint32_t b) const {
    return subtract(mesh_.vertices[b], mesh_.vertices[a]);
  }

  double dihedral(const std::array<std::uint32_t, 4>& tet, std::uint32_t a, std::uint32_t b) const {
    Vec3 normal[2];
    int sides = 0;
    for (const std::uint32_t v : tet) {
      if (v != a && v != b && sides < 2) normal[sides++] = cross(edge(a, b), edge(a, v));
    }
    return between(normal[0], normal[1]);
  }

  const TetMesh& mesh_;
};

// Do the statistics number vertices of this mesh?
bool has_sharpest(const Result& result) {
  const MeshStatistics& s = result.statistics.final;
  const auto known = [&](std::uint32_t v) { return v < result.mesh.vertices.size(); };
  return s.tetrahedra > 0 && s.tetrahedra == result.mesh.tetrahedra.size() &&
         std::ranges::all_of(s.sharpest_dihedral, known) &&
         std::ranges::all_of(s.sharpest_face_angle, known);
}

std::string sharpest_edge(const Result& result) {
  const auto& v = result.statistics.final.sharpest_dihedral;
  return place(middle(result.mesh.vertices[v[0]], result.mesh.vertices[v[1]]));
}

}  // namespace

std::string quality_text(const Result& result) {
  const MeshStatistics& s = result.statistics.final;
  if (!has_sharpest(result)) return "";
  return "dihedral angles " + number(s.min_dihedral, 2) + " to " + number(s.max_dihedral, 2) +
         " degrees, " + std::to_string(s.below_5) + " tetrahedra below 5, the smallest at " +
         sharpest_edge(result) + "; smallest face angle " + number(s.min_face_angle, 2) +
         "; mean shape " + number(s.mean_gamma, 2) + " (1 is regular)";
}

std::string size_text(const Statistics& s, std::uint64_t budget) {
  std::string text;
  if (s.chosen_size > 0) {
    text = "; edges of " + number(s.chosen_size, 0) +
           (budget > 0 ? " to fill the budget, because there are "
                       : " by default, because there are only ") +
           std::to_string(s.tetrahedra_without_size) + " tetrahedra with --size none";
  }
  const bool is_full =
      static_cast<double>(s.final.tetrahedra) >= kFullBudget * static_cast<double>(budget);
  if (s.ladder[Rung::fill_budget] > 0 && !is_full) {
    text += "; no length of edges tried makes nine tenths of the budget";
  }
  return text;
}

std::string quality_text(const PlaneResult& result) {
  const PlaneMeshStatistics& s = result.statistics.final;
  const PlaneMesh& mesh = result.mesh;
  if (s.triangles == 0) return "";
  const auto at = [&](std::uint32_t v) {
    return Vec3{mesh.vertices[v][0], mesh.vertices[v][1], 0};
  };
  double smallest = 360;
  std::uint32_t worst = 0;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 apex = at(t[i]);
      const double angle =
          between(subtract(at(t[(i + 1) % 3]), apex), subtract(at(t[(i + 2) % 3]), apex));
      if (angle >= smallest) continue;
      smallest = angle;
      worst = t[i];
    }
  }
  if (smallest > 180) return "";
  return "angles " + number(s.min_angle, 2) + " to " + number(s.max_angle, 2) +
         " degrees, the smallest at " + place(mesh.vertices[worst]) + "; mean of the smallest " +
         number(s.mean_min_angle, 2);
}

namespace {

// Longer than a bound, of an option, or than the sizes allow.
struct EdgeBounds {
  double most = 0;  // 0: any
  std::string option;
  geometry::SizeField sizes = {};
  bool tells_given = false;  // those of the surface as given are told apart
};

// In the tetrahedra that count.
template <class Counts>
std::vector<std::string> warnings_of(const TetMesh& mesh, const EdgeBounds& bounds,
                                     const Counts& counts) {
  if (bounds.most <= 0 && bounds.sizes.empty()) return {};
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (!counts(t)) continue;
    const auto& tet = mesh.tetrahedra[t];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        edges.push_back({std::min(tet[i], tet[j]), std::max(tet[i], tet[j])});
      }
    }
  }
  base::sort_unique(edges);
  std::vector<std::array<std::uint32_t, 2>> surface, given, rest;
  if (bounds.tells_given) {
    for (const auto& face : mesh.boundary) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = face[i], w = face[(i + 1) % 3];
        surface.push_back({std::min(v, w), std::max(v, w)});
      }
    }
  }
  base::sort_unique(surface);
  std::set_intersection(edges.begin(), edges.end(), surface.begin(), surface.end(),
                        std::back_inserter(given));
  std::set_difference(edges.begin(), edges.end(), given.begin(), given.end(),
                      std::back_inserter(rest));
  std::vector<std::string> warnings;
  const auto warn_of = [&](const std::vector<std::array<std::uint32_t, 2>>& some,
                           const std::string& where, const std::string& option,
                           const auto& is_too_long) {
    std::uint64_t count = 0;
    double longest = 0;
    Vec3 at{};
    for (const auto& [v, w] : some) {
      const Vec3 &a = mesh.vertices[v], &b = mesh.vertices[w];
      if (!is_too_long(a, b)) continue;
      ++count;
      const double length = norm(subtract(b, a));
      if (length <= longest) continue;
      longest = length;
      at = middle(a, b);
    }
    if (count == 0) return;
    char length[40];
    std::snprintf(length, sizeof length, "%.6g", longest);
    warnings.push_back(std::to_string(count) + (count == 1 ? " edge" : " edges") + where +
                       (count == 1 ? " is" : " are") + " longer than " + option +
                       " allows, the longest, " + length + ", at " + place(at));
  };
  const auto warn = [&](const std::string& option, const auto& is_too_long) {
    warn_of(given, " of the surface as given", option, is_too_long);
    warn_of(rest, "", option, is_too_long);
  };
  if (bounds.most > 0) {
    const double most = bounds.most * (1 + 1e-9);
    warn(bounds.option,
         [most](const Vec3& a, const Vec3& b) { return norm(subtract(b, a)) > most; });
  }
  if (!bounds.sizes.empty()) {
    warn("--size-field",
         [&](const Vec3& a, const Vec3& b) { return bounds.sizes.is_too_long(a, b); });
  }
  return warnings;
}

}  // namespace

std::vector<std::string> edge_warnings(const Result& result, const Options& options,
                                       const std::vector<SizeSource>& sizes,
                                       const std::map<std::int32_t, std::string>& label_names) {
  const TetMesh& mesh = result.mesh;
  // A surface that is kept has the edges that were given.
  const bool kept = options.surface == SurfaceChoice::keep || options.regions != Regions::solid;
  const double bound = bound_on_edges(options);
  const EdgeBounds everywhere = {bound,
                                 bound == options.max_edge ? "--max-edge" : "--size",
                                 {sizes, options.size_growth},
                                 kept};
  std::vector<std::string> warnings = warnings_of(mesh, everywhere, [&](std::size_t t) {
    return options.region != Region::interior || mesh.inside.empty() || mesh.inside[t] != 0;
  });
  const auto warn_in = [&](const std::string& name, double max_edge, const char* option,
                           const auto& is_meant) {
    const auto is_there = [&](std::size_t t) {
      return is_meant(result.regions[static_cast<std::size_t>(mesh.regions[t] - 1)]);
    };
    for (const std::string& warning : warnings_of(mesh, {max_edge, option, {}, true}, is_there)) {
      warnings.push_back(name + ": " + warning);
    }
  };
  for (const RegionSize& size : options.region_sizes) {
    warn_in(size.region, size.max_edge, "--max-edge", [&](const MeshRegion& region) {
      return name_of_region(region, label_names) == size.region;
    });
  }
  for (const MeshRegion& bounded : result.regions) {
    if (bounded.max_edge == 0) continue;
    warn_in(name_of_region(bounded, label_names), bounded.max_edge, "the volume of its point",
            [&](const MeshRegion& region) { return &region == &bounded; });
  }
  return warnings;
}

std::vector<std::string> quality_warnings(const Result& result, double delta) {
  std::vector<std::string> warnings;
  if (!has_sharpest(result)) return warnings;
  const MeshStatistics& s = result.statistics.final;
  const InputAngles input(result.mesh);
  if (s.min_face_angle < delta - kRounding) {
    // Faces across a sharp edge have angles at its vertices that are no larger than the angle of
    // the edge.
    const std::uint32_t apex = s.sharpest_face_angle[0];
    const double corner = input.corner(apex), wedge = input.wedge_at(apex);
    const double forced = std::min(delta, kForced * s.min_face_angle);
    std::string why = ", not the " + number(delta, 2) + " asked for";
    if (corner <= forced) {
      why = ", where the input has a corner of " + number(corner, 2);
    } else if (wedge <= forced) {
      why = ", where facets of the input meet at " + number(wedge, 2);
    }
    warnings.push_back("the smallest face angle is " + number(s.min_face_angle, 2) +
                       " degrees, at " + place(result.mesh.vertices[apex]) + why);
  }
  if (s.min_dihedral < kSharp) {
    const double wedge = input.wedge(s.sharpest_dihedral);
    const bool forced = wedge <= kForced * s.min_dihedral;
    const std::string why = forced ? ", where facets of the input meet at " + number(wedge, 2)
                                   : input.thin(s.sharpest_dihedral);
    warnings.push_back("the smallest dihedral angle is " + number(s.min_dihedral, 2) +
                       " degrees, at " + sharpest_edge(result) + why);
  }
  return warnings;
}

}  // namespace delmesher::cli
