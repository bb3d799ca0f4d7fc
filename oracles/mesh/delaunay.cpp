#include "oracles/mesh/delaunay.h"

#include <algorithm>
#include <optional>

#include "oracles/base/ball_side.h"
#include "oracles/base/buckets.h"
#ifdef TETPROOF_SECOND_OPINIONS
#include "oracles/cgal/kernel_opinion.h"
#endif
#include "oracles/base/simplex_set.h"
#include "oracles/mesh/sample.h"

namespace tetproof::oracles {
namespace {

// Keeps the sphere of the last tetrahedron, because its faces follow in turn. BallSide
// evaluates the in-sphere determinant with the opposite sign, whatever the orientation.
class Circumsphere {
 public:
  void move_to(const ExactPoints& points, const Tet& t, Index number) {
    if (ball_ && number == number_) return;
    ball_ = BallSide::circumscribed(points, t);
    number_ = number;
  }
  int insphere(const ExactPoints& points, const Tet& t, Index e) const {
    const int side = ball_->side(e);
    return side != 0 ? -side : exact::insphere(points, t[0], t[1], t[2], t[3], e);
  }

 private:
  std::optional<BallSide> ball_;
  Index number_ = 0;
};

#ifdef TETPROOF_SECOND_OPINIONS
// The in-sphere sign of our arithmetic, checked against CGAL's.
class TwoOpinions {
 public:
  explicit TwoOpinions(const ExactPoints& points) : points_(points), cgal_(points) {}

  void tell(OracleReport&) const {}
  int insphere(const Circumsphere& sphere, const Tet& t, Index e, OracleReport& report) {
    const int ours = sphere.insphere(points_, t, e);
    const int theirs = cgal_.insphere(t[0], t[1], t[2], t[3], e);
    if (ours != theirs) {
      report.fail("the in-sphere tests of this program (" + std::to_string(ours) +
                  ") and of CGAL (" + std::to_string(theirs) + ") disagree");
    }
    return theirs;
  }

 private:
  const ExactPoints& points_;
  const KernelOpinion cgal_;
};
#else
// The in-sphere sign of our arithmetic alone.
class TwoOpinions {
 public:
  explicit TwoOpinions(const ExactPoints& points) : points_(points) {}

  void tell(OracleReport& report) const { report.notes.push_back(kNoSecondOpinion); }
  int insphere(const Circumsphere& sphere, const Tet& t, Index e, OracleReport&) const {
    return sphere.insphere(points_, t, e);
  }

 private:
  const ExactPoints& points_;
};
#endif

struct ViolationNames {
  const TetComplex& complex;
  std::string face(Index tet_face, Index opposite) const {
    const Tet& tet = complex.tetrahedra[tet_face / 4];
    return complex.face_name(face_of(tet, static_cast<int>(tet_face % 4))) + ": " +
           complex.vertex_name(opposite) + " lies inside the circumsphere of " +
           complex.tet_name(tet_face / 4);
  }
};

// Visits the sampled tetrahedra with every vertex strictly inside their circumspheres.
template <class Visit>
std::uint64_t for_each_inside(const TetComplex& complex, const Visit& visit) {
  const std::vector<Index> vertices = used_vertices(complex);
  const Sample sample(complex.tetrahedra.size(), vertices.size());
  std::uint64_t tried = 0;
  for (std::size_t t = sample.first(); t < complex.tetrahedra.size(); t += sample.step(), ++tried) {
    const auto& [a, b, c, d] = complex.tetrahedra[t];
    const BallSide ball = BallSide::circumscribed(*complex.points, complex.tetrahedra[t]);
    for (const Index v : vertices) {
      const int side = ball.side(v);
      if (side > 0 || v == a || v == b || v == c || v == d) continue;
      if (side < 0 || exact::insphere(*complex.points, a, b, c, d, v) > 0) visit(t, v);
    }
  }
  return tried;
}

// Does the surface block the view from the centroid of a tetrahedron to a vertex?
class Sight {
 public:
  Sight(const TetComplex& complex, const InputSurface& surface)
      : points_(*complex.points), complex_(complex), surface_(surface) {}

