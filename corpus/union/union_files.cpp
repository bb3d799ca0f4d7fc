#include "corpus/union/union_files.h"

#include <filesystem>
#include <new>
#include <utility>

#include "mesher/delmesher_files.h"

namespace tetproof::unite {
namespace {

namespace io = delmesher::io;
using Say = std::function<void(const std::string&)>;

enum ExitCode {
  kDone = 0,
  kTouching = 1,
  kUnreadable = 3,
  kUnsound = 4,
  kLimit = 5,
  kInternal = 6,
  kInterrupted = 130
};

int exit_code_of(io::ReadCode code) {
  switch (code) {
    case io::ReadCode::ok:
      return kDone;
    case io::ReadCode::unreadable:
      return kUnreadable;
    case io::ReadCode::out_of_memory:
      return kLimit;
    case io::ReadCode::stopped:
      return kInterrupted;
  }
  return kInternal;
}

int exit_code_of(UnionCode code) {
  switch (code) {
    case UnionCode::done:
      return kDone;
    case UnionCode::touching:
      return kTouching;
    case UnionCode::unsound:
    case UnionCode::empty:
      return kUnsound;
    case UnionCode::imprecise:
    case UnionCode::out_of_range:
    case UnionCode::inseparable:
      return kLimit;
    case UnionCode::stopped:
      return kInterrupted;
  }
  return kInternal;
}

// As a mesh that has nothing but a boundary.
delmesher::TetMesh boundary_of(delmesher::Surface surface) {
  delmesher::TetMesh mesh;
  mesh.vertices = std::move(surface.vertices);
  mesh.boundary = std::move(surface.triangles);
  mesh.boundary_labels = std::move(surface.labels);
  mesh.boundary_facets.resize(mesh.boundary.size());
  return mesh;
}

int unite_readable(const std::string& input, const std::string& output, const UnionOptions& options,
                   const Say& say) {
  io::ReadOptions reading;
  reading.go_on = options.go_on;
  io::ReadResult read = io::read_surface(input, reading);
  for (const std::string& warning : read.warnings) say(input + ": warning: " + warning);
  if (!read.ok()) {
    say(read.error);
    return exit_code_of(read.code);
  }
  UnionResult result = unite(read.surface, options);
  for (const std::string& line : result.done) say(input + ": " + line);
  const int code = exit_code_of(result.code);
  if (code != kDone && code != kTouching) {
    say(input + ": " + result.message);
    return code;
  }
  const io::WriteStatus written =
      io::write_mesh(output, boundary_of(std::move(result.surface)), read.names);
  if (!written.ok()) {
    say(written.error);
    return kUnreadable;
  }
  const char* what =
      options.walls ? "triangles for `delmesher mesh --regions all`" : "a valid surface";
  say(output + ": " + (code == kDone ? what : result.message));
  return code;
}

}  // namespace

bool is_surface_output(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  return extension == ".stl" || extension == ".ply" || extension == ".off";
}

int unite_files(const std::string& input, const std::string& output, const UnionOptions& options,
                const Say& say) {
  try {
    return unite_readable(input, output, options, say);
  } catch (const std::bad_alloc&) {
    say(input + ": not enough memory");
    return kLimit;
  } catch (const std::exception& error) {
    say(input + ": internal error: " + error.what());
    return kInternal;
  }
}

}  // namespace tetproof::unite
