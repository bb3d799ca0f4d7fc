// Carries out a parsed command.
#pragma once

#include <functional>
#include <string>

#include "mesher/cli/arguments.h"
#include "mesher/delmesher_plane.h"

namespace delmesher::cli {

// The functions of the library. Tests put others in their place.
struct Library {
  std::function<Result(const Surface&, const Options&)> tetrahedralize;
  std::function<Result(const Surface&, const CdtOptions&)> constrained_delaunay;
  std::function<SurfaceReport(const Surface&, const CheckOptions&)> check_surface;
  std::function<PlaneResult(const PlanarGraph&, const PlaneOptions&)> triangulate_polygon = nullptr;
  std::function<Result(const TetMesh&, const ImproveOptions&)> improve_mesh = nullptr;
  std::function<RemeshResult(const Surface&, const RemeshOptions&)> remesh_surface = nullptr;
};

struct Streams {
  std::function<void(const std::string&)> out, error;
  bool terminal = false;  // standard error is one: show progress
  bool escapes = false;   // and takes escape sequences
};

// The exit code; never throws. Errors are one line, "delmesher: FILE: reason".
int run(const Command& command, const Library& library, const Streams& streams);

}  // namespace delmesher::cli
