// The library for Python, without comfort: arrays in, tuples of arrays out.
// python/tetproof/__init__.py makes it comfortable.
#include <pybind11/stl.h>

#include <chrono>
#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/delmesher_files.h"
#include "mesher/delmesher_plane.h"
#include "python/arrays.h"

namespace py = pybind11;

namespace {

using namespace delmesher;
using namespace tetproof_python;

Surface surface_of(const Array<double>& points, const Array<std::uint32_t>& triangles,
                   const Labels& labels) {
  Surface surface;
  surface.vertices = rows_of<double, 3>(points, "points");
  surface.triangles = rows_of<std::uint32_t, 3>(triangles, "triangles");
  surface.labels = numbers_of(labels, "labels", surface.triangles.size(), "triangles");
  return surface;
}

// As docstrings say it.
std::string type_of(const options::Value& option) {
  static constexpr const char* kTypes[] = {"float", "int", "bool", "",
                                           "(k, 4) array_like of float"};
  std::string type = kTypes[static_cast<std::size_t>(option.kind)];
  if (option.text.unit == options::Unit::length_or_share) type += " or str";
  for (const options::Word& word : option.text.words) {
    if (word.word.empty()) continue;
    type += (type.empty() ? "'" : " or '") + std::string(word.word) + "'";
  }
  if (option.text.lists == options::Text::Lists::regions ||
      option.text.lists == options::Text::Lists::walls) {
    type += " or list of str";
  }
  if (option.text.lists == options::Text::Lists::values_of_regions) type += " or dict";
  return type;
}

template <class JobOptions>
bool set_option(JobOptions& job, const std::string& name, const py::handle& value) {
  if constexpr (requires { job.size_field; }) {
    if (name == "size_field") {
      for (const auto& [x, y, z, size] :
           rows_of<double, 4>(py::cast<Array<double>>(value), "size_field")) {
        job.size_field.push_back({{x, y, z}, size});
      }
      return true;
    }
  }
  if constexpr (requires { job.label_names; }) {
    if (name == "label_names") {
      job.label_names = py::cast<std::map<std::int32_t, std::string>>(value);
      return true;
    }
  }
  if constexpr (requires { job.region_points; }) {
    if (name == "region_points") {
      for (const auto& item : py::cast<std::vector<py::tuple>>(value)) {
        auto point = py::cast<std::array<double, 3>>(item[0]);
        job.region_points.push_back({point, py::cast<std::string>(item[1]),
                                     py::cast<double>(item[2]), py::cast<bool>(item[3])});
      }
      return true;
    }
  }
  if (py::isinstance<py::str>(value)) {
    return options::set(job, name, std::string_view(py::cast<std::string>(value)));
  }
  return options::set(job, name,
                      py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(value))));
}

// " (but 'interior' or 'hull')", where an option has words.
template <class JobOptions>
std::string words_of(const JobOptions& job, const std::string& name) {
  std::string words;
  for (const options::Value& option : options::values_of(job)) {
    if (option.text.name == name) words = type_of(option);
  }
  return words.find('\'') == std::string::npos ? "" : " (but " + words + ")";
}

template <class JobOptions>
JobOptions options_of(const py::dict& given) {
  JobOptions job;
  for (const auto& [key, value] : given) {
    const auto name = py::cast<std::string>(key);
    if (!set_option(job, name, value)) {
      throw py::value_error(name + " cannot be " + py::cast<std::string>(py::repr(value)) +
                            words_of(job, name));
    }
  }
  return job;
}

// A default as Python writes it.
py::object default_of(const options::Value& option) {
  if (option.kind == options::Kind::sources || option.text.zero_is_none) return py::none();
  for (const options::Word& word : option.text.words) {
    if (!word.word.empty() && word.value == option.value) return py::str(std::string(word.word));
  }
  if (option.kind == options::Kind::on_off) return py::bool_(option.value != 0);
  if (option.kind == options::Kind::count) return py::int_(static_cast<std::int64_t>(option.value));
  if (option.text.unit == options::Unit::length_or_share) {
    char text[32];
    std::snprintf(text, sizeof text, "%gd", -option.value);
    return py::str(text);
  }
  return py::float_(option.value);
}

