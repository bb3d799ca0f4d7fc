// Families whose distances go to zero.
#include <algorithm>
#include <cmath>

#include "corpus/generators/families.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using namespace shapes;

// A slab with irregular grids above and below, flat, wavy or bent.
Surface plate(FamilyMember& m) {
  Random& r = m.random;
  const int n = r.integer(1, 6);
  const double thickness = r.thin(m.bits);
  const double waves = r.chance(0.5) ? 0 : r.between(0, 0.3);
  const int kind = r.integer(0, 2);
  std::vector<double> base(static_cast<std::size_t>((n + 1) * (n + 1)), 0);
  for (double& z : base) {
    if (kind == 1) z = waves * r.unit();
  }
  const auto at = [&](int x, int y) { return base[static_cast<std::size_t>(y * (n + 1) + x)]; };
  Surface s = slab(n, at, [&](int x, int y) { return at(x, y) + thickness; });
  if (kind == 2) {
    move(s, [&](const Point& p) {
      return Point{p[0], p[1], p[2] + waves * p[0] * p[0] + waves * p[0] * p[1]};
    });
  }
  return s;
}

// Two blocks, or the two legs of one, with a thin gap between them.
Surface gap(FamilyMember& m) {
  Random& r = m.random;
  const double width = r.thin(m.bits);
  if (r.chance(0.4)) {
    const double reach = r.between(0.2, 0.9);
    return extrude({{0, 0},
                    {1, 0},
                    {1, 0.5},
                    {1 - reach, 0.5},
                    {1 - reach, 0.5 + width},
                    {1, 0.5 + width},
                    {1, 1 + width},
                    {0, 1 + width}},
                   0, r.between(0.1, 1));
  }
  const int n = r.integer(1, 4);
  const bool rough = r.chance(0.5);
  const auto roughness = [&](int, int) { return rough ? 0.2 * r.unit() : 0; };
  Surface s = slab(
      n, [](int, int) { return -1; }, roughness);
  Surface other = slab(
      r.chance(0.5) ? n : n + 1, [&](int, int) { return (rough ? 0.2 : 0) + width; },
      [](int, int) { return 2; });
  const double shift = r.chance(0.5) ? 0 : r.between(-0.5, 0.5);
  move(other, [&](const Point& p) { return Point{p[0] + shift, p[1], p[2]}; });
  append(s, other);
  return s;
}

// Shells inside each other, alternately solid and hollow.
Surface cavities(FamilyMember& m) {
  Random& r = m.random;
  const int shells = r.integer(2, 5);
  const bool boxes = r.chance(0.4);
  const Surface shape = boxes ? box({-1, -1, -1}, {1, 1, 1})
                              : sphere(r.integer(0, 1), [&] { return r.between(0.6, 1); });
  Surface s;
  double scale = 1;
  for (int i = 0; i < shells; ++i) {
    Surface shell = shape;
    move(shell, [&](const Point& p) { return Point{p[0] * scale, p[1] * scale, p[2] * scale}; });
    // Some are left as they are, because parity decides the orientation of components.
    if (i % 2 != 0 && r.chance(0.8)) reverse(shell);
    append(s, shell);
    scale *= r.chance(0.4) ? r.between(0.4, 0.8) : 1 - r.thin(m.bits);
  }
  return s;
}

// A wall wound up several times.
Surface spiral(FamilyMember& m) {
  Random& r = m.random;
  const int corners = r.integer(12, 60);
  const double turns = r.between(1, 3);
  const double thickness = r.chance(0.5) ? 1 - r.thin(m.bits) : r.thin(m.bits);
  Polygon inner, outer;
  for (int i = 0; i < corners; ++i) {
    const double at = turns * i / corners;
    const auto [x, y] = circle(at);
    inner.push_back({(1 + at) * x, (1 + at) * y});
    outer.push_back({(1 + at + 0.7 * thickness) * x, (1 + at + 0.7 * thickness) * y});
  }
  Polygon outline = outer;
  outline.insert(outline.end(), inner.rbegin(), inner.rend());
  Surface s = extrude(outline, 0, r.between(0.1, 2));
  if (r.chance(0.3)) move(s, [&](const Point& p) { return Point{p[0], p[1], p[2] + 0.25 * p[0]}; });
  return s;
}

// Two or more parts, the nearest points of which are one (or a few) doubles apart.
Surface ulp_parts(FamilyMember& m) {
  Random& r = m.random;
  const int steps = r.chance(0.6) ? 1 : r.integer(2, 9);
  const double x = r.chance(0.5) ? 1 : r.between(0.1, 3);
  Surface s;
  switch (r.integer(0, 3)) {
    case 0: {  // face to face, shifted or not
      append(s, box({0, 0, 0}, {x, 1, 1}));
      const double y = r.chance(0.5) ? 0 : r.between(-0.5, 0.5);
      append(s, box({ulps_away(x, steps), y, y}, {x + 1, y + 1, r.between(1, 2)}));
      break;
    }
    case 1:  // edge to edge
      append(s, box({0, 0, 0}, {x, x, 1}));
      append(s,
             box({ulps_away(x, steps), ulps_away(x, r.integer(0, steps)), 0}, {x + 1, x + 1, 1}));
      break;
    case 2: {  // corner to face
      append(s, box({0, 0, 0}, {x, 1, 1}));
      const double y = r.between(0, 1), z = r.between(0, 1);
      append(s, tetrahedron({ulps_away(x, steps), y, z}, {x + 1, y - 0.5, z},
                            {x + 1, y + 0.25, z + 0.5}, {x + 1, y + 0.25, z - 0.5}));
      break;
    }
    default:  // corner to corner
      append(s, tetrahedron({x, x, x}, {0, 0, 0}, {0, r.unit(), 1}, {0, 1, r.unit() - 1}));
      append(s, tetrahedron({ulps_away(x, steps), ulps_away(x, r.integer(-1, 1)), x}, {4, 0, 0.5},
                            {5, 2, 0}, {4, 1, 3}));
      break;
  }
  return s;
}

// A box whose faces are grids, the inner corners some doubles off the plane.
Surface ulp_grid(FamilyMember& m) {
  Random& r = m.random;
  const int n = r.integer(2, 5), steps = r.integer(1, 4);
  const double height = r.chance(0.5) ? 1 : r.between(0.2, 2);
  const auto nudged = [&](double z) {
    return [&, z](int x, int y) {
      const bool inner = x > 0 && y > 0 && x < n && y < n;
      return inner ? ulps_away(z, r.integer(-steps, steps)) : z;
    };
  };
  Surface s = slab(n, nudged(1), nudged(1 + height));
  if (r.chance(0.5)) {
    move(s, [&](const Point& p) {
      const bool inner = p[0] > 0 && p[1] > 0 && p[0] < 1 && p[1] < 1;
      return inner ? Point{ulps_away(p[0], r.integer(-steps, steps)), p[1], p[2]} : p;
    });
  }
  return s;
}

}  // namespace

std::vector<Family> close_families() {
  return {{"plate", "slabs down to 2^-50 thick, flat, wavy and bent", plate},
          {"gap", "blocks and slots down to 2^-50 apart", gap},
          {"cavities", "shells inside each other, down to 2^-50 apart", cavities},
          {"spiral", "wound walls, thin or nearly touching", spiral},
          {"ulp_parts", "parts a few doubles apart: faces, edges, corners", ulp_parts},
          {"ulp_grid", "faces of many corners a few doubles off their plane", ulp_grid}};
}

}  // namespace tetproof
