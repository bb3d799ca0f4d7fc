#include "mesher/io/parse_surface.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "mesher/io/foreign_content.h"
#include "mesher/io/output.h"
#include "mesher/io/readers.h"

namespace delmesher::io {
namespace {

enum class Format : std::uint8_t { off, obj, stl, ply, smesh, poly, unknown, foreign };

constexpr const char* kNames[] = {"OFF", "OBJ", "STL", "PLY", "smesh", "poly", "", ""};

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// Formats with a signature are known by it whatever the file is called; the others by name.
Format detect(std::string_view bytes, const std::string& path) {
  if (looks_like_ply(bytes)) return Format::ply;
  if (looks_like_off(bytes)) return Format::off;
  const std::string extension = lower_extension(path);
  if (looks_like_stl(bytes)) return Format::stl;
  if (!foreign_content(bytes).empty()) return Format::foreign;
  if (extension == ".off") return Format::off;
  if (extension == ".obj") return Format::obj;
  if (extension == ".stl") return Format::stl;
  if (extension == ".ply") return Format::ply;
  if (extension == ".smesh") return Format::smesh;
  if (extension == ".poly") return Format::poly;
  return looks_like_obj(bytes) ? Format::obj : Format::unknown;
}

std::string located(const std::string& path, const ParseError& error) {
  switch (error.position.unit) {
    case Position::Unit::line:
      return path + ":" + std::to_string(error.position.number) + ": " + error.reason;
    case Position::Unit::byte:
      return path + ": byte " + std::to_string(error.position.number) + ": " + error.reason;
    case Position::Unit::none:
      break;
  }
  return path + ": " + error.reason;
}

void read(std::string_view bytes, Format format, const NodeFile& node_file,
          const ReadOptions& options, SurfaceBuilder& builder) {
  switch (format) {
    case Format::off:
      return read_off(bytes, builder);
    case Format::obj:
      return read_obj(bytes, options.planar, builder);
    case Format::stl:
      return read_stl(bytes, builder);
    case Format::ply:
      return read_ply(bytes, builder);
    case Format::smesh:
      return read_tetgen(bytes, TetgenKind::smesh, node_file, builder);
    case Format::poly:
      return read_tetgen(bytes, TetgenKind::poly, node_file, builder);
    case Format::foreign:
      fail({}, std::string(foreign_content(bytes)));
    case Format::unknown:
      break;
  }
  fail({}, "not a known format (OFF, OBJ, STL, PLY, .smesh, .poly)");
}

ReadResult parse(std::string_view bytes, const std::string& path, const NodeFile& node_file,
                 const ReadOptions& options) {
  ReadResult result;
  SurfaceBuilder builder(options.go_on);
  try {
    const Format format = detect(bytes, path);
    result.format = kNames[static_cast<std::size_t>(format)];
    read(bytes, format, node_file, options, builder);
    result.surface = builder.finish();
    result.lines = builder.lines();
    result.warnings = builder.warnings();
    result.notes = builder.notes();
    result.names = builder.names();
  } catch (const ParseError& error) {
    result.code = ReadCode::unreadable;
    result.error = located(path, error);
  } catch (const std::bad_alloc&) {
    result.code = ReadCode::out_of_memory;
    result.error = path + ": out of memory while reading";
  } catch (const std::length_error&) {
    result.code = ReadCode::out_of_memory;
    result.error = path + ": out of memory while reading";
  } catch (const ReadingStopped&) {
    result.code = ReadCode::stopped;
    result.error = path + ": stopped while reading";
  }
  return result;
}

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::optional<std::string> read_file(const std::string& path, std::string& error,
                                     const std::function<bool()>& go_on) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    error = "is a directory";
    return std::nullopt;
  }
  const std::unique_ptr<std::FILE, Closer> file(is_standard_stream(path)
                                                    ? ::fdopen(::dup(STDIN_FILENO), "rb")
                                                    : std::fopen(path.c_str(), "rb"));
  if (!file) {
    error = "cannot open: " + std::string(std::strerror(errno));
    return std::nullopt;
  }
  std::string bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  if (!ignored && size <= kMaxFileBytes) bytes.reserve(size + 1);
  // In pieces, so that pipes work and endless files end.
  for (std::size_t piece = std::size_t{1} << 16;;
       piece = std::min(2 * piece, std::size_t{1} << 24)) {
    const std::size_t old = bytes.size();
    bytes.resize(old + piece);
    const std::size_t got = std::fread(bytes.data() + old, 1, piece, file.get());
    bytes.resize(old + got);
    if (got < piece) break;
    if (go_on && !go_on()) throw ReadingStopped();
    if (bytes.size() > kMaxFileBytes) {
      error = "larger than " + std::to_string(kMaxFileBytes >> 30) + " GiB";
      return std::nullopt;
    }
  }
  if (std::ferror(file.get()) != 0) {
    error = "cannot read: " + std::string(std::strerror(errno));
    return std::nullopt;
  }
  return bytes;
}

ReadResult parse_surface(std::string_view bytes, const std::string& path,
                         const ReadOptions& options) {
  return parse(bytes, path, nullptr, options);
}

ReadResult read_surface(const std::string& path, const ReadOptions& options) {
  ReadResult result;
  try {
    std::string error;
    const auto bytes = read_file(path, error, options.go_on);
    if (!bytes) {
      result.code = ReadCode::unreadable;
      result.error = path + ": " + error;
      return result;
    }
    const NodeFile node_file = [&]() -> std::optional<std::string> {
      std::string ignored;
      return read_file(std::filesystem::path(path).replace_extension(".node").string(), ignored,
                       options.go_on);
    };
    return parse(*bytes, path, node_file, options);
  } catch (const std::bad_alloc&) {
    result.code = ReadCode::out_of_memory;
    result.error = path + ": out of memory while reading";
  } catch (const ReadingStopped&) {
    result.code = ReadCode::stopped;
    result.error = path + ": stopped while reading";
  } catch (const std::exception& error) {
    result.code = ReadCode::unreadable;
    result.error = path + ": " + error.what();
  }
  return result;
}

}  // namespace delmesher::io
