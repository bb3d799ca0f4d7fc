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
  remove_comments();
  for (const std::string tag : {"<VTKFile", "<Piece", "<Points", "<Cells", "<CellData"}) {
    if (text_.find(tag) != text_.rfind(tag)) fail(tag.substr(1) + " is there twice");
  }
  if (text_.find("<VTKFile type=\"UnstructuredGrid\"") == std::string_view::npos) {
    fail("it does not begin as an unstructured grid does");
  }
  const std::size_t end = text_.find("</VTKFile>");
  if (end == std::string_view::npos) fail("the end is missing");
  const std::size_t after = end + std::string_view("</VTKFile>").size();
  if (text_.find_first_not_of(" \t\r\n", after) != std::string_view::npos) {
    fail("something follows the end");
  }
  points_ = count("NumberOfPoints");
  cells_ = count("NumberOfCells");
}

// What is in them is not there. Marked sections, which could hold arrays as well, are refused.
void VtuText::remove_comments() {
  if (text_.find("<!") == std::string_view::npos) return;
  for (std::size_t at = 0; at < text_.size();) {
    const std::size_t begin = std::min(text_.find("<!", at), text_.size());
    without_comments_.append(text_.substr(at, begin - at));
    if (begin == text_.size()) break;
    const std::size_t end = text_.find("-->", begin);
    if (!text_.substr(begin).starts_with("<!--") || end == std::string_view::npos) {
      fail("a declaration, or a comment without an end");
    }
    at = end + 3;
  }
  text_ = without_comments_;
}

// Of the piece.
std::size_t VtuText::count(const std::string& name) const {
  const std::size_t at = text_.find("<Piece");
  if (at == std::string_view::npos) fail("there is no piece");
  const std::string number = attribute(text_.substr(at, text_.find('>', at) - at), name);
  if (number.empty()) fail("the piece has no " + name);
  return TextReader(path_, number, '\0').index(0, 0xffffffffU);
}

void VtuText::fail(const std::string& reason) const {
  throw ReadError(path_ + ": " + reason);
}

std::int64_t VtuText::integer(double value) const {
  if (!(std::fabs(value) < 0x1p53) || value != std::trunc(value)) fail("a value is no integer");
  return static_cast<std::int64_t>(value);
}

std::int32_t VtuText::integer32(double value) const {
  const std::int64_t whole = integer(value);
  if (whole != static_cast<std::int32_t>(whole)) fail("a value is no integer of 32 bits");
  return static_cast<std::int32_t>(whole);
}

// The text of an array from there to the end of its element.
std::vector<double> VtuText::values(std::string_view tag, std::size_t start) const {
  std::vector<double> values;
  if (tag.ends_with('/')) return values;
  if (attribute(tag, "format") != "ascii") fail("only text .vtu files are read");
  const std::size_t stop = std::min(text_.find('<', start), text_.size());
  if (!text_.substr(stop).starts_with("</DataArray>")) fail("an array does not end as it should");
  TextReader reader(path_, text_.substr(start, stop - start), '\0');
  while (!reader.at_end()) values.push_back(reader.number());
  if (attribute(tag, "type") == "Float32") {  // which is what readers make of them
    for (double& value : values) value = static_cast<float>(value);
  }
  return values;
}

std::vector<double> VtuText::array(const std::string& section, const std::string& name) const {
  std::vector<double> result;
  std::size_t at = text_.find("<" + section);
  if (at == std::string_view::npos) return result;
  const std::size_t end = text_.find("</" + section, at);
  if (end == std::string_view::npos) fail(section + " does not end");
  const std::string wanted = section == "Points" ? "3" : "1";
  const std::string what = "the array " + name + (name.empty() ? "" : " ") + "of " + section;
  bool found = false;
  while ((at = text_.find("<DataArray", at)) < end) {
    const std::size_t close = text_.find('>', at);
    if (close == std::string_view::npos) fail("a tag does not end");
    const std::string_view tag = text_.substr(at, close - at);
    at = close;
    const std::string called = attribute(tag, "Name");
    // It could be this one all the same.
    if (!name.empty() && (called.empty() || called.find('&') != std::string::npos)) {
      fail("an array of " + section + " without a plain name");
    }
    if (!name.empty() && called != name) continue;
    if (std::exchange(found, true)) fail(what + " is there twice");
    const std::string components = attribute(tag, "NumberOfComponents");
    if (components != wanted && !(components.empty() && wanted == "1")) {
      fail(what + " has \"" + components + "\" components, not " + wanted);
    }
    result = values(tag, close + 1);
    const std::size_t size = section == "Points" ? 3 * points_ : cells_;
    if (name != "connectivity" && result.size() != size) {
      fail(what + " has " + std::to_string(result.size()) + " values, not " + std::to_string(size));
    }
  }
  return result;
}

std::vector<double> VtuText::required_array(const std::string& section,
                                            const std::string& name) const {
  std::vector<double> result = array(section, name);
  if (result.empty() && (section == "Points" ? points_ : cells_) > 0) {
    fail("the array " + name + (name.empty() ? "" : " ") + "of " + section + " is missing");
  }
  return result;
}

}  // namespace tetproof::oracles
