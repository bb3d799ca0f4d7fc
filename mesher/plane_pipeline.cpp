// The order of the stages in the plane (section 3), and nothing else.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/base/validating.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/delmesher_plane.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/enrich.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/mending.h"
#include "mesher/plane/mesh_to_write.h"
#include "mesher/plane/refine.h"
#include "mesher/plane/rounding.h"
#include "mesher/policies/sparing.h"
#include "mesher/results/plane_recorder.h"
#include "mesher/run/options.h"
#include "mesher/run/plane_session.h"

namespace delmesher::plane {
namespace {

Phase phase_of(RefineStep step) {
  static constexpr Phase kPhase[] = {Phase::delaunay, Phase::segments, Phase::refine};
  return kPhase[static_cast<std::size_t>(step)];
}

[[noreturn]] void refuse(const std::string& why) {
  throw Stopped{{StatusCode::invalid_surface, why, Limit::none}};
}

// As written: in the units of the store it is.
bool box_is_finite(const InputGraph& graph, const PointStore& points) {
  for (const VertexId v : {graph.vertices, graph.vertices + 2}) {
    const Vec3 p = points.nearest(v);
    if (!std::isfinite(std::ldexp(p[0], graph.scale)) ||
        !std::isfinite(std::ldexp(p[1], graph.scale))) {
      return false;
    }
  }
  return true;
}

// The graph as all stages see it: valid, and there is something to mesh.
InputGraph check(const PlanarGraph& input, Session& s, Recorder& recorder) {
  s.control.enter(Phase::check);
  InputGraph graph = build_graph(input, s.points, s.predicates, s.control);
  recorder.checked(graph);
  if (s.options.region == Region::interior &&
      std::count(graph.inside.begin(), graph.inside.end(), 1) == 0) {
    refuse("the segments enclose nothing (--region hull meshes the rectangle around them)");
  }
  const bool box_is_seen = s.options.region == Region::hull || s.options.want_exact;
  if (box_is_seen && !box_is_finite(graph, s.points)) {
    refuse("the rectangle around the graph, which is asked for, ends beyond the largest double");
  }
  return graph;
}

// Triangles. Nobody who has many channels, each wide enough to be refined, thinks of so many.
constexpr double kMostInChannels = 5e6;

std::string too_many_in_channels(double predicted) {
  return "about " + std::to_string(static_cast<std::uint64_t>(predicted / 1e6)) +
         " million triangles are predicted in narrow channels between segments: a larger --tau "
         "leaves more of these to the last step, --max-vertices N allows N vertices for them";
}

Chamfered filter_and_chamfer(const InputGraph& graph, Sparing& sparing, Session& s,
                             Recorder& recorder) {
  s.control.enter(Phase::chamfer);
  ChamferOptions options;
  // Right angles and those of 60 degrees are off by rounding; a billionth less does no harm.
  options.cosine_squared = cosine_squared(s.options.acute) * (1 + 1e-9) + 1e-18;
  options.max_radius = std::ldexp(s.options.chamfer_radius, -graph.scale);
  options.tau = s.options.tau;
  options.everywhere = s.options.region == Region::hull;
  Chamfered result = chamfer(graph, s.points, s.predicates, options, sparing.spared(), s.control);
  recorder.chamfered(result);
  // Of wedges and channels of all widths, in the mesh: 1.15 to 1.3 triangles for a square.
  constexpr double kPerSquare = 1.25, kPerVertex = 8;
  if (s.options.tau > 0) {
    const double in_channels = kPerSquare * result.channel_squares;
    if (s.options.max_vertices == 0 && in_channels > kMostInChannels) {
      throw Stopped{{StatusCode::limit_reached, too_many_in_channels(in_channels), Limit::size}};
    }
    s.control.predict(in_channels + kPerVertex * graph.vertices);
  }
  return result;
}

RefinedMesh refine(InputGraph& graph, const Chamfered& chamfered, Session& s) {
  RefineOptions options;
  options.delta = s.options.delta;
  options.max_edge = std::ldexp(s.options.max_edge, -graph.scale);
  options.everywhere = s.options.region == Region::hull;
  options.circumcentres = s.options.as_paper.steiner_point;
  if (s.options.tau > 0) {
    // A channel as narrow as tau allows takes about 4 / tau; neighbours may add to that.
    options.most_splits = 16 * (static_cast<std::uint64_t>(1 / s.options.tau) + graph.vertices);
  }
  options.on_step = [&s](RefineStep step) { s.control.enter(phase_of(step)); };
  return refine(graph, chamfered, s.points, s.predicates, options, s.control);
}

// The input itself, with the vertices of the refined mesh. Gives the attributes of regions.
std::vector<double> enrich(const InputGraph& graph, const Chamfered& chamfered, RefinedMesh& mesh,
                           Session& s) {
  s.control.enter(Phase::enrich);
  enrich(graph, chamfered, mesh.carrier, s.options.as_paper.kept_points, mesh.mesh, s.points,
         s.predicates, s.control);
  if (kValidating) mesh.mesh.validate(true);
  s.control.enter(Phase::classify);
  Faces faces = find_faces(graph, mesh.mesh, s.points, nullptr);
  mesh.side.resize(mesh.mesh.size());
  for (std::size_t t = 0; t < mesh.side.size(); ++t) {
    mesh.side[t] = faces.inside[t] != 0 ? Side::inside : Side::outside;
  }
  return std::move(faces.attributes);
}

RoundedPlane round(const InputGraph& graph, const RefinedMesh& mesh,
                   const std::vector<double>& attributes, Session& s) {
  s.control.enter(Phase::round);
  const MeshToWrite exact = select(mesh.mesh, mesh.side, attributes, s.options.region);
  RoundedPlane rounded = round_plane(graph, exact, s.points, s.control);
  s.control.poll_now(rounded.mesh.vertices.size(), 1);  // small meshes are hardly asked before
  return rounded;
}

void mesh(const PlanarGraph& input, Session& s, Recorder& recorder) {
  InputGraph graph = check(input, s, recorder);

  const std::size_t input_points = s.points.size();
  Sparing sparing;
  for (;;) {
    Chamfered chamfered = filter_and_chamfer(graph, sparing, s, recorder);
    RefinedMesh refined = refine(graph, chamfered, s);
    while (refined.crowded) {
      sparing.spare(graph, refined);
      s.points.truncate(input_points);
      chamfered = filter_and_chamfer(graph, sparing, s, recorder);
      refined = refine(graph, chamfered, s);
    }
    recorder.refined(graph, chamfered, sparing.spared(), refined);

    std::vector<double> attributes;
    if (!s.options.approximate) {
      attributes = enrich(graph, chamfered, refined, s);
      recorder.enriched(graph, refined);
    }
    RoundedPlane rounded = round(graph, refined, attributes, s);
    if (rounded.disturbed.empty() ||
        !sparing.spare_disturbed(graph, chamfered, refined, rounded.disturbed)) {
      recorder.written(graph, std::move(rounded));
      return;
    }
    s.points.truncate(input_points);
  }
}

// Narrow channels and extreme scales may ask for any number of triangles. Unless told otherwise,
// nobody shall wait for a machine that runs out of memory.
std::uint64_t default_limit(const PlanarGraph& graph) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;  // an index
  return std::min(10'000'000 + 64 * static_cast<std::uint64_t>(graph.vertices.size()), kMost);
}

// Of the inside, rounded.
double area_of(const InputGraph& graph, const PointStore& points) {
  double area = 0;
  for (TriangleId t = 0; t < graph.base.size(); ++t) {
    if (graph.inside[t] == 0) continue;
    const auto corner = [&](int i) { return points.nearest(graph.base.origin(edge_of(t, i))); };
    const Vec3 a = corner(0), b = corner(1), c = corner(2);
    area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  return std::ldexp(area, 2 * graph.scale);
}

std::vector<std::string> hints_of(const GraphReport& report) {
  const auto any = [&](GraphDefect kind) {
    return !report.places[static_cast<std::size_t>(kind)].empty();
  };
  std::vector<std::string> hints;
  if (any(GraphDefect::equal_vertices) || any(GraphDefect::no_length)) {
    hints.emplace_back(
        "`delmesher repair` merges vertices at the same place and drops segments without length");
  }
  if (any(GraphDefect::overlap) || any(GraphDefect::crossing)) {
    hints.emplace_back("`delmesher repair` makes a vertex of each crossing and cuts overlaps");
  }
  return hints;
}

}  // namespace
}  // namespace delmesher::plane

