#include "mesher/delmesher_c.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"

struct delmesher_options {
  std::map<std::string, double, std::less<>> values;
  std::vector<delmesher::SizeSource> size_field;
  std::vector<delmesher::RegionPoint> region_points;
  std::function<bool(const delmesher::Progress&)> progress;
};

struct delmesher_result {
  delmesher::Result value;
};

namespace {

using delmesher::CdtOptions;
using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;

// The numbers of the C header are part of its promise.
constexpr delmesher_status status_of(StatusCode code) {
  switch (code) {
    case StatusCode::ok:
      return DELMESHER_OK;
    case StatusCode::invalid_options:
      return DELMESHER_INVALID_OPTIONS;
    case StatusCode::invalid_surface:
      return DELMESHER_INVALID_SURFACE;
    case StatusCode::limit_reached:
      return DELMESHER_LIMIT_REACHED;
    case StatusCode::interrupted:
      return DELMESHER_INTERRUPTED;
    case StatusCode::invalid_mesh:
      return DELMESHER_INVALID_MESH;
    case StatusCode::internal_error:
      break;
  }
  return DELMESHER_INTERNAL_ERROR;
}

Surface surface_of(const delmesher_surface& given) {
  Surface surface;
  surface.vertices.resize(given.n_vertices);
  surface.triangles.resize(given.n_triangles);
  const auto copy = [](auto& to, const auto* from) {
    if (!to.empty()) std::memcpy(to.data(), from, to.size() * sizeof to[0]);
  };
  copy(surface.vertices, given.vertices);
  copy(surface.triangles, given.triangles);
  if (given.labels != nullptr) {
    surface.labels.resize(given.n_triangles);
    copy(surface.labels, given.labels);
  }
  return surface;
}

// The options of a job; empty, or what it does not use.
template <class JobOptions>
std::string take(const delmesher_options& given, JobOptions& options) {
  for (const auto& [name, value] : given.values) {
    if (!delmesher::options::set(options, name, value)) return name;
  }
  options.progress = given.progress;
  if constexpr (requires { options.size_field; }) {
    options.size_field = given.size_field;
  } else if (!given.size_field.empty()) {
    return "size_field";
  }
  if constexpr (requires { options.region_points; }) options.region_points = given.region_points;
  return {};
}

template <class JobOptions>
delmesher_result* result_of(const delmesher_surface* surface, const delmesher_options* given,
                            Result (*call)(const Surface&, const JobOptions&)) {
  auto* result = new (std::nothrow) delmesher_result;
  if (result == nullptr || surface == nullptr) return result;
  try {
    JobOptions options;
    const std::string unused = given != nullptr ? take(*given, options) : "";
    if (unused.empty()) {
      result->value = call(surface_of(*surface), options);
    } else {
      result->value.status = {StatusCode::invalid_options, unused + " is not an option of this job",
                              delmesher::Limit::none};
    }
  } catch (const std::bad_alloc&) {
    result->value.status = {StatusCode::limit_reached, "out of memory", delmesher::Limit::memory};
  }
  return result;
}

template <class T>
void give(const T* data, const T** target) {
  if (target != nullptr) *target = data;
}

}  // namespace

const char* delmesher_version(void) {
  return delmesher::version();
}

delmesher_status delmesher_label_by_angle(const delmesher_surface* surface, double degrees,
                                          int32_t* labels) {
  if (surface == nullptr || labels == nullptr) return DELMESHER_INVALID_SURFACE;
  try {
    Surface labelled = surface_of(*surface);
    const delmesher::Status status = delmesher::label_by_angle(labelled, degrees);
    if (status.ok()) std::copy(labelled.labels.begin(), labelled.labels.end(), labels);
    return status_of(status.code);
  } catch (const std::bad_alloc&) {
    return DELMESHER_LIMIT_REACHED;
  }
}

delmesher_options* delmesher_options_new(void) {
  return new (std::nothrow) delmesher_options;
}

void delmesher_options_free(delmesher_options* options) {
  delete options;
}

int delmesher_options_set(delmesher_options* options, const char* name, double value) {
  if (options == nullptr || name == nullptr) return -1;
  Options mesh;
  CdtOptions cdt;
  if (!delmesher::options::set(mesh, name, value) && !delmesher::options::set(cdt, name, value)) {
    return -1;
  }
  try {
    options->values[name] = value;
  } catch (...) {
    return -1;
  }
  return 0;
}

