#include "mesher/remesh/coverage.h"

#include <algorithm>

namespace delmesher::remesh {
namespace {

constexpr int kDepth = 64;
constexpr std::size_t kMostCorners = 16;
// Pieces per candidate: beyond that the answer is no.
constexpr std::size_t kMostPieces = 8;

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = subtract(b, a);
  const double length = squared_norm(along);
  if (!(length > 0)) return a;
  const double t = std::clamp(dot(subtract(p, a), along) / length, 0.0, 1.0);
  return t == 1 ? b : add_scaled(a, t, along);
}

}  // namespace

Simplex::Simplex(const std::array<Vec3, 3>& triangle, std::int32_t triangle_label)
    : corner(triangle),
      label(triangle_label),
      box(Box::around(corner)),
      normal(cross(subtract(corner[1], corner[0]), subtract(corner[2], corner[0]))) {
  const double square = squared_norm(normal);
  if (!(square > 0)) return;
  of_second = add_scaled({}, 1 / square, cross(subtract(corner[2], corner[0]), normal));
  of_third = add_scaled({}, 1 / square, cross(normal, subtract(corner[1], corner[0])));
}

Simplex::Simplex(const Vec3& a, const Vec3& b)
    : corner{a, b, b}, is_segment(true), box(Box::around(corner)) {}

Vec3 nearest_point(const Vec3& p, const Simplex& simplex) {
  const auto& [a, b, c] = simplex.corner;
  if (simplex.is_segment) return nearest_on_segment(p, a, b);
  const Vec3 ap = subtract(p, a);
  const double v = dot(ap, simplex.of_second), w = dot(ap, simplex.of_third);
  if (v > 0 && w > 0 && v + w < 1) {
    return add_scaled(add_scaled(a, v, subtract(b, a)), w, subtract(c, a));
  }
  // On a side that p is beyond.
  Vec3 best = a;
  double least = HUGE_VAL;
  const auto see = [&](const Vec3& from, const Vec3& to) {
    const Vec3 q = nearest_on_segment(p, from, to);
    const double d = squared_norm(subtract(p, q));
    if (d >= least) return;
    least = d;
    best = q;
  };
  if (w <= 0) see(a, b);
  if (v <= 0) see(c, a);
  if (v + w >= 1) see(b, c);
  return best;
}

struct Coverage::Polygon {
  std::array<Vec3, kMostCorners> corner;
  std::size_t n = 0;

  void push(const Vec3& p) { corner[n++] = p; }
  std::span<const Vec3> corners() const { return {corner.data(), n}; }
  Vec3 centre() const {
    Vec3 sum{};
    for (const Vec3& p : corners()) sum = geometry::add(sum, p);
    return add_scaled({}, 1.0 / static_cast<double>(n), sum);
  }
  // The part where the heights are not negative, or, with sign -1, not positive.
  Polygon part(std::span<const double> height, double sign) const {
    Polygon result;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const double h = sign * height[i], next = sign * height[j];
      if (h >= 0) result.push(corner[i]);
      if (n == 2 && i == 1) break;
      if ((h > 0 && next < 0) || (h < 0 && next > 0)) {
        result.push(add_scaled(corner[i], h / (h - next), subtract(corner[j], corner[i])));
      }
    }
    return result;
  }
};

Coverage::Coverage(double distance) : distance_(distance), squared_(distance_ * distance_) {}

void Coverage::clear(bool many) {
  candidates_.clear();
  many_ = many;
  ++round_;
}

void Coverage::add(std::uint32_t id, const Simplex& simplex) {
  if (id >= added_.size()) added_.resize(id + 1);
  if (added_[id] == round_) return;
  added_[id] = round_;
  candidates_.push_back({id, &simplex});
}

bool Coverage::is_within(const Polygon& polygon, const Simplex& simplex) const {
  return std::ranges::all_of(polygon.corners(), [&](const Vec3& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (p[i] < simplex.box.lo[i] - distance_ || p[i] > simplex.box.hi[i] + distance_)
        return false;
    }
    return squared_distance(p, simplex) <= squared_;
  });
}

