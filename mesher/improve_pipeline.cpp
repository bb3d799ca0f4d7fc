// The improvement of meshes from elsewhere: its steps in their order, and their statistics.
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "mesher/base/control.h"
#include "mesher/base/guarded.h"
#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/geometry/vector.h"
#include "mesher/improve/given_mesh.h"
#include "mesher/improve/improve.h"
#include "mesher/output/statistics.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/results/recorder.h"
#include "mesher/results/units.h"
#include "mesher/run/options.h"
#include "mesher/run/session.h"

namespace delmesher {
namespace {

// The pipeline sees what the results see, so these names need no prefix. Names of stages keep
// theirs.
using namespace results;  // NOLINT(google-build-using-namespace)

using Part = std::pair<std::uint8_t, std::int32_t>;  // inside, and number of the region

std::string sizes_defect(const TetMesh& mesh) {
  const auto differ = [](const auto& list, const char* name, const auto& cells,
                         const char* cell_name) -> std::string {
    if (list.empty() || list.size() == cells.size()) return {};
    return std::to_string(list.size()) + " " + name + " for " + std::to_string(cells.size()) + " " +
           cell_name;
  };
  for (std::string text :
       {differ(mesh.inside, "flags of sides", mesh.tetrahedra, "tetrahedra"),
        differ(mesh.regions, "regions", mesh.tetrahedra, "tetrahedra"),
        differ(mesh.boundary_labels, "labels", mesh.boundary, "boundary triangles"),
        differ(mesh.boundary_facets, "facets", mesh.boundary, "boundary triangles")}) {
    if (!text.empty()) return text;
  }
  return {};
}

// The regions of a mesh, numbered by their first tetrahedra. Each is a part of the inside for the
// improvement, since every tetrahedron counts.
struct GivenRegions {
  explicit GivenRegions(const TetMesh& mesh) {
    std::map<Part, tetmesh::RegionId> ids;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const Part region = {mesh.inside.empty() ? std::uint8_t{1} : mesh.inside[t],
                           mesh.regions.empty() ? 0 : mesh.regions[t]};
      const auto [entry, is_new] =
          ids.try_emplace(region, static_cast<tetmesh::RegionId>(of_id.size()));
      if (is_new) of_id.push_back(region);
      of_tetrahedron.push_back(entry->second);
    }
  }

