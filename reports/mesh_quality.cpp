#include "reports/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "oracles/base/vectors.h"
#include "oracles/mesh/angles.h"

namespace tetproof {
namespace {

using oracles::Position;
using oracles::Tet;
using Vertices = std::span<const Position>;
using Tetrahedra = std::span<const Tet>;

void measure_sizes(Vertices vertices, Tetrahedra tetrahedra, PartQuality& result) {
  result.shortest_edge = std::numeric_limits<double>::infinity();
  for (const Tet& t : tetrahedra) {
    Position edge[3];
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        const Position e = oracles::minus(vertices[t[i]], vertices[t[j]]);
        result.shortest_edge = std::min(result.shortest_edge, std::hypot(e[0], e[1], e[2]));
        if (j == 0) edge[i - 1] = e;
      }
    }
    result.volume += std::fabs(oracles::dot(edge[0], oracles::cross(edge[1], edge[2]))) / 6;
  }
}

// The faces of the tetrahedra, as Neighbours: those that are equal refer to the first of them.
oracles::Neighbours distinct_faces(Tetrahedra tetrahedra, PartQuality& result) {
  // A bucket for each smallest vertex: to sort all of them at once would take most of the time.
  struct Rest {
    oracles::Index middle, high, face;
    auto operator<=>(const Rest&) const = default;
  };
  oracles::Index most = 0;
  for (const Tet& t : tetrahedra) most = std::max(most, *std::max_element(t.begin(), t.end()));
  std::vector<std::uint64_t> start(most + 2, 0);
  const auto for_each = [&](auto visit) {
    for (oracles::Index i = 0; i < 4 * tetrahedra.size(); ++i) {
      const Tet& t = tetrahedra[i / 4];
      std::array f = {t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]};
      std::sort(f.begin(), f.end());
      visit(f[0], Rest{f[1], f[2], i});
    }
  };
  for_each([&](oracles::Index low, const Rest&) { ++start[low + 1]; });
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<Rest> rests(start.back());
  std::vector<std::uint64_t> next(start.begin(), start.end() - 1);
  for_each([&](oracles::Index low, const Rest& rest) { rests[next[low]++] = rest; });
  oracles::Neighbours neighbours;
  neighbours.across.assign(4 * tetrahedra.size(), oracles::kNone);
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    std::sort(rests.begin() + static_cast<std::ptrdiff_t>(start[v]),
              rests.begin() + static_cast<std::ptrdiff_t>(start[v + 1]));
    for (std::size_t i = start[v], end = i; i < start[v + 1]; i = end) {
      while (end < start[v + 1] && rests[end].middle == rests[i].middle &&
             rests[end].high == rests[i].high) {
        ++end;
      }
      for (std::size_t k = i + 1; k < end; ++k) neighbours.across[rests[k].face] = rests[i].face;
      ++result.faces;
      result.crowded_faces += end - i > 2 ? 1 : 0;
    }
  }
  return neighbours;
}

// As the oracle of angles measures them.
void measure_angles(const oracles::ExactPoints& points, const std::vector<Tet>& tetrahedra,
                    PartQuality& result) {
  const oracles::Neighbours neighbours = distinct_faces(tetrahedra, result);
  oracles::TetComplex complex;
  complex.points = &points;
  complex.tetrahedra = tetrahedra;
  oracles::OracleReport report("measures");
  oracles::measure_angles(complex, neighbours, std::vector<std::uint8_t>(tetrahedra.size(), 1),
                          report);
  const auto figure = [&](const char* name) { return report.figure(name).value(); };
  AngleStatistics& a = result.angles;
  a.min_face_angle = figure("smallest face angle");
  a.max_face_angle = figure("largest face angle");
  a.min_dihedral = figure("smallest dihedral angle");
  a.max_dihedral = figure("largest dihedral angle");
  a.mean_min_face_angle = figure("mean of faces' smallest angles");
  a.mean_max_face_angle = figure("mean of faces' largest angles");
  a.mean_min_dihedral = figure("mean of smallest dihedral angles");
  a.mean_max_dihedral = figure("mean of largest dihedral angles");
  a.below_5 = static_cast<std::uint64_t>(figure("tetrahedra below 5 degrees"));
  a.below_10 = static_cast<std::uint64_t>(figure("tetrahedra below 10 degrees"));
  a.dihedral_percent = figure("1 % quantile of smallest dihedral angles");
  a.face_angle_histogram = report.histograms.at(0).second;
  a.dihedral_histogram = report.histograms.at(1).second;
  result.shapes = {figure("smallest gamma"), figure("mean gamma"), figure("1 % quantile of gamma"),
                   figure("smallest SICN"), figure("mean SICN")};
}

std::uint64_t used_vertices(std::size_t vertices, Tetrahedra tetrahedra) {
  std::vector<bool> used(vertices);
  for (const auto& t : tetrahedra) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
}