std::size_t Coverage::nearest_to(const Vec3& p) const {
  std::size_t best = candidates_.size();
  double least = squared_;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Simplex& simplex = *candidates_[i].simplex;
    if (geometry::squared_distance(simplex.box, {p, p}) > least) continue;
    const double d = squared_distance(p, simplex);
    if (d > least || (d == least && best != candidates_.size())) continue;
    least = d;
    best = i;
  }
  return best;
}

bool Coverage::covers(const Simplex& simplex, std::size_t most,
                      const std::function<void(const Vec3&)>& more) {
  used_.clear();
  for (Candidate& candidate : candidates_) candidate.used = false;
  pieces_ = 0;
  most_ = kMostPieces * (most + 8);
  Polygon polygon;
  for (std::size_t i = 0; i < (simplex.is_segment ? 2U : 3U); ++i) polygon.push(simplex.corner[i]);
  return covers(polygon, kDepth, more);
}

bool Coverage::covers(const Polygon& polygon, int depth,
                      const std::function<void(const Vec3&)>& more) {
  const Vec3 centre = polygon.centre();
  if (many_) {
    clear(true);
    more(centre);
  }
  for (Candidate& candidate : candidates_) {
    if (!is_within(polygon, *candidate.simplex)) continue;
    if (!candidate.used && !many_) used_.push_back(candidate.id);
    candidate.used = true;
    return true;
  }
  if (depth == 0 || ++pieces_ > most_) return false;
  std::size_t nearest = nearest_to(centre);
  if (nearest == candidates_.size() && !many_) {
    more(centre);
    if (nearest_to(centre) != candidates_.size()) return covers(polygon, depth - 1, more);
  }
  return nearest != candidates_.size() &&
         covers_cut(polygon, *candidates_[nearest].simplex, depth - 1, more);
}

// Along the sides of the simplex, or in the middle if none of them cuts.
bool Coverage::covers_cut(const Polygon& polygon, const Simplex& simplex, int depth,
                          const std::function<void(const Vec3&)>& more) {
  const auto& c = simplex.corner;
  const double least = distance_ / 64;  // no thinner pieces
  Polygon rest = polygon;
  std::vector<Polygon> outside;
  const auto cut = [&](const Vec3& from, const Vec3& inwards) {
    if (rest.n == kMostCorners) return;
    const double length = norm(inwards);
    std::array<double, kMostCorners> height{};
    double low = 0, high = 0;
    for (std::size_t i = 0; i < rest.n; ++i) {
      const double h = dot(inwards, subtract(rest.corner[i], from)) / length;
      height[i] = std::fabs(h) < least ? 0 : h;
      low = std::min(low, height[i]);
      high = std::max(high, height[i]);
    }
    if (!(low < 0 && high > 0)) return;
    outside.push_back(rest.part(height, -1));
    rest = rest.part(height, 1);
  };
  for (std::size_t i = 0; i < (simplex.is_segment ? 2U : 3U); ++i) {
    const Vec3 side = subtract(c[(i + 1) % (simplex.is_segment ? 2 : 3)], c[i]);
    const Vec3 inwards = simplex.is_segment ? side : cross(simplex.normal, side);
    if (squared_norm(inwards) > 0) cut(c[i], inwards);
  }
  if (outside.empty()) {
    std::size_t longest = 0;
    const auto side = [&](std::size_t i) {
      return subtract(rest.corner[(i + 1) % rest.n], rest.corner[i]);
    };
    for (std::size_t i = 1; i < rest.n; ++i) {
      if (squared_norm(side(i)) > squared_norm(side(longest))) longest = i;
    }
    const Vec3 along = side(longest);
    if (!(norm(along) > least)) return false;
    cut(add_scaled(rest.corner[longest], 0.5, along), along);
    if (outside.empty()) return false;
  }
  return covers(rest, depth, more) && std::ranges::all_of(outside, [&](const Polygon& part) {
           return covers(part, depth, more);
         });
}

}  // namespace delmesher::remesh
