#include "mesher/results/units.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace delmesher::results {
namespace {

// Tenth powers of lengths of ordinary size, and of a 2^-20th of them, are far from the limits.
constexpr int kOrdinary = 64;
// Coordinates in small units must not become subnormal in the given ones.
constexpr int kSmallest = -700;

using Point = std::array<double, 3>;

void scale(Point& p, int exponent) {
  for (double& x : p) x = std::ldexp(x, exponent);
}

bool is_exact(const std::vector<Point>& points, int exponent) {
  return std::all_of(points.begin(), points.end(), [&](const Point& p) {
    return std::all_of(p.begin(), p.end(), [&](double x) {
      return std::ldexp(std::ldexp(x, exponent), -exponent) == x;
    });
  });
}

void scale(ExactRecord& record, int exponent) {
  for (ExactPoint& p : record.points) {
    if (p.kind != ExactPoint::Kind::explicit_point) continue;
    p.x = std::ldexp(p.x, exponent);
    p.y = std::ldexp(p.y, exponent);
    p.z = std::ldexp(p.z, exponent);
  }
  for (ExactRecord::Plane& plane : record.planes) {
    for (Point& p : plane.through) scale(p, exponent);
  }
  record.parameters.tolerance = std::ldexp(record.parameters.tolerance, exponent);
  record.parameters.planar = std::ldexp(record.parameters.planar, exponent);
  for (ExactRecord::Corner& corner : record.corners) {
    corner.distance = std::ldexp(corner.distance, exponent);
  }
}

// 0 for models of ordinary size.
int unit_exponent(const std::vector<Point>& vertices) {
  double largest = 0;
  for (const Point& p : vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  if (!(largest > 0) || !std::isfinite(largest)) return 0;
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::abs(exponent) <= kOrdinary ? 0 : exponent;
}

// For models of extreme size whose numbers do not fit into other units. Where the stages steer by
// lengths that over- or underflow, nothing is wrong but that.
template <class Model>
Result in_given_units(const Model& model, const Options& options,
                      Result (&task)(const Model&, const Options&)) {
  Result result = task(model, options);
  if (result.status.code == StatusCode::internal_error) {
    result.status = {StatusCode::limit_reached,
                     "the model is too large or too small for double precision, and some "
                     "coordinates do not fit into other units (" +
                         result.status.message + ")",
                     Limit::precision};
  }
  return result;
}

template <class Model>
Result scaled_and_back(const Model& model, const Options& options,
                       Result (&task)(const Model&, const Options&)) {
  const int exponent = unit_exponent(model.vertices);
  if (exponent == 0) return task(model, options);
  if (exponent < kSmallest || !is_exact(model.vertices, -exponent)) {
    return in_given_units(model, options, task);
  }
  Model scaled = model;
  for (Point& p : scaled.vertices) scale(p, -exponent);
  Options units = options;
  units.max_edge = std::ldexp(options.max_edge, -exponent);
  units.chamfer_radius = std::ldexp(options.chamfer_radius, -exponent);
  for (SizeSource& source : units.size_field) {
    scale(source.point, -exponent);
    source.size = std::ldexp(source.size, -exponent);
  }
  Result result = task(scaled, units);
  // Messages about defects name coordinates; points that become subnormal are not exact.
  if (result.status.code == StatusCode::invalid_surface ||
      result.status.code == StatusCode::invalid_mesh || !is_exact(result.mesh.vertices, exponent)) {
    return in_given_units(model, options, task);
  }
  for (Point& p : result.mesh.vertices) scale(p, exponent);
  for (Point& p : result.chamfered.vertices) scale(p, exponent);
  scale(result.exact, exponent);
  Statistics& s = result.statistics;
  s.bbox_diagonal = std::ldexp(s.bbox_diagonal, exponent);
  s.max_surface_deviation = std::ldexp(s.max_surface_deviation, exponent);
  s.planar_deviation = std::ldexp(s.planar_deviation, exponent);
  s.planar_bound = std::ldexp(s.planar_bound, exponent);
  return result;
}

// The copies, of model and options, are no part of a task: their memory is guarded here.
template <class Model>
Result guarded_task(const Model& model, const Options& options,
                    Result (&task)(const Model&, const Options&)) {
  try {
    return scaled_and_back(model, options, task);
  } catch (const std::bad_alloc&) {
    Result result;
    result.status = {StatusCode::limit_reached, "out of memory", Limit::memory};
    return result;
  }
}

}  // namespace

Result in_ordinary_units(const Surface& surface, const Options& options, Task& task) {
  return guarded_task(surface, options, task);
}

Result in_ordinary_units(const TetMesh& mesh, const Options& options, MeshTask& task) {
  return guarded_task(mesh, options, task);
}

}  // namespace delmesher::results
