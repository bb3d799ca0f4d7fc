// Complexes of triangles for tests, and their meshes with all regions.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::complexes {

using delmesher::Options;
using delmesher::Surface;
using oracles::MeshFile;
using oracles::Polyhedron;
using oracles::VerifyReport;

inline constexpr std::uint64_t kSeed = 20261129;

inline Options all_regions() {
  Options options;
  options.regions = delmesher::Regions::all;
  return options;
}

inline VerifyReport verified(const Polyhedron& input, const MeshFile& mesh) {
  VerifyReport report;
  EXPECT_EQ(oracles::verify(input, mesh, nullptr, {.promised = oracles::promise_of(all_regions())},
                            report),
            "");
  return report;
}

class Builder {
 public:
  std::uint32_t vertex(const std::array<double, 3>& p) {
    const auto [at, fresh] = number_.try_emplace(p, surface_.vertices.size());
    if (fresh) surface_.vertices.push_back(p);
    return static_cast<std::uint32_t>(at->second);
  }
  void triangle(const std::array<double, 3>& a, const std::array<double, 3>& b,
                const std::array<double, 3>& c, int label = 0) {
    surface_.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    surface_.labels.push_back(label);
  }
  void square(const std::array<double, 3>& a, const std::array<double, 3>& b,
              const std::array<double, 3>& c, const std::array<double, 3>& d, int label = 0) {
    triangle(a, b, c, label);
    triangle(a, c, d, label);
  }
  // An axis-parallel box.
  void box(const std::array<double, 3>& low, const std::array<double, 3>& high, int label = 0) {
    const auto at = [&](int x, int y, int z) -> std::array<double, 3> {
      return {x != 0 ? high[0] : low[0], y != 0 ? high[1] : low[1], z != 0 ? high[2] : low[2]};
    };
    square(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), label);
    square(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), label);
    square(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1), label);
    square(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), label);
    square(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0), label);
    square(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1), label);
  }
  const Surface& surface() const { return surface_; }

 private:
  Surface surface_;
  std::map<std::array<double, 3>, std::size_t> number_;
};

// Each triangle at the edge from a to b in two, with a vertex on it.
inline Surface cut_at(Surface surface, const std::array<double, 3>& a,
                      const std::array<double, 3>& b, const std::array<double, 3>& place) {
  const auto middle = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.push_back(place);
  const auto at = [&](std::uint32_t v) -> const std::array<double, 3>& {
    return surface.vertices[v];
  };
  for (std::size_t t = 0, given = surface.triangles.size(); t < given; ++t) {
    auto& one = surface.triangles[t];
    const auto first = std::ranges::find_if(one, [&](std::uint32_t v) { return at(v) == a; }),
               second = std::ranges::find_if(one, [&](std::uint32_t v) { return at(v) == b; });
    if (first == one.end() || second == one.end()) continue;
    auto other = one;
    other[static_cast<std::size_t>(first - one.begin())] = middle;
    *second = middle;
    surface.triangles.push_back(other);
    surface.labels.push_back(surface.labels[t]);
  }
  return surface;
}

// A number for each cell of a grid, 0 where there is nothing.
using Cell = std::array<int, 3>;
using Materials = std::map<Cell, int>;

inline int at(const Materials& materials, const Cell& cell) {
  const auto found = materials.find(cell);
  return found == materials.end() ? 0 : found->second;
}

// The walls between different materials, triangulated and turned at random.
inline Surface walls_of(const Materials& materials, int n, std::mt19937_64& random) {
  Builder builder;
  for (int axis = 0; axis < 3; ++axis) {
    for (int x = 0; x <= n; ++x) {
      for (int y = 0; y < n; ++y) {
        for (int z = 0; z < n; ++z) {
          Cell cell;
          cell[axis] = x;
          cell[(axis + 1) % 3] = y;
          cell[(axis + 2) % 3] = z;
          Cell before = cell;
          --before[axis];
          if (at(materials, cell) == at(materials, before)) continue;
          std::array<std::array<double, 3>, 4> corner;
          for (int k = 0; k < 4; ++k) {
            Cell c = cell;
            c[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
            c[(axis + 2) % 3] += k >= 2 ? 1 : 0;
            corner[k] = {double(c[0]), double(c[1]), double(c[2])};
          }
          const int first = static_cast<int>(random() % 2);
          const auto corner_at = [&](int k) { return corner[(k + first) % 4]; };
          builder.triangle(corner_at(0), corner_at(1), corner_at(2));
          random() % 2 != 0 ? builder.triangle(corner_at(0), corner_at(2), corner_at(3))
                            : builder.triangle(corner_at(0), corner_at(3), corner_at(2));
        }
      }
    }
  }
  return builder.surface();
}

}  // namespace tetproof::complexes
