// tetproof-tetgen [--markers label|facet|triangle|one] SWITCHES INPUT OUT.mesh STATS.json
//
// TetGen, in memory, on the very doubles that our own mesher reads, with its result written by the
// same writer and the same exit codes: 3 input unreadable, 4 refused, 5 out of memory, 6 internal
// error. TetGen may also abort, hang or crash: the caller runs this as a supervised child.
#include <tetgen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <new>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "corpus/peers/programs/adapter.h"
#include "corpus/peers/tetgen/inside_flood.h"

namespace {

using tetproof::adapter::Call;
using tetproof::adapter::finish;

// Ends with the meaning of the integer that TetGen throws.
[[noreturn]] void refused(int thrown, const Call& call) {
  switch (thrown) {
    case 1:
      finish(call, 5, call.input, "TetGen 1: out of memory");
    case 2:
      finish(call, 6, call.input, "TetGen 2: internal error");
    case 3:
      finish(call, 4, call.input, "TetGen 3: self-intersection detected");
    case 4:
      finish(call, 4, call.input, "TetGen 4: very small input feature");
    case 5:
      finish(call, 4, call.input, "TetGen 5: two very close input facets");
    case 10:
      finish(call, 4, call.input, "TetGen 10: input error");
    default:
      finish(call, 4, call.input, "TetGen " + std::to_string(thrown));
  }
}

// The triangles that share a facet marker. TetGen merges adjacent facets of one marker that are
// almost coplanar, by a tolerance of its own, and keeps the edges between different markers.
// README.md has the consequences.
enum class MarkersBy : std::uint8_t {
  label,     // all triangles of one label of the input
  facet,     // adjacent triangles of one label that are exactly coplanar
  triangle,  // none
  one        // all, as if there were no markers
};

constexpr struct {
  const char* name;
  MarkersBy by;
} kMarkersBy[] = {{"label", MarkersBy::label},
                  {"facet", MarkersBy::facet},
                  {"triangle", MarkersBy::triangle},
                  {"one", MarkersBy::one}};

// Faces of no facet have marker 0 or, on the hull, 1; ours start well above.
constexpr int kFirstMarker = 16;

// The exactly coplanar neighbours of one label, each group named by its smallest triangle.
std::vector<std::uint32_t> coplanar_groups(const delmesher::Surface& surface) {
  double extent[3] = {0, 0, 0};
  for (const auto& vertex : surface.vertices) {
    for (int c = 0; c < 3; ++c) extent[c] = std::max(extent[c], std::fabs(vertex[c]));
  }
  exactinit(0, 0, 0, 2 * extent[0], 2 * extent[1], 2 * extent[2]);
  std::vector<std::uint32_t> group(surface.triangles.size());
  std::iota(group.begin(), group.end(), 0U);
  const auto root = [&](std::uint32_t t) {
    while (group[t] != t) t = group[t] = group[group[t]];
    return t;
  };
  const auto coplanar = [&](std::uint32_t t, std::uint32_t vertex) {
    REAL p[4][3];
    const auto& corners = surface.triangles[t];
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 3; ++i) p[i][c] = surface.vertices[corners[i]][c];
      p[3][c] = surface.vertices[vertex][c];
    }
    return orient3d(p[0], p[1], p[2], p[3]) == 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_at;  // edge -> triangle
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] =
          std::minmax(surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]);
      const auto [at, fresh] = first_at.try_emplace({low, high}, t);
      if (fresh) continue;
      const std::uint32_t other = at->second;
      const bool same_label = surface.labels.empty() || surface.labels[t] == surface.labels[other];
      if (!same_label || !coplanar(other, surface.triangles[t][(i + 2) % 3])) continue;
      const auto [a, b] = std::minmax({root(t), root(other)});  // values, not references
      group[b] = a;
    }
  }
  for (std::uint32_t t = 0; t < group.size(); ++t) group[t] = root(t);
  return group;
}

struct Markers {
  std::vector<int> of_triangle;          // from kFirstMarker on
  std::vector<std::uint32_t> triangles;  // by marker - kFirstMarker: its smallest input triangle

  Markers(const delmesher::Surface& surface, MarkersBy by) {
    std::vector<std::uint32_t> coplanar;
    if (by == MarkersBy::facet) coplanar = coplanar_groups(surface);
    std::map<std::int64_t, int> known;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      std::int64_t key = 0;
      if (by == MarkersBy::label && !surface.labels.empty()) key = surface.labels[t];
      if (by == MarkersBy::facet) key = coplanar[t];
      if (by == MarkersBy::triangle) key = t;
      const int next = kFirstMarker + static_cast<int>(triangles.size());
      const auto [at, fresh] = known.try_emplace(key, next);
      if (fresh) triangles.push_back(t);
      of_triangle.push_back(at->second);
    }
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
    in.facetmarkerlist[i] = markers.of_triangle[i];
  }
}

delmesher::TetMesh take(const tetgenio& out, const delmesher::Surface& surface,
                        const Markers& markers, bool whole_hull) {
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
    // TetGen does not tell the facet, so that it is the first of its marker.
    const std::uint32_t facet =
        markers.triangles.at(static_cast<std::size_t>(marker - kFirstMarker));
    mesh.boundary_labels.push_back(surface.labels.empty() ? 0 : surface.labels[facet]);
    mesh.boundary_facets.push_back(facet);
  }
  tetproof::adapter::orient(mesh);
  if (whole_hull) mesh.inside = tetproof::flood_inside(mesh.tetrahedra, mesh.boundary);
  if (mesh.inside.empty()) mesh.inside.assign(mesh.tetrahedra.size(), whole_hull ? 0 : 1);
  return mesh;
}

// `switches` is TetGen's to write into.
[[noreturn]] void run(MarkersBy by, char* switches, const Call& call) {
  const tetproof::adapter::Stopwatch reading;
  const delmesher::Surface surface = tetproof::adapter::read(call);
  tetgenio in, out;
  const Markers markers(surface, by);
  fill(surface, markers, in);
  const double read_seconds = reading.seconds();

  const tetproof::adapter::Stopwatch meshing;
  try {
    tetrahedralize(switches, &in, &out);
  } catch (int thrown) {
    refused(thrown, call);
  } catch (const std::bad_alloc&) {
    finish(call, 5, call.input, "out of memory");
  }
  const double mesh_seconds = meshing.seconds();
  const bool whole_hull = std::strchr(switches, 'c') != nullptr;
  tetproof::adapter::deliver(call, surface, take(out, surface, markers, whole_hull), read_seconds,
                             mesh_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::puts("TetGen " TETGEN_VERSION);
    return 0;
  }
  MarkersBy by = MarkersBy::facet;
  bool understood = argc == 5 || argc == 7;
  if (argc == 7) {
    understood = false;
    for (const auto& choice : kMarkersBy) {
      if (std::strcmp(argv[1], "--markers") != 0 || std::strcmp(argv[2], choice.name) != 0)
        continue;
      by = choice.by;
      understood = true;
    }
    argv += 2;
  }
  if (!understood) {
    std::fprintf(stderr,
                 "usage: tetproof-tetgen [--markers label|facet|triangle|one] SWITCHES INPUT "
                 "OUT.mesh STATS.json\n");
    return 2;
  }
  run(by, argv[1], {"tetproof-tetgen", argv[1], argv[2], argv[3], argv[4]});
}
