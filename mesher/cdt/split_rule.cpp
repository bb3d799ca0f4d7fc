#include "mesher/cdt/split_rule.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/vector.h"
#include "mesher/predicates/exact_point.h"

namespace delmesher::cdt {
namespace {

// Edges are only said to run along each other up to this distance, relative to the length of a
// part.
constexpr double kBeside = 0x1p-6;
// Parts of an edge, as a share of it, below which short ends are accepted around an acute vertex.
constexpr double kDeep = 0x1p-6;
// So many hopeless references in one recovery mean that it does not end. It ends in spite of some.
constexpr std::uint32_t kMostHopeless = 1024;

}  // namespace

SplitTarget SplitRule::target(std::uint32_t n, Centre centre, VertexId reference) {
  const ChainNode &u = chains_.node(n), &w = chains_.next(n);
  const double width = fraction_between(u, w);
  const SplitTarget middle = target_in_the_middle(u, w);
  if (centre == Centre::both || reference == kNone) return middle;
  const double length = chains_.length(u.edge);
  if (centre == Centre::none) {
    bool soon = false;
    if (SplitTarget t{}; target_opposite(u, w, reference, t, soon)) return t;
    if (soon) return middle;
    const double to_u = distance_between(points_, u.vertex, reference) / length;
    const double to_w = distance_between(points_, w.vertex, reference) / length;
    const double step = std::min(to_u, to_w);
    // Written so that a NaN means the middle, here and below.
    if (!(step > 0 && step <= width / 2)) return middle;
    return target_behind(u, w, to_u <= to_w ? step : width - step);
  }
  return on_sphere(u, w, static_cast<int>(centre), reference, middle);
}

// Opposite a reference on an edge that runs along this one: the reference's projection.
//
// The rules by distances from ends would not end here. Points of two edges at a distance d would
// not face each other, so each new point would be the reference of the next one on the other edge,
// a distance d farther on. Points that face each other are done with. They have to face each other
// up to d^2 / L, where L is the length of the part of the other edge: a point farther from its
// place is in the diametral ball of that part, and a part between two other edges may then be
// missing for good.
//
// So the projection has twice as many bits where it takes them. It is used only where the edges are
// so nearly parallel that the projection back onto the other edge is as near. `soon` says that this
// part will be short enough for that when it has been halved a few times.
bool SplitRule::target_opposite(const ChainNode& u, const ChainNode& w, VertexId reference,
                                SplitTarget& t, bool& soon) const {
  const Vec3 along = points_.difference(u.vertex, w.vertex);
  const double part = safe_distance(along, {});
  const Vec3 to_reference = points_.difference(u.vertex, reference);
  const Vec3 d = scaled_difference(along, {}, part), f = scaled_difference(to_reference, {}, part);
  const double place = dot(d, f), squared_off = dot(cross(d, f), cross(d, f));
  if (!(place > 0 && place < 1 && squared_off < kBeside * kBeside)) return false;
  const double parallel = std::sqrt(squared_off) / 16;
  if (!runs_along(u.edge, reference, parallel)) {
    constexpr double kSoon = 256;
    soon = runs_along(u.edge, reference, kSoon * parallel);
    return false;
  }
  const std::array<VertexId, 2> end = chains_.topology().edge_vertices(u.edge);
  t = target_behind(u, w, place * fraction_between(u, w));
  const VertexId apex = end[t.anchor], other = end[1 - t.anchor];
  // In units of a power of two near the length: squares may overflow otherwise.
  int exponent = 0;
  std::frexp(chains_.length(u.edge), &exponent);
  Dyadic whole = squared_distance(apex, other), share = product(apex, reference, other);
  if (share.sign() <= 0) return false;
  whole.exponent -= 2 * exponent;
  share.exponent -= 2 * exponent;
  double& fraction = t.from[t.anchor];
  fraction = round_to_double(share).value / round_to_double(whole).value;
  t.from[1 - t.anchor] = 1 - fraction;
  t.tolerance = std::min(t.tolerance, squared_off / 16 * part / chains_.length(u.edge));
  if (t.tolerance > fraction * 0x1p-50) return true;
  t.tolerance = 0;
  t.low = round_to_double(share - whole * Dyadic::from_double(fraction)).value /
          round_to_double(whole).value;
  return true;
}

// Is v on another edge whose direction differs by at most this sine?
bool SplitRule::runs_along(std::uint32_t edge, VertexId v, double sine) const {
  const SurfaceTopology& s = chains_.topology();
  if (const std::uint32_t n = chains_.node_of(v); n != kNone) {
    return sine_between(edge, chains_.node(n).edge) <= sine;
  }
  if (v >= s.vertex_half_edge.size()) return false;
  bool along = false;
  s.for_each_edge_at(v, [&](std::uint32_t other) {
    along = s.edge_is_flat[other] == 0 && sine_between(edge, other) <= sine;
    return !along;
  });
  return along;
}

double SplitRule::sine_between(std::uint32_t e, std::uint32_t f) const {
  const auto direction = [&](std::uint32_t edge) {
    const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
    return scaled_difference(points_.difference(end[0], end[1]), {}, chains_.length(edge));
  };
  return norm(cross(direction(e), direction(f)));
}

// (v - a) . (b - a)
Dyadic SplitRule::product(VertexId a, VertexId v, VertexId b) const {
  const DyadicPoint origin = dyadic_point(points_, a), p = dyadic_point(points_, v),
                    q = dyadic_point(points_, b);
  Dyadic sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sum = sum + (p[axis] - origin[axis]) * (q[axis] - origin[axis]);
  }
  return sum;
}

