#include "oracles/vtu_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oracles/text_reader.h"

namespace tetproof::oracles {
namespace {

std::string attribute(std::string_view tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string_view::npos) return {};
  const std::size_t start = at + name.size() + 3;
  return std::string(tag.substr(start, tag.find('"', start) - start));
}

}  // namespace

VtuText::VtuText(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
  for (const std::string tag : {"<Piece", "<Points", "<Cells", "<CellData"}) {
    if (text_.find(tag) != text_.rfind(tag)) fail(tag.substr(1) + " is there twice");
  }
  const std::size_t end = text_.find("</VTKFile>");
  if (end == std::string_view::npos) fail("the end is missing");
  if (text_.find('<', end + 1) != std::string_view::npos) fail("something follows the end");
}

void VtuText::fail(const std::string& reason) const {
  throw ReadError(path_ + ": " + reason);
}

std::int64_t VtuText::integer(double value) const {
  if (!(std::fabs(value) < 0x1p53) || value != std::trunc(value)) fail("a value is no integer");
  return static_cast<std::int64_t>(value);
}

std::vector<double> VtuText::array(const std::string& section, const std::string& name) const {
  std::vector<double> values;
  std::size_t at = text_.find("<" + section);
  if (at == std::string_view::npos) return values;
  const std::size_t end = text_.find("</" + section, at);
  bool found = false;
  while ((at = text_.find("<DataArray", at)) < end) {
    const std::size_t close = text_.find('>', at);
    if (close == std::string_view::npos) break;
    const std::string_view tag = text_.substr(at, close - at);
    at = close;
    if (!name.empty() && attribute(tag, "Name") != name) continue;
    if (std::exchange(found, true)) fail("an array of " + section + " is there twice");
    if (attribute(tag, "format") != "ascii") fail("only text .vtu files are read");
    const std::size_t stop = std::min(text_.find('<', close), text_.size());
    TextReader reader(path_, text_.substr(close + 1, stop - close - 1), '\0');
    while (!reader.at_end()) values.push_back(reader.number());
  }
  return values;
}

}  // namespace tetproof::oracles
