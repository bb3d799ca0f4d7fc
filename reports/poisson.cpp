#include "reports/poisson.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "oracles/base/vectors.h"
#include "reports/mesh_quality.h"

namespace tetproof {
namespace {

using oracles::cross;
using oracles::dot;
using oracles::Index;
using oracles::minus;
using oracles::Position;
using oracles::Tet;

// u = sin(w . (p - p0)), for which - Laplace u = |w|^2 u.
class Solution {
 public:
  Solution(const std::vector<Position>& points, const std::vector<Tet>& tetrahedra) {
    Position low = points[tetrahedra[0][0]], high = low;
    for (const Tet& tet : tetrahedra) {
      for (const Index v : tet) {
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], points[v][axis]);
          high[axis] = std::max(high[axis], points[v][axis]);
        }
      }
    }
    const Position diagonal = minus(high, low);
    const double length = std::sqrt(dot(diagonal, diagonal));
    origin_ = low;
    for (int axis = 0; axis < 3; ++axis) wave_[axis] = (axis + 1) / length;
  }

  double value(const Position& p) const { return std::sin(dot(wave_, minus(p, origin_))); }
  double load(const Position& p) const { return dot(wave_, wave_) * value(p); }

 private:
  Position origin_{}, wave_{};
};

// Vertices of faces that only one tetrahedron has, or that none of them has.
std::vector<std::uint8_t> fixed_vertices(std::size_t vertices, const std::vector<Tet>& tetrahedra) {
  std::vector<std::array<Index, 3>> faces;
  faces.reserve(4 * tetrahedra.size());
  std::vector<std::uint8_t> fixed(vertices, 1);
  for (const Tet& tet : tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      std::array<Index, 3> face{tet[(i + 1) % 4], tet[(i + 2) % 4], tet[(i + 3) % 4]};
      std::sort(face.begin(), face.end());
      faces.push_back(face);
      fixed[tet[i]] = 0;
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool alone =
        (i == 0 || faces[i - 1] != faces[i]) && (i + 1 == faces.size() || faces[i + 1] != faces[i]);
    if (!alone) continue;
    for (const Index v : faces[i]) fixed[v] = 1;
  }
  return fixed;
}

// A symmetric matrix by rows.
class Matrix {
 public:
  // With an entry for each pair of vertices of a tetrahedron.
  Matrix(std::size_t vertices, const std::vector<Tet>& tetrahedra) : begin_(vertices + 1, 0) {
    std::vector<std::vector<Index>> rows(vertices);
    for (const Tet& tet : tetrahedra) {
      for (const Index v : tet) {
        for (const Index w : tet) {
          const auto at = std::lower_bound(rows[v].begin(), rows[v].end(), w);
          if (at == rows[v].end() || *at != w) rows[v].insert(at, w);
        }
      }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
      columns_.insert(columns_.end(), rows[v].begin(), rows[v].end());
      begin_[v + 1] = columns_.size();
    }
    values_.resize(columns_.size());
  }

  void add(Index row, Index column, double value) { values_[at(row, column)] += value; }
  double diagonal(Index row) const { return values_[at(row, row)]; }

  // result = A x, with nothing from and to the vertices that are fixed.
  void multiply(const std::vector<double>& x, const std::vector<std::uint8_t>& fixed,
                std::vector<double>& result) const {
    for (std::size_t row = 0; row + 1 < begin_.size(); ++row) {
      result[row] = 0;
      if (fixed[row] == 0) result[row] = product(row, x);
    }
  }

  double product(std::size_t row, const std::vector<double>& x) const {
    double sum = 0;
    for (std::size_t i = begin_[row]; i < begin_[row + 1]; ++i) sum += values_[i] * x[columns_[i]];
    return sum;
  }

 private:
  std::size_t at(Index row, Index column) const {
    const auto first = columns_.begin() + static_cast<std::ptrdiff_t>(begin_[row]);
    const auto last = columns_.begin() + static_cast<std::ptrdiff_t>(begin_[row + 1]);
    return static_cast<std::size_t>(std::lower_bound(first, last, column) - columns_.begin());
  }

  std::vector<std::size_t> begin_;
  std::vector<Index> columns_;
  std::vector<double> values_;
};

struct Problem {
  Matrix matrix;
  std::vector<double> load, volume;  // per vertex; a quarter of each tetrahedron's
};

Problem assemble(const std::vector<Position>& points, const std::vector<Tet>& tetrahedra,
                 const Solution& solution) {
  Problem problem{Matrix(points.size(), tetrahedra), std::vector<double>(points.size()),
                  std::vector<double>(points.size())};
  for (const Tet& t : tetrahedra) {
    // The gradients of the four linear functions are -n / (6 V), for doubled areas n outwards.
    const Position &a = points[t[0]], &b = points[t[1]], &c = points[t[2]], &d = points[t[3]];
    const Position n[4] = {cross(minus(c, b), minus(d, b)), cross(minus(d, a), minus(c, a)),
                           cross(minus(b, a), minus(d, a)), cross(minus(c, a), minus(b, a))};
    const double volume6 = std::fabs(dot(minus(b, a), n[1]));
    if (volume6 == 0) continue;
    double loads = 0;
    for (const Index v : t) loads += solution.load(points[v]);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) problem.matrix.add(t[i], t[j], dot(n[i], n[j]) / (6 * volume6));
      problem.load[t[i]] += volume6 / 120 * (loads + solution.load(points[t[i]]));
      problem.volume[t[i]] += volume6 / 24;
    }
  }
  return problem;
}

double inner(const std::vector<double>& u, const std::vector<double>& v) {
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * v[i];
  return sum;
}

