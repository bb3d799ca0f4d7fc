// tetproof-tetgen SWITCHES INPUT OUT.mesh STATS.json
//
// TetGen, in memory, on the very doubles that our own mesher reads, with its result written by the
// same writer and the same exit codes: 3 input unreadable, 4 refused, 5 out of memory, 6 internal
// error. TetGen may also abort, hang or crash: the caller runs this as a supervised child.
#include <tetgen.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "corpus/tetgen_adapter/inside_flood.h"
#include "mesher/io/read_surface.h"
#include "mesher/io/write_mesh.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

[[noreturn]] void finish(int code, const std::string& file, const std::string& reason) {
  if (code != 0) std::fprintf(stderr, "tetproof-tetgen: %s: %s\n", file.c_str(), reason.c_str());
  std::fflush(nullptr);
  _exit(code);  // without TetGen's destructors, which are not part of what is measured
}

// What TetGen means by the integer it throws.
[[noreturn]] void refused(int thrown, const std::string& file) {
  switch (thrown) {
    case 1:
      finish(5, file, "TetGen 1: out of memory");
    case 2:
      finish(6, file, "TetGen 2: internal error");
    case 3:
      finish(4, file, "TetGen 3: self-intersection detected");
    case 4:
      finish(4, file, "TetGen 4: very small input feature");
    case 5:
      finish(4, file, "TetGen 5: two very close input facets");
    case 10:
      finish(4, file, "TetGen 10: input error");
    default:
      finish(4, file, "TetGen " + std::to_string(thrown));
  }
}

// One marker per label of the input, not per triangle: TetGen merges coplanar facets of one marker,
// and would otherwise keep every flat edge of the triangulation as a constraint. Faces of no facet
// have marker 0 or, on the hull, 1; ours start well above.
constexpr int kFirstMarker = 16;

struct Markers {
  std::vector<std::int32_t> labels;      // by marker - kFirstMarker, increasing
  std::vector<std::uint32_t> triangles;  // smallest input triangle of each

  explicit Markers(const delmesher::Surface& surface) : labels(surface.labels) {
    if (labels.empty()) labels.push_back(0);
    std::sort(labels.begin(), labels.end());
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    triangles.assign(labels.size(), 0);
    for (std::size_t i = surface.labels.size(); i-- > 0;) {
      triangles[index_of(surface.labels[i])] = static_cast<std::uint32_t>(i);
    }
  }
  std::size_t index_of(std::int32_t label) const {
    return static_cast<std::size_t>(std::lower_bound(labels.begin(), labels.end(), label) -
                                    labels.begin());
  }
};

// Arrays are TetGen's to delete.
void fill(const delmesher::Surface& surface, const Markers& markers, tetgenio& in) {
  in.firstnumber = 0;
  in.numberofpoints = static_cast<int>(surface.vertices.size());
  in.pointlist = new REAL[3 * surface.vertices.size()];
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    for (int c = 0; c < 3; ++c) in.pointlist[3 * i + c] = surface.vertices[i][c];
  }
  in.numberoffacets = static_cast<int>(surface.triangles.size());
  in.facetlist = new tetgenio::facet[surface.triangles.size()];
  in.facetmarkerlist = new int[surface.triangles.size()];
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    tetgenio::facet& facet = in.facetlist[i];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(&facet.polygonlist[0]);
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3];
    for (int c = 0; c < 3; ++c) {
      facet.polygonlist[0].vertexlist[c] = static_cast<int>(surface.triangles[i][c]);
    }
    const std::int32_t label = surface.labels.empty() ? 0 : surface.labels[i];
    in.facetmarkerlist[i] = kFirstMarker + static_cast<int>(markers.index_of(label));
  }
}

bool positive(const delmesher::TetMesh& mesh, const std::array<std::uint32_t, 4>& t) {
  double e[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) e[i][c] = mesh.vertices[t[i + 1]][c] - mesh.vertices[t[0]][c];
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
             e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
             e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) >
         0;
}

// TetGen orders corners the other way round. All are turned or none, so that tetrahedra that TetGen
// inverted stay visible.
void orient(delmesher::TetMesh& mesh) {
  const auto count = std::count_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(),
                                   [&](const auto& t) { return positive(mesh, t); });
  if (2 * static_cast<std::size_t>(count) >= mesh.tetrahedra.size()) return;
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
}

