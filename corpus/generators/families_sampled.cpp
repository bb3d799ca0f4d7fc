// Families of surfaces where a function sampled on a grid is zero, as images and implicit models
// give them: many triangles, nearly all of them small, some needles where a value is nearly zero.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "corpus/generators/families.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using namespace shapes;

// Negative inside; the argument has coordinates from 0 to 1.
using Function = std::function<double(const Point&)>;

double squared_distance(const Point& p, const Point& q) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
  return sum;
}

Function metaballs(Random& r) {
  std::vector<std::pair<Point, double>> balls;  // centre, squared radius
  for (int i = r.integer(2, 9); i > 0; --i) {
    const double radius = r.between(0.06, 0.16);
    balls.push_back(
        {{r.between(0.25, 0.75), r.between(0.25, 0.75), r.between(0.25, 0.75)}, radius * radius});
  }
  return [balls](const Point& p) {
    double sum = 0;
    for (const auto& [centre, square] : balls) sum += square / (squared_distance(p, centre) + 1e-6);
    return 1 - sum;
  };
}

// Like a sine of so many turns, made of parabolas.
double wave(double turns) {
  const double part = turns - std::floor(turns);
  return part < 0.5 ? 16 * part * (0.5 - part) : -16 * (part - 0.5) * (1 - part);
}

// A thin wall along a gyroid, cut off by a ball.
Function gyroid_shell(Random& r) {
  const double periods = r.between(1.5, 3), half = r.between(0.15, 0.5);
  return [periods, half](const Point& p) {
    const auto term = [&](std::size_t i, std::size_t j) {
      return wave(periods * p[i]) * wave(periods * p[j] + 0.25);
    };
    const double wall = std::fabs(term(0, 1) + term(1, 2) + term(2, 0)) - half;
    return std::max(wall, 8 * (squared_distance(p, {0.5, 0.5, 0.5}) - 0.19));
  };
}

Function ball(Random& r) {
  const Point centre = {r.between(0.4, 0.6), r.between(0.4, 0.6), r.between(0.4, 0.6)};
  const double square = r.between(0.04, 0.1);
  return [=](const Point& p) { return squared_distance(p, centre) - square; };
}

// Values at the (n + 1)^3 points of a grid, positive at its border.
class Samples {
 public:
  explicit Samples(int cells) : side_(static_cast<std::size_t>(cells) + 1) {
    values_.resize(side_ * side_ * side_);
  }

  std::size_t side() const { return side_; }
  double& at(std::size_t x, std::size_t y, std::size_t z) {
    return values_[(z * side_ + y) * side_ + x];
  }
  double at(const std::array<std::size_t, 3>& p) { return at(p[0], p[1], p[2]); }

  bool on_border(std::size_t x, std::size_t y, std::size_t z) const {
    return std::min({x, y, z}) == 0 || std::max({x, y, z}) + 1 == side_;
  }

 private:
  std::size_t side_;
  std::vector<double> values_;
};

Samples sampled(FamilyMember& m, int cells) {
  Random& r = m.random;
  const int kind = r.integer(0, 2);
  const Function function = kind == 0 ? metaballs(r) : kind == 1 ? gyroid_shell(r) : ball(r);
  const double noise = r.chance(0.5) ? 0 : r.between(0.001, 0.02);
  const double nearly_zero = r.chance(0.5) ? 0 : r.between(0.001, 0.05);  // share of the points
  Samples samples(cells);
  for (std::size_t z = 0; z < samples.side(); ++z) {
    for (std::size_t y = 0; y < samples.side(); ++y) {
      for (std::size_t x = 0; x < samples.side(); ++x) {
        double& value = samples.at(x, y, z);
        value = function({static_cast<double>(x) / cells, static_cast<double>(y) / cells,
                          static_cast<double>(z) / cells});
        if (noise > 0) value += r.between(-noise, noise);
        if (nearly_zero > 0 && std::fabs(value) < 0.05 && r.chance(nearly_zero)) {
          value = r.sign() * r.tiny(m.bits);
        }
        if (value == 0) value = 0x1p-20;
        if (samples.on_border(x, y, z)) value = std::fabs(value) + 0.01;
      }
    }
  }
  return samples;
}

// Marching tetrahedra: each cell is six tetrahedra along its diagonal, the same way in all cells,
// so that the surface is a closed manifold, whatever the values. Units are cells.
class March {
 public:
  explicit March(Samples& samples) : samples_(samples) {}

