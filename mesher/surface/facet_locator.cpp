#include "mesher/surface/facet_locator.h"

#include <algorithm>
#include <cmath>

namespace delmesher::surface {
namespace {

constexpr std::size_t kBruteForce = 8;  // triangles; below it a grid does not pay

std::array<int, 2> plane_axes(int axis) {
  return {(axis + 1) % 3, (axis + 2) % 3};
}

}  // namespace

FacetLocator::FacetLocator(const SurfaceTopology& topology, const PointStore& points)
    : topology_(topology),
      points_(points),
      grids_(topology.facet_triangles.size()),
      built_(topology.facet_triangles.size(), 0) {}

std::array<std::uint32_t, 2> FacetLocator::cell_of(const Grid& grid, double x, double y) const {
  std::array<std::uint32_t, 2> cell{};
  const double at[2] = {x, y};
  for (int k = 0; k < 2; ++k) {
    const double n = grid.cell[k] > 0 ? (at[k] - grid.low[k]) / grid.cell[k] : 0;
    cell[k] = n > 0 ? std::min(grid.count[k] - 1, static_cast<std::uint32_t>(std::min(n, 1e9))) : 0;
  }
  return cell;
}

void FacetLocator::build(FacetId facet) {
  const auto& triangles = topology_.facet_triangles[facet];
  const auto axes = plane_axes(topology_.facet_axis[facet]);
  Grid& grid = grids_[facet];
  grid.low = {HUGE_VAL, HUGE_VAL};
  std::array<double, 2> high = {-HUGE_VAL, -HUGE_VAL};
  for (const std::uint32_t t : triangles) {
    for (const VertexId v : topology_.triangles[t]) {
      for (int k = 0; k < 2; ++k) {
        grid.low[k] = std::min(grid.low[k], points_.nearest(v)[axes[k]]);
        high[k] = std::max(high[k], points_.nearest(v)[axes[k]]);
      }
    }
  }
  const auto per_axis =
      static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(triangles.size()))));
  grid.count = {per_axis, per_axis};
  for (int k = 0; k < 2; ++k) grid.cell[k] = (high[k] - grid.low[k]) / per_axis;
  const auto for_cells = [&](std::uint32_t t, auto&& visit) {
    std::array<std::uint32_t, 2> from = {kNone, kNone};
    std::array<std::uint32_t, 2> to = {0, 0};
    for (const VertexId v : topology_.triangles[t]) {
      const Vec3 p = points_.nearest(v);
      const auto cell = cell_of(grid, p[axes[0]], p[axes[1]]);
      for (int k = 0; k < 2; ++k) {
        from[k] = std::min(from[k], cell[k]);
        to[k] = std::max(to[k], cell[k]);
      }
    }
    for (std::uint32_t y = from[1]; y <= to[1]; ++y) {
      for (std::uint32_t x = from[0]; x <= to[0]; ++x) visit(y * grid.count[0] + x);
    }
  };
  grid.begin.assign(std::size_t{per_axis} * per_axis + 1, 0);
  for (const std::uint32_t t : triangles) {
    for_cells(t, [&](std::uint32_t cell) { ++grid.begin[cell + 1]; });
  }
  for (std::size_t n = 1; n < grid.begin.size(); ++n) grid.begin[n] += grid.begin[n - 1];
  grid.triangles.resize(grid.begin.back());
  std::vector<std::uint32_t> fill(grid.begin.begin(), grid.begin.end() - 1);
  for (const std::uint32_t t : triangles) {
    for_cells(t, [&](std::uint32_t cell) { grid.triangles[fill[cell]++] = t; });
  }
}

double FacetLocator::inside_by(FacetId facet, std::uint32_t triangle, const Vec3& p) const {
  const auto axes = plane_axes(topology_.facet_axis[facet]);
  std::array<Vec3, 3> c;
  for (int k = 0; k < 3; ++k) c[k] = points_.nearest(topology_.triangles[triangle][k]);
  const auto area = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
    return (b[axes[0]] - a[axes[0]]) * (d[axes[1]] - a[axes[1]]) -
           (b[axes[1]] - a[axes[1]]) * (d[axes[0]] - a[axes[0]]);
  };
  const double whole = area(c[0], c[1], c[2]);
  if (whole == 0) return -HUGE_VAL;
  return std::min({area(p, c[1], c[2]), area(c[0], p, c[2]), area(c[0], c[1], p)},
                  [&](double a, double b) { return a / whole < b / whole; }) /
         whole;
}

std::uint32_t FacetLocator::triangle_at(FacetId facet, const Vec3& p) {
  const auto& triangles = topology_.facet_triangles[facet];
  std::uint32_t best = triangles[0];
  double best_by = -HUGE_VAL;
  const auto consider = [&](std::uint32_t t) {
    const double by = inside_by(facet, t, p);
    if (by > best_by) {
      best_by = by;
      best = t;
    }
  };
  if (triangles.size() > kBruteForce) {
    if (built_[facet] == 0) {
      build(facet);
      built_[facet] = 1;
    }
    const Grid& grid = grids_[facet];
    const auto axes = plane_axes(topology_.facet_axis[facet]);
    const auto cell = cell_of(grid, p[axes[0]], p[axes[1]]);
    const std::uint32_t c = cell[1] * grid.count[0] + cell[0];
    for (std::uint32_t n = grid.begin[c]; n < grid.begin[c + 1]; ++n) consider(grid.triangles[n]);
    if (best_by > -1e-6) return best;
  }
  for (const std::uint32_t t : triangles) consider(t);
  return best;
}

}  // namespace delmesher::surface
