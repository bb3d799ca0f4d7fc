// Reads a cube from a file, meshes it and writes the mesh, with the libraries as the README shows
// them.
#include <delmesher.h>
#include <delmesher_files.h>

#include <cstdio>
#include <string>

namespace {

int fail(const std::string& why) {
  std::fprintf(stderr, "consumer: %s\n", why.c_str());
  return 1;
}

}  // namespace

int main() {
  namespace io = delmesher::io;
  delmesher::Surface cube;
  for (int corner = 0; corner < 8; ++corner) {
    cube.vertices.push_back({double(corner & 1), double(corner >> 1 & 1), double(corner >> 2)});
  }
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  if (const io::WriteStatus status = io::write_off("cube.off", cube); !status.ok()) {
    return fail(status.error);
  }
  const io::ReadResult read = io::read_surface("cube.off");
  if (!read.ok()) return fail(read.error);
  if (read.surface.vertices != cube.vertices) return fail("the file has other vertices");

  delmesher::Options options;
  options.want_exact = true;
  const delmesher::Result result = delmesher::tetrahedralize(read.surface, options);
  if (!result.status.ok()) return fail(result.status.message);
  for (const char* path : {"cube.mesh", "cube.msh", "cube.vtu", "cube.node", "cube.tet"}) {
    const io::WriteStatus status = io::write_mesh(path, result.mesh);
    if (!status.ok()) return fail(status.error);
  }
  if (io::write_mesh("cube.doc", result.mesh).ok()) return fail("an unknown format was written");
  if (!io::write_exact("cube.exact", result.exact).ok()) return fail("no record");
  const io::ExactResult exact = io::read_exact("cube.exact");
  if (!exact.ok()) return fail(exact.error);
  if (exact.record.final.size() != result.exact.final.size()) return fail("another record");
  std::printf("%zu tetrahedra\n", result.mesh.tetrahedra.size());
  return result.mesh.tetrahedra.size() < 5;  // a cube has no triangulation with fewer
}
