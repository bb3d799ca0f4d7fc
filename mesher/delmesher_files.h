// Files of surfaces, planar graphs, meshes and exact records, as the command line reads and writes
// them: library delmesher::io, which needs the standard library, and zlib if it was built with it.
// mesher/io/formats.md and mesher/io/exact_format.md describe the formats.
//
// With zlib, files that are compressed with gzip are read as well, ".gz" after their name or not.
// Nothing is thrown but std::bad_alloc. An error is one line that names the file, and the line or
// byte where there is one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "delmesher.h"
#include "delmesher_plane.h"

namespace delmesher::io {

enum class ReadCode : std::uint8_t {
  ok,
  unreadable,
  out_of_memory,
  stopped  // ReadOptions::go_on said no
};

// The names of labels in files; the mesher knows their numbers alone. A label need not have a name.
using LabelNames = std::map<std::int32_t, std::string>;

struct ReadResult {
  ReadCode code = ReadCode::ok;
  std::string error;  // "file:line: reason", "file: byte N: reason" or "file: reason"
  Surface surface;
  LabelNames names;    // solids of an STL, objects of a 3MF, materials, groups or objects of an OBJ
  std::string format;  // "OFF", "OBJ", "STL", "PLY", "3MF", "smesh", "poly"
  std::vector<std::string> warnings;                // what the user should know
  std::vector<std::string> notes;                   // for a log
  std::vector<std::array<std::uint32_t, 2>> lines;  // ReadOptions::planar: edges of polylines
  std::vector<RegionPoint> region_points;           // of .poly and .smesh
  bool ok() const { return code == ReadCode::ok; }
};

struct ReadOptions {
  // OBJ vertices may have two coordinates, and polylines are read; there may be no faces then.
  bool planar = false;
  // Asked many times a second while a file is read; reading stops when it answers no.
  std::function<bool()> go_on;
};

// A surface from OFF, OBJ, STL, PLY, 3MF, or TetGen's .smesh and .poly, by content and extension.
// Faces of more than three corners are cut by the rule of formats.md; check_surface() and
// tetrahedralize() decide whether the surface is valid.
ReadResult read_surface(const std::string& path, const ReadOptions& options = {});

struct PlaneReadResult {
  ReadCode code = ReadCode::ok;
  std::string error;  // "file:line: reason" or "file: reason"
  PlanarGraph graph;
  std::string format;  // "poly", "OFF", "OBJ", "polygons"
  std::vector<std::string> warnings;
  bool ok() const { return code == ReadCode::ok; }
};

// A planar straight-line graph from Triangle's .poly, flat OFF and OBJ, or rings of "x y" lines.
// `go_on`: ReadOptions::go_on.
PlaneReadResult read_plane(const std::string& path, const std::function<bool()>& go_on = {});

struct MeshReadResult {
  ReadCode code = ReadCode::ok;
  std::string error;  // "file:line: reason" or "file: reason"
  TetMesh mesh;
  LabelNames names;  // of physical groups, in .msh and .vtu
  LabelNames region_names;
  std::string format;  // "MEDIT", "Gmsh", "VTU", "TetGen", "tet"
  // 2: there are elements of second order. Their corners are the mesh; nodes in the middle of edges
  // are left out, and a warning says how far off the middle they are.
  int order = 1;
  std::vector<std::string> warnings;
  bool ok() const { return code == ReadCode::ok; }
};

// A tetrahedral mesh, by the extension: .mesh (MEDIT), .msh (Gmsh 4.1 or 2.2), .vtu, .node or .ele
// (TetGen, which stand together, and a .face if there is one), .tet. Vertices of cells are
// in range and coordinates are finite; improve_mesh() decides whether the mesh is conforming.
// "-" is standard input, known by its content: of these all but TetGen's. `go_on`:
// ReadOptions::go_on.
MeshReadResult read_mesh(const std::string& path, const std::function<bool()>& go_on = {});

struct NamesResult {
  std::string error;  // "file:line: reason" or "file: reason"; empty if read
  LabelNames names;
  bool ok() const { return error.empty(); }
};

// Lines "LABEL NAME", the name being the rest of the line; blank lines and '#' comments are
// skipped.
NamesResult read_label_names(const std::string& path);

struct SizeFieldResult {
  std::string error;  // "file:line: reason" or "file: reason"; empty if read
  std::vector<SizeSource> sources;
  bool ok() const { return error.empty(); }
};

// Options::size_field from lines "X Y Z SIZE", with spaces or commas between them; blank lines, '#'
// comments and a first line of words are skipped. Or a view of scalars as Gmsh's .pos, whose points
// and corners of elements become the sources.
SizeFieldResult read_size_field(const std::string& path);

struct PointsResult {
  std::string error;  // "file:line: reason" or "file: reason"; empty if read
  std::vector<std::array<double, 3>> points;
  bool ok() const { return error.empty(); }
};

// Lines "X Y Z", as those of a size field. Further vertices of a surface become vertices of its
// mesh.
PointsResult read_points(const std::string& path);

struct ExactResult {
  std::string error;  // "file:line: reason"; empty if read
  ExactRecord record;
  bool ok() const { return error.empty(); }
};

// Reads a file written by write_exact().
ExactResult read_exact(const std::string& path);

// The reason why a file could not be written, "file: reason"; empty if all is well.
struct WriteStatus {
  std::string error;
  std::vector<std::string> warnings = {};  // of what the format cannot hold, a line each
  bool ok() const { return error.empty(); }
};

// Of Gmsh's .msh: MFEM, GetDP, Palace and others read 2.2 alone, which is always text.
enum class MshVersion : std::uint8_t { v4_1, v2_2 };

struct WriteOptions {
  // 2: ten-node tetrahedra and six-node triangles with straight edges, whose further nodes are in
  // the middle of the edges as written; in .mesh, .msh, .vtu, .vtk, .inp and .bdf. Else 1.
  int order = 1;
  // As text where a format has both, .msh and .vtu; else as bytes.
  bool ascii = false;
  MshVersion msh = MshVersion::v4_1;
  // The names of TetMesh::regions.
  LabelNames region_names = {};
};

// Each file, or set of files, is complete or what it was before. The format is that of the
// extension: .mesh (MEDIT), .msh (Gmsh), .vtu, .node (TetGen, with .ele and .face beside it),
// .tet, .inp (Abaqus), .bdf (Nastran), .vtk (legacy), .xdmf, and of the boundary alone .stl, .ply
// and .off. formats.md says where names are written; of equal ones all but the first get a number.
WriteStatus write_mesh(const std::string& path, const TetMesh& mesh, const LabelNames& names = {},
                       const WriteOptions& options = {});
// A surface, as .stl, .ply or .off.
WriteStatus write_surface(const std::string& path, const Surface& surface,
                          const LabelNames& names = {});
// OFF; labels are not kept, as the format has none.
WriteStatus write_off(const std::string& path, const Surface& surface);
// .node (Triangle, with .ele and .poly), .vtu, .off, .msh, .svg. The holes and regions of `graph`,
// if any, go into a .poly, so that it means the same as the input. Elements are of first order.
WriteStatus write_plane(const std::string& path, const PlaneMesh& mesh,
                        const PlanarGraph* graph = nullptr, const WriteOptions& options = {});
// The sidecars of --exact.
WriteStatus write_exact(const std::string& path, const ExactRecord& record);
WriteStatus write_plane_exact(const std::string& path, const PlaneRecord& record);

}  // namespace delmesher::io