  bool blocked(std::size_t t, Index v) {
    std::array<Index, 5> all;
    std::copy_n(complex_.tetrahedra[t].begin(), 4, all.begin());
    all[4] = v;
    found_.clear();
    surface_.triangles_near(box_around(points_, all), found_);
    return std::any_of(found_.begin(), found_.end(), [&](Index triangle) {
      return crosses(surface_.triangles()[triangle], complex_.tetrahedra[t], v);
    });
  }

 private:
  // The sum of the corners less four times `from`: towards the centroid.
  ExactVector towards_centroid(Index from, const Tet& tet) const {
    ExactVector sum;
    for (const Index c : tet) {
      const ExactVector d = exact::difference(points_, from, c);
      for (int axis = 0; axis < 3; ++axis) sum[axis] += d[axis];
    }
    return sum;
  }
  IntervalVector rough_towards_centroid(Index from, const Tet& tet) const {
    IntervalVector sum;
    for (const Index c : tet) {
      const IntervalVector d = points_.rough_difference(from, c);
      for (int axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] + d[axis];
    }
    return sum;
  }

  // The side of a triangle on which the centroid lies.
  int side_of_centroid(const std::array<Index, 3>& triangle, const Tet& tet) const {
    const auto& [a, b, c] = triangle;
    const int rough =
        exact::dot(exact::rough_area2(points_, a, b, c), rough_towards_centroid(a, tet)).sign();
    if (rough != 2) return rough;
    return sgn(exact::dot(exact::area2(points_, a, b, c), towards_centroid(a, tet)));
  }

  // How the line from v to the centroid passes the line from a to b.
  int passes(Index a, Index b, const Tet& tet, Index v) const {
    const int rough =
        exact::dot(rough_towards_centroid(v, tet), exact::rough_area2(points_, v, a, b)).sign();
    if (rough != 2) return rough;
    return sgn(exact::dot(towards_centroid(v, tet), exact::area2(points_, v, a, b)));
  }

  bool crosses(const std::array<Index, 3>& triangle, const Tet& tet, Index v) const {
    const auto& [a, b, c] = triangle;
    if (exact::orient3d(points_, a, b, c, v) * side_of_centroid(triangle, tet) >= 0) return false;
    // The line from v to the centroid passes the three sides on the same side, or meets them.
    const int sides[3] = {passes(a, b, tet, v), passes(b, c, tet, v), passes(c, a, tet, v)};
    const auto [low, high] = std::minmax({sides[0], sides[1], sides[2]});
    return low * high >= 0;
  }

