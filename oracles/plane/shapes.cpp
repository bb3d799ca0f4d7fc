#include "oracles/plane/shapes.h"

#include <cmath>

namespace tetproof::shapes {
namespace {

using Corner = std::array<double, 2>;
constexpr double kPi = 3.14159265358979323846;

// The same numbers everywhere, unlike the distributions of the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ULL + 0x1234567ULL) {}
  std::uint64_t bits() {  // splitmix64
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::uint64_t state_;
};

void add_ring(PlanarGraph& graph, const std::vector<Corner>& corners) {
  const auto first = static_cast<std::uint32_t>(graph.vertices.size());
  const auto n = static_cast<std::uint32_t>(corners.size());
  graph.vertices.insert(graph.vertices.end(), corners.begin(), corners.end());
  for (std::uint32_t i = 0; i < n; ++i) {
    graph.segments.push_back({first + i, first + (i + 1 < n ? i + 1 : 0)});
  }
}

void add_segment(PlanarGraph& graph, const Corner& a, const Corner& b) {
  const auto first = static_cast<std::uint32_t>(graph.vertices.size());
  graph.vertices.push_back(a);
  graph.vertices.push_back(b);
  graph.segments.push_back({first, first + 1});
}

std::vector<Corner> square_corners(double half) {
  return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
}

}  // namespace

PlanarGraph polygon(const std::vector<Corner>& corners) {
  PlanarGraph graph;
  graph.insideness = delmesher::Insideness::nested;
  add_ring(graph, corners);
  return graph;
}

PlanarGraph square() {
  return polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}

PlanarGraph needle(double angle) {
  return polygon({{0, 0}, {1, 0}, {std::cos(angle), std::sin(angle)}});
}

PlanarGraph star(int n, double ratio) {
  std::vector<Corner> corners;
  for (int i = 0; i < 2 * n; ++i) {
    const double r = i % 2 == 0 ? 1 : ratio, a = kPi * i / n;
    corners.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return polygon(corners);
}

PlanarGraph comb(int n, double width) {
  std::vector<Corner> corners = {{0, -0.5}, {2 * n * width, -0.5}};
  for (int i = n - 1; i >= 0; --i) {
    const double x = 2 * i * width;
    if (i + 1 < n) {
      corners.push_back({x + 2 * width, 0});
    } else {
      corners.push_back({x + 2 * width, 0});
    }
    corners.push_back({x + 1.5 * width, 1});
    corners.push_back({x + 0.5 * width, 1});
  }
  corners.push_back({0, 0});
  return polygon(corners);
}

PlanarGraph koch(int level) {
  std::vector<Corner> corners = {{0, 0}, {0.5, std::sqrt(0.75)}, {1, 0}};
  for (int k = 0; k < level; ++k) {
    std::vector<Corner> finer;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Corner &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const double x = (b[0] - a[0]) / 3, y = (b[1] - a[1]) / 3;
      const double h = std::sqrt(0.75);
      finer.push_back(a);
      finer.push_back({a[0] + x, a[1] + y});
      finer.push_back({a[0] + 1.5 * x - h * y, a[1] + 1.5 * y + h * x});
      finer.push_back({a[0] + 2 * x, a[1] + 2 * y});
    }
    corners = std::move(finer);
  }
  return polygon(corners);
}

PlanarGraph rough_circle(int n, double noise, std::uint64_t seed) {
  Random random(seed);
  std::vector<Corner> corners;
  for (int i = 0; i < n; ++i) {
    const double r = 1 + noise * random.uniform(0, 1), a = 2 * kPi * i / n;
    corners.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return polygon(corners);
}

PlanarGraph fan(int n, double angle) {
  PlanarGraph graph;
  add_ring(graph, square_corners(1.5));
  graph.vertices.push_back({-0.5, -0.25});
  for (int i = 0; i < n; ++i) {
    const double a = 0.3 + angle * i;
    graph.segments.push_back({4, static_cast<std::uint32_t>(graph.vertices.size())});
    graph.vertices.push_back({-0.5 + std::cos(a), -0.25 + std::sin(a)});
  }
  return graph;
}

PlanarGraph nested_squares(int n) {
  PlanarGraph graph;
  graph.insideness = delmesher::Insideness::nested;
  for (int i = 0; i < n; ++i) add_ring(graph, square_corners(std::pow(0.7, i)));
  return graph;
}

PlanarGraph archipelago(int n, int islands, std::uint64_t seed) {
  Random random(seed);
  PlanarGraph graph;
  graph.insideness = delmesher::Insideness::nested;
  // A radius made of waves of falling amplitude, like a coast.
  std::vector<double> phase(24), height(24);
  for (std::size_t k = 0; k < phase.size(); ++k) {
    phase[k] = random.uniform(0, 2 * kPi);
    height[k] = random.uniform(0.2, 1) * 0.12 / std::pow(1.45, static_cast<double>(k));
  }
  std::vector<Corner> ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * kPi * i / n;
    double r = 1;
    for (std::size_t k = 0; k < phase.size(); ++k) {
      r += height[k] * std::sin(std::pow(1.6, static_cast<double>(k)) * 3 * a + phase[k]) *
           std::sin(a / 2);
    }
    ring.push_back({r * std::cos(a), r * std::sin(a)});
  }
  add_ring(graph, ring);
  // Rows of islands off the coast.
  const int row = std::max(1, static_cast<int>(std::sqrt(islands)));
  for (int i = 0; i < islands; ++i) {
    const double x = 2.2 + 0.1 * (i / row), y = -1 + 0.1 * (i % row);
    std::vector<Corner> corners;
    const int m = random.integer(4, 14);
    for (int k = 0; k < m; ++k) {
      const double r = random.uniform(0.008, 0.045), a = 2 * kPi * k / m;
      corners.push_back({x + r * std::cos(a), y + r * std::sin(a)});
    }
    add_ring(graph, corners);
  }
  return graph;
}

PlanarGraph figure() {
  // Lobes with tips of a few degrees around a body, and a slit hole.
  std::vector<Corner> ring;
  const int lobes = 7;
  for (int i = 0; i < lobes; ++i) {
    const double a = 2 * kPi * i / lobes;
    const double tip = 1.1 + 0.25 * std::cos(3 * a);
    ring.push_back({0.42 * std::cos(a - 0.30), 0.42 * std::sin(a - 0.30)});
    ring.push_back({0.60 * std::cos(a - 0.10), 0.60 * std::sin(a - 0.10)});
    ring.push_back({tip * std::cos(a), tip * std::sin(a)});
    ring.push_back({0.62 * std::cos(a + 0.12), 0.62 * std::sin(a + 0.12)});
  }
  PlanarGraph graph = polygon(ring);
  add_ring(graph, {{-0.22, -0.02}, {0.25, 0.03}, {-0.05, 0.12}});
  return graph;
}

PlanarGraph moved(PlanarGraph graph, double angle, double scale, double x, double y) {
  const double c = std::cos(angle) * scale, s = std::sin(angle) * scale;
  for (Corner& p : graph.vertices) p = {c * p[0] - s * p[1] + x, s * p[0] + c * p[1] + y};
  for (Corner& p : graph.holes) p = {c * p[0] - s * p[1] + x, s * p[0] + c * p[1] + y};
  return graph;
}

Named tiny_angles(std::uint64_t seed) {
  Random random(seed);
  Named result;
  const double tiny = random.log_uniform(1e-12, 0.3);
  const int kind = static_cast<int>(seed % 8);
  switch (kind) {
    case 0:
      result = {"needle", needle(tiny)};
      break;
    case 1:
      result = {"star", star(random.integer(3, 12), random.log_uniform(1e-6, 0.3))};
      break;
    case 2:
      result = {"fan", fan(random.integer(2, 12), random.log_uniform(1e-12, 0.05))};
      break;
    case 3:
      result = {"comb", comb(random.integer(2, 12), random.log_uniform(1e-9, 0.2))};
      break;
    case 4: {  // a slit cut into a square, closing to a tiny angle
      const double w = random.log_uniform(1e-12, 0.2);
      result = {"slit",
                polygon({{0, 0}, {1, 0}, {1, 0.5 - w}, {0.3, 0.5}, {1, 0.5 + w}, {1, 1}, {0, 1}})};
      break;
    }
    case 5: {  // a loose end just before a side, and another just beside a corner
      PlanarGraph graph = square();
      graph.insideness = delmesher::Insideness::enclosed;
      const double gap = random.log_uniform(1e-13, 0.1);
      add_segment(graph, {0.25, 0.25}, {0.6, 1 - gap});
      add_segment(graph, {0.8, 0.3}, {1 - gap, gap});
      result = {"loose ends", graph};
      break;
    }
    case 6: {  // a needle in a needle
      const double outer = random.log_uniform(1e-8, 0.3);
      PlanarGraph graph = needle(outer);
      add_ring(graph, {{0.3, 0.3 * std::tan(outer / 3)},
                       {0.9, 0.9 * std::tan(outer / 3)},
                       {0.9, 0.9 * std::tan(outer * 2 / 3)}});
      result = {"needle in needle", graph};
      break;
    }
    default:
      result = {"rough circle",
                rough_circle(random.integer(5, 60), random.log_uniform(1e-3, 20), random.bits())};
      break;
  }
  const double scale = std::ldexp(1.0, random.integer(-60, 60));
  const double far = random.integer(0, 2) == 0 ? scale * random.uniform(-100, 100) : 0;
  // A shape of tiny features far from the origin may be spoilt by rounding: only some are moved.
  const bool robust = kind == 0 || kind == 1 || kind == 7;
  result.graph = moved(std::move(result.graph), robust ? random.uniform(0, 6) : 0, scale,
                       robust ? far : 0, robust ? far / 3 : 0);
  return result;
}

}  // namespace tetproof::shapes
