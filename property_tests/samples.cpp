#include "property_tests/samples.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <ostream>
#include <random>

#include "oracles/cgal/surface_opinion.h"

namespace tetproof::samples {
namespace {

using oracles::Face;
using oracles::Index;
using oracles::Position;
using oracles::Tet;

// Six tetrahedra around the diagonal of a cell (Kuhn): paths from corner 0 to corner 7 along the
// axes. Neighbouring cells agree on the diagonals of their common faces.
constexpr int kPaths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};

struct Grid {
  int n;
  Index vertex(int x, int y, int z) const {
    return static_cast<Index>((z * (n + 1) + y) * (n + 1) + x);
  }
  Index corner(int x, int y, int z, int bits) const {
    return vertex(x + (bits & 1), y + (bits >> 1 & 1), z + (bits >> 2));
  }
};

void add_cell(const Grid& grid, int x, int y, int z, std::vector<Tet>& tets) {
  for (const auto& [first, second] : kPaths) {
    tets.push_back({grid.corner(x, y, z, 0), grid.corner(x, y, z, first),
                    grid.corner(x, y, z, second), grid.corner(x, y, z, 7)});
  }
}

// Renumbers the vertices that occur, in order.
template <class Cell>
std::vector<Index> compact(std::vector<Cell>& cells) {
  std::vector<Index> used;
  for (const Cell& cell : cells) used.insert(used.end(), cell.begin(), cell.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (Cell& cell : cells) {
    for (Index& v : cell) {
      v = static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    }
  }
  return used;
}

std::vector<Position> positions(const Grid& grid, const std::vector<Index>& used) {
  std::vector<Position> result;
  const Index m = static_cast<Index>(grid.n + 1);
  for (const Index v : used) {
    const double n = grid.n;
    result.push_back({v % m / n, v / m % m / n, v / m / m / n});
  }
  return result;
}

std::vector<Face> boundary_of(const std::vector<Tet>& tets) {
  std::map<Face, std::vector<Face>> faces;
  for (const Tet& tet : tets) {
    for (int i = 0; i < 4; ++i) {
      const Face face = oracles::face_of(tet, i);
      Face sorted = face;
      std::sort(sorted.begin(), sorted.end());
      faces[sorted].push_back(face);
    }
  }
  std::vector<Face> boundary;
  for (const auto& [sorted, list] : faces) {
    if (list.size() == 1) boundary.push_back(list[0]);
  }
  return boundary;
}

delmesher::Surface prism(int sides, double height, double twist) {
  delmesher::Surface s;
  for (int level = 0; level < 2; ++level) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * 3.14159265358979 * i / sides + level * twist;
      s.vertices.push_back({std::cos(angle), std::sin(angle), level * height});
    }
  }
  const auto v = [&](int level, int i) {
    return static_cast<std::uint32_t>(level * sides + i % sides);
  };
  for (int i = 0; i < sides; ++i) {
    s.triangles.push_back({v(0, i), v(0, i + 1), v(1, i + 1)});
    s.triangles.push_back({v(0, i), v(1, i + 1), v(1, i)});
    if (i > 0 && i + 1 < sides) {
      s.triangles.push_back({v(0, 0), v(0, i + 1), v(0, i)});
      s.triangles.push_back({v(1, 0), v(1, i), v(1, i + 1)});
    }
  }
  return s;
}

// A star-shaped surface: the octahedron's subdivision with random radii.
delmesher::Surface star(std::uint64_t seed, int rounds, double roughness) {
  delmesher::Surface s;
  s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.emplace(std::minmax(a, b), s.vertices.size());
      if (fresh) {
        const auto p = s.vertices[a], q = s.vertices[b];
        s.vertices.push_back({p[0] + q[0], p[1] + q[1], p[2] + q[2]});
      }
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    s.triangles = finer;
  }
  std::mt19937_64 random(seed);
  for (auto& p : s.vertices) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    const double scale = (1 + roughness * (share - 0.5)) / std::hypot(p[0], p[1], p[2]);
    for (double& x : p) x *= scale;
  }
  return s;
}