  const ExactPoints& points_;
  const TetComplex& complex_;
  const InputSurface& surface_;
  std::vector<Index> found_;
};

// Numbers near each other become numbers that seem to have nothing in common.
std::uint32_t scattered(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

}  // namespace

std::vector<Index> used_vertices(const TetComplex& complex) {
  std::vector<std::uint8_t> used(complex.points->size(), 0);
  for (const Tet& tet : complex.tetrahedra) {
    for (const Index v : tet) used[v] = 1;
  }
  std::vector<Index> vertices;
  for (Index v = 0; v < used.size(); ++v) {
    if (used[v]) vertices.push_back(v);
  }
  return vertices;
}

std::vector<std::uint8_t> in_both(const std::vector<delmesher::ExactRecord::Tet>& tetrahedra,
                                  const TetComplex& other, std::uint64_t* compared) {
  // By a number that is the same for all orders of the corners. By one of the corners, there would
  // be as many to compare as have it in common: on a large flat facet, most of the mesh.
  constexpr Index kInEach = 4;
  const auto slots = static_cast<Index>(other.tetrahedra.size() / kInEach + 1);
  const auto slot = [slots](const Tet& tet) {
    std::uint32_t sum = 0;
    for (const Index v : tet) sum += scattered(v);
    return sum % slots;
  };
  Buckets by_slot(slots);
  for (const Tet& tet : other.tetrahedra) by_slot.count(slot(tet));
  by_slot.allot();
  for (Index t = 0; t < other.tetrahedra.size(); ++t) by_slot.put(slot(other.tetrahedra[t]), t);
  std::vector<std::uint8_t> found(tetrahedra.size());
  std::uint64_t pairs = 0;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const Tet& tet = tetrahedra[t].vertices;
    const std::span<const Index> candidates = by_slot.of(slot(tet));
    found[t] = std::any_of(candidates.begin(), candidates.end(), [&](Index c) {
      ++pairs;
      return std::is_permutation(tet.begin(), tet.end(), other.tetrahedra[c].begin());
    });
  }
  if (compared != nullptr) *compared = pairs;
  return found;
}

OracleReport check_delaunay(const TetComplex& complex, const Neighbours& neighbours) {
  OracleReport report("delaunay", "faces between two tetrahedra, and tetrahedra");
  const ViolationNames names{complex};
  TwoOpinions opinions(*complex.points);
  opinions.tell(report);
  Circumsphere sphere;
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    const Index j = neighbours.across[i];
    if (j == kNone || j < i) continue;
    const Index opposite = complex.tetrahedra[j / 4][j % 4];
    ++report.checked;
    const Tet& tet = complex.tetrahedra[i / 4];
    sphere.move_to(*complex.points, tet, i / 4);
    if (opinions.insphere(sphere, tet, opposite, report) > 0) {
      report.fail(names.face(i, opposite), complex.tet_site(i / 4));
    }
  }
  const std::uint64_t tried = for_each_inside(complex, [&](std::size_t t, Index v) {
    report.fail(complex.vertex_name(v) + " lies inside the circumsphere of " + complex.tet_name(t),
                complex.tet_site(t));
  });
  report.checked += tried;
  report.figures.emplace_back("tetrahedra tried against all vertices", tried);
  return report;
}

OracleReport check_constrained_delaunay(const TetComplex& complex, const Neighbours& neighbours,
                                        const InputSurface& surface,
                                        const std::vector<Face>& constraints,
                                        const ConstrainedDelaunayOptions& options) {
  OracleReport report("constrained-delaunay", "faces off the surface, and tetrahedra");
  report.promised = options.gate;
  const ViolationNames names{complex};
  const SimplexSet<3> constrained(constraints);
  std::uint64_t not_delaunay = 0;
  Circumsphere sphere;
  TwoOpinions opinions(*complex.points);
  opinions.tell(report);
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    const Index j = neighbours.across[i];
    if (j == kNone || j < i) continue;
    // Most faces have a corner off the surface, and need no search.
    const unsigned among = constrained.corners_among(complex.tetrahedra[i / 4]);
    if ((among | 1U << i % 4) == 15 &&
        constrained.contains(face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4)))) {
      continue;
    }
    const Index opposite = complex.tetrahedra[j / 4][j % 4];
    ++report.checked;
    if (!options.known.empty() && options.known[i / 4] != 0 && options.known[j / 4] != 0) continue;
    const Tet& tet = complex.tetrahedra[i / 4];
    sphere.move_to(*complex.points, tet, i / 4);
    // Violations that are only counted need no second opinion.
    const int side = options.gate ? opinions.insphere(sphere, tet, opposite, report)
                                  : sphere.insphere(*complex.points, tet, opposite);
    if (side <= 0) continue;
    ++not_delaunay;
    if (options.gate) report.fail(names.face(i, opposite), complex.tet_site(i / 4));
  }
  report.figures.emplace_back("not locally Delaunay", not_delaunay);
  if (!options.gate) return report;
  Sight sight(complex, surface);
  std::uint64_t inside = 0;
  const std::uint64_t tried = for_each_inside(complex, [&](std::size_t t, Index v) {
    ++inside;
    if (sight.blocked(t, v)) return;
    report.fail(
        complex.tet_name(t) + " sees " + complex.vertex_name(v) + " inside its circumsphere",
        complex.tet_site(t));
  });
  report.checked += tried;
  report.figures.emplace_back("tetrahedra tried against all vertices", tried);
  report.figures.emplace_back("hidden vertices inside their spheres", inside);
  return report;
}

}  // namespace tetproof::oracles