  std::vector<Part> of_id = {{0, 0}};  // tetmesh::kOutside is none of them
  std::vector<tetmesh::RegionId> of_tetrahedron;
};

double diagonal(const std::vector<Vec3>& vertices) {
  Vec3 low = vertices[0], high = vertices[0];
  for (const Vec3& p : vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return norm(subtract(high, low));
}

MeshStatistics statistics_of(const TetMesh& mesh, Session& s) {
  const auto interior = static_cast<std::uint64_t>(
      std::count_if(mesh.inside.begin(), mesh.inside.end(), [](auto flag) { return flag != 0; }));
  return output::mesh_statistics(mesh.vertices, mesh.tetrahedra, {}, mesh.vertices.size(), interior,
                                 s.control);
}

// The vertices in use in the order in which they were given, then new ones, and tetrahedra of them.
// `became`: the present point of each given vertex.
void take_tetrahedra(tetmesh::ConformingMesh improved, const std::vector<VertexId>& became,
                     const GivenRegions& regions, const PointStore& points, TetMesh& mesh,
                     std::vector<std::uint32_t>& number) {
  std::vector<std::uint8_t> used(points.size(), 0);
  for (const auto& t : improved.tetrahedra) {
    for (const VertexId v : t) used[v] = 1;
  }
  number.assign(points.size(), kNone);
  const auto take = [&](VertexId p) {
    if (used[p] == 0 || number[p] != kNone) return;
    number[p] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(points.nearest(p));
  };
  for (const VertexId p : became) {
    if (p != kNone) take(p);
  }
  for (VertexId p = 0; p < points.size(); ++p) take(p);
  mesh.tetrahedra = std::move(improved.tetrahedra);
  for (auto& t : mesh.tetrahedra) {
    for (VertexId& v : t) v = number[v];
  }
  for (const tetmesh::RegionId id : improved.region) {
    mesh.inside.push_back(regions.of_id[id].first);
    mesh.regions.push_back(regions.of_id[id].second);
  }
}

std::string counted(std::uint64_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

// The conforming mesh that was given, turned if all of it was negative. Warnings tell of oddities.
Status check(const TetMesh& given, const GivenRegions& regions, Session& s, Result& result,
             tetmesh::ConformingMesh& mesh) {
  improve::CheckedMesh checked = improve::check_given(
      {given.vertices, given.tetrahedra, regions.of_tetrahedron, given.boundary}, s.control);
  if (!checked.defect.empty()) return {StatusCode::invalid_mesh, std::move(checked.defect)};
  if (checked.turned) {
    result.warnings.emplace_back("all tetrahedra were negative and have been turned");
  }
  if (checked.flat > 0) {
    result.warnings.push_back("the mesh given has " +
                              counted(checked.flat, "flat tetrahedron", "flat tetrahedra"));
  }
  s.diagonal = result.statistics.bbox_diagonal = diagonal(given.vertices);
  for (const Vec3& p : given.vertices) s.points.add_explicit(p[0], p[1], p[2]);
  mesh = std::move(checked.mesh);
  return {};
}

// The statistics of the mesh as given, without vertices of no tetrahedron.
void measure_given(const TetMesh& given, const tetmesh::ConformingMesh& checked,
                   const GivenRegions& regions, Session& s, Result& result) {
  std::vector<VertexId> same(given.vertices.size());
  for (VertexId v = 0; v < same.size(); ++v) same[v] = v;
  TetMesh used;
  std::vector<std::uint32_t> number;
  take_tetrahedra(checked, same, regions, s.points, used, number);
  if (const std::uint64_t unused = given.vertices.size() - used.vertices.size(); unused > 0) {
    result.warnings.push_back(
        counted(unused, "vertex of no tetrahedron is", "vertices of no tetrahedron are") +
        " dropped");
  }
  result.statistics.refined = statistics_of(used, s);
}

// The improved mesh as it is written; its boundary is the one given.
void take_result(const TetMesh& given, improve::ImproveResult improved, const GivenRegions& regions,
                 const PointStore& points, TetMesh& mesh) {
  std::vector<std::uint32_t> number;
  take_tetrahedra(std::move(improved.mesh), improved.became, regions, points, mesh, number);
  mesh.boundary = given.boundary;
  for (auto& triangle : mesh.boundary) {
    for (std::uint32_t& v : triangle) v = number[improved.became[v]];
  }
  if (given.regions.empty()) mesh.regions.clear();
  mesh.boundary_labels = given.boundary_labels;
  mesh.boundary_labels.resize(mesh.boundary.size());
  mesh.boundary_facets = given.boundary_facets;
  mesh.boundary_facets.resize(mesh.boundary.size());
  mesh.planar_within = given.planar_within;
}

void count_not_positive(const TetMesh& mesh, Statistics& statistics) {
  for (const auto& t : mesh.tetrahedra) {
    const auto at = [&](std::size_t i) -> const Vec3& { return mesh.vertices[t[i]]; };
    const int sign = orient3d_sign(at(0), at(1), at(2), at(3));
    statistics.rounding_flat += sign == 0 ? 1 : 0;
    statistics.rounding_inverted += sign < 0 ? 1 : 0;
  }
}

Status improve_given(const TetMesh& given, Session& s, Result& result) {
  s.control.enter(Phase::check);
  if (std::string defect = sizes_defect(given); !defect.empty()) {
    return {StatusCode::invalid_mesh, std::move(defect)};
  }
  const GivenRegions regions(given);
  tetmesh::ConformingMesh mesh;
  if (Status status = check(given, regions, s, result, mesh); !status.ok()) return status;
  measure_given(given, mesh, regions, s, result);

  s.control.enter(Phase::improve);
  const improve::ImproveOptions options{.delta = s.options.delta,
                                        .max_edge = s.options.max_edge,
                                        .sizes = &s.sizes,
                                        .region = Region::hull};
  improve::ImproveResult improved =
      improve::improve(std::move(mesh), nullptr, {}, options, s.points, s.predicates, s.control);
  s.control.enter(Phase::round);
  take_result(given, std::move(improved), regions, s.points, result.mesh);
  count_not_positive(result.mesh, result.statistics);
  result.statistics.final = statistics_of(result.mesh, s);
  return {};
}

Result run_improvement(const TetMesh& mesh, const ImproveOptions& given) {
  Result result;
  const auto options = options::taken_from<Options>(given);
  Control control(options);
  Session session(options, control);
  Recorder recorder(session, result);
  result.status = guarded(control, [&]() -> Status {
    if (std::string defect = options_defect(given); !defect.empty()) {
      return {StatusCode::invalid_options, std::move(defect)};
    }
    session.sizes = SizeField(options.size_field, options.size_growth);
    return improve_given(mesh, session, result);
  });
  recorder.finish();
  return result;
}

}  // namespace

Result improve_mesh(const TetMesh& mesh, const ImproveOptions& options) {
  return in_ordinary_units(mesh, options, run_improvement);
}

}  // namespace delmesher