  Surface surface() {
    constexpr std::size_t kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                         {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const std::size_t cells = samples_.side() - 1;
    for (std::size_t z = 0; z < cells; ++z) {
      for (std::size_t y = 0; y < cells; ++y) {
        for (std::size_t x = 0; x < cells; ++x) {
          for (const auto& axes : kAxes) {
            std::array<Corner, 4> corners;
            corners[0] = {x, y, z};
            for (std::size_t i = 0; i < 3; ++i) {
              corners[i + 1] = corners[i];
              ++corners[i + 1][axes[i]];
            }
            cut(corners);
          }
        }
      }
    }
    return std::move(surface_);
  }

 private:
  using Corner = std::array<std::size_t, 3>;

  void cut(const std::array<Corner, 4>& corners) {
    std::vector<Corner> inside, outside;
    for (const Corner& c : corners) (samples_.at(c) < 0 ? inside : outside).push_back(c);
    if (inside.size() == 1) {
      add({{{inside[0], outside[0]}, {inside[0], outside[1]}, {inside[0], outside[2]}}});
    } else if (outside.size() == 1) {
      add({{{inside[0], outside[0]}, {inside[1], outside[0]}, {inside[2], outside[0]}}});
    } else if (inside.size() == 2) {
      add({{{inside[0], outside[0]}, {inside[0], outside[1]}, {inside[1], outside[1]}}});
      add({{{inside[0], outside[0]}, {inside[1], outside[1]}, {inside[1], outside[0]}}});
    }
  }

  using Side = std::array<Corner, 2>;  // inside, outside

  // Turned so that the corner inside of its first side is behind it, as the middles of the sides
  // tell: twice their coordinates are small integers.
  void add(const std::array<Side, 3>& sides) {
    std::int64_t rows[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        rows[i][c] = static_cast<std::int64_t>(sides[i][0][c] + sides[i][1][c]) -
                     2 * static_cast<std::int64_t>(sides[0][0][c]);
      }
    }
    const std::int64_t volume = rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
                                rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
                                rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
    std::array<std::uint32_t, 3> triangle = {vertex(sides[0]), vertex(sides[1]), vertex(sides[2])};
    if (volume < 0) std::swap(triangle[1], triangle[2]);
    surface_.triangles.push_back(triangle);
  }

  std::uint32_t vertex(const Side& side) {
    const auto place = [&](const Corner& c) {
      return (c[2] * samples_.side() + c[1]) * samples_.side() + c[0];
    };
    const std::size_t one = place(side[0]), other = place(side[1]);
    // The lower end, and which of seven directions.
    std::size_t direction = 0;
    for (std::size_t c = 0; c < 3; ++c) direction = 2 * direction + (side[0][c] != side[1][c]);
    const std::uint64_t key = 8 * static_cast<std::uint64_t>(std::min(one, other)) + direction;
    const auto [found, fresh] =
        number_.try_emplace(key, static_cast<std::uint32_t>(surface_.vertices.size()));
    if (fresh) {
      const double inside = samples_.at(side[0]), outside = samples_.at(side[1]);
      Point p, q;
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] = static_cast<double>(side[0][c]);
        q[c] = static_cast<double>(side[1][c]);
      }
      surface_.vertices.push_back(mix(p, q, inside / (inside - outside)));
    }
    return found->second;
  }

  Samples& samples_;
  Surface surface_;
  std::unordered_map<std::uint64_t, std::uint32_t> number_;
};

Surface isosurface(FamilyMember& m) {
  Samples samples = sampled(m, m.random.integer(8, 20));
  return March(samples).surface();
}

// Evenly in the exponent.
Surface large_isosurface(FamilyMember& m) {
  const double octaves = m.random.between(0, 2.2);
  const int whole = static_cast<int>(octaves);
  const int cells = static_cast<int>(std::ldexp(32 * (1 + octaves - whole), whole));
  Samples samples = sampled(m, cells);
  return March(samples).surface();
}

}  // namespace

const std::vector<Family>& sampled_families() {
  static const std::vector<Family> all = {
      {"isosurface", "zeros of functions on grids, some values nearly zero or noisy", isosurface},
      {"large_isosurface", "the same with ten thousand to a million triangles", large_isosurface}};
  return all;
}

}  // namespace tetproof
