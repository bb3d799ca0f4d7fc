// Netgen alone on a surface, with nothing of this project:
//   d=/usr/lib/x86_64-linux-gnu/netgen; g++ reproduce.cpp -L$d -Wl,-rpath,$d -lnglib -o reproduce
// && ./reproduce SURFACE.off
#include <cstddef>
namespace nglib {
#include <netgen/nglib.h>
}

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace {

// The file without its first word and without comments.
std::istringstream numbers_of(const char* path) {
  std::ifstream file(path);
  std::string text, line;
  while (std::getline(file, line)) text += line.substr(0, line.find('#')) + "\n";
  std::istringstream numbers(text);
  std::string off;
  numbers >> off;
  return numbers;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::istringstream in = numbers_of(argv[1]);
  int vertices = 0, triangles = 0, edges = 0;
  if (!(in >> vertices >> triangles >> edges)) return 2;
  nglib::Ng_Init();
  nglib::Ng_Mesh* mesh = nglib::Ng_NewMesh();
  for (int v = 0; v < vertices; ++v) {
    double p[3] = {};
    in >> p[0] >> p[1] >> p[2];
    nglib::Ng_AddPoint(mesh, p);
  }
  for (int t = 0; t < triangles; ++t) {
    int count = 0, corners[3] = {};
    in >> count >> corners[0] >> corners[1] >> corners[2];
    for (int& corner : corners) ++corner;  // counted from 1
    nglib::Ng_AddSurfaceElement(mesh, nglib::NG_TRIG, corners);
  }
  nglib::Ng_Meshing_Parameters parameters;
  parameters.maxh = 1e6;
  const nglib::Ng_Result result = nglib::Ng_GenerateVolumeMesh(mesh, &parameters);
  std::cout << "result " << result << ", " << nglib::Ng_GetNE(mesh) << " tetrahedra\n";
  return result == nglib::NG_OK ? 0 : 1;
}
