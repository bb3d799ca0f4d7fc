// One call, one file: for programs that have no need of an OutputSet.
#include "mesher/delmesher_files.h"
#include "mesher/io/exact_file.h"
#include "mesher/io/output.h"
#include "mesher/io/write_mesh.h"
#include "mesher/io/write_plane.h"

namespace delmesher::io {
namespace {

template <class Write>
WriteStatus written(const Write& write) {
  OutputSet outputs;
  WriteStatus status = write(outputs);
  if (status.ok()) status.error = outputs.commit().error;
  return status;
}

}  // namespace

WriteStatus write_mesh(const std::string& path, const TetMesh& mesh, const LabelNames& names,
                       const WriteOptions& options) {
  return written(
      [&](OutputSet& outputs) { return write_mesh(outputs, path, mesh, names, options); });
}

WriteStatus write_surface(const std::string& path, const Surface& surface,
                          const LabelNames& names) {
  return written([&](OutputSet& outputs) { return write_surface(outputs, path, surface, names); });
}

WriteStatus write_off(const std::string& path, const Surface& surface) {
  return written([&](OutputSet& outputs) { return write_off(outputs, path, surface); });
}

WriteStatus write_plane(const std::string& path, const PlaneMesh& mesh, const PlanarGraph* graph,
                        const WriteOptions& options) {
  return written(
      [&](OutputSet& outputs) { return write_plane(outputs, path, mesh, graph, options); });
}

WriteStatus write_exact(const std::string& path, const ExactRecord& record) {
  return written([&](OutputSet& outputs) { return write_exact(outputs, path, record); });
}

WriteStatus write_plane_exact(const std::string& path, const PlaneRecord& record) {
  return written([&](OutputSet& outputs) { return write_plane_exact(outputs, path, record); });
}

}  // namespace delmesher::io
