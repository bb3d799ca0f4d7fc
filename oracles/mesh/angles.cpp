#include "oracles/mesh/angles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracles/base/vectors.h"
#include "oracles/mesh/shapes.h"

namespace tetproof::oracles {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr int kBins = 12;

// A tetrahedron in doubles. Each edge and normal is computed once for all of its angles, which
// takes a fraction of the time that intervals take angle by angle.
//
// Edges have components of at most h, with an error of at most e = h u + E, where E is that of a
// close difference of points. As in ball_side.cpp, for a polynomial of degree d whose monomials
// add up to m h^d, rounding costs less than 16 m h^d u and the error of the edges less than d m
// h^(d-1) e. All bounds are taken twice or more.
class RoughTet {
 public:
  // Sine and cosine up to a common positive factor, with an error of at most `error` each.
  struct Angle {
    double sine, cosine, error;
    bool certain() const { return error <= 1e-9 * sine; }
    double degrees() const { return std::atan2(sine, cosine) * kDegrees; }
  };

  RoughTet(const ExactPoints& points, const Tet& tet) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        const Position u = points.close_difference(tet[j], tet[i]);
        edges_[j][i] = u;
        edges_[i][j] = {-u[0], -u[1], -u[2]};
        for (const double x : u) size_ = std::max(size_, std::fabs(x));
      }
    }
    error_ = size_ * 0x1p-53 + points.close_error();
    // Else something could over- or underflow.
    if (!(size_ > 0x1p-100 && size_ < 0x1p100)) error_ = std::numeric_limits<double>::infinity();
  }

  // Are all face angles certainly not below the one whose squared cosine this is? Each of them has
  // c2 |u|^2 |v|^2 > (u . v)^2, of degree 4 with m = 18, or u . v < 0, of degree 2 with m = 3.
  bool no_face_angle_below(double squared_cosine) const {
    const double error2 = 120 * size_ * error_, error4 = 800 * size_ * size_ * size_ * error_;
    for (int a = 0; a < 4; ++a) {
      double squares[4];
      for (int b = 0; b < 4; ++b) squares[b] = dot(edges_[a][b], edges_[a][b]);
      for (int b = 0; b < 4; ++b) {
        for (int c = 0; c < b; ++c) {
          if (a == b || a == c) continue;
          const double uv = dot(edges_[a][b], edges_[a][c]);
          if (uv < -error2) continue;
          if (!(squares[b] * squares[c] * squared_cosine - uv * uv > error4)) return false;
        }
      }
    }
    return true;
  }

  // Twice the areas, as vectors, are of degree 2 with m = 2 for each component.
  void find_normals() {
    for (int i = 0; i < 4; ++i) {
      const auto& [a, b, c] = kFaces[i];
      normals_[i] = cross(edges_[a][b], edges_[a][c]);
    }
    volume6_ = std::fabs(dot(edges_[0][3], normals_[3]));
  }

  // At corner k of face i, as face_of has them.
  Angle face_angle(int i, int k) const {
    const int a = kFaces[i][k], b = kFaces[i][(k + 1) % 3], c = kFaces[i][(k + 2) % 3];
    return {std::sqrt(dot(normals_[i], normals_[i])), dot(edges_[a][b], edges_[a][c]),
            300 * size_ * error_};
  }

  // At edge ab, opposite to edge cd: |m x n| = |ab| |det|, of degrees 1 and 3, for the normals m
  // and n of the faces opposite to c and d, and m . n is of degree 4 with m = 12.
  Angle dihedral_angle(int a, int b, int c, int d) const {
    return {volume6_ * std::sqrt(dot(edges_[a][b], edges_[a][b])), -dot(normals_[c], normals_[d]),
            1000 * size_ * size_ * size_ * error_};
  }

 private:
  // As face_of: counter-clockwise seen from outside.
  static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

  Position edges_[4][4] = {}, normals_[4] = {};
  double size_ = 0, error_ = 0, volume6_ = 0;
};