// The options of a job: name, type, default, unit, meaning.
template <class JobOptions>
std::vector<py::tuple> described() {
  static constexpr const char* kUnits[] = {"", "degrees", "in units of the input", "seconds",
                                           "in units of the input"};
  std::vector<py::tuple> rows;
  for (const options::Value& option : options::values_of(JobOptions())) {
    rows.push_back(py::make_tuple(
        std::string(option.text.name), type_of(option), default_of(option),
        kUnits[static_cast<std::size_t>(option.text.unit)], std::string(option.text.help)));
  }
  return rows;
}

py::dict all_described() {
  py::dict jobs;
  jobs["mesh"] = described<Options>();
  jobs["cdt"] = described<CdtOptions>();
  jobs["plane"] = described<PlaneOptions>();
  jobs["improve"] = described<ImproveOptions>();
  jobs["check"] = described<CheckOptions>();
  jobs["remesh"] = described<RemeshOptions>();
  return jobs;
}

// Lets Ctrl-C and a callable end a run, a few times a second, while other threads of Python go on.
class Watch {
 public:
  Watch(TimeLimit& options, py::object progress) : progress_(std::move(progress)) {
    options.progress = [this](const Progress& p) { return go_on(p); };
  }

  template <class Call>
  auto run(Call call) {
    auto result = [&] {
      const py::gil_scoped_release free;
      return call();
    }();
    if (error_) std::rethrow_exception(error_);
    return result;
  }

 private:
  bool go_on(const Progress& p) {
    const auto now = std::chrono::steady_clock::now();
    if (p.phase == phase_ && now - last_ < std::chrono::milliseconds(100)) return true;
    phase_ = p.phase;
    last_ = now;
    const py::gil_scoped_acquire held;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (progress_.is_none()) return true;
      const py::object answer = progress_(phase_name(p.phase), p.done, p.vertices);
      if (answer.is_none()) return true;
      const int goes_on = PyObject_IsTrue(answer.ptr());  // as Python means it: of anything
      if (goes_on < 0) throw py::error_already_set();
      if (goes_on != 0) return true;
    } catch (...) {
      error_ = std::current_exception();
    }
    return false;
  }

  py::object progress_;
  std::exception_ptr error_;
  Phase phase_ = Phase::read;
  std::chrono::steady_clock::time_point last_{};
};

py::dict statistics_of(const MeshStatistics& s) {
  py::dict d;
  d["vertices"] = s.vertices;
  d["tetrahedra"] = s.tetrahedra;
  d["interior_tetrahedra"] = s.interior_tetrahedra;
  d["min_face_angle"] = s.min_face_angle;
  d["max_face_angle"] = s.max_face_angle;
  d["min_dihedral"] = s.min_dihedral;
  d["max_dihedral"] = s.max_dihedral;
  d["dihedral_1_percent"] = s.dihedral_1_percent;
  d["tetrahedra_below_5_degrees"] = s.below_5;
  d["min_gamma"] = s.min_gamma;
  d["mean_gamma"] = s.mean_gamma;
  d["gamma_1_percent"] = s.gamma_1_percent;
  d["min_sicn"] = s.min_sicn;
  d["mean_sicn"] = s.mean_sicn;
  return d;
}

py::dict seconds_of(const std::array<double, kPhaseCount>& seconds) {
  py::dict d;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    if (seconds[i] > 0) d[phase_name(static_cast<Phase>(i))] = seconds[i];
  }
  return d;
}

void put_status(py::dict& d, const Status& status, const std::vector<std::string>& warnings) {
  static constexpr const char* kLimits[] = {"none",   "size",      "time",
                                            "memory", "precision", "budget"};
  static constexpr const char* kCodes[] = {
      "ok",          "invalid_options", "invalid_surface", "limit_reached",
      "interrupted", "internal_error",  "invalid_mesh"};
  d["status"] = kCodes[static_cast<std::size_t>(status.code)];
  d["message"] = status.message;
  d["limit"] = kLimits[static_cast<std::size_t>(status.limit)];
  d["warnings"] = warnings;
}

void put_mesh(py::dict& d, TetMesh&& mesh) {
  d["points"] = taken(std::move(mesh.vertices));
  d["tetrahedra"] = taken(std::move(mesh.tetrahedra));
  d["inside"] = taken(std::move(mesh.inside));
  d["regions"] = taken(std::move(mesh.regions));
  d["boundary"] = taken(std::move(mesh.boundary));
  d["labels"] = taken(std::move(mesh.boundary_labels));
  d["facets"] = taken(std::move(mesh.boundary_facets));
  d["planar_within"] = mesh.planar_within;
}

