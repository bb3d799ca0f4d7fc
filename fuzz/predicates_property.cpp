#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <sstream>
#include <vector>

#include "fuzz/properties.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/predicates.h"
#include "mesher/predicates/rational_reference.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using namespace delmesher::geometry;

Leniency no_bound("infinite-error-bound", 0.01);

struct Points {
  PointStore store;
  VertexId corners = 0;  // the points that segments and triangles may be between
};

// Through points of the store, all of which are explicit yet.
void add_plane(PointStore& store, Bytes& bytes) {
  const auto corner = [&] {
    return store.nearest(bytes.below(static_cast<std::uint32_t>(store.size())));
  };
  PlaneEquation plane{{}, {corner(), {}, {}}};
  const std::uint32_t kind = bytes.below(3);
  plane.spanned = kind == 0;
  if (plane.spanned) {
    plane.through[1] = corner();
    plane.through[2] = corner();
    plane.normal = cross(subtract(plane.through[1], plane.through[0]),
                         subtract(plane.through[2], plane.through[0]));
  } else {
    // Small integers give short denominators, and points that coincide.
    for (double& x : plane.normal) x = kind == 1 ? bytes.below(5) - 2.0 : bytes.coordinate();
  }
  const double length = norm(plane.normal);
  if (std::isfinite(length) && length > 0) store.add_plane(plane);
}

// Planes, and points where three of them meet. Points beyond the range of doubles are left out: the
// mesher has none (results/units).
void add_meeting_points(PointStore& store, Bytes& bytes) {
  for (std::uint32_t n = bytes.below(6); n > 0; --n) add_plane(store, bytes);
  const auto count = static_cast<std::uint32_t>(store.plane_count());
  const mpq_class most = reference::rational(0x1p1000);
  for (std::uint32_t n = count < 3 ? 0 : bytes.below(4); n > 0; --n) {
    const std::array<std::uint32_t, 3> three = {bytes.below(count), bytes.below(count),
                                                bytes.below(count)};
    const std::array<PlaneEquation, 3> planes = {store.plane(three[0]), store.plane(three[1]),
                                                 store.plane(three[2])};
    if (!reference::meet_in_a_point(planes)) continue;
    const reference::Point at = reference::meeting_point(planes);
    if (std::ranges::all_of(at, [&](const mpq_class& x) { return abs(x) < most; })) {
      store.add_on_planes(three[0], three[1], three[2]);
    }
  }
}

Points read_points(Bytes& bytes, bool with_planes) {
  Points p;
  p.corners = 3 + bytes.below(6);
  // Every second set is nearly in an axis-parallel plane: a corner is in it or an ulp beside it, so
  // that points between corners are rounded into it.
  const std::uint32_t flat = bytes.below(6);
  const double level = flat < 3 ? bytes.coordinate() : 0;
  for (VertexId i = 0; i < p.corners; ++i) {
    Vec3 x = {bytes.coordinate(), bytes.coordinate(), bytes.coordinate()};
    if (flat < 3) x[flat] = bytes.below(4) == 0 ? std::nextafter(level, DBL_MAX) : level;
    p.store.add_explicit(x[0], x[1], x[2]);
  }
  if (with_planes) {
    add_meeting_points(p.store, bytes);
    p.corners = static_cast<VertexId>(p.store.size());
  }
  for (std::uint32_t n = bytes.below(8); n > 0; --n) {
    const VertexId a = bytes.below(p.corners), b = bytes.below(p.corners),
                   c = bytes.below(p.corners);
    const double u = bytes.parameter(), v = bytes.parameter();
    if (bytes.below(2) == 0) {
      p.store.add_on_segment(a, b, u);
    } else {
      p.store.add_on_triangle(a, b, c, u, v);
    }
  }
  return p;
}