// Certifies that angles are not below a bound: cos^2 <= c2 for acute ones.
class SmallestAngle {
 public:
  explicit SmallestAngle(double degrees) {
    const double cosine = std::cos(degrees / kDegrees);
    bound_ = cosine * cosine * (1 + 1e-9);
    exact_bound_ = bound_;
  }

  double squared_cosine() const { return bound_; }

  // Is the angle of the triangle at `apex` below the bound?
  bool below(const ExactPoints& points, Index apex, Index b, Index c) const {
    const IntervalVector p = points.rough_difference(apex, b), q = points.rough_difference(apex, c);
    Interval uv(0), uu(0), vv(0);
    for (int axis = 0; axis < 3; ++axis) {
      const Interval u = p[axis], v = q[axis];
      uv = uv + u * v;
      uu = uu + u * u;
      vv = vv + v * v;
    }
    if (uv.sign() == -1) return false;
    if (uv.sign() == 1) {
      const int sign = (uu * vv * Interval(bound_) - uv * uv).sign();
      if (sign != 2) return sign < 0;
    }
    return below_exactly(points, apex, b, c);
  }

 private:
  bool below_exactly(const ExactPoints& points, Index apex, Index b, Index c) const {
    const ExactVector u = exact::difference(points, apex, b);
    const ExactVector v = exact::difference(points, apex, c);
    const ExactNumber uv = exact::dot(u, v);
    if (uv <= 0) return exact::is_zero(u) || exact::is_zero(v);
    const ExactNumber product = exact::dot(u, u) * exact::dot(v, v);
    return (uv * uv).rational() > product.rational() * exact_bound_;
  }

  double bound_;
  mpq_class exact_bound_;
};

// The first angle below the bound, as face and corner; false if there is none.
bool find_small_angle(const ExactPoints& points, const Tet& tet, const SmallestAngle& bound,
                      Face& corner_first) {
  if (RoughTet(points, tet).no_face_angle_below(bound.squared_cosine())) return false;
  for (int i = 0; i < 4; ++i) {
    const Face face = face_of(tet, i);
    for (int corner = 0; corner < 3; ++corner) {
      const Index a = face[corner], b = face[(corner + 1) % 3], c = face[(corner + 2) % 3];
      if (bound.below(points, a, b, c)) {
        corner_first = {a, b, c};
        return true;
      }
    }
  }
  return false;
}

// Cosine and squared sine up to positive factors, and the product of the squared norms that
// belongs to the cosine.
template <class Number>
struct Parts {
  Number cosine, sine_squared, norms;
};

