#include "oracles/mesh/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "oracles/mesh/measures.h"

namespace tetproof::oracles {

int area_unit(double largest_coordinate) {
  const bool ordinary = largest_coordinate > 0x1p-200 && largest_coordinate < 0x1p200;
  return ordinary || largest_coordinate == 0 ? 0 : std::ilogb(largest_coordinate);
}

// By intervals where these are narrow.
double surface_area(const TetComplex& complex, const std::vector<Face>& faces, int unit) {
  double sum = 0;
  for (const Face& f : faces) {
    const IntervalVector rough = exact::rough_area2(*complex.points, f[0], f[1], f[2]);
    Position n{};
    double width = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      n[axis] = rough[axis].middle();
      width = std::max(width, rough[axis].high - rough[axis].low);
    }
    const double size = std::hypot(n[0], n[1], n[2]);
    const bool known = size > 0x1p-900 && size < HUGE_VAL && width < 0x1p-30 * size;
    sum += (known ? std::ldexp(size, -2 * unit)
                  : length(exact::area2(*complex.points, f[0], f[1], f[2]),
                           2 * (complex.points->exponent() - unit))) /
           2;
  }
  return sum;
}

namespace {

// The absolute values of the numbers that an interval encloses.
Interval magnitude(const Interval& x) {
  const bool finite = x.low - x.low == 0 && x.high - x.high == 0;
  if (!finite) return {0, std::numeric_limits<double>::infinity()};
  if (x.low >= 0) return x;
  if (x.high <= 0) return -x;
  return {0, std::max(-x.low, x.high)};
}

// Volumes by region, outside and inside.
template <class Number, class Volume>
std::map<std::int64_t, std::array<Number, 2>> volumes_of(const TetComplex& complex,
                                                         const std::vector<std::int64_t>& regions,
                                                         const Volume& volume) {
  std::map<std::int64_t, std::array<Number, 2>> volumes;
  for (std::size_t t = 0; t < regions.size(); ++t) {
    Number& sum = volumes[regions[t]][complex.inside[t]];
    sum = sum + volume(complex.tetrahedra[t]);
  }
  return volumes;
}

// Is more of a region inside than outside? Exact volumes are computed only where the two are nearly
// equal. A file of one region is of the inside, or of nothing: in a solid that is thinner than
// roundings more of it may be beside the surface. Its boundary and its volume are judged all the
// same.
std::map<std::int64_t, bool> inside_regions(const TetComplex& complex,
                                            const std::vector<std::int64_t>& regions) {
  if (!regions.empty() && std::ranges::count(regions, regions.front()) == std::ssize(regions)) {
    return {{regions.front(), true}};
  }
  std::map<std::int64_t, bool> result;
  bool certain = true;
  for (const auto& [region, sides] :
       volumes_of<Interval>(complex, regions, [&complex](const Tet& tet) {
         return magnitude(exact::rough_volume6(*complex.points, tet));
       })) {
    const int sign = (sides[1] - sides[0]).sign();
    certain = certain && (sign == 1 || sign == -1);
    result[region] = sign == 1;
  }
  if (certain) return result;
  exact::Volume6 volume6;
  for (const auto& [region, sides] : volumes_of<ExactNumber>(
           complex, regions,
           [&complex, &volume6](const Tet& tet) { return abs(volume6(*complex.points, tet)); })) {
    result[region] = sides[1] > sides[0];
  }
  return result;
}

// Do the tetrahedra certainly have the volume of the solid to within a millionth?
bool clearly_fills(const TetComplex& complex, const InputSurface& surface) {
  Interval sum(0);
  for (const Tet& tet : complex.tetrahedra) {
    sum = sum + exact::rough_volume6(*complex.points, tet);
  }
  const double nearest = surface.volume6().value(3 * complex.points->exponent());
  const Interval volume = Interval::around(nearest, nearest);
  return (volume - magnitude(sum - volume) * Interval(1000000)).sign() == 1;
}

}  // namespace

Regions::Regions(TetComplex& complex, const std::vector<std::int64_t>& regions)
    : complex_(complex), regions_(regions) {
  const std::map<std::int64_t, bool> is_inside = inside_regions(complex, regions);
  count_ = is_inside.size();
  for (std::size_t t = 0; t < regions.size(); ++t) {
    const std::uint8_t side = is_inside.at(regions[t]);
    if (complex.inside[t] != side) strays_.push_back(t);
    complex.inside[t] = side;
  }
}

OracleReport Regions::check_strays(double allowed, const std::vector<std::uint8_t>& called) const {
  OracleReport report("regions", "tetrahedra");
  report.checked = regions_.size();
  for (const std::size_t t : strays_) {
    if (smallest_altitude(*complex_.points, complex_.tetrahedra[t]) <= allowed) continue;
    report.fail(complex_.tet_name(t) + " is not on the side of the surface where the rest of " +
                    "region " + std::to_string(regions_[t]) + " lies",
                complex_.tet_site(t));
  }
  for (std::size_t t = 0; t < called.size(); ++t) {
    if (called[t] == complex_.inside[t]) continue;
    report.fail(
        complex_.tet_name(t) + (called[t] != 0 ? " is called inside, and its region is not"
                                               : " is called outside, and its region is inside"),
        complex_.tet_site(t));
  }
  report.figures.emplace_back("regions", static_cast<double>(count_));
  report.figures.emplace_back("slivers along the surface", static_cast<double>(strays_.size()));
  return report;
}

bool fills(const TetComplex& complex, const InputSurface& surface, double rounding) {
  if (clearly_fills(complex, surface)) return true;
  ExactSum sum;
  exact::Volume6 volume6;
  for (const Tet& tet : complex.tetrahedra) sum += volume6(*complex.points, tet);
  if (within(sum, surface.volume6(), 1000000, surface.volume6())) return true;
  const int unit = area_unit(surface.largest_coordinate());
  const double volume =
      difference(sum, surface.volume6(), 3 * complex.points->exponent() - 2 * unit) / 6;
  return std::fabs(volume) <= 2 * rounding * surface_area(complex, surface.triangles(), unit);
}

}  // namespace tetproof::oracles
