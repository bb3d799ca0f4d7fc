// What verification costs, in steps that neither a clock nor a machine decides.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fuzz/properties.h"
#include "oracles/base/steps.h"
#include "oracles/improvement/improved.h"
#include "oracles/plane/verify.h"
#include "oracles/verify.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using oracles::Face;
using oracles::Index;
using oracles::MeshFile;
using oracles::PlaneFile;
using oracles::Polyhedron;
using oracles::Position;
using oracles::Tet;

// Small, so that a thousand are verified in a minute; what takes quadratic time takes many times
// the most per element even so.
constexpr std::size_t kMostElements = 4000;
// Steps per element of the input and the mesh. Honest cubes of 6 to 6000 tetrahedra take 60 to 140,
// damaged ones up to 1300; in the plane up to 10 000, where pieces lie under copies of triangles.
constexpr double kMost = 3000, kMostInPlane = 30000;

// What was given twice as often, damaged: some of `list`, by two bytes.
template <class T>
std::pair<std::size_t, std::size_t> part_of(const std::vector<T>& list, Bytes& bytes) {
  if (list.empty()) return {0, 0};
  const std::size_t first = bytes.byte() * list.size() / 256;
  return {first, std::min(list.size(), first + 1 + bytes.below(8))};
}

// How often to do something to an element: seldom, or so often that nothing larger is allowed.
std::size_t times(Bytes& bytes) {
  return std::size_t{1} << bytes.below(12);
}

// A cube of n^3 cells, six tetrahedra each.
void add_cube(std::size_t n, Polyhedron& input, MeshFile& mesh) {
  const auto corner = [](std::size_t side, std::size_t x, std::size_t y, std::size_t z) {
    return static_cast<Index>((x * (side + 1) + y) * (side + 1) + z);
  };
  const auto each_tet = [&](std::size_t side, auto&& take) {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
    for (std::size_t cell = 0; cell < side * side * side; ++cell) {
      for (int k = 0; k < 6; ++k) {
        std::array<std::size_t, 3> at = {cell / (side * side), cell / side % side, cell % side};
        Tet tet = {corner(side, at[0], at[1], at[2])};
        for (std::size_t i = 0; i < 3; ++i) {
          ++at[kOrders[k][i]];
          tet[i + 1] = corner(side, at[0], at[1], at[2]);
        }
        if (k >= 3) std::swap(tet[2], tet[3]);
        take(tet);
      }
    }
  };
  const auto place = [](std::size_t side, std::vector<Position>& list) {
    const double s = 1.0 / static_cast<double>(side);
    for (std::size_t x = 0; x <= side; ++x) {
      for (std::size_t y = 0; y <= side; ++y) {
        for (std::size_t z = 0; z <= side; ++z) {
          list.push_back(
              {static_cast<double>(x) * s, static_cast<double>(y) * s, static_cast<double>(z) * s});
        }
      }
    }
  };
  place(1, input.vertices);
  each_tet(1, [&](const Tet& tet) {
    for (int i = 0; i < 4; ++i) {
      const Face face = oracles::face_of(tet, i);
      const auto on_side = [&](std::size_t axis, double at) {
        return std::ranges::all_of(face, [&](Index v) { return input.vertices[v][axis] == at; });
      };
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (on_side(axis, 0) || on_side(axis, 1)) input.triangles.push_back(face);
      }
    }
  });
  place(n, mesh.vertices);
  each_tet(n, [&](const Tet& tet) { mesh.tetrahedra.push_back(tet); });
}

// One more part of the input, beside the others or within, and perhaps that of the mesh.
void add_copies(std::size_t count, Bytes& bytes, Polyhedron& input, MeshFile& mesh) {
  const double by = std::ldexp(1.0 + bytes.below(3), bytes.below(40) - 20);
  const bool meshed = bytes.below(2) != 0;
  for (std::size_t n = 1; n <= count && input.triangles.size() < kMostElements / 4; ++n) {
    const double x = by * static_cast<double>(n);
    const auto first = static_cast<Index>(input.vertices.size());
    for (std::size_t v = 0; v < 8; ++v) {
      const Position p = input.vertices[v];
      input.vertices.push_back({p[0] + x, p[1], p[2]});
    }
    for (std::size_t t = 0; t < 12; ++t) {
      const auto [a, b, c] = input.triangles[t];
      input.triangles.push_back({a + first, b + first, c + first});
    }
    if (!meshed) continue;
    const auto begin = static_cast<Index>(mesh.vertices.size());
    for (std::size_t v = first; v < input.vertices.size(); ++v) {
      mesh.vertices.push_back(input.vertices[v]);
    }
    MeshFile coarse;
    Polyhedron unused;
    add_cube(1, unused, coarse);
    for (const auto& [a, b, c, d] : coarse.tetrahedra) {
      mesh.tetrahedra.push_back({a + begin, b + begin, c + begin, d + begin});
    }
  }
}