template <class Number>
Number dot(const std::array<Number, 3>& u, const std::array<Number, 3>& v) {
  return Number(u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
}

template <class Number>
std::array<Number, 3> cross(const std::array<Number, 3>& u, const std::array<Number, 3>& v) {
  return {Number(u[1] * v[2] - u[2] * v[1]), Number(u[2] * v[0] - u[0] * v[2]),
          Number(u[0] * v[1] - u[1] * v[0])};
}

template <class Number>
Parts<Number> between(const std::array<Number, 3>& u, const std::array<Number, 3>& v) {
  const std::array<Number, 3> n = cross(u, v);
  return {dot(u, v), dot(n, n), Number(dot(u, u) * dot(v, v))};
}

IntervalVector rough(const ExactPoints& points, Index from, Index to) {
  return points.rough_difference(from, to);
}

// The angle at `apex` between the directions to b and c.
struct FaceAngle {
  Index apex, b, c;
  Parts<Interval> roughly(const ExactPoints& points) const {
    return between(rough(points, apex, b), rough(points, apex, c));
  }
  Parts<ExactNumber> exactly(const ExactPoints& points) const {
    return between(exact::difference(points, apex, b), exact::difference(points, apex, c));
  }
};

// The angle at edge ab between the half-planes of c and d: that of ab x ac and ab x ad.
struct DihedralAngle {
  Index a, b, c, d;
  Parts<Interval> roughly(const ExactPoints& points) const {
    return parts<Interval>(rough(points, a, b), rough(points, a, c), rough(points, a, d));
  }
  Parts<ExactNumber> exactly(const ExactPoints& points) const {
    return parts<ExactNumber>(exact::difference(points, a, b), exact::difference(points, a, c),
                              exact::difference(points, a, d));
  }

 private:
  // |(u x v) x (u x w)| = |u| |det(u, v, w)|.
  template <class Number>
  static Parts<Number> parts(const std::array<Number, 3>& u, const std::array<Number, 3>& v,
                             const std::array<Number, 3>& w) {
    const std::array<Number, 3> m = cross(u, v), n = cross(u, w);
    const Number volume = dot(m, w);
    return {dot(m, n), Number(Number(volume * volume) * dot(u, u)), Number(dot(m, m) * dot(n, n))};
  }
};

bool narrow(const Interval& x, double scale) {
  return x.high - x.low <= 1e-10 * scale;
}

// Extremes, mean and histogram of one kind of angle.
class Distribution {
 public:
  explicit Distribution(const ExactPoints& points) : points_(points) {}

  // Counts an angle and returns it in degrees, to a relative 1e-9, also near 0 and 180 degrees.
  // Doubles first, then intervals, then exact numbers.
  template <class Angle>
  double add(const RoughTet::Angle& guess, const Angle& angle) {
    double degrees = 0;
    int bin = -1;
    bool known = guess.certain();
    if (known) {
      degrees = guess.degrees();
    } else {
      known = roughly(angle, degrees);
    }
    if (known) {
      const double bins = degrees / 15;
      if (std::fabs(bins - std::round(bins)) > 1e-6) bin = static_cast<int>(bins);
    } else {
      const Parts<ExactNumber> e = angle.exactly(points_);
      degrees = exact_angle(e.sine_squared, e.cosine);
    }
    if (bin < 0) {
      const Parts<ExactNumber> e = angle.exactly(points_);
      bin = angle_bin(e.cosine, e.norms);
    }
    ++histogram[bin];
    if (degrees < smallest || degrees > largest) widen(angle);
    return degrees;
  }

  // The smallest and the largest of several angles, which are all counted. Doubles tell which these
  // are, and the bins of the others, by their cotangents.
  template <class Angle, std::size_t N>
  std::pair<double, double> add_all(const std::array<RoughTet::Angle, N>& guesses,
                                    const std::array<Angle, N>& angles) {
    std::array<int, N> bins{};
    std::array<double, N> cotangents{};
    bool known = true;
    for (std::size_t i = 0; i < N; ++i) {
      cotangents[i] = guesses[i].cosine / guesses[i].sine;
      bins[i] = bin_of(cotangents[i]);
      known = known && guesses[i].certain() && bins[i] >= 0;
    }
    if (!known) {
      double low = 180, high = 0;
      for (std::size_t i = 0; i < N; ++i) {
        const double degrees = add(guesses[i], angles[i]);
        low = std::min(low, degrees);
        high = std::max(high, degrees);
      }
      return {low, high};
    }
    for (const int bin : bins) ++histogram[bin];
    const auto [most, least] = std::ranges::minmax_element(cotangents);
    const std::size_t of_low = least - cotangents.begin(), of_high = most - cotangents.begin();
    const double low = guesses[of_low].degrees(), high = guesses[of_high].degrees();
    if (low < smallest || low > largest) widen(angles[of_low]);
    if (high < smallest || high > largest) widen(angles[of_high]);
    return {low, high};
  }

  std::array<std::uint64_t, kBins> histogram{};
  double smallest = 180, largest = 0;

 private:
  // -1 within a millionth of a degree or more of its ends.
  static int bin_of(double cotangent) {
    static const std::array<double, kBins - 1> kEnds = [] {
      std::array<double, kBins - 1> ends{};
      for (int k = 1; k < kBins; ++k) ends[k - 1] = 1 / std::tan(k * 15 / kDegrees);
      return ends;
    }();
    int bin = 0, near = 0;
    for (const double end : kEnds) {
      bin += static_cast<int>(cotangent < end);
      near += static_cast<int>(std::fabs(cotangent - end) <= 3e-7 * (1 + end * end));
    }
    return near > 0 ? -1 : bin;
  }

  template <class Angle>
  void widen(const Angle& angle) {
    const Parts<ExactNumber> e = angle.exactly(points_);
    const double better = exact_angle(e.sine_squared, e.cosine);
    smallest = std::min(smallest, better);
    largest = std::max(largest, better);
  }

  template <class Angle>
  bool roughly(const Angle& angle, double& degrees) const {
    const Parts<Interval> p = angle.roughly(points_);
    const double cosine = p.cosine.middle(), sine2 = p.sine_squared.middle();
    const double sine = std::sqrt(std::max(0.0, sine2));
    degrees = std::atan2(sine, cosine) * kDegrees;
    return narrow(p.sine_squared, sine2) && narrow(p.cosine, std::fabs(cosine) + sine);
  }

  const ExactPoints& points_;
};

// The edges of a tetrahedron, each with the one opposite.
constexpr int kEdges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                              {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

struct Mean {
  double sum = 0;
  std::uint64_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
};

// Face angles and dihedral angles of a selection, each face once.
class AngleMeasure {
 public:
  AngleMeasure(const TetComplex& complex, const Neighbours& neighbours,
               const std::vector<std::uint8_t>& selected)
      : complex_(complex),
        neighbours_(neighbours),
        selected_(selected),
        face_(*complex.points),
        dihedral_(*complex.points) {}

  void run(OracleReport& report) {
    for (std::size_t t = 0; t < complex_.tetrahedra.size(); ++t) {
      if (!selected_[t]) continue;
      const Tet& tet = complex_.tetrahedra[t];
      RoughTet rough(*complex_.points, tet);
      rough.find_normals();
      for (int i = 0; i < 4; ++i) {
        if (counts(4 * t + i)) add_face(rough, i, face_of(tet, i));
      }
      shapes_.add(shape_of(*complex_.points, tet), add_dihedrals(rough, tet));
    }
    if (smallest_dihedral_.count == 0) return;
    report.figures.emplace_back("smallest face angle", face_.smallest);
    report.figures.emplace_back("largest face angle", face_.largest);
    report.figures.emplace_back("smallest dihedral angle", dihedral_.smallest);
    report.figures.emplace_back("largest dihedral angle", dihedral_.largest);
    report.figures.emplace_back("mean of faces' smallest angles", smallest_face_.value());
    report.figures.emplace_back("mean of faces' largest angles", largest_face_.value());
    report.figures.emplace_back("mean of smallest dihedral angles", smallest_dihedral_.value());
    report.figures.emplace_back("mean of largest dihedral angles", largest_dihedral_.value());
    shapes_.report(report);
    report.histograms.emplace_back("face angles", face_.histogram);
    report.histograms.emplace_back("dihedral angles", dihedral_.histogram);
  }

 private:
  // A face between two selected tetrahedra belongs to the first.
  bool counts(std::size_t tet_face) const {
    const Index other = neighbours_.across[tet_face];
    return other == kNone || !selected_[other / 4] || tet_face < other;
  }

  void add_face(const RoughTet& rough, int i, const Face& f) {
    const auto [low, high] = face_.add_all(
        std::array{rough.face_angle(i, 0), rough.face_angle(i, 1), rough.face_angle(i, 2)},
        std::array{FaceAngle{f[0], f[1], f[2]}, FaceAngle{f[1], f[2], f[0]},
                   FaceAngle{f[2], f[0], f[1]}});
    smallest_face_.add(low);
    largest_face_.add(high);
  }

  // Returns the smallest one.
  double add_dihedrals(const RoughTet& rough, const Tet& t) {
    std::array<RoughTet::Angle, 6> guesses;
    std::array<DihedralAngle, 6> angles;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto& [a, b, c, d] = kEdges[e];
      guesses[e] = rough.dihedral_angle(a, b, c, d);
      angles[e] = {t[a], t[b], t[c], t[d]};
    }
    const auto [low, high] = dihedral_.add_all(guesses, angles);
    smallest_dihedral_.add(low);
    largest_dihedral_.add(high);
    return low;
  }

  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const std::vector<std::uint8_t>& selected_;
  Distribution face_, dihedral_;
  Mean smallest_face_, largest_face_, smallest_dihedral_, largest_dihedral_;
  ShapeMeasure shapes_;
};

}  // namespace

