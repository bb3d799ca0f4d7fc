// Families that change other surfaces.
#include <algorithm>
#include <cmath>

#include "corpus/generators/approach.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/edits.h"
#include "corpus/generators/families.h"
#include "corpus/generators/rotate.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using namespace shapes;

// A model of the caller's, or a member of one of the other families.
Surface some_surface(FamilyMember& m, int bits) {
  Random& r = m.random;
  if (m.models != nullptr && !m.models->empty()) return (*m.models)[r.below(m.models->size())];
  std::vector<Family> choice = sharp_families();
  for (const Family& f : close_families()) choice.push_back(f);
  for (const Family& f : tied_families()) choice.push_back(f);
  for (int attempt = 0; attempt < 20; ++attempt) {
    FamilyMember other{Random(r.bits()), std::min(m.bits, bits)};
    const Surface s = choice[r.below(choice.size())].make(other);
    if (!s.triangles.empty() && s.triangles.size() < 400 && certified_valid(s)) return s;
  }
  return box({0, 0, 0}, {1, 1, 1});
}

// Moved so far away that few bits are left of its shape.
Surface offset(FamilyMember& m) {
  Random& r = m.random;
  Surface s = some_surface(m, 10);
  Point shift;
  for (double& x : shift)
    x = r.chance(0.7) ? r.sign() * std::ldexp(1 + r.unit(), r.integer(8, 30)) : 0;
  move(s, [&](const Point& p) { return Point{p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]}; });
  return s;
}

// So small, far away, that few doubles lie in it. Candidates that did not survive make it larger.
Surface coarse(FamilyMember& m) {
  const Surface s = some_surface(m, 10);
  return coarsened(s, m.random.integer(1, 30) + (50 - m.bits) / 3, m.random);
}

// Very large, very small, or both in different directions.
Surface scale(FamilyMember& m) {
  Random& r = m.random;
  Surface s = some_surface(m, 16);
  std::array<int, 3> power;
  const int common = r.integer(-6 * m.bits, 6 * m.bits);
  const bool uneven = r.chance(0.4);
  for (int& k : power) k = common + (uneven ? r.integer(-m.bits / 3, m.bits / 3) : 0);
  move(s, [&](const Point& p) {
    return Point{std::ldexp(p[0], power[0]), std::ldexp(p[1], power[1]),
                 std::ldexp(p[2], power[2])};
  });
  return s;
}

// Vertices pulled to within 2^-k of a facet.
Surface damaged(FamilyMember& m) {
  Random& r = m.random;
  Surface s = some_surface(m, 20);
  for (int damage = r.integer(1, 3); damage > 0; --damage) pull_near(s, r, m.bits);
  return s;
}

// Edge flips, splits, collapses, nudges, extrusions and cuts, one after the other.
Surface edited(FamilyMember& m) {
  Random& r = m.random;
  Surface s = some_surface(m, 20);
  for (int i = r.integer(3, 25); i > 0; --i) edit(s, r, m.bits);
  return s;
}

// In another position, so that facets are flat except for rounding, in one of three precisions.
Surface rotated_member(FamilyMember& m) {
  Random& r = m.random;
  const Surface s = some_surface(m, 12);
  Quaternion q;
  for (int& x : q) x = r.integer(1, 9) * (r.chance(0.5) ? 1 : -1);
  constexpr Precision kPrecisions[] = {Precision::doubles, Precision::single, Precision::decimals};
  return rotated(s, q, kPrecisions[r.below(3)]);
}

// Facets that are flat except for noise between an ulp and 2^-16, or except for a vertex that a
// split put at a rounded point.
Surface noisy(FamilyMember& m) {
  Random& r = m.random;
  Surface s = some_surface(m, 12);
  for (int splits = r.integer(0, 8); splits > 0; --splits) {
    const auto t = static_cast<std::uint32_t>(r.below(s.triangles.size()));
    if (r.chance(0.5)) {
      split_at_rounded_point(s, t, r);
    } else {
      split_at_rounded_point(s, t, r.integer(0, 2), r);
    }
  }
  if (r.chance(0.7)) add_noise(s, std::ldexp(1.0, -r.integer(16, 52)), r);
  return s;
}

}  // namespace

std::vector<Family> derived_families() {
  return {
      {"offset", "surfaces moved until few bits of their shape are left", offset},
      {"coarse", "surfaces of 2 to 2^30 roundings of their coordinates, and a few more", coarse},
      {"scale", "surfaces times powers of two, down to 2^-300 and up to 2^300", scale},
      {"damaged", "vertices pulled to within 2^-50 of a facet (see --model)", damaged},
      {"edited", "half-edge edits of other surfaces (see --model)", edited},
      {"rotated", "facets bent by rounding: rotated, to doubles, float32 or six digits",
       rotated_member},
      {"noisy", "facets bent by noise of 2^-52 to 2^-16, or split at rounded points", noisy}};
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> list;
    for (const auto& group :
         {sharp_families(), close_families(), tied_families(), derived_families()}) {
      list.insert(list.end(), group.begin(), group.end());
    }
    return list;
  }();
  return all;
}

const Family* find_family(const std::string& name) {
  for (const auto* group : {&families(), &sampled_families()}) {
    const auto at =
        std::find_if(group->begin(), group->end(), [&](const Family& f) { return name == f.name; });
    if (at != group->end()) return &*at;
  }
  return nullptr;
}

}  // namespace tetproof
