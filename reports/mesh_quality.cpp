#include "reports/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "reports/angles.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

using Vertices = std::span<const std::array<double, 3>>;
using Tetrahedra = std::span<const std::array<std::uint32_t, 4>>;

std::size_t bin(double degrees) {
  return std::min<std::size_t>(11, static_cast<std::size_t>(degrees / 15));
}

Corners corners(Vertices vertices, const std::array<std::uint32_t, 4>& t) {
  return {vertices[t[0]], vertices[t[1]], vertices[t[2]], vertices[t[3]]};
}

void measure_dihedrals(Vertices vertices, Tetrahedra tetrahedra, AngleStatistics& result) {
  double sum_min = 0, sum_max = 0;
  std::vector<double> smallest;
  smallest.reserve(tetrahedra.size());
  result.min_dihedral = 180;
  for (const auto& t : tetrahedra) {
    const auto angles = dihedral_angles(corners(vertices, t));
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    smallest.push_back(*low);
    sum_min += *low;
    sum_max += *high;
    result.min_dihedral = std::min(result.min_dihedral, *low);
    result.max_dihedral = std::max(result.max_dihedral, *high);
    result.below_5 += *low < 5;
    result.below_10 += *low < 10;
    for (const double angle : angles) ++result.dihedral_histogram[bin(angle)];
  }
  result.mean_min_dihedral = sum_min / static_cast<double>(tetrahedra.size());
  result.mean_max_dihedral = sum_max / static_cast<double>(tetrahedra.size());
  result.dihedral_percent = *quantile(std::move(smallest), 0.01);
}

void measure_shapes(Vertices vertices, Tetrahedra tetrahedra, int upright,
                    ShapeStatistics& result) {
  double sum_gamma = 0, sum_sicn = 0;
  std::vector<double> gammas;
  gammas.reserve(tetrahedra.size());
  result.min_gamma = result.min_sicn = 1;
  for (const auto& t : tetrahedra) {
    const Corners c = corners(vertices, t);
    const TetrahedronShape shape = tetrahedron_shape(c);
    const double sicn = orientation(c) == -upright ? -shape.sicn : shape.sicn;
    gammas.push_back(shape.gamma);
    sum_gamma += shape.gamma;
    sum_sicn += sicn;
    result.min_gamma = std::min(result.min_gamma, shape.gamma);
    result.min_sicn = std::min(result.min_sicn, sicn);
  }
  result.mean_gamma = sum_gamma / static_cast<double>(tetrahedra.size());
  result.mean_sicn = sum_sicn / static_cast<double>(tetrahedra.size());
  result.gamma_percent = *quantile(std::move(gammas), 0.01);
}

double length(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double volume(const Corners& c) {
  const auto d = [&](int i, int j) { return c[static_cast<std::size_t>(i)][j] - c[0][j]; };
  return (d(1, 0) * (d(2, 1) * d(3, 2) - d(2, 2) * d(3, 1)) -
          d(1, 1) * (d(2, 0) * d(3, 2) - d(2, 2) * d(3, 0)) +
          d(1, 2) * (d(2, 0) * d(3, 1) - d(2, 1) * d(3, 0))) /
         6;
}

void measure_sizes(Vertices vertices, Tetrahedra tetrahedra, PartQuality& result) {
  result.shortest_edge = std::numeric_limits<double>::infinity();
  for (const auto& t : tetrahedra) {
    const Corners c = corners(vertices, t);
    result.volume += std::fabs(volume(c));
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        result.shortest_edge = std::min(result.shortest_edge, length(c[i], c[j]));
      }
    }
  }
}

// The triangles of all tetrahedra, grouped by their smallest vertex: a bucket sort, because
// sorting all of them at once would dominate the measurement of large meshes.
class Faces {
 public:
  using Rest = std::pair<std::uint32_t, std::uint32_t>;  // the two larger vertices, in order

