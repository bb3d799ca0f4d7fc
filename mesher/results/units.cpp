#include "mesher/results/units.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <span>

#include "mesher/delmesher/option_table.h"

namespace delmesher::results {
namespace {

// Tenth powers of lengths of ordinary size, and of a 2^-20th of them, are far from the limits.
constexpr int kOrdinary = 64;

using geometry::LocalFrame;
using Point = std::array<double, 3>;

void scale(Point& p, int exponent) {
  for (double& x : p) x = std::ldexp(x, exponent);
}

bool is_exact(std::span<const Point> points, int exponent) {
  return std::all_of(points.begin(), points.end(), [&](const Point& p) {
    return std::all_of(p.begin(), p.end(), [&](double x) {
      return std::ldexp(std::ldexp(x, exponent), -exponent) == x;
    });
  });
}

bool is_exact(const ExactRecord& record, int exponent) {
  const auto point_is_exact = [&](const ExactPoint& p) {
    const Point place = {p.x, p.y, p.z};
    return p.kind != ExactPoint::Kind::explicit_point || is_exact({&place, 1}, exponent);
  };
  const auto corner_is_exact = [&](const ExactRecord::Corner& corner) {
    const Point distance = {corner.distance, 0, 0};
    return is_exact({&distance, 1}, exponent);
  };
  return std::ranges::all_of(record.points, point_is_exact) &&
         std::ranges::all_of(record.corners, corner_is_exact) &&
         std::ranges::all_of(record.planes, [&](const ExactRecord::Plane& plane) {
           return is_exact(plane.through, exponent);
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

Status does_not_fit() {
  return {StatusCode::limit_reached,
          "the model is too large or too small for double precision, and some coordinates do not "
          "fit into other units: scale it",
          Limit::precision};
}

// For models of extreme size whose numbers do not fit into other units. Where the stages steer by
// lengths that over- or underflow, nothing is wrong but that.
template <class Model, class JobOptions, class Run>
auto in_given_units(const Model& model, const JobOptions& given, const Run& run) {
  auto result = run(model, given, 0);
  if (result.status.code == StatusCode::internal_error) result.status = does_not_fit();
  return result;
}

// Messages about defects name coordinates.
template <class AnyResult>
bool names_places(const AnyResult& result) {
  return result.status.code == StatusCode::invalid_surface ||
         result.status.code == StatusCode::invalid_mesh;
}

bool is_exact(const Result& result, int exponent) {
  return is_exact(result.mesh.vertices, exponent) &&
         is_exact(result.chamfered.vertices, exponent) && is_exact(result.exact, exponent);
}
bool is_exact(const RemeshResult& result, int exponent) {
  return is_exact(result.surface.vertices, exponent);
}

void scale(Result& result, int exponent) {
  for (Point& p : result.mesh.vertices) scale(p, exponent);
  for (Point& p : result.chamfered.vertices) scale(p, exponent);
  for (MeshRegion& region : result.regions) {
    region.volume = std::ldexp(region.volume, 3 * exponent);
    region.max_edge = std::ldexp(region.max_edge, exponent);
  }
  scale(result.exact, exponent);
  Statistics& s = result.statistics;
  for (double* length : {&s.bbox_diagonal, &s.chosen_size, &s.tolerance, &s.max_surface_deviation,
                         &s.planar_deviation, &s.planar_bound}) {
    *length = std::ldexp(*length, exponent);
  }
}
void scale(RemeshResult& result, int exponent) {
  for (Point& p : result.surface.vertices) scale(p, exponent);
  result.tolerance = std::ldexp(result.tolerance, exponent);
}

// `run` gets the exponent of its units.
template <class Model, class JobOptions, class Run>
auto scaled_and_back(const Model& model, const JobOptions& given, const Run& run) {
  const int exponent = unit_exponent(model.vertices);
  if (exponent == 0) return run(model, given, 0);
  if (!is_exact(model.vertices, -exponent)) return in_given_units(model, given, run);
  Model scaled = model;
  for (Point& p : scaled.vertices) scale(p, -exponent);
  JobOptions units = given;
  options::scale_lengths(units, -exponent);
  auto result = run(scaled, units, exponent);
  if (names_places(result)) return in_given_units(model, given, run);
  // Points that become subnormal are not.
  if (result.status.ok() && !is_exact(result, exponent)) {
    result = {};
    result.status = does_not_fit();
    return result;
  }
  scale(result, exponent);
  return result;
}

// At the least corner of the bounding box, on the axes on which that is far away.
LocalFrame frame_of(const std::vector<Point>& vertices) {
  constexpr double kFar = 0x1p26;  // nearer to the origin, real models have doubles enough
  constexpr double kApart = 16;    // of the size: differences are exact as far as the outer box
  if (vertices.empty()) return {};
  Point low = vertices[0], high = low;
  for (const Point& p : vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  double size = 0, farthest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    size = std::max(size, high[i] - low[i]);
    farthest = std::max(farthest, std::fabs(low[i]));
  }
  LocalFrame frame;
  if (!(size > 0) || !(farthest >= kFar * size)) return frame;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::fabs(low[i]) >= kApart * size) frame.origin[i] = low[i];
  }
  return frame;
}

bool moves_exactly(Point& p, const LocalFrame& frame) {
  const Point before = p;
  for (std::size_t i = 0; i < 3; ++i) p[i] -= frame.origin[i];
  return frame.given(p) == before;
}

// Beside the origin, and back.
Result moved_and_back(const Surface& surface, const Options& options, Task& task) {
  const auto in_frame = [&](LocalFrame frame) {
    return [&task, frame](const Surface& s, const Options& o, int exponent) {
      LocalFrame scaled = frame;
      scale(scaled.origin, -exponent);
      return task(s, o, scaled);
    };
  };
  const auto as_given = [&] { return scaled_and_back(surface, options, in_frame({})); };
  const LocalFrame frame = frame_of(surface.vertices);
  if (!frame.moved()) return as_given();
  Surface local = surface;
  Options beside = options;
  bool exact = true;
  for (Point& p : local.vertices) exact = exact && moves_exactly(p, frame);
  for (SizeSource& source : beside.size_field) exact = exact && moves_exactly(source.point, frame);
  for (RegionPoint& p : beside.region_points) exact = exact && moves_exactly(p.point, frame);
  if (!exact) return as_given();
  Result result = scaled_and_back(local, beside, in_frame(frame));
  if (names_places(result)) return as_given();
  for (Point& p : result.mesh.vertices) p = frame.given(p);
  for (Point& p : result.chamfered.vertices) p = frame.given(p);
  if (!result.exact.points.empty()) result.exact.origin = frame.origin;
  return result;
}

// The copies, of model and options, are not part of a task: their memory is guarded here.
template <class Run>
auto guarded_run(const Run& run) {
  try {
    return run();
  } catch (const std::bad_alloc&) {
    decltype(run()) result;
    result.status = {StatusCode::limit_reached, "out of memory", Limit::memory};
    return result;
  }
}

}  // namespace

Result in_ordinary_units(const Surface& surface, const Options& options, Task& task) {
  return guarded_run([&] { return moved_and_back(surface, options, task); });
}

Result in_ordinary_units(const TetMesh& mesh, const ImproveOptions& options, MeshTask& task) {
  return guarded_run([&] {
    return scaled_and_back(mesh, options, [&task](const TetMesh& m, const ImproveOptions& o, int) {
      return task(m, o);
    });
  });
}

RemeshResult in_ordinary_units(const Surface& surface, const RemeshOptions& options,
                               RemeshTask& task) {
  return guarded_run([&] {
    return scaled_and_back(
        surface, options,
        [&task](const Surface& s, const RemeshOptions& o, int) { return task(s, o); });
  });
}

}  // namespace delmesher::results