namespace delmesher {

PlaneResult triangulate_polygon(const PlanarGraph& graph, const PlaneOptions& options) {
  PlaneResult result;
  auto limits = options::taken_from<Limits>(options);
  if (limits.max_vertices == 0) limits.max_vertices = plane::default_limit(graph);
  base::Control control(limits);
  plane::Session session(options, control);
  plane::Recorder recorder(session, result);
  result.status = base::guarded(control, [&]() -> Status {
    if (const std::string defect = run::options_defect(options); !defect.empty()) {
      return {StatusCode::invalid_options, defect};
    }
    plane::mesh(graph, session, recorder);
    return {};
  });
  recorder.finish();
  return result;
}

const char* defect_name(GraphDefect defect) {
  static constexpr std::array<const char*, kGraphDefects> kNames = {
      "equal vertices", "segment without length", "overlap", "crossing"};
  return kNames[static_cast<std::size_t>(defect)];
}

GraphReport check_graph(const PlanarGraph& graph, const TimeLimit& given) {
  GraphReport report;
  PlaneOptions options;
  static_cast<TimeLimit&>(options) = given;
  const auto limits = options::taken_from<Limits>(options);
  base::Control control(limits);
  report.status = base::guarded(control, [&]() -> Status {
    control.enter(Phase::check);
    plane::check_numbers(graph);
    report.places = plane::defects_of(graph, control);
    report.hints = plane::hints_of(report);
    plane::Session session(options, control);
    PlaneResult unused;
    plane::Recorder recorder(session, unused);
    const plane::InputGraph input = plane::check(graph, session, recorder);
    report.warnings = input.warnings;
    report.bbox_diagonal = input.diagonal;
    report.area = plane::area_of(input, session.points);
    return {};
  });
  return report;
}

GraphRepairResult repair_graph(const PlanarGraph& graph, double weld, const TimeLimit& given) {
  GraphRepairResult result;
  PlaneOptions options;
  static_cast<TimeLimit&>(options) = given;
  const auto limits = options::taken_from<Limits>(options);
  base::Control control(limits);
  result.status = base::guarded(control, [&]() -> Status {
    control.enter(Phase::check);
    plane::check_numbers(graph);
    if (!(weld >= 0) || !std::isfinite(weld)) {
      return {StatusCode::invalid_options, "weld must be at least 0, and finite"};
    }
    result.graph = plane::mended(graph, weld, result.done, control);
    return {};
  });
  return result;
}

}  // namespace delmesher
