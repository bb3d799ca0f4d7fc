// The oracles for Python, without comfort: the verdict of a mesh that is given as arrays. They know
// nothing of the mesher, whose module is another one; _verdicts.py makes this comfortable.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "oracles/envelope.h"
#include "oracles/verify.h"
#include "python/arrays.h"
#include "reports/mesh_quality.h"

namespace py = pybind11;

namespace {

using namespace tetproof::oracles;
using namespace tetproof_python;

Polyhedron polyhedron_of(const Array<double>& points, const Array<std::uint32_t>& triangles,
                         const Labels& labels, const std::map<std::int64_t, std::string>& names) {
  Polyhedron surface;
  surface.vertices = rows_of<double, 3>(points, "points");
  surface.triangles = rows_of<std::uint32_t, 3>(triangles, "triangles");
  surface.labels = numbers_of(labels, "labels", surface.triangles.size(), "triangles");
  surface.names_read = !names.empty();
  for (const auto& [number, name] : names) surface.names[{2, number}] = name;
  return surface;
}

// What is not there is None.
template <class T>
std::vector<T> each(const py::dict& d, const char* key, std::size_t cells, const char* cell_name) {
  return numbers_of(py::cast<PerCell<T>>(d[key]), key, cells, cell_name);
}

MeshFile mesh_of(const py::dict& d) {
  MeshFile mesh;
  mesh.vertices = rows_of<double, 3>(py::cast<Array<double>>(d["points"]), "points");
  mesh.tetrahedra =
      rows_of<std::uint32_t, 4>(py::cast<Array<std::uint32_t>>(d["tetrahedra"]), "tetrahedra");
  mesh.lists_boundary = !d["boundary"].is_none();
  if (mesh.lists_boundary) {
    mesh.boundary =
        rows_of<std::uint32_t, 3>(py::cast<Array<std::uint32_t>>(d["boundary"]), "boundary");
  }
  const std::size_t cells = mesh.tetrahedra.size();
  mesh.regions = each<std::int64_t>(d, "regions", cells, "tetrahedra");
  mesh.inside = each<std::uint8_t>(d, "inside", cells, "tetrahedra");
  mesh.labels = each<std::int32_t>(d, "labels", mesh.boundary.size(), "triangles");
  mesh.facets = each<std::uint32_t>(d, "facets", mesh.boundary.size(), "triangles");
  mesh.names_sides = !mesh.regions.empty();
  mesh.all_called_inside =
      mesh.names_sides && std::ranges::find(mesh.inside, 0) == mesh.inside.end();
  mesh.planar_within = py::cast<double>(d["planar_within"]);
  mesh.either_orientation = py::cast<bool>(d["either_orientation"]);
  for (const auto& [dimension, key] : {std::pair(2, "names"), std::pair(3, "region_names")}) {
    const auto names = py::cast<std::map<std::int64_t, std::string>>(d[key]);
    mesh.has_names = mesh.has_names || !names.empty();
    for (const auto& [number, name] : names) mesh.names[{dimension, number}] = name;
  }
  return mesh;
}

// By what they are.
py::dict places_of(const OracleReport& oracle) {
  py::dict places;
  for (std::size_t kind = 0; kind < std::size(kSiteKinds); ++kind) {
    const auto numbers = static_cast<py::ssize_t>(kSiteKinds[kind].numbers);
    std::vector<std::int64_t> found;
    for (const Site& site : oracle.sites) {
      if (site.kind == static_cast<Site::Kind>(kind)) {
        found.insert(found.end(), site.numbers.begin(), site.numbers.begin() + numbers);
      }
    }
    if (found.empty()) continue;
    const auto count = static_cast<py::ssize_t>(found.size()) / numbers;
    py::array array = taken(std::move(found));
    places[kSiteKinds[kind].name] = numbers > 1 ? array.reshape({count, numbers}) : array;
  }
  if (!oracle.points.empty()) {
    places["points"] = taken(std::vector<std::array<double, 3>>(oracle.points));
  }
  return places;
}

py::dict dict_of(const VerifyReport& report, bool bad) {
  py::dict d, places;
  for (const OracleReport& oracle : report.oracles) {
    const py::dict here = places_of(oracle);
    if (!here.empty()) places[py::str(oracle.name)] = here;
  }
  d["json"] = to_json(report);
  d["text"] = to_text(report);
  d["places"] = places;
  d["failed"] = bad;
  return d;
}

// The command's `tetproof verify`, without a record; an `envelope` of 0 is none. Of an input that
// bounds no solid only "invalid", the reason.
py::dict verify_arrays(const Array<double>& points, const Array<std::uint32_t>& triangles,
                       const Labels& labels, const std::map<std::int64_t, std::string>& names,
                       const py::dict& given, const std::string& promised, double envelope,
                       double declared_deviation, unsigned threads) {
  const Polyhedron input = polyhedron_of(points, triangles, labels, names);
  const MeshFile mesh = mesh_of(given);
  VerifyOptions options;
  if (const std::string why = parse_promise(promised, options.promised); !why.empty()) {
    throw py::value_error("promised: " + why);
  }
  const Promise& promise = options.promised;
  if (promise.task == Task::plane || promise.task == Task::improve) {
    throw py::value_error("promised: 'mesh OPTIONS' or 'cdt OPTIONS' is expected");
  }
  if (envelope > 0 && promise.tolerance != 0) {
    throw py::value_error("envelope: the promise has a tolerance");
  }
  options.stage = stage_of(promise, false);
  options.declared_deviation = declared_deviation;
  options.threads = threads;
  options.progress = [](const OracleReport&) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
  VerifyReport report;
  std::string why;
  std::optional<NearSurface> near;
  {
    const py::gil_scoped_release free;
    why = envelope > 0 ? verify_envelope(input, mesh, envelope, options, report)
                       : verify(input, mesh, nullptr, options, report);
    if (why.empty() && envelope == 0 && promise.tolerance == 0 && only_surface_differs(report)) {
      near = nearness(input, mesh);
    }
  }
  locate(input, mesh, report);
  py::dict d;
  if (!why.empty()) {
    d["invalid"] = why;
    return d;
  }
  d = dict_of(report, envelope > 0 ? report.verdict == Verdict::broken : failed(report, options));
  if (near) d["near"] = py::make_tuple(near->farthest, std::strtod(near->envelope, nullptr));
  return d;
}

// The command's `tetproof measure`, as JSON.
std::string measure_arrays(const py::dict& given) {
  const MeshFile mesh = mesh_of(given);
  const py::gil_scoped_release free;
  return tetproof::to_json(tetproof::measure(mesh));
}

}  // namespace

PYBIND11_MODULE(_oracles, module) {
  refuse_unknown_numpy();
  module.def("verify", verify_arrays);
  module.def("measure", measure_arrays);
  module.attr("least_envelope") = kLeastEnvelope;
}
