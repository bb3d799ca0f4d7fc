#include "oracles/record/ordinary_units.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tetproof::oracles {
namespace {

class Scaling {
 public:
  explicit Scaling(int exponent) : exponent_(exponent) {}

  bool exact() const { return exact_; }
  void operator()(double& x) {
    const double scaled = std::ldexp(x, exponent_);
    exact_ = exact_ && std::ldexp(scaled, -exponent_) == x;
    x = scaled;
  }
  void operator()(Position& p) {
    for (double& x : p) (*this)(x);
  }

 private:
  int exponent_;
  bool exact_ = true;
};

void scale(delmesher::ExactRecord& record, Scaling& scaled) {
  using Kind = delmesher::ExactPoint::Kind;
  scaled(record.parameters.tolerance);
  scaled(record.parameters.planar);
  scaled(record.origin);
  for (auto& plane : record.planes) {
    for (auto& point : plane.through) scaled(point);
  }
  for (delmesher::ExactPoint& point : record.points) {
    if (point.kind != Kind::explicit_point) continue;  // parameters have no unit
    scaled(point.x);
    scaled(point.y);
    scaled(point.z);
  }
  for (auto& corner : record.corners) scaled(corner.distance);
}

}  // namespace

std::optional<InOrdinaryUnits> in_ordinary_units(const Polyhedron& input, const MeshFile& mesh,
                                                 const delmesher::ExactRecord* record,
                                                 const Promise& promise) {
  double largest = 0;
  for (const Position& p : input.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  if (!(largest > 0) || !std::isfinite(largest) || (largest > 0x1p-200 && largest < 0x1p200)) {
    return {};
  }
  InOrdinaryUnits result{input, mesh, {}, promise, std::ilogb(largest)};
  Scaling scaled(-result.exponent);
  Scaling volumes(-3 * result.exponent);
  for (Position& p : result.input.vertices) scaled(p);
  for (RegionPoint& region : result.input.region_points) {
    scaled(region.point);
    volumes(region.volume);
  }
  for (Position& p : result.mesh.vertices) scaled(p);
  for (MeshFile::EdgeNode& node : result.mesh.edge_nodes) scaled(node.at);
  for_each_length(result.promise, std::ref(scaled));
  if (record != nullptr) scale(result.record.emplace(*record), scaled);
  if (!scaled.exact() || !volumes.exact()) return {};
  return result;
}

}  // namespace tetproof::oracles