void append(delmesher::Surface& s, const delmesher::Surface& other, const Position& shift) {
  const auto offset = static_cast<std::uint32_t>(s.vertices.size());
  for (const auto& p : other.vertices) {
    s.vertices.push_back({p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]});
  }
  for (const auto& [a, b, c] : other.triangles) {
    s.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

}  // namespace

Sample grid_sample(int coarse, int finer, const Cells& solid, bool hull) {
  Sample sample;
  const Grid rough{coarse}, fine{coarse * finer};
  std::vector<Tet> solid_tets;
  for (int z = 0; z < coarse; ++z) {
    for (int y = 0; y < coarse; ++y) {
      for (int x = 0; x < coarse; ++x) {
        if (solid(x, y, z)) add_cell(rough, x, y, z, solid_tets);
      }
    }
  }
  sample.input.triangles = boundary_of(solid_tets);
  sample.input.vertices = positions(rough, compact(sample.input.triangles));
  for (int z = 0; z < fine.n; ++z) {
    for (int y = 0; y < fine.n; ++y) {
      for (int x = 0; x < fine.n; ++x) {
        const bool inside = solid(x / finer, y / finer, z / finer);
        if (!inside && !hull) continue;
        add_cell(fine, x, y, z, sample.mesh.tetrahedra);
        sample.mesh.regions.resize(sample.mesh.tetrahedra.size(), inside);
      }
    }
  }
  sample.mesh.vertices = positions(fine, compact(sample.mesh.tetrahedra));
  std::vector<Tet> inside;
  for (std::size_t t = 0; t < sample.mesh.tetrahedra.size(); ++t) {
    if (sample.mesh.regions[t]) inside.push_back(sample.mesh.tetrahedra[t]);
  }
  sample.mesh.boundary = boundary_of(inside);
  return sample;
}

Sample cube() {
  return grid_sample(1, 4, [](int, int, int) { return true; });
}

Sample l_shape() {
  return grid_sample(2, 2, [](int x, int y, int) { return x == 0 || y == 0; });
}

Sample hollow_cube() {
  const auto middle = [](int i) { return i == 1 || i == 2; };
  return grid_sample(4, 1,
                     [=](int x, int y, int z) { return !(middle(x) && middle(y) && middle(z)); });
}

Sample cube_in_hull() {
  const auto middle = [](int i) { return i == 1 || i == 2; };
  return grid_sample(
      4, 1, [=](int x, int y, int z) { return middle(x) && middle(y) && middle(z); }, true);
}

Sample skewed(Sample sample) {
  constexpr double kMatrix[3][3] = {{0.9, 0.123, -0.31}, {-0.2, 1.1, 0.07}, {0.33, -0.17, 0.77}};
  for (auto* list : {&sample.input.vertices, &sample.mesh.vertices}) {
    for (Position& p : *list) {
      Position q;
      for (int i = 0; i < 3; ++i) {
        q[i] = kMatrix[i][0] * p[0] + kMatrix[i][1] * p[1] + kMatrix[i][2] * p[2];
      }
      p = q;
    }
  }
  return sample;
}

ExactSample exact_sample() {
  using delmesher::ExactPoint;
  ExactSample result;
  oracles::Polyhedron& input = result.sample.input;
  input.vertices = {{0.1, 0.2, 0.3}, {1.7, 0.1, 0.2}, {0.3, 1.9, 0.1}, {0.2, 0.4, 1.3}};
  input.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  delmesher::ExactRecord& exact = result.exact;
  exact.points = oracles::explicit_points(input.vertices);
  // Point 4 on edge 0-1, point 5 on triangle 1-2-3; everything is Delaunay.
  exact.points.push_back({ExactPoint::Kind::on_segment, 0, 1, 0, 0x1.85p-1, 0, 0});
  exact.points.push_back({ExactPoint::Kind::on_triangle, 1, 2, 3, 0x1.43p-1, 0x1.03p-2, 0});
  // Tetrahedra 0 2 3 with 4, and 4 with the three parts of 1-2-3.
  exact.final = {
      {{0, 4, 2, 3}, true}, {{4, 1, 2, 5}, true}, {{4, 2, 3, 5}, true}, {{4, 3, 1, 5}, true}};
  exact.final_facets = {{0, 2, 4, 0}, {4, 2, 1, 0}, {0, 4, 3, 1}, {4, 1, 3, 1},
                        {1, 2, 5, 2}, {2, 3, 5, 2}, {3, 1, 5, 2}, {2, 0, 3, 3}};
  exact.facets = {{0, 0, 0, {0}}, {1, 0, 0, {1}}, {2, 0, 0, {2}}, {3, 0, 0, {3}}};
  exact.mesh_vertices = {0, 1, 2, 3, 4, 5};
  oracles::MeshFile& mesh = result.sample.mesh;
  oracles::ExactPoints points;
  points.assign(exact.points);
  for (Index v = 0; v < points.size(); ++v) mesh.vertices.push_back(points.nearest(v));
  for (const auto& tet : exact.final) mesh.tetrahedra.push_back(tet.vertices);
  for (const auto& [a, b, c, id] : exact.final_facets) {
    mesh.boundary.push_back({a, b, c});
    mesh.facets.push_back(id);
  }
  return result;
}