delmesher::TetMesh take(const tetgenio& out, const Markers& markers, bool whole_hull) {
  delmesher::TetMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(out.numberofpoints));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int c = 0; c < 3; ++c) mesh.vertices[i][c] = out.pointlist[3 * i + c];
  }
  mesh.tetrahedra.resize(static_cast<std::size_t>(out.numberoftetrahedra));
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    for (int c = 0; c < 4; ++c) {
      mesh.tetrahedra[i][c] = static_cast<std::uint32_t>(
          out.tetrahedronlist[i * static_cast<std::size_t>(out.numberofcorners) + c]);
    }
  }
  for (int i = 0; i < out.numberoftrifaces; ++i) {
    const int marker = out.trifacemarkerlist == nullptr ? 0 : out.trifacemarkerlist[i];
    if (marker < kFirstMarker) continue;
    const int* v = out.trifacelist + 3 * i;
    mesh.boundary.push_back({static_cast<std::uint32_t>(v[0]), static_cast<std::uint32_t>(v[1]),
                             static_cast<std::uint32_t>(v[2])});
    const auto group = static_cast<std::size_t>(marker - kFirstMarker);
    mesh.boundary_labels.push_back(markers.labels.at(group));
    mesh.boundary_facets.push_back(markers.triangles.at(group));  // TetGen does not tell the facet
  }
  orient(mesh);
  if (whole_hull) mesh.inside = tetproof::flood_inside(mesh.tetrahedra, mesh.boundary);
  if (mesh.inside.empty()) mesh.inside.assign(mesh.tetrahedra.size(), whole_hull ? 0 : 1);
  return mesh;
}

void write_statistics(const char* path, const delmesher::Surface& surface,
                      const delmesher::TetMesh& mesh, double read, double meshing, double write) {
  std::ofstream out(path);
  out.precision(9);
  const auto inside = std::count(mesh.inside.begin(), mesh.inside.end(), 1);
  out << "{\"input\": {\"vertices\": " << surface.vertices.size()
      << ", \"triangles\": " << surface.triangles.size() << "}, \"status\": \"ok\", "
      << "\"phases_seconds\": {\"read\": " << read << ", \"tetrahedralize\": " << meshing
      << ", \"write\": " << write << "}, \"final\": {\"vertices\": " << mesh.vertices.size()
      << ", \"tetrahedra\": " << mesh.tetrahedra.size() << ", \"interior_tetrahedra\": " << inside
      << "}}\n";
}

int run(char* switches, const std::string& input, const std::string& output, const char* stats) {
  auto start = Clock::now();
  const delmesher::io::ReadResult read = delmesher::io::read_surface(input);
  if (!read.ok()) finish(3, input, read.error);
  tetgenio in, out;
  const Markers markers(read.surface);
  fill(read.surface, markers, in);
  const double reading = seconds_since(start);

  start = Clock::now();
  try {
    tetrahedralize(switches, &in, &out);
  } catch (int thrown) {
    refused(thrown, input);
  } catch (const std::bad_alloc&) {
    finish(5, input, "out of memory");
  }
  const double meshing = seconds_since(start);

  start = Clock::now();
  const bool whole_hull = std::strchr(switches, 'c') != nullptr;
  const delmesher::TetMesh mesh = take(out, markers, whole_hull);
  delmesher::io::OutputSet outputs;
  delmesher::io::WriteStatus status = delmesher::io::write_mesh(outputs, output, mesh);
  if (status.ok()) status = outputs.commit();
  if (!status.ok()) finish(3, output, status.error);
  write_statistics(stats, read.surface, mesh, reading, meshing, seconds_since(start));
  finish(0, input, "");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::puts("TetGen " TETGEN_VERSION);
    return 0;
  }
  if (argc != 5) {
    std::fprintf(stderr, "usage: tetproof-tetgen SWITCHES INPUT OUT.mesh STATS.json\n");
    return 2;
  }
  return run(argv[1], argv[2], argv[3], argv[4]);
}
