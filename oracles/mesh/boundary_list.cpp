// Whether a file lists the boundary of its solid (conformity.h).
#include <algorithm>

#include "oracles/mesh/conformity.h"

namespace tetproof::oracles {

OracleReport check_boundary_list(const TetComplex& complex, const Neighbours& neighbours,
                                 const InputSurface& surface, const ConformityResult& conformity,
                                 const std::vector<Face>& listed,
                                 const std::vector<std::int32_t>& labels, bool oriented) {
  OracleReport report("boundary-list", "listed triangles");
  const auto sorted = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<std::pair<Face, Index>> actual;
  for (Index f = 0; f < conformity.faces.size(); ++f) {
    actual.emplace_back(sorted(conformity.faces[f]), f);
  }
  std::sort(actual.begin(), actual.end());
  std::vector<std::uint8_t> found(actual.size(), 0);
  std::vector<Face> hull;
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    if (neighbours.across[i] != kNone || complex.inside[i / 4]) continue;
    hull.push_back(sorted(face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4))));
  }
  std::sort(hull.begin(), hull.end());
  std::uint64_t turned = 0;
  const auto site = [](std::size_t i) {
    return Site{Site::Kind::listed_triangle, {static_cast<Index>(i), 0, 0}};
  };
  for (std::size_t i = 0; i < listed.size(); ++i) {
    ++report.checked;
    const auto at =
        std::lower_bound(actual.begin(), actual.end(), std::pair(sorted(listed[i]), Index{0}));
    if (at == actual.end() || at->first != sorted(listed[i])) {
      if (std::binary_search(hull.begin(), hull.end(), sorted(listed[i]))) continue;
      report.fail("listed triangle " + std::to_string(i) + " is not a boundary face of the solid",
                  site(i));
      continue;
    }
    Face outwards = conformity.faces[at->second];
    while (outwards[0] != listed[i][0])
      std::rotate(outwards.begin(), outwards.begin() + 1, outwards.end());
    turned += outwards != listed[i];
    if (found[at - actual.begin()]++) {
      report.fail("listed triangle " + std::to_string(i) + " is listed twice", site(i));
    }
    const Index facet = conformity.facets[at->second];
    if (!labels.empty() && facet != kNone && surface.facets()[facet].label != labels[i]) {
      report.fail("listed triangle " + std::to_string(i) + " has label " +
                      std::to_string(labels[i]) + ", its facet " +
                      std::to_string(surface.facets()[facet].label),
                  site(i));
    }
  }
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (found[i]) continue;
    const Face& face = actual[i].first;
    report.fail("boundary " + complex.face_name(face) + " is not listed", complex.face_site(face));
  }
  if (turned > 0) report.figures.emplace_back(kTurned, static_cast<double>(turned));
  if (oriented && turned > 0) {
    report.fail(std::to_string(turned) + " listed triangles are seen from inside the solid");
  }
  return report;
}

}  // namespace tetproof::oracles