double exact_angle(const ExactNumber& sine_squared, const ExactNumber& cosine) {
  if (sine_squared == 0) return cosine < 0 ? 180 : 0;
  // Scaled so that neither overflows: sine^2 and cosine by 2^(2 s) and 2^s.
  const auto length = [](const mpz_class& n) {
    return static_cast<long>(mpz_sizeinbase(n.get_mpz_t(), 2));
  };
  const long bits = length(sine_squared.numerator()) - length(sine_squared.denominator());
  const long shift = (bits + 1) / 2;
  const double sine = std::sqrt(to_double(sine_squared, -2 * shift));
  return std::atan2(sine, to_double(cosine, -shift)) * kDegrees;
}

int angle_bin(const ExactNumber& dot_product, const ExactNumber& norms) {
  const ExactNumber dd = dot_product * dot_product;
  // For an acute angle a: cos^2 a > cos^2(15 k), that is a < 15 k. cos^2(15) and cos^2(75) are
  // (2 +- sqrt 3) / 4, and x = 4 dd - 2 norms is compared with +- sqrt(3) norms by squares.
  const ExactNumber x = 4 * dd - 2 * norms;
  const int square = cmp(x * x, 3 * norms * norms);
  const int beyond[5] = {x > 0 ? square : -1,  // 15 degrees
                         cmp(4 * dd, 3 * norms), cmp(2 * dd, norms), cmp(4 * dd, norms),
                         x < 0 ? -square : 1};
  const int sign = sgn(dot_product);
  if (sign == 0) return 6;
  int k = 0;
  if (sign > 0) {
    while (k < 5 && beyond[k] <= 0) ++k;  // a >= 15 (k + 1)
    return k;
  }
  while (k < 5 && beyond[k] < 0) ++k;  // 180 - a > 15 (k + 1)
  return kBins - 1 - k;
}