// The exact points, in units that make all coordinates integers. Predicates do not depend on the
// unit, and rationals without denominators need no common divisors, which took most of the time.
std::vector<reference::Point> integer_points(const std::vector<reference::Point>& exact) {
  mpz_class unit = 1;
  for (const auto& p : exact) {
    for (const mpq_class& x : p) unit = lcm(unit, x.get_den());
  }
  std::vector<reference::Point> scaled = exact;
  for (auto& p : scaled) {
    for (mpq_class& x : p) x *= unit;
  }
  return scaled;
}

// Nearest doubles and remainders are as near as they say, on which the filters rely.
Finding approximations_hold(const PointStore& store, const std::vector<reference::Point>& at) {
  for (VertexId v = 0; v < store.size(); ++v) {
    if (store.is_explicit(v)) continue;
    const reference::Point& exact = at[v];
    const Approximation near = store.approximation(v), rest = store.remainder(v);
    const Vec3 first = {near.x, near.y, near.z}, second = {rest.x, rest.y, rest.z};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isfinite(near.error)) {
        no_bound.take();
        continue;
      }
      const mpq_class left = exact[i] - reference::rational(first[i]);
      if (abs(left) > reference::rational(near.error)) return "approximation: farther than it says";
      if (!std::isfinite(rest.error)) {
        no_bound.take();
        continue;
      }
      if (abs(mpq_class(left - reference::rational(second[i]))) > reference::rational(rest.error)) {
        return "remainder: farther than it says";
      }
    }
  }
  return {};
}

// One call of a predicate with the ids it gets.
class Call {
 public:
  Call(Points& points, const std::vector<reference::Point>& at, Bytes& bytes)
      : points_(points), predicates_(points.store) {
    for (VertexId& v : id_) v = bytes.below(static_cast<std::uint32_t>(points.store.size()));
    for (std::size_t i = 0; i < id_.size(); ++i) at_[i] = at[id_[i]];
    axis_ = static_cast<int>(bytes.below(3));
    cosine_squared_ = bytes.below(2) == 0 ? 0.25 : bytes.parameter();
    predicate_ = bytes.below(13);
  }

  Finding compare() {
    const auto [name, ours, right] = answers();
    if (ours == right) return {};
    std::ostringstream out;
    out << "predicate " << name << ": ours " << ours << ", rational " << right << ", arguments";
    for (std::size_t i = 0; i < id_.size(); ++i) describe(out, id_[i]);
    out << " axis " << axis_ << " cosine^2 " << std::hexfloat << cosine_squared_;
    return out.str();
  }

 private:
  struct Answers {
    const char* name;
    int ours, right;
  };

  void describe(std::ostream& out, VertexId v) const {
    const PointDefinition d = points_.store.definition(v);
    if (d.kind == PointKind::explicit_point) {
      const Vec3 p = points_.store.nearest(v);
      out << " E(" << std::hexfloat << p[0] << ' ' << p[1] << ' ' << p[2] << ")";
    } else if (d.kind == PointKind::on_planes) {
      out << " P(" << std::hexfloat;
      for (const std::uint32_t n : d.corner) {
        const PlaneEquation& plane = points_.store.plane(n);
        for (const double x : plane.normal) out << ' ' << x;
        for (std::size_t k = 0; k < (plane.spanned ? 3U : 1U); ++k) {
          for (const double x : plane.through[k]) out << ' ' << x;
        }
      }
      out << ")";
    } else {
      out << (d.kind == PointKind::on_segment ? " S(" : " T(");
      for (int i = 0; i < (d.kind == PointKind::on_segment ? 2 : 3); ++i) {
        describe(out, d.corner[static_cast<std::size_t>(i)]);
      }
      out << ' ' << std::hexfloat << d.u << ' ' << d.v << ")";
    }
  }