  Faces(std::size_t vertices, Tetrahedra tetrahedra) : start_(vertices + 1, 0) {
    for_each(tetrahedra, [&](std::uint32_t low, Rest) { ++start_[low + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
    rest_.resize(start_.back());
    std::vector<std::uint64_t> next(start_.begin(), start_.end() - 1);
    for_each(tetrahedra, [&](std::uint32_t low, Rest rest) { rest_[next[low]++] = rest; });
    for (std::size_t v = 0; v < vertices; ++v) std::sort(begin(v), begin(v + 1));
  }

  // visit(corners, how many tetrahedra have this face)
  template <typename Visit>
  void for_each_distinct(Visit visit) {
    for (std::uint32_t v = 0; v + 1 < start_.size(); ++v) {
      for (auto it = begin(v); it != begin(v + 1);) {
        const auto end = std::find_if(it, begin(v + 1), [&](const Rest& r) { return r != *it; });
        visit(std::array<std::uint32_t, 3>{v, it->first, it->second}, end - it);
        it = end;
      }
    }
  }

 private:
  template <typename Visit>
  static void for_each(Tetrahedra tetrahedra, Visit visit) {
    for (auto t : tetrahedra) {
      std::sort(t.begin(), t.end());
      visit(t[0], Rest(t[1], t[2]));
      visit(t[0], Rest(t[1], t[3]));
      visit(t[0], Rest(t[2], t[3]));
      visit(t[1], Rest(t[2], t[3]));
    }
  }

  std::vector<Rest>::iterator begin(std::size_t vertex) {
    return rest_.begin() + static_cast<std::ptrdiff_t>(start_[vertex]);
  }

  std::vector<std::uint64_t> start_;  // per vertex, into rest_
  std::vector<Rest> rest_;
};

void measure_faces(Vertices vertices, Tetrahedra tetrahedra, PartQuality& result,
                   std::uint64_t* crowded_faces) {
  AngleStatistics& angles = result.angles;
  double sum_min = 0, sum_max = 0;
  std::uint64_t crowded = 0;
  angles.min_face_angle = 180;
  Faces(vertices.size(), tetrahedra).for_each_distinct([&](const auto& f, std::ptrdiff_t sharing) {
    const auto three = triangle_angles(vertices[f[0]], vertices[f[1]], vertices[f[2]]);
    const auto [low, high] = std::minmax_element(three.begin(), three.end());
    ++result.faces;
    crowded += sharing > 2;
    sum_min += *low;
    sum_max += *high;
    angles.min_face_angle = std::min(angles.min_face_angle, *low);
    angles.max_face_angle = std::max(angles.max_face_angle, *high);
    for (const double angle : three) ++angles.face_angle_histogram[bin(angle)];
  });
  angles.mean_min_face_angle = sum_min / static_cast<double>(result.faces);
  angles.mean_max_face_angle = sum_max / static_cast<double>(result.faces);
  if (crowded_faces != nullptr) *crowded_faces = crowded;
}

std::uint64_t used_vertices(std::size_t vertices, Tetrahedra tetrahedra) {
  std::vector<bool> used(vertices);
  for (const auto& t : tetrahedra) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true));
}

void count_signs(const oracles::MeshFile& mesh, MeshQuality& result) {
  std::uint64_t positive = 0, negative = 0;
  for (const auto& t : mesh.tetrahedra) {
    const int sign = orientation(corners(mesh.vertices, t));
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

PartQuality measure_part(Vertices vertices, Tetrahedra tetrahedra, int upright,
                         std::uint64_t* crowded_faces) {
  PartQuality result;
  result.tetrahedra = tetrahedra.size();
  result.vertices = used_vertices(vertices.size(), tetrahedra);
  if (tetrahedra.empty()) return result;
  measure_dihedrals(vertices, tetrahedra, result.angles);
  measure_shapes(vertices, tetrahedra, upright, result.shapes);
  measure_sizes(vertices, tetrahedra, result);
  measure_faces(vertices, tetrahedra, result, crowded_faces);
  return result;
}

std::vector<std::array<std::uint32_t, 4>> inside_of(const oracles::MeshFile& mesh) {
  check_indices(mesh);
  if (!tells_inside(mesh)) return mesh.tetrahedra;
  std::vector<std::array<std::uint32_t, 4>> inside;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    if (mesh.regions[i] == 1) inside.push_back(mesh.tetrahedra[i]);
  }
  return inside;
}

MeshQuality measure(const oracles::MeshFile& mesh) {
  check_indices(mesh);
  MeshQuality result;
  count_signs(mesh, result);
  const int upright = result.left_handed ? -1 : 1;
  result.all = measure_part(mesh.vertices, mesh.tetrahedra, upright, &result.crowded_faces);
  result.unused_vertices = mesh.vertices.size() - result.all.vertices;
  if (tells_inside(mesh)) {
    const auto inside = inside_of(mesh);
    result.inside = inside.size() == mesh.tetrahedra.size()
                        ? result.all
                        : measure_part(mesh.vertices, inside, upright);
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
  json["crowded_faces"] = quality.crowded_faces;
  json["left_handed"] = quality.left_handed;
  return json.dump();
}

}  // namespace tetproof