py::dict dict_of(Result&& result) {
  py::dict d, stats;
  put_status(d, result.status, result.warnings);
  if (!result.status.ok()) return d;
  const Statistics& s = result.statistics;
  stats["refined"] = statistics_of(s.refined);
  stats["final"] = statistics_of(s.final);
  stats["seconds"] = seconds_of(s.phase_seconds);
  stats["bbox_diagonal"] = s.bbox_diagonal;
  stats["chosen_size"] = s.chosen_size;
  stats["tetrahedra_without_size"] = s.tetrahedra_without_size;
  stats["facets"] = s.facets;
  stats["acute_vertices"] = s.acute_vertices;
  stats["acute_edges"] = s.acute_edges;
  stats["predicted_tetrahedra"] = s.predicted_tetrahedra;
  stats["tau"] = s.tau;
  stats["left_on_surface"] = s.left_on_surface;
  stats["inverted"] = s.rounding_inverted;
  stats["flat"] = s.rounding_flat;
  stats["max_surface_deviation"] = s.max_surface_deviation;
  d["stats"] = stats;
  py::dict labels, names;  // of the regions that are in a solid, or have a point with a name
  for (std::size_t n = 0; n < result.regions.size(); ++n) {
    const MeshRegion& region = result.regions[n];
    if (region.label) labels[py::int_(n + 1)] = *region.label;
    if (!region.name.empty()) names[py::int_(n + 1)] = region.name;
  }
  d["region_labels"] = labels;
  d["region_names"] = names;
  d["wall_names"] = result.wall_names;
  put_mesh(d, std::move(result.mesh));
  return d;
}

template <class JobOptions, Result (*job)(const Surface&, const JobOptions&)>
py::dict mesh(const Array<double>& points, const Array<std::uint32_t>& triangles,
              const Labels& labels, const py::dict& given, py::object progress) {
  const Surface surface = surface_of(points, triangles, labels);
  auto options = options_of<JobOptions>(given);
  Watch watch(options, std::move(progress));
  return dict_of(watch.run([&] { return job(surface, options); }));
}

TetMesh mesh_of(const py::dict& d) {
  TetMesh mesh;
  mesh.vertices = rows_of<double, 3>(py::cast<Array<double>>(d["points"]), "points");
  mesh.tetrahedra =
      rows_of<std::uint32_t, 4>(py::cast<Array<std::uint32_t>>(d["tetrahedra"]), "tetrahedra");
  mesh.inside = values_of(py::cast<Array<std::uint8_t>>(d["inside"]), "inside");
  mesh.regions = values_of(py::cast<Array<std::int32_t>>(d["regions"]), "regions");
  mesh.boundary =
      rows_of<std::uint32_t, 3>(py::cast<Array<std::uint32_t>>(d["boundary"]), "boundary");
  mesh.boundary_labels = values_of(py::cast<Array<std::int32_t>>(d["labels"]), "labels");
  mesh.boundary_facets = values_of(py::cast<Array<std::uint32_t>>(d["facets"]), "facets");
  mesh.planar_within = py::cast<double>(d["planar_within"]);
  return mesh;
}

py::dict improve(const py::dict& given_mesh, const py::dict& given, py::object progress) {
  const TetMesh before = mesh_of(given_mesh);
  auto options = options_of<ImproveOptions>(given);
  Watch watch(options, std::move(progress));
  return dict_of(watch.run([&] { return improve_mesh(before, options); }));
}

py::dict remesh(const Array<double>& points, const Array<std::uint32_t>& triangles,
                const Labels& labels, const py::dict& given, py::object progress) {
  const Surface surface = surface_of(points, triangles, labels);
  auto options = options_of<RemeshOptions>(given);
  Watch watch(options, std::move(progress));
  RemeshResult result = watch.run([&] { return remesh_surface(surface, options); });
  py::dict d;
  put_status(d, result.status, result.warnings);
  d["points"] = taken(std::move(result.surface.vertices));
  d["triangles"] = taken(std::move(result.surface.triangles));
  d["labels"] = taken(std::move(result.surface.labels));
  return d;
}