void PrintTo(const NamedSurface& model, std::ostream* stream) {
  *stream << model.name;
}

delmesher::Surface random_voxels(std::uint64_t seed) {
  constexpr int kSize = 4;
  std::mt19937_64 random(seed);
  for (;;) {
    std::array<bool, kSize * kSize * kSize> cells{};
    cells[random() % cells.size()] = true;
    for (int n = 0; n < 40; ++n) {  // grow over faces
      const std::size_t at = random() % cells.size();
      const std::size_t step = std::array<std::size_t, 3>{1, kSize, kSize * kSize}[random() % 3];
      if (at + step < cells.size() && at / step % kSize + 1 < kSize) {
        if (cells[at] || cells[at + step]) cells[at] = cells[at + step] = true;
      }
    }
    const Sample sample = grid_sample(kSize, 1, [&](int x, int y, int z) {
      return cells[static_cast<std::size_t>((z * kSize + y) * kSize + x)];
    });
    delmesher::Surface surface = to_surface(sample.input);
    if (oracles::cgal_surface_opinion(sample.input).valid()) return surface;
  }
}

delmesher::Surface quantized_star(std::uint64_t seed) {
  for (;; seed += 1000003) {
    delmesher::Surface surface = star(seed, 1, 0.9);
    for (auto& p : surface.vertices) {
      for (double& x : p) x = std::nearbyint(x * 8) / 8;
    }
    if (oracles::cgal_surface_opinion(to_polyhedron(surface)).valid()) return surface;
  }
}

delmesher::Surface finned_cube(double length, double h) {
  delmesher::Surface s;
  const double l = length;
  s.vertices = {{0, 0, 0},
                {1, 0, 0},
                {1, 1, 0},
                {0, 1, 0},
                {0, 0, 1},
                {1, 0, 1},
                {1, 1, 1},
                {0, 1, 1},
                // The fin stands on the side x = 1, in the middle of it.
                {1, 0.5, 0.5},
                {1, 0.5 + l, 0.5},
                {1, 0.5 + l, 0.5 + h},
                {1, 0.5, 0.5 + h},
                {1 + l, 0.5, 0.5},
                {1 + l, 0.5 + l, 0.5},
                {1 + l, 0.5 + l, 0.5 + h},
                {1 + l, 0.5, 0.5 + h}};
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  quad(0, 3, 2, 1);
  quad(4, 5, 6, 7);
  quad(0, 1, 5, 4);
  quad(2, 3, 7, 6);
  quad(0, 4, 7, 3);
  // The side around the fin.
  quad(1, 2, 9, 8);
  quad(2, 6, 10, 9);
  quad(6, 5, 11, 10);
  quad(5, 1, 8, 11);
  // The fin.
  quad(8, 9, 13, 12);
  quad(9, 10, 14, 13);
  quad(10, 11, 15, 14);
  quad(11, 8, 12, 15);
  quad(12, 13, 14, 15);
  return s;
}

delmesher::Options split_surface() {
  delmesher::Options options;
  options.surface = delmesher::SurfaceChoice::split;
  options.size = 0;
  return options;
}

bool exact_or_rounded(const oracles::VerifyReport& report) {
  return report.verdict == oracles::Verdict::exact || report.verdict == oracles::Verdict::rounded;
}