// The tridiagonal matrix that conjugate gradients make on their way (Lanczos).
class Tridiagonal {
 public:
  // Adds one iteration: the length of its step, and the share of the previous direction that the
  // next direction takes.
  void add(double step, double share) {
    diagonal_.push_back(1 / step + (diagonal_.empty() ? 0 : share_ / step_));
    // Squares of what stands beside the diagonal.
    beside_.push_back(share / (step * step));
    step_ = step;
    share_ = share;
  }

  // The largest eigenvalue over the smallest one; 0 if there is none.
  double condition() const {
    if (diagonal_.empty()) return 0;
    double high = 0;
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      const double before = i == 0 ? 0 : std::sqrt(beside_[i - 1]);
      const double after = i + 1 == diagonal_.size() ? 0 : std::sqrt(beside_[i]);
      high = std::max(high, diagonal_[i] + before + after);
    }
    const double largest = eigenvalue(diagonal_.size() - 1, high);
    const double smallest = eigenvalue(0, high);
    return smallest > 0 ? largest / smallest : 0;
  }

 private:
  // How many eigenvalues are below x, by Sturm's sequence.
  std::size_t count_below(double x) const {
    constexpr double kTiny = 1e-300;
    std::size_t count = 0;
    double last = 1;
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      last = diagonal_[i] - x - (i == 0 ? 0 : beside_[i - 1] / last);
      if (last == 0) last = kTiny;
      count += last < 0;
    }
    return count;
  }

  // The one that `rank` others are below, by bisection of the logarithm; all are positive and at
  // most `high`.
  double eigenvalue(std::size_t rank, double high) const {
    double low = 1e-18 * high;
    for (int i = 0; i < 60; ++i) {
      const double middle = std::sqrt(low) * std::sqrt(high);
      (count_below(middle) > rank ? high : low) = middle;
    }
    return high;
  }

  std::vector<double> diagonal_, beside_;
  double step_ = 1, share_ = 0;
};

// Improves x on the vertices that are not fixed.
void conjugate_gradients(const Problem& problem, const std::vector<std::uint8_t>& fixed,
                         unsigned most_iterations, std::vector<double>& x, PoissonRun& run) {
  constexpr double kResidual = 1e-8;
  const std::size_t n = x.size();
  std::vector<double> residual(n), z(n), direction(n), product(n), inverse(n);
  for (std::size_t v = 0; v < n; ++v) {
    if (fixed[v] != 0) continue;
    residual[v] = problem.load[v] - problem.matrix.product(v, x);
    inverse[v] = 1 / problem.matrix.diagonal(static_cast<Index>(v));
    direction[v] = z[v] = inverse[v] * residual[v];
  }
  const double goal = kResidual * kResidual * inner(residual, residual);
  const auto most =
      static_cast<unsigned>(std::min<std::uint64_t>(10 * run.unknowns + 100, most_iterations));
  Tridiagonal seen;
  double rz = inner(residual, z);
  while (!(run.converged = inner(residual, residual) <= goal) && run.iterations < most) {
    ++run.iterations;
    problem.matrix.multiply(direction, fixed, product);
    const double step = rz / inner(direction, product);
    for (std::size_t v = 0; v < n; ++v) {
      x[v] += step * direction[v];
      residual[v] -= step * product[v];
      z[v] = inverse[v] * residual[v];
    }
    const double before = rz;
    rz = inner(residual, z);
    seen.add(step, rz / before);
    for (std::size_t v = 0; v < n; ++v) direction[v] = z[v] + rz / before * direction[v];
  }
  run.condition = seen.condition();
}

}  // namespace

PoissonRun solve_poisson(const oracles::MeshFile& mesh, unsigned most_iterations) {
  PoissonRun run;
  const std::vector<Tet> tetrahedra = inside_of(mesh);
  run.tetrahedra = tetrahedra.size();
  if (tetrahedra.empty()) return run;
  const std::vector<Position>& points = mesh.vertices;
  const Solution solution(points, tetrahedra);
  const std::vector<std::uint8_t> fixed = fixed_vertices(points.size(), tetrahedra);
  run.unknowns = static_cast<std::uint64_t>(std::count(fixed.begin(), fixed.end(), 0));
  const Problem problem = assemble(points, tetrahedra, solution);
  std::vector<double> x(points.size());
  for (std::size_t v = 0; v < x.size(); ++v) x[v] = fixed[v] != 0 ? solution.value(points[v]) : 0;
  conjugate_gradients(problem, fixed, most_iterations, x, run);
  double largest = 0, volume = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (problem.volume[v] == 0) continue;
    const double exact = solution.value(points[v]), error = std::fabs(x[v] - exact);
    run.largest_error = std::max(run.largest_error, error);
    run.mean_error += error * error * problem.volume[v];
    volume += problem.volume[v];
    largest = std::max(largest, std::fabs(exact));
  }
  run.largest_error /= largest;
  run.mean_error = std::sqrt(run.mean_error / volume) / largest;
  return run;
}

std::string to_json(const PoissonRun& run) {
  return fmt::format(
      "{{\"tetrahedra\": {}, \"unknowns\": {}, \"iterations\": {}, \"converged\": {}, "
      "\"per_root\": {:.4f}, \"condition\": {:.4e}, \"largest_error\": {:.3e}, \"mean_error\": "
      "{:.3e}}}",
      run.tetrahedra, run.unknowns, run.iterations, run.converged,
      run.unknowns == 0 ? 0 : run.iterations / std::cbrt(static_cast<double>(run.unknowns)),
      run.condition, run.largest_error, run.mean_error);
}

}  // namespace tetproof
