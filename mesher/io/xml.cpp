#include "mesher/io/xml.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

// Takes what is before the first of these characters.
std::string_view take_until(std::string_view& text, std::string_view characters) {
  const std::size_t size = std::min(text.find_first_of(characters), text.size());
  const std::string_view taken = text.substr(0, size);
  text.remove_prefix(size);
  return taken;
}

void skip_space(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

// What is between '&' and ';'; false if it means no character.
bool append_reference(std::string& out, std::string_view reference) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kNamed = {
      {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}}};
  for (const auto& [name, character] : kNamed) {
    if (reference == name) return out += character, true;
  }
  if (!reference.starts_with('#')) return false;
  reference.remove_prefix(1);
  const bool hexadecimal = reference.starts_with('x');
  if (hexadecimal) reference.remove_prefix(1);
  std::uint32_t code = 0;
  const char* const last = reference.data() + reference.size();
  const auto [end, error] = std::from_chars(reference.data(), last, code, hexadecimal ? 16 : 10);
  if (error != std::errc() || end != last || code == 0 || code > 0x10ffff) return false;
  if (code >= 0xd800 && code < 0xe000) return false;   // half of a UTF-16 character
  if (code == 0xfffe || code == 0xffff) return false;  // no characters of XML
  append_utf8(out, code);
  return true;
}

}  // namespace

std::uint64_t XmlTags::line_at(std::size_t offset) const {
  return 1 + static_cast<std::uint64_t>(std::count(
                 text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

void XmlTags::fail(const std::string& reason) const {
  io::fail(at_line(line_at(begin_)), reason);
}

std::size_t XmlTags::find(std::string_view what, std::size_t from) const {
  const std::size_t found = text_.find(what, from);
  if (found == std::string_view::npos)
    fail("the file ends where '" + std::string(what) + "' is expected");
  return found;
}

bool XmlTags::next() {
  for (;;) {
    const std::size_t from = end_;
    begin_ = std::min(text_.find('<', from), text_.size());
    polling_.poll(1 + (begin_ - from) / 16);
    if (begin_ == text_.size()) return false;
    const std::string_view rest = text_.substr(begin_);
    if (rest.starts_with("<!--")) {
      end_ = find("-->", begin_ + 4) + 3;
    } else if (rest.starts_with("<![CDATA[")) {
      end_ = find("]]>", begin_) + 3;
    } else if (rest.starts_with("<?")) {
      end_ = find("?>", begin_) + 2;
    } else if (rest.starts_with("<!")) {
      fail("a document type is not read");
    } else {
      read_tag();
      return true;
    }
  }
}

// A '>' may be in the value of an attribute.
void XmlTags::read_tag() {
  std::size_t at = begin_ + 1;
  is_end_ = at < text_.size() && text_[at] == '/';
  if (is_end_) ++at;
  const std::size_t name = at;
  char quote = '\0';
  for (; at < text_.size() && (quote != '\0' || text_[at] != '>'); ++at) {
    const char c = text_[at];
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
  }
  if (at >= text_.size()) fail("an element without an end");
  end_ = at + 1;
  alone_ = !is_end_ && text_[at - 1] == '/';
  attributes_ = text_.substr(name, at - name - (alone_ ? 1 : 0));
  name_ = take_until(attributes_, kSpace);
  if (name_.empty()) fail("an element without a name");
}

bool XmlTags::take_attribute(std::string_view& text, std::string_view& name,
                             std::string_view& value) {
  skip_space(text);
  name = take_until(text, " \t\r\n=");
  skip_space(text);
  if (name.empty() || !text.starts_with('=')) return false;
  text.remove_prefix(1);
  skip_space(text);
  if (!text.starts_with('"') && !text.starts_with('\'')) return false;
  const std::string_view quote = text.substr(0, 1);
  text.remove_prefix(1);
  value = take_until(text, quote);
  if (text.empty()) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<std::string_view> XmlTags::attribute(std::string_view name) const {
  std::string_view rest = attributes_, found, value;
  while (take_attribute(rest, found, value)) {
    if (found == name) return value;
  }
  return std::nullopt;
}

std::string_view XmlTags::text_after() const {
  return text_.substr(end_, std::min(text_.find('<', end_), text_.size()) - end_);
}

std::string_view xml_encoding(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (!text.starts_with("<?xml ")) return {};
  text = text.substr(0, std::min(text.find('>'), text.size()));
  const std::size_t name = text.find("encoding");
  if (name == std::string_view::npos) return {};
  text.remove_prefix(std::min(text.find_first_of("\"'", name), text.size()));
  return text.empty() ? text : text.substr(1, text.find(text.front(), 1) - 1);
}

std::string xml_text(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    out += take_until(text, "&");
    const std::size_t end = text.find(';');
    if (end == std::string_view::npos || !append_reference(out, text.substr(1, end - 1))) {
      out += text.substr(0, 1);
      if (!text.empty()) text.remove_prefix(1);
    } else {
      text.remove_prefix(end + 1);
    }
  }
  return out;
}

}  // namespace delmesher::io
