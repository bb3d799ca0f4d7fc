#include "mesher/cli/run.h"

#include <new>

#include "mesher/cli/defects.h"
#include "mesher/cli/improve_run.h"
#include "mesher/cli/plane_run.h"
#include "mesher/cli/quality.h"
#include "mesher/cli/repair_run.h"
#include "mesher/cli/run_steps.h"
#include "mesher/io/exact_file.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/write_mesh.h"
#include "mesher/surface/hints.h"

namespace delmesher::cli {
namespace {

class Runner : RunSteps {
 public:
  Runner(const Command& command, const Library& library, const Streams& streams)
      : RunSteps(command, library, streams) {}

  int run();

 private:
  int read();
  int label_by_angle();
  int add_points();
  int check();
  int mesh();
  int remesh();
  int write_surface_defects(const SurfaceReport& report) const;
  void count_defects(Status& status) const;
  io::WriteStatus write_all(io::OutputSet& outputs, const Result& result) const;

  Surface surface_;
  io::LabelNames names_;
  std::vector<RegionPoint> region_points_;
};

int Runner::read() {
  io::ReadOptions options;
  options.go_on = goes_on();
  io::ReadResult input = io::read_surface(command_.input, options);
  if (!input.ok()) return fail_reading(input.code, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  surface_ = std::move(input.surface);
  names_ = std::move(input.names);
  region_points_ = std::move(input.region_points);
  note_input(input.format, surface_.vertices.size(), surface_.triangles.size(), "triangles");
  for (const std::string& note : input.notes) tell(command_.input + ": " + note);
  int code = label_by_angle();
  if (code == kDone) code = add_points();
  return code == kDone ? read_beside(names_, surface_.labels) : code;
}

// What is not a surface keeps its labels: the job says why it is not one.
int Runner::label_by_angle() {
  if (command_.label_angle == 0) return kDone;
  const Status status = delmesher::label_by_angle(surface_, command_.label_angle);
  if (status.code == StatusCode::invalid_surface) return kDone;
  if (!status.ok()) {
    return fail_input(exit_code_of(status.code), "--label-by-angle: " + status.message);
  }
  names_.clear();
  for (const std::int32_t label : surface_.labels) {
    names_.try_emplace(label, "face_" + std::to_string(label));
  }
  remark(command_.input + ": " + std::to_string(names_.size()) + " faces by angle");
  return kDone;
}

// Vertices that no triangle has become vertices of the mesh.
int Runner::add_points() {
  if (command_.points_file.empty()) return kDone;
  io::PointsResult read = io::read_points(command_.points_file);
  if (!read.ok()) return fail(kUnreadable, read.error);
  surface_.vertices.insert(surface_.vertices.end(), read.points.begin(), read.points.end());
  return kDone;
}

int Runner::check() {
  const SurfaceReport report = check_surface(surface_, true, region_points_);
  const StatusCode code = report.status.code;
  if (code == StatusCode::ok || code == StatusCode::invalid_surface) {
    streams_.out(command_.json ? check_json(command_.input, surface_, names_, report)
                               : check_text(command_.input, surface_, names_, report));
  }
  if (!command_.defects_file.empty() &&
      (code == StatusCode::ok || code == StatusCode::invalid_surface)) {
    const int written = write_surface_defects(report);
    if (written != kDone) return written;
  }
  if (code == StatusCode::ok) return kDone;
  return fail_input(exit_code_of(code), report.status.message);
}

int Runner::write_surface_defects(const SurfaceReport& report) const {
  const bool vtu = defects_format(command_.defects_file) == DefectsFormat::vtu;
  return write_defects(vtu ? defects_vtu(surface_, report) : coloured_ply(surface_, report),
                       std::string("the surface, ") +
                           (vtu && !surface_.labels.empty() ? "with its labels, " : "") +
                           "coloured by what is wrong; " +
                           (vtu ? "ParaView opens it" : "MeshLab and Blender open it"));
}

// Counts the defects by kind; the library stops at the first.
void Runner::count_defects(Status& status) const {
  if (status.code != StatusCode::invalid_surface || !library_.check_surface) return;
  const SurfaceReport report = check_surface(surface_);
  const std::string line = surface::defects_line(report);
  if (report.status.code != StatusCode::invalid_surface || line.empty()) return;
  status.message += " (in all " + line;
  for (const surface::Contact& contact : surface::contacts(surface_, report))
    status.message += ": " + contact.what;
  const auto* options = std::get_if<Options>(&command_.options);
  if (options != nullptr && options->regions != Regions::solid &&
      report.defect_counts[static_cast<std::size_t>(Defect::Kind::self_intersection)] > 0) {
    status.message += "; `tetproof union --walls` cuts them along each other";
  }
  status.message += "; see delmesher check)";
}

io::WriteStatus Runner::write_all(io::OutputSet& outputs, const Result& result) const {
  io::WriteStatus status;
  io::WriteOptions write = command_.write;
  write.region_names = region_names(result.regions, names_);
  io::LabelNames names = names_;
  names.insert(result.wall_names.begin(), result.wall_names.end());
  for (const std::string& output : command_.outputs) {
    status = warned(io::write_mesh(outputs, output, result.mesh, names, write));
    if (!status.ok()) return status;
  }
  if (!command_.chamfered_file.empty()) {
    status = io::write_off(outputs, command_.chamfered_file, result.chamfered);
  }
  if (status.ok() && !command_.exact_file.empty()) {
    status = io::write_exact(outputs, command_.exact_file, result.exact);
  }
  return status;
}

int Runner::mesh() {
  const auto* options = std::get_if<Options>(&command_.options);  // else those of cdt
  if (options == nullptr || options->regions == Regions::solid) ignore(region_points_);
  Result result = options != nullptr
                      ? call(*options,
                             [&](Options& o) {
                               o.label_names = names_;  // by which regions are chosen
                               o.region_points = region_points_;
                               return library_.tetrahedralize(surface_, o);
                             })
                      : call(std::get<CdtOptions>(command_.options), [&](const CdtOptions& o) {
                          return library_.constrained_delaunay(surface_, o);
                        });
  note_interruption(result.status);
  count_defects(result.status);
  const Statistics& s = result.statistics;
  if (options != nullptr && s.planar_groups > 0) {
    const bool as_given = options->planar == 0 || s.diagonals > 0;
    // More than any surface may be off: coordinates are rounded coarsely, or noisy.
    const bool far = options->planar == kPlanarAuto && !as_given &&
                     s.planar_deviation > 0x1p-19 * s.bbox_diagonal;
    const std::string text = planar_text(command_.input, s, as_given);
    far ? say(text) : remark(text);
  }
  if (!result.regions.empty()) {
    remark(regions_text(command_.input, result.regions, region_names(result.regions, names_)));
  }
  if (s.remeshed_triangles > 0) {
    remark(command_.input + ": " +
           remeshed_text(surface_.triangles.size(), s.remeshed_triangles, s.tolerance));
  }
  const std::uint64_t budget = options == nullptr ? 0 : options->budget;
  if (s.ladder[Rung::keep_surface] > 0) {
    const bool bounds_edges = options != nullptr && (bound_on_edges(*options) > 0 ||
                                                     !sizes_.empty() || s.chosen_size > 0);
    remark(kept_text(command_.input, s, bounds_edges, budget));
  }
  for (const std::string& limit : limits_texts(s)) tell(command_.input + ": " + limit);
  // The constrained Delaunay tetrahedrization promises no angles, and a kept surface none of faces.
  if (result.status.ok() && options != nullptr) {
    const bool kept = options->surface == SurfaceChoice::keep ||
                      options->regions != Regions::solid || s.ladder[Rung::keep_surface] > 0;
    for (std::string& warning : quality_warnings(result, kept ? 0 : options->delta)) {
      result.warnings.push_back(std::move(warning));
    }
    for (std::string& warning : edge_warnings(result, *options, sizes_, names_)) {
      result.warnings.push_back(std::move(warning));
    }
  }
  return finish({result.status, result.warnings,
                 [&](io::OutputSet& outputs) { return write_all(outputs, result); },
                 [&] { return stats_json(command_, result, facts_); },
                 [&] {
                   return conclude(s.phase_seconds,
                                   {result.mesh.vertices.size(), result.mesh.tetrahedra.size(),
                                    s.rounding_inverted, s.rounding_flat, "tetrahedra",
                                    quality_text(result) + size_text(s, budget)});
                 }});
}

int Runner::remesh() {
  ignore(region_points_);
  RemeshResult result =
      call(std::get<RemeshOptions>(command_.options),
           [&](const RemeshOptions& o) { return library_.remesh_surface(surface_, o); });
  note_interruption(result.status);
  count_defects(result.status);
  for (const std::string& warning : result.warnings) warn(warning);
  if (!result.status.ok()) {
    return fail_input(exit_code_of(result.status.code), result.status.message);
  }
  if (const int code = write_surfaces(result.surface, names_); code != kDone) return code;
  say(command_.outputs.front() + ": " +
      remeshed_text(surface_.triangles.size(), result.surface.triangles.size(), result.tolerance));
  return kDone;
}

int Runner::run() {
  note_files_in_place(false);
  try {
    if (command_.job() == Job::plane) return run_plane(command_, library_, streams_);
    const bool takes_graphs = command_.job() == Job::check || command_.job() == Job::repair;
    if (takes_graphs && io::is_plane_file(command_.input)) {
      return run_graph(command_, library_, streams_);
    }
    if (command_.job() == Job::repair) return run_repair(command_, library_, streams_);
    if (command_.job() == Job::improve) return run_improve(command_, library_, streams_);
    const bool remeshes = command_.job() == Job::remesh;
    int code = check_outputs(remeshes ? io::boundary_files_of : io::mesh_files_of);
    if (code == kDone) code = read();
    if (code != kDone) return code;
    return remeshes ? remesh() : command_.job() == Job::check ? check() : mesh();
  } catch (const std::bad_alloc&) {
    return fail_input(kLimit, "out of memory");
  } catch (const std::exception& error) {
    return fail_input(kInternal, std::string("internal error: ") + error.what() +
                                     " (a bug: please send the input and the command line)");
  }
}

}  // namespace

int run(const Command& command, const Library& library, const Streams& streams) {
  return Runner(command, library, streams).run();
}

}  // namespace delmesher::cli