void count_signs(const oracles::MeshFile& mesh, const oracles::ExactPoints& points,
                 MeshQuality& result) {
  std::uint64_t positive = 0, negative = 0;
  for (const auto& t : mesh.tetrahedra) {
    const int sign = oracles::exact::orient3d(points, t[0], t[1], t[2], t[3]);
    positive += sign > 0;
    negative += sign < 0;
    result.flat += sign == 0;
    auto sorted = t;
    std::sort(sorted.begin(), sorted.end());
    result.repeated_corners += std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  }
  // Programs differ in the order of corners; a file only has to keep to one order.
  result.left_handed = negative > positive;
  result.inverted = std::min(positive, negative);
}

void check_indices(const oracles::MeshFile& mesh) {
  for (const auto& t : mesh.tetrahedra) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.vertices.size()) {
        throw std::runtime_error("a tetrahedron refers to a vertex that is not there");
      }
    }
  }
}

PartQuality measure_part(Vertices vertices, const oracles::ExactPoints& points,
                         const std::vector<Tet>& tetrahedra) {
  PartQuality result;
  result.tetrahedra = tetrahedra.size();
  result.vertices = used_vertices(vertices.size(), tetrahedra);
  if (tetrahedra.empty()) return result;
  measure_sizes(vertices, tetrahedra, result);
  measure_angles(points, tetrahedra, result);
  return result;
}

// The oracles see meshes of about unit size, as here; powers of two change no angle.
std::vector<Position> in_ordinary_units(std::vector<Position> vertices) {
  double largest = 0;
  for (const Position& p : vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  for (Position& p : vertices) {
    for (double& x : p) x = std::ldexp(x, -exponent);
  }
  return vertices;
}

bool tells_inside(const oracles::MeshFile& mesh) {
  const auto& regions = mesh.regions;
  return regions.size() == mesh.tetrahedra.size() &&
         std::count(regions.begin(), regions.end(), 1) > 0 &&
         std::all_of(regions.begin(), regions.end(), [](auto r) { return r >= 0 && r <= 2; });
}

nlohmann::ordered_json json_of(const PartQuality& part) {
  const AngleStatistics& a = part.angles;
  const ShapeStatistics& shapes = part.shapes;
  return {{"vertices", part.vertices},
          {"tetrahedra", part.tetrahedra},
          {"faces", part.faces},
          {"min_face_angle", a.min_face_angle},
          {"max_face_angle", a.max_face_angle},
          {"min_dihedral", a.min_dihedral},
          {"max_dihedral", a.max_dihedral},
          {"mean_min_face_angle", a.mean_min_face_angle},
          {"mean_max_face_angle", a.mean_max_face_angle},
          {"mean_min_dihedral", a.mean_min_dihedral},
          {"mean_max_dihedral", a.mean_max_dihedral},
          {"tetrahedra_below_5_degrees", a.below_5},
          {"tetrahedra_below_10_degrees", a.below_10},
          {"dihedral_1_percent", a.dihedral_percent},
          {"min_gamma", shapes.min_gamma},
          {"mean_gamma", shapes.mean_gamma},
          {"gamma_1_percent", shapes.gamma_percent},
          {"min_sicn", shapes.min_sicn},
          {"mean_sicn", shapes.mean_sicn},
          {"shortest_edge", part.shortest_edge},
          {"volume", part.volume},
          {"face_angle_histogram", a.face_angle_histogram},
          {"dihedral_histogram", a.dihedral_histogram}};
}

}  // namespace

std::vector<Tet> inside_of(const oracles::MeshFile& mesh) {
  check_indices(mesh);
  if (!tells_inside(mesh)) return mesh.tetrahedra;
  std::vector<Tet> inside;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    if (mesh.regions[i] == 1) inside.push_back(mesh.tetrahedra[i]);
  }
  return inside;
}

MeshQuality measure(const oracles::MeshFile& mesh) {
  check_indices(mesh);
  oracles::ExactPoints points;
  if (const std::string error = points.assign(in_ordinary_units(mesh.vertices)); !error.empty()) {
    throw std::runtime_error(error);
  }
  MeshQuality result;
  count_signs(mesh, points, result);
  const auto part = [&](std::vector<Tet> tetrahedra) {
    if (result.left_handed) {
      for (Tet& t : tetrahedra) std::swap(t[2], t[3]);
    }
    return measure_part(mesh.vertices, points, tetrahedra);
  };
  result.all = part(mesh.tetrahedra);
  result.unused_vertices = mesh.vertices.size() - result.all.vertices;
  if (tells_inside(mesh)) {
    const auto inside = inside_of(mesh);
    result.inside = inside.size() == mesh.tetrahedra.size() ? result.all : part(inside);
  }
  return result;
}

std::string to_json(const MeshQuality& quality) {
  nlohmann::ordered_json json = json_of(quality.all);
  if (quality.inside) {
    json["interior_tetrahedra"] = quality.inside->tetrahedra;
    json["inside"] = json_of(*quality.inside);
  }
  json["inverted"] = quality.inverted;
  json["flat"] = quality.flat;
  json["repeated_corners"] = quality.repeated_corners;
  json["unused_vertices"] = quality.unused_vertices;
  json["crowded_faces"] = quality.all.crowded_faces;
  json["left_handed"] = quality.left_handed;
  return json.dump();
}

}  // namespace tetproof