WorstAngles worst_angles(const ExactPoints& points, const Tet& t) {
  RoughTet rough(points, t);
  rough.find_normals();
  // Among the certain ones only the largest cotangents have to become angles.
  double face_cotangent = -HUGE_VAL, dihedral_cotangent = -HUGE_VAL;
  WorstAngles worst;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (const RoughTet::Angle angle = rough.face_angle(i, k); angle.certain()) {
        face_cotangent = std::max(face_cotangent, angle.cosine / angle.sine);
        continue;
      }
      const Face f = face_of(t, i);
      const auto parts = FaceAngle{f[k], f[(k + 1) % 3], f[(k + 2) % 3]}.exactly(points);
      worst.face = std::min(worst.face, exact_angle(parts.sine_squared, parts.cosine));
    }
  }
  for (const auto& [a, b, c, d] : kEdges) {
    if (const RoughTet::Angle angle = rough.dihedral_angle(a, b, c, d); angle.certain()) {
      dihedral_cotangent = std::max(dihedral_cotangent, std::fabs(angle.cosine) / angle.sine);
      continue;
    }
    const auto parts = DihedralAngle{t[a], t[b], t[c], t[d]}.exactly(points);
    worst.dihedral = std::min(worst.dihedral, exact_angle(parts.sine_squared, abs(parts.cosine)));
  }
  const auto angle_of = [](double cotangent) { return std::atan2(1.0, cotangent) * kDegrees; };
  worst.face = std::min(worst.face, angle_of(face_cotangent));
  worst.dihedral = std::min(worst.dihedral, angle_of(dihedral_cotangent));
  return worst;
}

void measure_angles(const TetComplex& complex, const Neighbours& neighbours,
                    const std::vector<std::uint8_t>& selected, OracleReport& report) {
  AngleMeasure(complex, neighbours, selected).run(report);
}

namespace {

// Decides what an angle of a file that is below the bound means.
class AsWritten {
 public:
  AsWritten(const TetComplex& complex, const SmallestAngle& bound, double delta,
            const BeforeWriting& before)
      : complex_(complex), bound_(bound), delta_(delta), before_(before) {}