bool as_promised(const oracles::VerifyReport& report) {
  if (exact_or_rounded(report)) return true;
  const oracles::OracleReport* stand_in = report.find("stand-in");
  return report.verdict == oracles::Verdict::deviating && stand_in != nullptr &&
         stand_in->passed() && report.deviation_share <= report.planar_share;
}

delmesher::Surface triangular_prism(const std::array<std::array<double, 2>, 3>& base, double bottom,
                                    double top) {
  delmesher::Surface s;
  for (const double z : {bottom, top}) {
    for (const auto& [x, y] : base) s.vertices.push_back({x, y, z});
  }
  s.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                 {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return s;
}

void add_box(delmesher::Surface& surface, const std::array<double, 3>& low,
             const std::array<double, 3>& high) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const double z : {low[2], high[2]}) {
    for (const auto& [x, y] :
         {std::pair(low[0], low[1]), {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}) {
      surface.vertices.push_back({x, y, z});
    }
  }
  for (const auto& [a, b, c, d] : {std::array{0U, 3U, 2U, 1U},
                                   {4U, 5U, 6U, 7U},
                                   {0U, 1U, 5U, 4U},
                                   {1U, 2U, 6U, 5U},
                                   {2U, 3U, 7U, 6U},
                                   {3U, 0U, 4U, 7U}}) {
    surface.triangles.push_back({first + a, first + b, first + c});
    surface.triangles.push_back({first + a, first + c, first + d});
  }
}

delmesher::Surface wedge_and_slab() {
  delmesher::Surface s = triangular_prism({{{0, 0}, {1, 0}, {1, 0.2}}}, 0, 1);
  add_box(s, {2, 0, 0}, {3, 1, 0x1p-10});
  return s;
}

int iterations(int normal) {
  const char* factor = std::getenv("TETPROOF_ITERATIONS");
  const long times = factor != nullptr ? std::strtol(factor, nullptr, 10) : 1;
  return normal * static_cast<int>(std::clamp(times, 1L, 1000000L));
}

oracles::Polyhedron to_polyhedron(const delmesher::Surface& surface) {
  return {surface.vertices, surface.triangles, surface.labels, {}};
}

delmesher::Surface to_surface(const oracles::Polyhedron& polyhedron) {
  return {polyhedron.vertices, polyhedron.triangles, polyhedron.labels};
}

oracles::MeshFile to_mesh(const delmesher::TetMesh& mesh) {
  oracles::MeshFile file;
  file.vertices = mesh.vertices;
  file.tetrahedra = mesh.tetrahedra;
  file.names_sides = true;
  if (mesh.regions.empty()) {
    file.regions.assign(mesh.inside.begin(), mesh.inside.end());
  } else {
    file.regions.assign(mesh.regions.begin(), mesh.regions.end());
  }
  file.boundary = mesh.boundary;
  file.labels = mesh.boundary_labels;
  file.facets = mesh.boundary_facets;
  file.planar_within = mesh.planar_within;
  return file;
}

std::vector<NamedSurface> surfaces(std::uint64_t seed) {
  std::vector<NamedSurface> list;
  list.push_back({"cube", to_surface(cube().input)});
  list.push_back({"l_shape", to_surface(l_shape().input)});
  list.push_back({"hollow_cube", to_surface(hollow_cube().input)});
  list.push_back({"skewed_l", to_surface(skewed(l_shape()).input)});
  list.push_back({"needle", prism(3, 20, 0)});
  list.push_back({"coin", prism(12, 0.05, 0)});
  list.push_back({"twisted", prism(5, 1.5, 0.3)});
  list.push_back({"octahedron", star(seed, 0, 0)});
  list.push_back({"pebble", star(seed, 2, 0.2)});
  list.push_back({"star", star(seed, 2, 1.2)});
  delmesher::Surface two = star(seed + 1, 1, 0.5);
  append(two, prism(4, 1, 0), {3, 0.25, 0});
  list.push_back({"two_components", two});
  // Dihedral angles from very sharp to very blunt.
  list.push_back({"wedge", triangular_prism({{{0, 0}, {1, 0}, {1, 0.02}}}, 0, 1)});
  return list;
}

}  // namespace tetproof::samples