py::dict check(const Array<double>& points, const Array<std::uint32_t>& triangles,
               const py::dict& given) {
  const Surface surface = surface_of(points, triangles, std::nullopt);
  auto options = options_of<CheckOptions>(given);
  Watch watch(options, py::none());
  SurfaceReport report = watch.run([&] { return check_surface(surface, options); });
  py::dict d, counts, places;
  put_status(d, report.status, report.warnings);
  d["hints"] = surface_hints(surface, report);  // which needs the places
  for (std::size_t kind = 0; kind < report.defect_counts.size(); ++kind) {
    if (report.defect_counts[kind] == 0) continue;
    counts[defect_name(static_cast<Defect::Kind>(kind))] = report.defect_counts[kind];
    places[defect_name(static_cast<Defect::Kind>(kind))] = taken(std::move(report.places[kind]));
  }
  py::list defects;
  for (const Defect& defect : report.defects) {
    defects.append(py::make_tuple(defect_name(defect.kind), defect.message,
                                  taken(std::vector(defect.vertices)),
                                  taken(std::vector(defect.triangles))));
  }
  d["counts"] = counts;
  d["places"] = places;
  d["defects"] = defects;
  d["flipped"] = report.flipped;
  d["components"] = report.components;
  d["volume"] = report.volume;
  d["facets"] = report.facets;
  d["acute_vertices"] = report.acute_vertices;
  d["acute_edges"] = report.acute_edges;
  d["bbox_diagonal"] = report.bbox_diagonal;
  d["smallest_local_feature_size"] = report.smallest_local_feature_size;
  return d;
}

py::array label(const Array<double>& points, const Array<std::uint32_t>& triangles,
                const Labels& labels, double degrees) {
  Surface surface = surface_of(points, triangles, labels);
  const Status status = [&] {
    const py::gil_scoped_release free;
    return label_by_angle(surface, degrees);
  }();
  if (!status.ok()) throw py::value_error(status.message);
  return taken(std::move(surface.labels));
}

std::vector<py::tuple> faces(const Array<double>& points, const Array<std::uint32_t>& triangles,
                             const Labels& labels) {
  static constexpr const char* kShapes[] = {"planar", "cylindrical", "other"};
  std::vector<py::tuple> rows;
  for (const LabelledFace& face : labelled_faces(surface_of(points, triangles, labels))) {
    rows.push_back(py::make_tuple(face.label, face.triangles, face.area,
                                  kShapes[static_cast<std::size_t>(face.shape)], face.direction,
                                  face.lower, face.upper));
  }
  return rows;
}

py::dict repair(const Array<double>& points, const Array<std::uint32_t>& triangles,
                const Labels& labels, double weld, bool fill) {
  const Surface surface = surface_of(points, triangles, labels);
  RepairResult result = [&] {
    const py::gil_scoped_release free;
    return repair_surface(surface, {.weld = weld, .fill = fill});
  }();
  py::dict d;
  d["points"] = taken(std::move(result.surface.vertices));
  d["triangles"] = taken(std::move(result.surface.triangles));
  d["labels"] = taken(std::move(result.surface.labels));
  d["done"] = result.done;
  return d;
}

PlanarGraph graph_of(const Array<double>& points, const Array<std::uint32_t>& segments,
                     const Labels& markers) {
  PlanarGraph graph;
  graph.vertices = rows_of<double, 2>(points, "points");
  graph.segments = rows_of<std::uint32_t, 2>(segments, "segments");
  graph.markers = numbers_of(markers, "markers", graph.segments.size(), "segments");
  return graph;
}

py::dict plane(const Array<double>& points, const Array<std::uint32_t>& segments,
               const Labels& markers, const Array<double>& holes, const py::dict& given,
               py::object progress) {
  PlanarGraph graph = graph_of(points, segments, markers);
  graph.holes = rows_of<double, 2>(holes, "holes");
  auto options = options_of<PlaneOptions>(given);
  Watch watch(options, std::move(progress));
  PlaneResult result = watch.run([&] { return triangulate_polygon(graph, options); });
  py::dict d, stats;
  put_status(d, result.status, result.warnings);
  if (!result.status.ok()) return d;
  const PlaneStatistics& s = result.statistics;
  stats["triangles"] = s.final.triangles;
  stats["min_angle"] = s.final.min_angle;
  stats["max_angle"] = s.final.max_angle;
  stats["guaranteed_delta"] = s.guaranteed_delta;
  stats["seconds"] = seconds_of(s.phase_seconds);
  d["stats"] = stats;
  d["points"] = taken(std::move(result.mesh.vertices));
  d["triangles"] = taken(std::move(result.mesh.triangles));
  d["inside"] = taken(std::move(result.mesh.inside));
  d["edges"] = taken(std::move(result.mesh.edges));
  d["markers"] = taken(std::move(result.mesh.edge_markers));
  d["segments"] = taken(std::move(result.mesh.edge_segments));
  return d;
}

