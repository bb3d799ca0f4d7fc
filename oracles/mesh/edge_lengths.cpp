#include "oracles/mesh/edge_lengths.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "oracles/base/distances.h"
#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

OracleReport check(const TetComplex& complex, AngleScope scope, const char* name,
                   const char* option,
                   const std::function<double(std::size_t, Index, Index)>& over) {
  OracleReport report(name, "tetrahedra");
  double largest = 0;
  std::set<std::pair<Index, Index>> too_long;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    ++report.checked;  // there may be none in the region
    if (complex.inside[t] == 0 && scope == AngleScope::solid) continue;
    const Tet& tet = complex.tetrahedra[t];
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        const double here = over(t, tet[i], tet[j]);
        largest = std::max(largest, here);
        if (here <= EdgeSizes::kMost || !too_long.insert(std::minmax(tet[i], tet[j])).second) {
          continue;
        }
        char times[32];
        std::snprintf(times, sizeof times, "%.6g", here);
        report.fail("edge " + complex.vertex_name(tet[j]) + " - " + complex.vertex_name(tet[i]) +
                        " is " + times + " times as long as " + option + " allows",
                    complex.edge_site(tet[j], tet[i]));
      }
    }
  }
  report.figures = {{kTooLong, static_cast<double>(too_long.size())}, {kLargestEdge, largest}};
  return report;
}

}  // namespace

std::vector<OracleReport> check_edge_lengths(const TetComplex& complex, const Promise& promise,
                                             std::span<const double> longest, AngleScope scope) {
  const ExactPoints& points = *complex.points;
  std::vector<OracleReport> reports;
  if (promise.max_edge > 0 || !longest.empty()) {
    const auto over = [&](std::size_t t, Index v, Index w) {
      const double most = longest.empty() ? promise.max_edge : longest[t];
      return most > 0 ? exact::distance(points, v, w) / most : 0;
    };
    reports.push_back(check(complex, scope, "edges", promise.bound_on_edges(), over));
  }
  if (!promise.size_field.empty()) {
    const EdgeSizes sizes(promise.size_field, promise.size_growth);
    const auto over = [&](std::size_t, Index v, Index w) {
      return sizes.excess(points.nearest(v), points.nearest(w));
    };
    reports.push_back(check(complex, scope, "sizes", "--size-field", over));
  }
  return reports;
}

}  // namespace tetproof::oracles
