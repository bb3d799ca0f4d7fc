#include "corpus/union/soup.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "oracles/base/union_find.h"

namespace tetproof::unite {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using oracles::UnionFind;

Kernel::Point_3 point(const Position& p) {
  return {p[0], p[1], p[2]};
}

bool is_degenerate(const Soup& soup, const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ||
         CGAL::collinear(point(soup.vertices[t[0]]), point(soup.vertices[t[1]]),
                         point(soup.vertices[t[2]]));
}

// For each vertex of a corner the first one at its place; kNone for the others.
std::vector<Index> representatives(const delmesher::Surface& surface) {
  std::vector<Index> first(surface.vertices.size(), kNone);
  for (const auto& t : surface.triangles) {
    for (const Index v : t) first[v] = v;
  }
  std::vector<Index> order(first);
  std::erase(order, kNone);
  const auto at = [&](Index v) -> const Position& { return surface.vertices[v]; };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::tie(at(a), a) < std::tie(at(b), b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (at(order[i]) == at(order[i - 1])) first[order[i]] = first[order[i - 1]];
  }
  return first;
}

void drop_unused_vertices(Soup& soup) {
  std::vector<Index> number(soup.vertices.size(), kNone);
  for (const Triangle& t : soup.triangles) {
    for (const Index v : t) number[v] = 0;
  }
  Index kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    soup.vertices[kept] = soup.vertices[v];
    number[v] = kept++;
  }
  soup.vertices.resize(kept);
  for (Triangle& t : soup.triangles) {
    for (Index& v : t) v = number[v];
  }
}

}  // namespace

std::string defect_of_lists(const delmesher::Surface& surface) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const Index v : surface.triangles[t]) {
      if (v >= surface.vertices.size()) {
        return "triangle " + std::to_string(t) + " refers to no vertex";
      }
      for (const double x : surface.vertices[v]) {
        if (!std::isfinite(x)) return "vertex " + std::to_string(v) + " is not finite";
      }
    }
  }
  return {};
}

Soup soup_of(const delmesher::Surface& surface) {
  Soup soup;
  const std::vector<Index> first = representatives(surface);
  soup.vertices = surface.vertices;
  for (std::size_t v = 0; v < first.size(); ++v) {
    soup.welded += first[v] != kNone && first[v] != v ? 1 : 0;
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Triangle corners = {first[a], first[b], first[c]};
    if (is_degenerate(soup, corners)) {
      ++soup.degenerate;
      continue;
    }
    soup.triangles.push_back(corners);
    soup.labels.push_back(surface.labels.empty() ? 0 : surface.labels[t]);
  }
  drop_unused_vertices(soup);
  return soup;
}

delmesher::Surface surface_of(const Soup& soup) {
  return {soup.vertices, soup.triangles, soup.labels};
}

double volume(const Soup& soup) {
  if (soup.triangles.empty()) return 0;
  const Position origin = soup.vertices[soup.triangles[0][0]];
  long double sum = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    std::array<std::array<long double, 3>, 3> x;
    std::size_t row = 0;
    for (const Index v : {a, b, c}) {
      for (std::size_t k = 0; k < 3; ++k) {
        x[row][k] = static_cast<long double>(soup.vertices[v][k]) - origin[k];
      }
      ++row;
    }
    sum += x[0][0] * (x[1][1] * x[2][2] - x[1][2] * x[2][1]) +
           x[0][1] * (x[1][2] * x[2][0] - x[1][0] * x[2][2]) +
           x[0][2] * (x[1][0] * x[2][1] - x[1][1] * x[2][0]);
  }
  return static_cast<double>(sum / 6);
}

double largest_coordinate(const Soup& soup) {
  double largest = 0;
  for (const Position& p : soup.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return largest;
}

double diagonal(const Soup& soup) {
  Position low = soup.vertices.front(), high = low;
  for (const Position& p : soup.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

Edges::Edges(std::span<const Triangle> triangles) {
  uses_.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      uses_.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), a < b});
    }
  }
  std::sort(uses_.begin(), uses_.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
}

std::uint64_t count_bodies(std::span<const Triangle> triangles) {
  UnionFind sets(triangles.size());
  std::uint64_t count = triangles.size();
  Edges(triangles).for_each([&](std::span<const EdgeUse> uses) {
    for (const EdgeUse& use : uses) {
      if (sets.unite(uses[0].triangle, use.triangle)) --count;
    }
  });
  return count;
}

// Corners of triangles are connected where the triangles share an edge at the vertex. A vertex that
// has several sets of them, and no edge of more than two triangles, is one where parts touch.
Touching find_touching(std::span<const Triangle> triangles) {
  Touching result;
  Index vertices = 0;
  for (const Triangle& t : triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  std::vector<bool> excused(vertices, false);
  UnionFind corners(3 * triangles.size());
  const auto corner = [&](Index t, Index v) {
    const auto at = std::find(triangles[t].begin(), triangles[t].end(), v);
    return static_cast<Index>(3 * t + (at - triangles[t].begin()));
  };
  Edges(triangles).for_each([&](std::span<const EdgeUse> uses) {
    for (const Index v : {uses[0].low, uses[0].high}) {
      if (uses.size() > 2) excused[v] = true;
      for (const EdgeUse& use : uses)
        corners.unite(corner(uses[0].triangle, v), corner(use.triangle, v));
    }
    if (uses.size() <= 2) return;
    if (result.edges++ == 0) result.place = uses[0].low;
  });
  std::vector<Index> fan(vertices, kNone);
  for (Index c = 0; c < corners.size(); ++c) {
    const Index v = triangles[c / 3][c % 3];
    if (excused[v]) continue;
    if (fan[v] == kNone) fan[v] = corners.find(c);
    if (fan[v] == corners.find(c)) continue;
    excused[v] = true;
    if (result.vertices++ == 0 && result.edges == 0) result.place = v;
  }
  return result;
}

}  // namespace tetproof::unite