void damage(Bytes& bytes, Polyhedron& input, MeshFile& mesh) {
  const auto [first, last] = part_of(mesh.tetrahedra, bytes);
  const std::size_t count = times(bytes);
  const double by = std::ldexp(1.0, -static_cast<int>(bytes.below(60)));
  const std::size_t axis = bytes.below(3);
  const auto is_full = [&] {
    return mesh.tetrahedra.size() + mesh.vertices.size() > kMostElements;
  };
  switch (bytes.below(8)) {
    case 0:  // the same again
      for (std::size_t n = 0; n < count && !is_full(); ++n) {
        for (std::size_t t = first; t < last; ++t) {
          mesh.tetrahedra.push_back(Tet(mesh.tetrahedra[t]));
        }
      }
      break;
    case 1:  // the same with vertices of its own, moved a little each time
      for (std::size_t n = 1; n <= count && !is_full(); ++n) {
        for (std::size_t t = first; t < last; ++t) {
          Tet tet = mesh.tetrahedra[t];
          for (Index& v : tet) {
            Position p = mesh.vertices[v];
            p[axis] += by * static_cast<double>(n);
            v = static_cast<Index>(mesh.vertices.size());
            mesh.vertices.push_back(p);
          }
          mesh.tetrahedra.push_back(tet);
        }
      }
      break;
    case 2:  // many on one face, at one edge, or at one vertex
      for (std::size_t n = 1; n <= count && first < last && !is_full(); ++n) {
        Tet tet = mesh.tetrahedra[first];
        for (std::size_t i = 3 - std::min<std::size_t>(axis, 2); i < 4; ++i) {
          Position p = mesh.vertices[tet[i]];
          p[axis] += by * static_cast<double>(n);
          tet[i] = static_cast<Index>(mesh.vertices.size());
          mesh.vertices.push_back(p);
        }
        mesh.tetrahedra.push_back(tet);
      }
      break;
    case 3:  // a vertex in place of others
      for (std::size_t t = first; t < std::min(mesh.tetrahedra.size(), first + count); ++t) {
        mesh.tetrahedra[t][axis] = mesh.tetrahedra[first][3];
      }
      break;
    case 4:  // vertices in one place, or nearly
      for (std::size_t v = first; v < std::min(mesh.vertices.size(), first + count); ++v) {
        mesh.vertices[v] = mesh.vertices[first];
        mesh.vertices[v][axis] += by * static_cast<double>(v - first);
      }
      break;
    case 5:
      mesh.tetrahedra.erase(mesh.tetrahedra.begin() + static_cast<std::ptrdiff_t>(first),
                            mesh.tetrahedra.begin() + static_cast<std::ptrdiff_t>(last));
      break;
    case 6:  // lists triangles, some often
      for (std::size_t n = 0; n < count && mesh.boundary.size() < kMostElements; ++n) {
        for (std::size_t t = first; t < last; ++t) {
          mesh.boundary.push_back(oracles::face_of(mesh.tetrahedra[t], static_cast<int>(n % 4)));
        }
      }
      break;
    default:
      add_copies(count, bytes, input, mesh);
  }
}

constexpr const char* kPromises[] = {"mesh",
                                     "mesh --planar 0",
                                     "mesh --planar 0.01",
                                     "mesh --surface keep",
                                     "mesh --max-edge 0.1",
                                     "mesh --approximate",
                                     "mesh --label-by-angle 30",
                                     "cdt",
                                     "improve"};

Finding judged(std::uint64_t before, std::size_t elements, double most) {
  const double each = static_cast<double>(oracles::steps - before) /
                      static_cast<double>(std::max<std::size_t>(elements, 100));
  if (each <= most) return {};
  return "verification: " + std::to_string(each) + " steps for each element";
}

