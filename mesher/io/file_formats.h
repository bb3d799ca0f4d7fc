// Tables of formats: what the extension of a path means. A row of any table has `extensions`, of
// which the first is the one that a path has.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/io/output.h"
#include "mesher/io/text.h"

namespace delmesher::io {

// One file per extension of a format.
using Sinks = std::span<TextSink* const>;

// What a format cannot tell, in bits.
enum Lacks : unsigned {
  kLacksNothing = 0,
  kLacksNames = 1,    // of labels and regions, which it has
  kLacksLabels = 2,   // or the markers of edges
  kLacksRegions = 4,  // but for the two sides
  kLacksSides = 8
};

template <class Written>
struct FileFormat {
  // The one that a path has, then those of the files that are written beside it.
  std::array<std::string_view, 3> extensions;
  void (*write)(Sinks files, const Written& written);
  unsigned lacks = kLacksNothing;
};

// The warnings that something is lost; `there`: bits of what there is.
inline std::vector<std::string> losses(const std::string& path, unsigned lacks, unsigned there) {
  struct Text {
    unsigned bit;
    const char* what;
  };
  static constexpr std::array<Text, 4> kTexts = {{{kLacksRegions, "regions"},
                                                  {kLacksSides, "inside and outside"},
                                                  {kLacksLabels, "labels"},
                                                  {kLacksNames, "names"}}};
  std::vector<std::string> lost;
  for (const auto& [bit, what] : kTexts) {
    if ((lacks & there & bit) != 0) {
      lost.push_back(path + " has no place for the " + what + ", which are lost there");
    }
  }
  return lost;
}

// Is there more than one value?
template <class Values>
bool several(const Values& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to()) != values.end();
}

// The format that the path's extension means, in any case; null if it means none.
template <class Format, std::size_t N>
const Format* format_of(const std::array<Format, N>& table, const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  for (const Format& format : table) {
    if (equal_ignoring_case(extension, format.extensions[0])) return &format;
  }
  return nullptr;
}

// The files that writing to the path makes: itself, and those beside it. Empty if its extension
// means no format.
template <class Written, std::size_t N>
std::vector<std::string> files_made(const std::array<FileFormat<Written>, N>& table,
                                    const std::string& path) {
  const FileFormat<Written>* format = format_of(table, path);
  if (format == nullptr) return {};
  std::vector<std::string> files = {path};
  for (const std::string_view extension : std::span(format->extensions).subspan(1)) {
    if (extension.empty()) continue;
    files.push_back(std::filesystem::path(path).replace_extension(extension).string());
  }
  return files;
}

// ".a, .b or .c"
template <class Format, std::size_t N>
std::string extensions_of(const std::array<Format, N>& table) {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) text += i + 1 < N ? ", " : " or ";
    text += table[i].extensions[0];
  }
  return text;
}

// Adds the files to a set of outputs, in the format of the path's extension.
// `there`: bits of Lacks, what there is to be told.
template <class Written, std::size_t N>
WriteStatus write_by_extension(const std::array<FileFormat<Written>, N>& table, OutputSet& outputs,
                               const std::string& path, const Written& written, unsigned there) {
  const FileFormat<Written>* format = format_of(table, path);
  if (format == nullptr) return {path + ": unknown mesh format (" + extensions_of(table) + ")"};
  WriteStatus status{{}, losses(path, format->lacks, there)};
  std::vector<TextSink*> sinks;
  for (const std::string& file : files_made(table, path)) {
    sinks.push_back(outputs.open(file, status));
    if (!status.ok()) return status;
  }
  format->write(sinks, written);
  return status;
}

}  // namespace delmesher::io