  static int xyz_sign(const reference::Point* p) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (const int s = cmp(p[0][i], p[1][i]); s != 0) return s < 0 ? -1 : 1;
    }
    return 0;
  }

  // By the definition: heights |p|^2 + eps_i, eps of smaller ids infinitely larger.
  int perturbed() const {
    std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return id_[i] < id_[j]; });
    for (std::size_t i = 0; i < 4; ++i) {
      if (id_[order[i]] == id_[order[i + 1]]) return 0;
    }
    if (const int s = reference::insphere(at_.data()); s != 0) return s;
    for (const std::size_t raised : order) {
      std::vector<std::vector<mpq_class>> m;
      for (std::size_t i = 0; i < 5; ++i) {
        m.push_back({1, at_[i][0], at_[i][1], at_[i][2], i == raised ? 1 : 0});
      }
      if (const int s = sgn(reference::determinant(m)); s != 0) return -s;
    }
    return 0;
  }

  Answers answers() {
    const auto [a, b, c, d, e] = id_;
    const reference::Point* p = at_.data();
    switch (predicate_) {
      case 0:
        break;
      case 1:
        return {"orient2d", predicates_.orient2d(axis_, a, b, c), reference::orient2d(axis_, p)};
      case 2:
        return {"insphere", predicates_.insphere(a, b, c, d, e), reference::insphere(p)};
      case 3:
        return {"dot", predicates_.dot_sign(a, b, c),
                sgn(reference::dot(reference::minus(p[0], p[1]), reference::minus(p[2], p[1])))};
      case 4:
        return {"dot of differences", predicates_.dot_difference_sign(a, b, c, d),
                sgn(reference::dot(reference::minus(p[1], p[0]), reference::minus(p[3], p[2])))};
      case 5:
        if (reference::collinear(p[0], p[1], p[2])) break;  // there is no ball
        return {"in ball", predicates_.in_diametral_ball(a, b, c, d),
                reference::in_diametral_ball(p)};
      case 6:
        return {"dihedral", predicates_.dihedral_sign(a, b, c, d), reference::dihedral_sign(p)};
      case 8:
        return {"order", predicates_.compare_xyz(a, b), xyz_sign(p)};
      case 9:
        return {"angle below", predicates_.angle_below(a, b, c, cosine_squared_),
                reference::below(reference::minus(p[0], p[1]), reference::minus(p[2], p[1]),
                                 cosine_squared_)};
      case 10:
        return {"perturbed insphere", predicates_.insphere_perturbed(a, b, c, d, e), perturbed()};
      case 11:
        if (reference::collinear(p[1], p[2], p[3])) break;  // there is no plane
        return {"edge and plane", predicates_.edge_plane_angle_below(a, b, c, d, cosine_squared_),
                reference::edge_plane_angle_below(p, cosine_squared_)};
      default:  // 7 and 12: other numbers keep their meaning in corpora
        return {"dihedral below", predicates_.dihedral_below(a, b, c, d, cosine_squared_),
                reference::dihedral_below(p, cosine_squared_)};
    }
    return {"orient3d", predicates_.orient3d(a, b, c, d), reference::orient3d(p)};
  }

  Points& points_;
  Predicates predicates_;
  std::array<VertexId, 5> id_{};
  std::array<reference::Point, 5> at_;
  int axis_ = 0;
  double cosine_squared_ = 0.25;
  std::uint32_t predicate_ = 0;
};

}  // namespace

static Finding agree(Bytes bytes, bool with_planes) {
  judging({&no_bound});
  Points points = read_points(bytes, with_planes);
  std::vector<reference::Point> exact;
  for (VertexId v = 0; v < points.store.size(); ++v) {
    exact.push_back(reference::point(points.store, v));
  }
  if (Finding finding = approximations_hold(points.store, exact); !finding.empty()) return finding;
  const auto at = integer_points(exact);
  for (int calls = 0; calls < 12 && !bytes.empty(); ++calls) {
    if (Finding finding = Call(points, at, bytes).compare(); !finding.empty()) return finding;
  }
  return {};
}

Finding predicates_agree(Bytes bytes) {
  return agree(bytes, false);
}

Finding predicates_on_planes_agree(Bytes bytes) {
  return agree(bytes, true);
}

}  // namespace tetproof::fuzz
