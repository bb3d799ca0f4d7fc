#include "oracles/surface/angle_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "oracles/base/union_find.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

enum class Bend : std::uint8_t { less, not_less, unknown };

// How triangles bend, compared with an angle.
class Bends {
 public:
  Bends(const Polyhedron& input, const ExactPoints& points, double degrees)
      : input_(input), points_(points) {
    constexpr double kKnown = 2e-15;
    const double cosine = std::cos(degrees * (3.14159265358979323846 / 180));
    low_ = std::max(cosine * cosine - kKnown, 0.0);
    high_ = cosine * cosine + kKnown;
    for (const auto& [of, square] : {std::pair(30, 0.75), {45, 0.5}, {60, 0.25}, {90, 0.0}}) {
      if (degrees == of) low_ = high_ = square;
    }
  }

  Bend at(Index s, Index t) const {
    const auto &p = input_.triangles[s], &q = input_.triangles[t];
    const IntervalVector m = exact::rough_area2(points_, p[0], p[1], p[2]),
                         n = exact::rough_area2(points_, q[0], q[1], q[2]);
    const Interval cosine = exact::dot(m, n);
    if (cosine.sign() == -1) return Bend::not_less;
    if (cosine.sign() == 1) {
      const Interval beyond = cosine * cosine - Interval(low_.get_d(), high_.get_d()) *
                                                    (exact::dot(m, m) * exact::dot(n, n));
      if (beyond.sign() == 1) return Bend::less;
      if (beyond.sign() == -1) return Bend::not_less;
    }
    return exactly(exact::area2(points_, p[0], p[1], p[2]),
                   exact::area2(points_, q[0], q[1], q[2]));
  }

 private:
  Bend exactly(const ExactVector& m, const ExactVector& n) const {
    const ExactNumber cosine = exact::dot(m, n);
    if (sgn(cosine) <= 0) return Bend::not_less;
    const ExactNumber square = cosine * cosine, norms = exact::dot(m, m) * exact::dot(n, n);
    const auto beyond = [&](const mpq_class& bound) {
      return square * ExactNumber(mpz_class(bound.get_den())) >
             ExactNumber(mpz_class(bound.get_num())) * norms;
    };
    if (beyond(high_)) return Bend::less;
    return beyond(low_) ? Bend::unknown : Bend::not_less;
  }

  const Polyhedron& input_;
  const ExactPoints& points_;
  mpq_class low_, high_;  // the squared cosine is between these
};

struct Side {
  Index low, high;  // ends
  Index triangle;
  bool forward;
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
  bool operator<(const Side& other) const {
    return std::pair(low, high) < std::pair(other.low, other.high);
  }
};

}  // namespace

std::string label_by_angle(Polyhedron& input, double degrees) {
  if (std::ranges::adjacent_find(input.labels, std::ranges::not_equal_to()) != input.labels.end()) {
    return "it has labels, and --label-by-angle is for surfaces without";
  }
  ExactPoints points;
  if (std::string why = points.assign(input.vertices); !why.empty()) return why;
  std::vector<Side> sides;
  sides.reserve(3 * input.triangles.size());
  for (Index t = 0; t < input.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = input.triangles[t][k], b = input.triangles[t][(k + 1) % 3];
      if (a >= input.vertices.size()) return "a triangle names a vertex that is not there";
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::sort(sides.begin(), sides.end());
  const Bends bends(input, points, degrees);
  UnionFind faces(input.triangles.size());
  std::vector<std::pair<Index, Index>> unknown;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].same_edge(sides[first])) ++last;
    const Side &s = sides[first], &t = sides[last - 1];
    if (last - first != 2 || s.forward == t.forward || s.low == s.high) continue;
    const Bend bend = bends.at(s.triangle, t.triangle);
    if (bend == Bend::less) faces.unite(s.triangle, t.triangle);
    if (bend == Bend::unknown) unknown.emplace_back(s.triangle, t.triangle);
  }
  for (const auto& [s, t] : unknown) {
    if (faces.find(s) == faces.find(t)) continue;
    return "triangles " + std::to_string(s) + " and " + std::to_string(t) +
           " bend by the angle of --label-by-angle, as far as doubles can tell";
  }
  input.labels.assign(input.triangles.size(), 0);
  input.names.clear();
  input.names_read = true;
  std::int32_t last = 0;
  for (Index t = 0; t < input.triangles.size(); ++t) {
    const Index first = faces.find(t);
    input.labels[t] = first == t ? ++last : input.labels[first];
  }
  for (std::int32_t label = 1; label <= last; ++label) {
    input.names[{2, label}] = "face_" + std::to_string(label);
  }
  return {};
}

}  // namespace tetproof::oracles