Finding in_space(Bytes& bytes) {
  Polyhedron input;
  MeshFile mesh;
  add_cube(1 + bytes.below(6), input, mesh);
  const MeshFile given = mesh;
  oracles::VerifyOptions options;
  options.stage = oracles::Stage::final;
  const std::string wrong =
      parse_promise(kPromises[bytes.below(std::size(kPromises))], options.promised);
  if (!wrong.empty()) return "promise: " + wrong;
  for (int n = 0; n < 6 && !bytes.empty(); ++n) damage(bytes, input, mesh);
  mesh.either_orientation = bytes.below(2) != 0;
  oracles::VerifyReport report;
  const std::uint64_t before = oracles::steps;
  if (options.promised.task == oracles::Task::improve) {
    verify_improved(given, mesh, options, report);
  } else {
    verify(input, mesh, nullptr, options, report);
  }
  return judged(before,
                input.triangles.size() + given.tetrahedra.size() + mesh.tetrahedra.size() +
                    mesh.vertices.size() + mesh.boundary.size(),
                kMost);
}

// Squares in a row, each of two triangles.
void add_squares(std::size_t n, delmesher::PlanarGraph& graph, PlaneFile& file) {
  for (std::size_t x = 0; x < n; ++x) {
    const auto first = static_cast<std::uint32_t>(file.vertices.size());
    const double left = 2 * static_cast<double>(x);
    for (const auto& p : {std::array{left, 0.0}, std::array{left + 1, 0.0},
                          std::array{left + 1, 1.0}, std::array{left, 1.0}}) {
      graph.vertices.push_back(p);
      file.vertices.push_back(p);
    }
    for (std::uint32_t i = 0; i < 4; ++i)
      graph.segments.push_back({first + i, first + (i + 1) % 4});
    file.triangles.push_back({first, first + 1, first + 2});
    file.triangles.push_back({first, first + 2, first + 3});
  }
}

void damage(Bytes& bytes, delmesher::PlanarGraph& graph, PlaneFile& file) {
  const auto [first, last] = part_of(file.triangles, bytes);
  const std::size_t count = times(bytes);
  const double by = std::ldexp(1.0, -static_cast<int>(bytes.below(60)));
  const std::size_t axis = bytes.below(2);
  const auto is_full = [&] { return file.triangles.size() + file.vertices.size() > kMostElements; };
  const auto moved = [&](std::array<double, 2> p, std::size_t n) {
    p[axis] += by * static_cast<double>(n);
    return p;
  };
  const std::size_t kind = bytes.below(6);
  for (std::size_t n = 1; n <= count && first < last && !is_full(); ++n) {
    auto triangle = file.triangles[first + n % (last - first)];
    // The same, or with one, two or three vertices of its own.
    for (std::size_t i = 0; kind < 4 && i < kind; ++i) {
      const auto p = moved(file.vertices[triangle[i]], n);
      triangle[i] = static_cast<std::uint32_t>(file.vertices.size());
      file.vertices.push_back(p);
    }
    if (kind < 4) file.triangles.push_back(triangle);
    // Spokes, and rows of points of the input.
    if (kind >= 4 && graph.vertices.size() < kMostElements / 4) {
      const auto p = moved(graph.vertices[first % graph.vertices.size()], n);
      if (std::ranges::find(graph.vertices, p) != graph.vertices.end()) continue;
      const auto v = static_cast<std::uint32_t>(graph.vertices.size());
      graph.vertices.push_back(p);
      graph.segments.push_back({kind == 4 ? 0 : v - 1, v});
      if (axis == 0) file.vertices.push_back(p);
    }
  }
}

Finding in_plane(Bytes& bytes) {
  delmesher::PlanarGraph graph;
  PlaneFile file;
  add_squares(1 + bytes.below(64), graph, file);
  for (int n = 0; n < 4 && !bytes.empty(); ++n) damage(bytes, graph, file);
  file.lists_edges = false;
  PlaneVerifyOptions options;
  const bool hull = bytes.below(2) != 0;
  const std::string wrong = parse_promise(hull ? "plane --region hull" : "plane", options.promised);
  if (!wrong.empty()) return "promise: " + wrong;
  oracles::VerifyReport report;
  const std::uint64_t before = oracles::steps;
  verify_plane(graph, file, nullptr, options, report);
  return judged(
      before,
      graph.segments.size() + graph.vertices.size() + file.triangles.size() + file.vertices.size(),
      kMostInPlane);
}

}  // namespace

Finding verification_cost_holds(Bytes bytes) {
  judging({});
  return bytes.below(3) == 0 ? in_plane(bytes) : in_space(bytes);
}

}  // namespace tetproof::fuzz
