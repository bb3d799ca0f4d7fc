#include "mesher/io/reading.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "mesher/io/inflate.h"
#include "mesher/io/output.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string located(const std::string& path, const ParseError& error) {
  switch (error.position.unit) {
    case Position::Unit::line:
      return path + ":" + std::to_string(error.position.number) + ": " + error.reason;
    case Position::Unit::byte:
      return path + ": " + describe(error.position) + ": " + error.reason;
    case Position::Unit::none:
      break;
  }
  return path + ": " + error.reason;
}

}  // namespace

std::string describe(Position position) {
  const char* unit = position.unit == Position::Unit::byte ? "byte " : "line ";
  return unit + std::to_string(position.number);
}

void fail(Position position, std::string reason) {
  throw ParseError{position, std::move(reason)};
}

namespace {

// The bytes as they stand.
std::string bytes_of_file(const std::string& path, const std::function<bool()>& go_on) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw FileError{path + ": is a directory"};
  const std::unique_ptr<std::FILE, Closer> file(is_standard_stream(path)
                                                    ? ::fdopen(::dup(STDIN_FILENO), "rb")
                                                    : std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError{path + ": cannot open: " + std::strerror(errno)};
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
      throw FileError{path + ": larger than " + std::to_string(kMaxFileBytes >> 30) + " GiB"};
    }
  }
  if (std::ferror(file.get()) != 0) {
    throw FileError{path + ": cannot read: " + std::strerror(errno)};
  }
  return bytes;
}

constexpr std::string_view kGzipExtension = ".gz";

}  // namespace

std::string read_file(const std::string& path, const std::function<bool()>& go_on) {
  std::string bytes = bytes_of_file(path, go_on);
  if (!is_gzip(bytes)) return bytes;
  Polling polling(go_on);
  try {
    return unpacked(bytes, Wrapping::gzip, kMaxFileBytes, polling);
  } catch (const ParseError& error) {
    throw FileError{located(path, error)};
  }
}

std::string without_gz(const std::string& path) {
  const std::size_t size = path.size() - std::min(path.size(), kGzipExtension.size());
  return equal_ignoring_case(path.substr(size), kGzipExtension) ? path.substr(0, size) : path;
}

std::string name_beside(const std::string& path, const char* extension) {
  return std::filesystem::path(without_gz(path)).replace_extension(extension).string();
}

std::string file_beside(const std::string& path, const char* extension) {
  std::string plain = name_beside(path, extension);
  std::string packed = plain + std::string(kGzipExtension);
  return !std::filesystem::exists(plain) && std::filesystem::exists(packed) ? packed : plain;
}

std::optional<std::string> read_beside(const std::string& path, const char* extension,
                                       const std::function<bool()>& go_on) {
  const std::string file = file_beside(path, extension);
  if (!std::filesystem::exists(file)) return std::nullopt;
  return read_file(file, go_on);
}

ReadingEnd end_of_reading(const std::string& path) {
  try {
    throw;
  } catch (const ParseError& error) {
    return {ReadCode::unreadable, located(path, error)};
  } catch (const FileError& error) {
    return {ReadCode::unreadable, error.text};
  } catch (const ReadingStopped&) {
    return {ReadCode::stopped, path + ": stopped while reading"};
  } catch (const std::bad_alloc&) {
    return {ReadCode::out_of_memory, path + ": out of memory while reading"};
  } catch (const std::length_error&) {
    return {ReadCode::out_of_memory, path + ": out of memory while reading"};
  } catch (const std::exception& error) {
    return {ReadCode::unreadable, path + ": " + error.what()};
  }
}

}  // namespace delmesher::io
