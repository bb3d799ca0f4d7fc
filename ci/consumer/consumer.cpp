// Meshes a cube through the installed package, as the README shows it.
#include <delmesher.h>

#include <cstdio>

int main() {
  delmesher::Surface cube;
  for (int corner = 0; corner < 8; ++corner) {
    cube.vertices.push_back({double(corner & 1), double(corner >> 1 & 1), double(corner >> 2)});
  }
  cube.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const delmesher::Result result = delmesher::tetrahedralize(cube);
  if (!result.status.ok()) {
    std::fprintf(stderr, "consumer: %s\n", result.status.message.c_str());
    return 1;
  }
  std::printf("%zu tetrahedra\n", result.mesh.tetrahedra.size());
  return result.mesh.tetrahedra.size() < 5;  // a cube has no triangulation with fewer
}