// Where the sphere around the acute end through the reference meets the subsegment. All points
// around an acute vertex must be on the same spheres up to less than the angles there, hence all
// 53 bits of the parameter, anchored at that vertex.
SplitTarget SplitRule::on_sphere(const ChainNode& u, const ChainNode& w, int centre,
                                 VertexId reference, const SplitTarget& middle) {
  const double length = chains_.length(u.edge);
  const VertexId apex = chains_.topology().edge_vertices(u.edge)[centre];
  const double radius = distance_from_apex(apex, reference) / length;
  const ChainNode& near = centre == 0 ? u : w;
  const ChainNode& far = centre == 0 ? w : u;
  const double step = radius - near.from[centre], rest = far.from[centre] - radius;
  const double width = fraction_between(u, w);
  // Points on different spheres that halve their parts instead may be each other's references,
  // all the way down to the apex; at some depth they have to meet on one.
  const bool deep = width < kDeep;
  const double least = (deep ? 0.02 : 0.2) * width;
  if (!(step >= least && rest >= least)) return middle;
  SplitTarget t;
  t.anchor = centre;
  t.tolerance = 0;
  t.from[centre] = radius;
  t.from[1 - centre] = 1 - radius;
  sharpen(t, u.edge, reference);
  const Vec3 x = scaled_difference(points_.difference(near.vertex, far.vertex), {}, width / step);
  const Vec3 to_reference = points_.difference(near.vertex, reference);
  if (!deep && rest * length < safe_distance(x, to_reference)) return middle;
  return t;
}

// By the chain's own parameter where possible: coordinates are too coarse far from the origin.
double SplitRule::distance_from_apex(VertexId apex, VertexId v) const {
  const std::uint32_t n = chains_.node_of(v);
  if (n != kNone) {
    const std::uint32_t edge = chains_.node(n).edge;
    const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
    for (int k = 0; k < 2; ++k) {
      if (end[k] == apex) return chains_.node(n).from[k] * chains_.length(edge);
    }
  }
  return distance_between(points_, apex, v);
}

// At angles below 2^-40 a radius of 53 bits is not enough for two points to be on the same sphere
// up to less than their distance d. An edge of length L between two others that run along it
// (shells inside each other) even needs it up to d^2 / L: a sphere through its ends that keeps
// clear of the one point meets the other. So from an angle of 2^-10 down the target gets twice as
// many bits, by exact Newton steps for |apex + t (end - apex)| = |reference - apex|.
void SplitRule::sharpen(SplitTarget& target, std::uint32_t edge, VertexId reference) {
  const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
  const VertexId apex = end[target.anchor], other = end[1 - target.anchor];
  double& fraction = target.from[target.anchor];
  const double length = chains_.length(edge);
  const Vec3 d = scaled_difference(points_.difference(apex, other), {}, length);
  const Vec3 f = scaled_difference(points_.difference(apex, reference), {}, fraction * length);
  const double squared_sine = dot(cross(d, f), cross(d, f));
  if (!(squared_sine < 0x1p-20)) return;
  // At a smaller sine than 2^-106 no two points can be matched by the parameters that a point has,
  // and splitting goes on for ever. Edges of doubles of about the same size never come so close to
  // each other.
  if (squared_sine < 0x1p-212) ++hopeless_;
  if (hopeless_ == kMostHopeless) stop_beside(chains_, edge);
  const Dyadic squared_radius = squared_distance(apex, reference);
  const Dyadic squared_length = squared_distance(apex, other);
  // In units of a power of two near the length: squares may overflow otherwise.
  int exponent = 0;
  const double mantissa = std::frexp(length, &exponent);
  for (int step = 0; step < 2; ++step) {
    fraction += target.low;
    const Dyadic t = Dyadic::from_double(fraction);
    Dyadic difference = squared_radius - squared_length * t * t;
    if (difference.sign() != 0) difference.exponent -= 2 * exponent;
    target.low = round_to_double(difference).value / (2 * fraction * mantissa * mantissa);
  }
}

}  // namespace delmesher::cdt
