#include "oracles/record/record_origin.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "oracles/base/box.h"

namespace tetproof::oracles {
namespace {

// Is x - origin a double? By the error of the difference (Knuth).
bool move(double& x, double origin) {
  const double difference = x - origin, back = difference - x;
  const double error = (x - (difference - back)) - (origin + back);
  x = difference;
  return std::isfinite(difference) && error == 0;
}

// Only a surface that is far away is meshed beside an origin, which is then beside it. From
// anywhere else the coordinates would be larger than those given, and so what counts as their
// rounding.
void check_place(const Polyhedron& input, const Position& origin, OracleReport& report) {
  constexpr double kFar = 0x1p26;  // times its size: mesher/io/exact_format.md
  if (input.vertices.empty()) return;
  const Box box = box_of(input.vertices);
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    size = std::max(size, box.high[i] - box.low[i]);
    if (origin[i] != 0 && !(box.low[i] <= origin[i] && origin[i] <= box.high[i])) {
      report.fail("the origin of the record is not beside the input");
      return;
    }
  }
  if (!(box.largest() >= kFar * size)) {
    report.fail("the record names an origin, and the input is near 0 for its size");
  }
}

}  // namespace

bool names_origin(const delmesher::ExactRecord& record) {
  return std::ranges::any_of(record.origin, [](double x) { return x != 0; });
}

OracleReport move_to_origin(BesideOrigin& task) {
  OracleReport report("frame", "points of input and file");
  const Position origin = task.record.origin;
  check_place(task.input, origin, report);
  const auto take = [&](Position& p, const std::string& what) {
    ++report.checked;
    bool exact = true;
    for (std::size_t i = 0; i < 3; ++i) exact = move(p[i], origin[i]) && exact;
    if (!exact) report.fail(what + " is not a double relative to the origin of the record");
  };
  for (std::size_t v = 0; v < task.input.vertices.size(); ++v) {
    for (const double x : task.input.vertices[v]) {
      task.largest = std::max(task.largest, std::fabs(x));
    }
    take(task.input.vertices[v], "input vertex " + std::to_string(v));
  }
  for (std::size_t v = 0; v < task.mesh.vertices.size(); ++v) {
    take(task.mesh.vertices[v], "vertex " + std::to_string(v) + " of the file");
  }
  for (MeshFile::EdgeNode& node : task.mesh.edge_nodes) take(node.at, "a node of the file");
  for (delmesher::SizeSource& source : task.promise.size_field) take(source.point, "a size");
  report.notes.emplace_back("places that other oracles name are relative to it");
  return report;
}

}  // namespace tetproof::oracles