py::dict check_plane(const Array<double>& points, const Array<std::uint32_t>& segments) {
  const PlanarGraph graph = graph_of(points, segments, std::nullopt);
  GraphReport report = [&] {
    const py::gil_scoped_release free;
    return check_graph(graph);
  }();
  py::dict d, places;
  put_status(d, report.status, report.warnings);
  for (std::size_t kind = 0; kind < kGraphDefects; ++kind) {
    if (report.places[kind].empty()) continue;
    places[defect_name(static_cast<GraphDefect>(kind))] = taken(std::move(report.places[kind]));
  }
  d["places"] = places;
  d["hints"] = report.hints;
  d["area"] = report.area;
  return d;
}

py::dict repair_plane(const Array<double>& points, const Array<std::uint32_t>& segments,
                      const Labels& markers, double weld) {
  const PlanarGraph graph = graph_of(points, segments, markers);
  GraphRepairResult mended = [&] {
    const py::gil_scoped_release free;
    return repair_graph(graph, weld);
  }();
  py::dict d;
  put_status(d, mended.status, {});
  d["points"] = taken(std::move(mended.graph.vertices));
  d["segments"] = taken(std::move(mended.graph.segments));
  d["markers"] = taken(std::move(mended.graph.markers));
  d["done"] = mended.done;
  return d;
}

template <class Read>
void ok_or_throw(const Read& read) {
  if (!read.ok()) throw py::value_error(read.error);
}

py::dict read_surface_file(const std::string& path) {
  io::ReadResult read = io::read_surface(path);
  ok_or_throw(read);
  py::dict d;
  d["points"] = taken(std::move(read.surface.vertices));
  d["triangles"] = taken(std::move(read.surface.triangles));
  d["labels"] = taken(std::move(read.surface.labels));
  d["names"] = read.names;
  py::list region_points;
  for (const RegionPoint& p : read.region_points) {
    region_points.append(py::make_tuple(p.point, p.name, p.max_edge, p.is_hole));
  }
  d["region_points"] = region_points;
  d["warnings"] = read.warnings;
  return d;
}

py::dict read_mesh_file(const std::string& path) {
  io::MeshReadResult read = io::read_mesh(path);
  ok_or_throw(read);
  py::dict d;
  d["names"] = read.names;
  d["region_names"] = read.region_names;
  d["warnings"] = read.warnings;
  put_mesh(d, std::move(read.mesh));
  return d;
}

// These answer with warnings.
std::vector<std::string> write_mesh_file(const std::string& path, const py::dict& given,
                                         const io::LabelNames& names,
                                         const io::LabelNames& region_names, int order, bool ascii,
                                         bool msh_2_2) {
  const io::WriteStatus status =
      io::write_mesh(path, mesh_of(given), names,
                     {.order = order,
                      .ascii = ascii,
                      .msh = msh_2_2 ? io::MshVersion::v2_2 : io::MshVersion::v4_1,
                      .region_names = region_names});
  ok_or_throw(status);
  return status.warnings;
}

std::vector<std::string> write_surface_file(const std::string& path, const Array<double>& points,
                                            const Array<std::uint32_t>& triangles,
                                            const Labels& labels, const io::LabelNames& names) {
  const io::WriteStatus status =
      io::write_surface(path, surface_of(points, triangles, labels), names);
  ok_or_throw(status);
  return status.warnings;
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  refuse_unknown_numpy();
  module.doc() = "What tetproof is made of; use tetproof instead.";
  module.attr("version") = version();
  module.attr("options") = all_described();
  module.def("mesh", &mesh<Options, tetrahedralize>);
  module.def("cdt", &mesh<CdtOptions, constrained_delaunay>);
  module.def("improve", &improve);
  module.def("check", &check);
  module.def("label_by_angle", &label);
  module.def("labelled_faces", &faces);
  module.def("repair", &repair);
  module.def("remesh", &remesh);
  module.def("plane", &plane);
  module.def("check_plane", &check_plane);
  module.def("repair_plane", &repair_plane);
  module.def("read_surface", &read_surface_file);
  module.def("read_mesh", &read_mesh_file);
  module.def("write_mesh", &write_mesh_file);
  module.def("write_surface", &write_surface_file);
}