int delmesher_options_size_field(delmesher_options* options, const double* sources,
                                 size_t n_sources) {
  if (options == nullptr || (sources == nullptr && n_sources > 0)) return -1;
  try {
    std::vector<delmesher::SizeSource> field(n_sources);
    for (std::size_t n = 0; n < n_sources; ++n) {
      const double* source = sources + 4 * n;
      field[n] = {{source[0], source[1], source[2]}, source[3]};
    }
    options->size_field = std::move(field);
  } catch (...) {
    return -1;
  }
  return 0;
}

int delmesher_options_region_point(delmesher_options* options, const double* xyz, const char* name,
                                   double max_edge, int is_hole) {
  if (options == nullptr || xyz == nullptr) return -1;
  try {
    options->region_points.push_back(
        {{xyz[0], xyz[1], xyz[2]}, name != nullptr ? name : "", max_edge, is_hole != 0});
  } catch (...) {
    return -1;
  }
  return 0;
}

void delmesher_options_progress(delmesher_options* options, delmesher_progress progress,
                                void* user) {
  if (options == nullptr) return;
  options->progress = nullptr;
  if (progress == nullptr) return;
  options->progress = [progress, user](const delmesher::Progress& p) {
    return progress(user, delmesher::phase_name(p.phase), p.done, p.vertices) == 0;
  };
}

delmesher_result* delmesher_tetrahedralize(const delmesher_surface* surface,
                                           const delmesher_options* options) {
  return result_of(surface, options, delmesher::tetrahedralize);
}

delmesher_result* delmesher_constrained_delaunay(const delmesher_surface* surface,
                                                 const delmesher_options* options) {
  return result_of(surface, options, delmesher::constrained_delaunay);
}

void delmesher_result_free(delmesher_result* result) {
  delete result;
}

delmesher_status delmesher_result_status(const delmesher_result* result) {
  return result == nullptr ? DELMESHER_LIMIT_REACHED : status_of(result->value.status.code);
}

const char* delmesher_result_message(const delmesher_result* result) {
  return result == nullptr ? "out of memory" : result->value.status.message.c_str();
}

size_t delmesher_result_vertices(const delmesher_result* result, const double** xyz) {
  if (result == nullptr) return 0;
  const auto& vertices = result->value.mesh.vertices;
  give(vertices.empty() ? nullptr : vertices[0].data(), xyz);
  return vertices.size();
}

size_t delmesher_result_tetrahedra(const delmesher_result* result, const uint32_t** corners,
                                   const uint8_t** inside) {
  if (result == nullptr) return 0;
  const auto& mesh = result->value.mesh;
  give(mesh.tetrahedra.empty() ? nullptr : mesh.tetrahedra[0].data(), corners);
  give(mesh.inside.data(), inside);
  return mesh.tetrahedra.size();
}

size_t delmesher_result_regions(const delmesher_result* result, const int32_t** numbers) {
  if (result == nullptr) return 0;
  const auto& regions = result->value.mesh.regions;
  give(regions.data(), numbers);
  return regions.size();
}

const char* delmesher_result_region_name(const delmesher_result* result, int32_t number) {
  if (result == nullptr || number < 1) return "";
  const auto& regions = result->value.regions;
  const auto n = static_cast<std::size_t>(number - 1);
  return n < regions.size() ? regions[n].name.c_str() : "";
}

const char* delmesher_result_wall_name(const delmesher_result* result, int32_t label) {
  if (result == nullptr) return "";
  const auto known = result->value.wall_names.find(label);
  return known != result->value.wall_names.end() ? known->second.c_str() : "";
}

size_t delmesher_result_boundary(const delmesher_result* result, const uint32_t** corners,
                                 const int32_t** labels, const uint32_t** facets) {
  if (result == nullptr) return 0;
  const auto& mesh = result->value.mesh;
  give(mesh.boundary.empty() ? nullptr : mesh.boundary[0].data(), corners);
  give(mesh.boundary_labels.data(), labels);
  give(mesh.boundary_facets.data(), facets);
  return mesh.boundary.size();
}
