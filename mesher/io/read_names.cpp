#include "mesher/io/foreign_content.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

LabelNames parse_names(std::string_view text) {
  LabelNames names;
  TextLines in(text, Comments::at_token_start);
  while (in.next_line()) {
    std::string_view token;
    in.next_token(token);
    std::int32_t label = 0;
    const Position here = at_line(in.line());
    if (!parse_integer(token, label)) fail(here, "no label: " + in_quotes(token));
    const std::string name = as_utf8(in.rest_of_line());
    if (name.empty()) fail(here, "label " + std::to_string(label) + " has no name");
    if (!names.try_emplace(label, name).second) {
      fail(here, "label " + std::to_string(label) + " is named twice");
    }
  }
  return names;
}

}  // namespace

NamesResult read_label_names(const std::string& path) {
  try {
    const std::string bytes = read_file(path);
    if (const std::string_view foreign = foreign_content(bytes); !foreign.empty()) {
      return {path + ": " + std::string(foreign), {}};
    }
    return {{}, parse_names(bytes)};
  } catch (...) {
    return {end_of_reading(path).error, {}};
  }
}

}  // namespace delmesher::io