  // Did the tetrahedron keep the bound before it was written?
  bool kept_before(const Tet& tet) const {
    if (before_.points == nullptr) return false;
    Tet meant;
    for (int i = 0; i < 4; ++i) {
      const Index v = tet[i] - complex_.first_vertex;
      if (v >= before_.point.size() || before_.point[v] >= before_.points->size()) return false;
      meant[i] = before_.point[v];
    }
    Face at;
    return !find_small_angle(*before_.points, meant, bound_, at);
  }

  // Can vertices that are no farther from their places than that explain it? A vector between two
  // of them is off by twice as much, and turned by the arc sine of its share.
  bool explained(const Tet& tet) const {
    if (!(before_.farthest > 0)) return false;
    for (int i = 0; i < 4; ++i) {
      const Face face = face_of(tet, i);
      for (int corner = 0; corner < 3; ++corner) {
        const FaceAngle angle{face[corner], face[(corner + 1) % 3], face[(corner + 2) % 3]};
        const double turn = turn_of(angle.apex, angle.b) + turn_of(angle.apex, angle.c);
        const Parts<ExactNumber> parts = angle.exactly(*complex_.points);
        if (exact_angle(parts.sine_squared, parts.cosine) + turn < delta_) return false;
      }
    }
    return true;
  }

 private:
  double turn_of(Index from, Index to) const {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = complex_.points->nearest(to)[axis] - complex_.points->nearest(from)[axis];
      square += x * x;
    }
    const double share = 2 * before_.farthest / std::sqrt(square);
    return share < 1 ? std::asin(share) * kDegrees : 180;
  }

  const TetComplex& complex_;
  const SmallestAngle& bound_;
  double delta_;
  const BeforeWriting& before_;
};

}  // namespace

OracleReport check_angles(const TetComplex& complex, const Neighbours& neighbours,
                          const Places& places, double delta, AngleScope scope,
                          const BeforeWriting& before) {
  OracleReport report("angles", "tetrahedra");
  const SmallestAngle bound(delta);
  const AsWritten as_written(complex, bound, delta, before);
  std::uint64_t left_alone = 0, by_writing = 0, unexplained = 0;
  double smallest_by_writing = delta;
  std::vector<std::uint8_t> selected(complex.tetrahedra.size(), 1);
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const Tet& tet = complex.tetrahedra[t];
    Face at;
    const bool bad = find_small_angle(*complex.points, tet, bound, at);
    if (bad && scope == AngleScope::solid && places.of(t) == Place::outside) {
      ++left_alone;
      selected[t] = 0;
      continue;
    }
    ++report.checked;
    if (!bad) continue;
    if (as_written.kept_before(tet)) {
      ++by_writing;
      smallest_by_writing = std::min(smallest_by_writing, worst_angles(*complex.points, tet).face);
      continue;
    }
    if (!as_written.explained(tet)) ++unexplained;
    const Parts<ExactNumber> parts = FaceAngle{at[0], at[1], at[2]}.exactly(*complex.points);
    char text[64];
    std::snprintf(text, sizeof text, " has an angle of %.6g degrees at ",
                  exact_angle(parts.sine_squared, parts.cosine));
    report.fail(
        complex.tet_name(t) + text + complex.vertex_name(at[0]) + " in " + complex.face_name(at),
        complex.tet_site(t));
  }
  report.figures.emplace_back("bound", delta);
  report.figures.emplace_back("bad tetrahedra outside the solid", left_alone);
  if (before.points != nullptr) {
    report.figures.emplace_back("bad as written alone", by_writing);
    report.figures.emplace_back("smallest angle of these", smallest_by_writing);
  }
  report.undecided = report.violations > 0 && unexplained == 0;
  if (report.undecided) {
    report.notes.push_back(
        "vertices that were rounded or put back where they were given can explain these angles: "
        "a record (--exact) decides");
  }
  measure_angles(complex, neighbours, selected, report);
  return report;
}

}  // namespace tetproof::oracles
