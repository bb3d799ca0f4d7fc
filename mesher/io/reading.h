// The common parts of all readers: files as bytes, and errors as results.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "mesher/base/polling.h"
#include "mesher/delmesher_files.h"

namespace delmesher::io {

struct Position {
  enum class Unit : std::uint8_t { none, line, byte };
  Unit unit = Unit::none;
  std::uint64_t number = 0;
};

inline Position at_line(std::uint64_t line) {
  return {Position::Unit::line, line};
}
inline Position at_byte(std::uint64_t byte) {
  return {Position::Unit::byte, byte};
}

std::string describe(Position position);  // "line 7", "byte 90"

// Thrown by readers of one text, which do not know its name.
struct ParseError {
  Position position;
  std::string reason;
};

[[noreturn]] void fail(Position position, std::string reason);

// Thrown by readers of several files, with the whole line: "file:line: reason" or "file: reason".
struct FileError {
  std::string text;
};

// Larger files are rejected.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

// A whole file as bytes, unpacked if they are compressed with gzip. Throws FileError and, if
// `go_on` says no, ReadingStopped.
std::string read_file(const std::string& path, const std::function<bool()>& go_on = {});

// The path that determines the format: "part.stl" for "part.stl.gz".
std::string without_gz(const std::string& path);

// The name of the file beside another one, with its own extension.
std::string name_beside(const std::string& path, const char* extension);

// That, with ".gz" after it where only such a file exists.
std::string file_beside(const std::string& path, const char* extension);

// The bytes of that file; nullopt if there is none. Throws as read_file() does.
std::optional<std::string> read_beside(const std::string& path, const char* extension,
                                       const std::function<bool()>& go_on);

struct ReadingEnd {
  ReadCode code;
  std::string error;
};

// To be called in a handler: the meaning of the current exception for the caller who asked for
// `path`. Rethrows an exception that is not a reader's.
ReadingEnd end_of_reading(const std::string& path);

// The result that `body` fills. Where it throws, the result is empty except for code and error.
template <class Result, class Body>
Result caught(const std::string& path, const Body& body) {
  Result result;
  try {
    body(result);
  } catch (...) {
    result = {};
    auto [code, error] = end_of_reading(path);
    result.code = code;
    result.error = std::move(error);
  }
  return result;
}

}  // namespace delmesher::io
