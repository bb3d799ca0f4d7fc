// Families whose angles go to zero.
#include <algorithm>
#include <cmath>

#include "corpus/generators/families.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using namespace shapes;

// A prism over a triangle with one angle about `tiny`, its top shifted along the edge or twisted.
Surface wedge(FamilyMember& m) {
  Random& r = m.random;
  const double angle = r.thin(m.bits), shift = r.chance(0.5) ? 0 : r.between(-2, 2);
  const double reach = r.between(0.3, 1);
  Polygon low = {{0, 0}, {1, 0}, {reach, angle}};
  Polygon high = low;
  for (auto& p : high) p[0] += shift;
  if (r.chance(0.3)) high[2][1] *= r.between(0.5, 2);
  Surface s = tower({low, high}, {0, r.between(0.2, 3)}, [&](int) { return r.chance(0.5); });
  if (r.chance(0.3)) {  // two wedges back to back
    Surface other = s;
    move(other, [&](const Point& p) { return Point{-p[0] - 0.125, p[1], p[2]}; });
    reverse(other);
    append(s, other);
  }
  return s;
}

Surface needle(FamilyMember& m) {
  Random& r = m.random;
  const double width = r.tiny(m.bits);
  const int corners = r.integer(3, 7);
  Polygon low = polygon(corners, [&](int) { return width * r.between(0.5, 1); });
  if (r.chance(0.5)) {
    std::vector<Point> ring;
    for (const auto& [x, y] : low) ring.push_back({x, y, width * r.between(-1, 1)});
    return spindle({0, 0, -r.between(0.1, 1)}, {ring}, {r.between(-1, 1), r.between(-1, 1), 1});
  }
  Polygon high = low;
  for (auto& p : high) p[0] += r.between(-1, 1) * width;
  return tower({low, high}, {0, 1});
}

// A vertex almost in the plane of its neighbours, on both sides.
Surface fan(FamilyMember& m) {
  Random& r = m.random;
  const int spokes = r.integer(3, 24);
  std::vector<Point> ring;
  for (const auto& [x, y] : polygon(spokes, [&](int) { return r.between(0.4, 1); })) {
    ring.push_back({x, y, r.chance(0.3) ? r.sign() * r.tiny(m.bits) : 0});
  }
  const Point top = {r.between(-0.2, 0.2), r.between(-0.2, 0.2), r.tiny(m.bits)};
  return spindle({0, 0, r.chance(0.5) ? -1 : -r.thin(m.bits)}, {ring}, top);
}

Surface cone(FamilyMember& m) {
  Random& r = m.random;
  const int spokes = r.integer(8, 96);
  std::vector<std::vector<Point>> rings(static_cast<std::size_t>(r.integer(1, 2)));
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (const auto& [x, y] : polygon(spokes)) {
      const double radius = 1 - 0.4 * static_cast<double>(i);
      rings[i].push_back({radius * x, radius * y, 0.3 * static_cast<double>(i)});
    }
  }
  // An apex far above, hardly above, or below the base: a cone inside a cone.
  const double height =
      r.chance(0.3) ? -0.5 + r.thin(20) : static_cast<double>(rings.size()) + 4 * r.unit();
  return spindle({0, 0, height < 0 ? -0.75 : -r.thin(m.bits)}, rings, {0, 0, height});
}

// Two poles with many neighbours each, at irregular distances.
Surface valence(FamilyMember& m) {
  Random& r = m.random;
  const int spokes = r.integer(30, 120);
  std::vector<Point> ring;
  const bool spikes = r.chance(0.5);
  const double low = spikes ? std::max(r.tiny(4), 0.05) : 0.8;
  for (const auto& [x, y] : polygon(spokes, [&](int i) { return i % 2 != 0 ? low : 1; })) {
    ring.push_back({x, y, spikes ? 0 : 0.1 * r.unit()});
  }
  const Point top = {0.3 * low * r.unit(), 0, 0.25 + r.unit()};
  return spindle({0, 0.3 * low * r.unit(), -r.thin(5)}, {ring}, top);
}

Surface star(FamilyMember& m) {
  Random& r = m.random;
  const int rounds = r.integer(0, 2);
  const int reach = r.integer(1, std::min(m.bits, 6));
  return sphere(rounds, [&] { return r.tiny(reach); });
}

// Schoenhardt's prism and its relatives: the sides bend inwards until they nearly meet.
Surface schoenhardt(FamilyMember& m) {
  Random& r = m.random;
  const int corners = r.integer(3, 8);
  // A twist of half the polygon's angle makes the diagonals meet on the axis.
  const double limit = 0.5 - 1.0 / corners;
  const double share = 1 - r.tiny(std::min(m.bits, 40));
  const double twist = limit * share;
  Polygon low = polygon(corners);
  Polygon high = polygon(corners, nullptr, twist);
  return tower({low, high}, {0, r.between(0.2, 3)}, [](int) { return true; });
}

