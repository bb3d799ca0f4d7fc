#include "mesher/io/parse_surface.h"
#include "mesher/io/text.h"

namespace delmesher::io {

NamesResult read_label_names(const std::string& path) {
  NamesResult result;
  std::string error;
  const auto text = read_file(path, error);
  if (!text) return {path + ": " + error, {}};
  TextLines in(*text, Comments::at_token_start);
  while (in.next_line()) {
    std::string_view token;
    in.next_token(token);
    std::int32_t label = 0;
    const std::string at = path + ":" + std::to_string(in.line()) + ": ";
    if (!parse_integer(token, label)) return {at + "no label: " + quoted(token), {}};
    const std::string name(in.rest_of_line());
    if (name.empty()) return {at + "label " + std::to_string(label) + " has no name", {}};
    if (!result.names.try_emplace(label, name).second) {
      return {at + "label " + std::to_string(label) + " is named twice", {}};
    }
  }
  return result;
}

}  // namespace delmesher::io
