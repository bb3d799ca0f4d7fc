#include "oracles/file_step.h"

#include <algorithm>
#include <string>
#include <utility>

#include "oracles/files/edge_nodes.h"
#include "oracles/mesh/conformity.h"
#include "oracles/mesh/edge_lengths.h"
#include "oracles/mesh/loose_points.h"
#include "oracles/verdict/edge_sizes.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {

// Some formats have no convention: there the sign of the majority is the right one. A file with a
// record was written by delmesher, which has one.
void FileStep::turn_all(TetComplex& complex) const {
  if (!mesh_.either_orientation || exact_ != nullptr) return;
  std::int64_t balance = 0;
  for (const auto& [a, b, c, d] : complex.tetrahedra) {
    balance += exact::orient3d(*complex.points, a, b, c, d);
  }
  if (balance >= 0) return;
  for (Tet& tet : complex.tetrahedra) std::swap(tet[2], tet[3]);
}

// Numbers that are not finite are reported by an oracle, as no file may make the verification fail
// otherwise.
bool FileStep::check_finite() {
  OracleReport report("complex", "vertices");
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    ++report.checked;
    if (!is_finite(mesh_.vertices[v])) {
      report.fail("vertex " + std::to_string(v) + " is not finite",
                  {Site::Kind::vertex, {static_cast<Index>(v), 0, 0}});
    }
  }
  if (report.violations == 0) return true;
  add(std::move(report));
  return false;
}

void FileStep::check_contents() {
  if (options_.promised.second_order && !mesh_.has_second_order) {
    report_.unproven.emplace_back(kLinearOnly);
  }
  if (!mesh_.edge_nodes.empty() || (options_.promised.second_order && mesh_.has_second_order)) {
    OracleReport nodes =
        check_edge_nodes(mesh_, options_.declared_deviation * diagonal_, largest_given_);
    // Of a file alone nobody may know with which options it was made.
    if (exact_ != nullptr && !options_.promised.second_order) {
      nodes.fail("the elements are of second order, promised were linear ones");
    }
    add(std::move(nodes));
  }
  const Promise& promised = options_.promised;
  const bool bounds_numbers = promised.max_vertices > 0 || promised.budget > 0;
  if (exact_ == nullptr && (bounds_numbers || mesh_.planar_within > 0)) {
    add(check_written(promised, mesh_.vertices.size(), mesh_.tetrahedra.size(),
                      mesh_.planar_within));
  }
}

bool FileStep::check_tetrahedra(const ExactPoints& points, bool is_part, TetComplex& complex,
                                Neighbours& neighbours) {
  const auto offset = static_cast<Index>(input_.vertices.size());
  complex = {&points, mesh_.tetrahedra, {}, offset, static_cast<Index>(points.size())};
  memory_.done_with(kFileTetrahedra);
  for (Tet& tet : complex.tetrahedra) {
    for (Index& v : tet) v = v < mesh_.vertices.size() ? v + offset : kNone;
  }
  const bool in_range = std::none_of(
      complex.tetrahedra.begin(), complex.tetrahedra.end(),
      [](const Tet& tet) { return *std::max_element(tet.begin(), tet.end()) == kNone; });
  // Neighbours are numbers of faces within tetrahedra, so no tetrahedron may be turned afterwards.
  if (in_range) turn_all(complex);
  OracleReport shape = check_complex(complex, neighbours, is_part);
  const bool hopeless = is_hopeless(shape);
  add(std::move(shape));
  if (!in_range || hopeless) return false;  // the complex oracle has reported it
  OracleReport orientation = check_orientation(complex);
  report_.inverted = static_cast<std::uint64_t>(orientation.figure("inverted").value_or(0));
  report_.flat = static_cast<std::uint64_t>(orientation.figure("flat").value_or(0));
  add(std::move(orientation));
  return true;
}

void FileStep::say_first(const std::string& what, OracleReport& oracle) {
  report_.unproven.push_back(what);
  oracle.only_count();
}

void FileStep::tell_turned(const OracleReport& list, const char* how) {
  const double turned = list.figure(kTurned).value_or(0);
  if (turned == 0 || !list.passed()) return;
  report_.unproven.push_back(std::string("listed triangles are ") + how + " (" +
                             std::to_string(static_cast<std::uint64_t>(turned)) + " are not)");
}

// Others than delmesher promise no such vertices.
void FileStep::check_points(const TetComplex& complex, double near) {
  const Promise& promised = options_.promised;
  if (promised.task == Task::cdt && !promised.keep) return;
  OracleReport points = check_loose_points(input_, mesh_, complex, near);
  if (points.checked == 0) return;
  if (exact_ == nullptr && promised.points.empty() && !promised.all_regions &&
      points.violations > 0) {
    say_first("points of no triangle (" + std::to_string(points.violations) + " are no vertices)",
              points);
  }
  add(std::move(points));
}

// Edges at corners that were cut off and came back are halved afterwards, and those of a surface
// that is kept where need be, unless doubles are too coarse for the halves of flat tetrahedra.
// Those left are said first. Nothing excuses one beside a surface that was to be kept and has no
// such edge.
void FileStep::check_lengths(const TetComplex& complex, std::span<const Face> surface) {
  const double longest = options_.promised.max_edge * EdgeSizes::kMost;
  const bool fine = std::ranges::all_of(surface, [&](const Face& face) {
    const auto& [a, b, c] = face;
    return std::max({exact::distance(*complex.points, a, b), exact::distance(*complex.points, b, c),
                     exact::distance(*complex.points, c, a)}) <= longest;
  });
  check_lengths(complex, std::span<const double>(), fine);
}

void FileStep::check_lengths(const TetComplex& complex, std::span<const double> each, bool fine) {
  const bool keep = options_.promised.keep;
  const bool excusable = !keep || options_.promised.halves;
  for (OracleReport& lengths : check_edge_lengths(complex, options_.promised, each, scope())) {
    const bool edges = lengths.name == "edges";
    if (excusable || !edges || !fine) {
      excuse_long_edges(edges ? options_.promised.bound_on_edges() : "--size-field",
                        keep || exact_ != nullptr, lengths, report_.unproven);
    }
    add(std::move(lengths));
  }
}

}  // namespace tetproof::oracles
