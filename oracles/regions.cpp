#include "oracles/regions.h"

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "oracles/measures.h"

namespace tetproof::oracles {

double surface_area(const TetComplex& complex, const std::vector<Face>& faces) {
  double sum = 0;
  for (const Face& f : faces) {
    const IntegerVector n = exact::area2(*complex.points, f[0], f[1], f[2]);
    sum += length(n, 2 * complex.points->exponent()) / 2;
  }
  return sum;
}

Regions::Regions(TetComplex& complex, const std::vector<std::int64_t>& regions)
    : complex_(complex), regions_(regions) {
  std::map<std::int64_t, std::array<mpz_class, 2>> volumes;
  exact::Volume6 volume6;
  for (std::size_t t = 0; t < regions.size(); ++t) {
    volumes[regions[t]][complex.inside[t]] += abs(volume6(*complex.points, complex.tetrahedra[t]));
  }
  count_ = volumes.size();
  for (std::size_t t = 0; t < regions.size(); ++t) {
    const auto& [outside, inside] = volumes[regions[t]];
    const std::uint8_t side = inside > outside;
    if (complex.inside[t] != side) strays_.push_back(t);
    complex.inside[t] = side;
  }
}

OracleReport Regions::check_strays(double allowed) const {
  OracleReport report("regions", "tetrahedra");
  report.checked = regions_.size();
  for (const std::size_t t : strays_) {
    if (smallest_altitude(*complex_.points, complex_.tetrahedra[t]) <= allowed) continue;
    report.fail(complex_.tet_name(t) + " is not on the side of the surface where the rest of " +
                "region " + std::to_string(regions_[t]) + " lies");
  }
  report.figures.emplace_back("regions", static_cast<double>(count_));
  report.figures.emplace_back("slivers along the surface", static_cast<double>(strays_.size()));
  return report;
}

bool fills(const TetComplex& complex, const InputSurface& surface, double rounding) {
  mpz_class sum;
  exact::Volume6 volume6;
  for (const Tet& tet : complex.tetrahedra) sum += volume6(*complex.points, tet);
  const mpz_class difference = abs(sum - surface.volume6());
  if (difference * 1000000 <= surface.volume6()) return true;
  const double volume = to_double(difference, 3 * complex.points->exponent()) / 6;
  return volume <= 2 * rounding * surface_area(complex, surface.triangles());
}

}  // namespace tetproof::oracles