Surface twisted_prism(FamilyMember& m) {
  Random& r = m.random;
  const int corners = r.integer(3, 9), levels = r.integer(2, 7);
  std::vector<Polygon> rings;
  std::vector<double> heights;
  double height = 0, turned = 0;
  for (int i = 0; i <= levels; ++i) {
    const double radius = r.between(0.6, 1);
    rings.push_back(polygon(
        corners, [&](int) { return radius; }, turned));
    heights.push_back(height);
    height += r.chance(0.3) ? r.thin(m.bits) : r.between(0.1, 0.5);
    turned += r.between(-0.3, 0.3) / corners;
  }
  return tower(rings, heights, [&](int) { return r.chance(0.5); });
}

// Chazelle's polyhedron: notches from below and from above whose edges come as near as the two
// rulings of the saddles z = x y / 2 n and that plus a gap.
class Notched {
 public:
  Notched(int notches, double width, double gap) : n_(notches), width_(width), gap_(gap) {}

  Surface surface() {
    Surface s;
    side(s, -1, false);
    side(s, -1, true);
    append(s, teeth(false));
    append(s, teeth(true));
    side(s, n_, false);
    side(s, n_, true);
    return welded(s);
  }

 private:
  double deep() const { return -1.0 - n_ / 2.0; }
  double tall() const { return 1.0 + n_ / 2.0; }

  // Corners of the comb seen from the side, in order of the running coordinate, with their heights
  // where the other coordinate is `at`.
  std::vector<Planar> comb(double at, bool upper) const {
    const double base = upper ? tall() : deep();
    std::vector<Planar> line = {{-1, base}};
    for (int i = 0; i < n_; ++i) {
      line.push_back({i - width_, base});
      line.push_back({static_cast<double>(i), i * at / (2 * n_) + (upper ? gap_ : 0)});
      line.push_back({i + width_, base});
    }
    line.push_back({static_cast<double>(n_), base});
    return line;
  }

  // A notched strip between the two combs at -1 and n.
  Surface teeth(bool upper) const {
    Surface s;
    const auto near = comb(-1, upper), far = comb(n_, upper);
    for (std::size_t i = 0; i + 1 < near.size(); ++i) {
      const auto at = [&](const Planar& p, double other) {
        return upper ? Point{p[0], other, p[1]} : Point{other, p[0], p[1]};
      };
      Surface strip;
      strip.vertices = {at(near[i], -1), at(near[i + 1], -1), at(far[i + 1], n_), at(far[i], n_)};
      // Cut from the base corner, so that the sides of a notch bulge into the notch.
      if (i % 3 == 1) {
        strip.triangles = {{0, 1, 2}, {0, 2, 3}};
      } else {
        strip.triangles = {{0, 1, 3}, {1, 2, 3}};
      }
      append(s, strip);
    }
    return s;
  }

  // The wall where one coordinate is `at`: a polygon with the comb on one side.
  void side(Surface& s, double at, bool upper) const {
    Polygon outline = comb(at, upper);
    const double opposite = upper ? deep() : tall();
    outline.push_back({static_cast<double>(n_), opposite});
    outline.push_back({-1, opposite});
    if (upper) std::reverse(outline.begin(), outline.end());
    Surface wall;
    for (const auto& [u, z] : outline) {
      wall.vertices.push_back(upper ? Point{u, at, z} : Point{at, u, z});
    }
    wall.triangles = triangulate(outline);
    // Counter-clockwise in (u, z) faces +x in (y, z) but -y in (x, z).
    if ((at < 0) != upper) reverse(wall);
    append(s, wall);
  }

  int n_;
  double width_, gap_;
};

Surface chazelle(FamilyMember& m) {
  Random& r = m.random;
  const double width = r.between(0.2, 0.4);
  const double gap = r.chance(0.3) ? r.between(0.1, 1) : r.tiny(std::min(m.bits, 40));
  return Notched(r.integer(1, 3), width, gap).surface();
}

}  // namespace

std::vector<Family> sharp_families() {
  return {{"wedge", "prisms with one edge angle down to 2^-50", wedge},
          {"needle", "long pyramids, spindles and prisms", needle},
          {"fan", "vertices almost in the plane of their neighbours", fan},
          {"cone", "cones with many spokes, also inside each other", cone},
          {"valence", "poles with up to 120 neighbours at irregular distances", valence},
          {"star", "spiky star-shaped surfaces", star},
          {"schoenhardt", "Schoenhardt's prism over up to 8 corners, twisted to its limit",
           schoenhardt},
          {"twisted_prism", "prisms twisted level by level, some levels very low", twisted_prism},
          {"chazelle", "Chazelle's notched box, the rulings up to 2^-40 apart", chazelle}};
}

}  // namespace tetproof
