#include "oracles/mesh/measures.h"

#include <algorithm>
#include <cmath>

#include "oracles/mesh/places.h"
#include "oracles/mesh/regions.h"

namespace tetproof::oracles {

double smallest_altitude(const ExactPoints& points, const Tet& tet) {
  const auto& [a, b, c, d] = tet;
  double largest = 0;
  for (int i = 0; i < 4; ++i) {
    const Face face = face_of(tet, i);
    const ExactVector n = exact::area2(points, face[0], face[1], face[2]);
    largest = std::max(largest, length(n, 2 * points.exponent()));
  }
  const double volume =
      std::fabs(to_double(exact::volume6(points, a, b, c, d), 3 * points.exponent()));
  return volume > 0 ? volume / largest : 0;
}

namespace {

bool opposite(const Face& f, const Face& g) {
  for (int i = 0; i < 3; ++i) {
    if (f[0] == g[i]) return f[1] == g[(i + 2) % 3] && f[2] == g[(i + 1) % 3];
  }
  return false;
}

}  // namespace

ExactSum sum_of_volumes6(const TetComplex& complex, const Neighbours& neighbours,
                         const std::vector<std::uint8_t>& selected) {
  const auto& tets = complex.tetrahedra;
  const auto& across = neighbours.across;
  std::vector<Face> alone;
  for (Index t = 0; t < tets.size(); ++t) {
    if (!selected.empty() && selected[t] == 0) continue;
    for (int i = 0; i < 4; ++i) {
      const Index here = 4 * t + static_cast<Index>(i), other = across[here];
      const bool paired =
          other != kNone && across[other] == here && (selected.empty() || selected[other / 4] != 0);
      if (paired && other < here) continue;
      const Face face = face_of(tets[t], i);
      if (!paired) {
        alone.push_back(face);
        continue;
      }
      const Face back = face_of(tets[other / 4], static_cast<int>(other % 4));
      if (opposite(face, back)) continue;
      alone.push_back(face);
      alone.push_back(back);
    }
  }
  return sum_from_origin6(*complex.points, alone);
}

OracleReport check_volume(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, double allowed) {
  OracleReport report("volume", "tetrahedra inside");
  for (const std::uint8_t inside : complex.inside) report.checked += inside;
  const ExactSum sum = sum_of_volumes6(complex, neighbours, complex.inside);
  const int unit = 2 * area_unit(surface.largest_coordinate());
  const long exponent = 3 * complex.points->exponent() - unit;
  const double volume = surface.volume6().value(exponent) / 6;
  if (unit != 0) {
    report.notes.push_back("volumes are in units of 2^" + std::to_string(unit));
  }
  if (!(sum == surface.volume6())) {
    const double excess = difference(sum, surface.volume6(), exponent) / 6;
    char text[128];
    std::snprintf(
        text, sizeof text,
        "the tetrahedra inside have a volume that differs by %.3g from the surface's %.6g", excess,
        volume);
    if (allowed == 0 || !(std::fabs(excess) <= allowed)) report.fail(text);
    report.figures.emplace_back("difference", excess);
    report.figures.emplace_back("allowed", allowed);
  }
  report.figures.emplace_back("volume", volume);
  return report;
}

std::vector<std::uint8_t> inside_by_parity(const TetComplex& complex, const InputSurface& surface) {
  std::vector<std::uint8_t> inside(complex.tetrahedra.size());
  for (std::size_t t = 0; t < inside.size(); ++t) {
    inside[t] = surface.inside(*complex.points, complex.tetrahedra[t]) == 1;
  }
  return inside;
}

OracleReport check_interior(const TetComplex& complex, const Neighbours& neighbours,
                            const InputSurface& surface, const std::vector<std::uint8_t>& walls) {
  OracleReport report("interior", "tetrahedra");
  std::vector<std::uint8_t> open(complex.tetrahedra.size());
  for (std::size_t t = 0; t < open.size(); ++t) {
    const auto& [a, b, c, d] = complex.tetrahedra[t];
    const bool positive = exact::orient3d(*complex.points, a, b, c, d) > 0;
    open[t] = positive ? static_cast<std::uint8_t>(~walls[t]) : 0;
  }
  const std::vector<Index> group = groups_over(neighbours, open);
  std::vector<std::int8_t> parities(open.size());
  std::uint64_t inside = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    if (group[t] == t) {
      parities[t] =
          static_cast<std::int8_t>(surface.inside(*complex.points, complex.tetrahedra[t]));
    }
    const int parity = parities[t] = parities[group[t]];
    ++report.checked;
    inside += complex.inside[t];
    if (parity == -1) {
      report.fail(complex.tet_name(t) + " has its centroid on the surface", complex.tet_site(t));
    } else if (parity != complex.inside[t]) {
      report.fail(complex.tet_name(t) + " is called " + (complex.inside[t] ? "inside" : "outside") +
                      " but its centroid is not",
                  complex.tet_site(t));
    }
  }
  report.figures.emplace_back("inside", inside);
  return report;
}

}  // namespace tetproof::oracles
