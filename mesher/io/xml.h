// The tags of a text in XML, one after the other: as much as the readers of .vtu and .3mf need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mesher/base/polling.h"

namespace delmesher::io {

// Comments, processing instructions and CDATA sections are passed over; a document type, which
// could define entities, is rejected. Whether elements are nested as they should be is left to the
// reader. The text must outlive it.
class XmlTags {
 public:
  XmlTags(std::string_view text, Polling& polling) : text_(text), polling_(polling) {}

  // Moves to the next tag; false if there is none. Throws ParseError, with the line.
  bool next();

  // The name of the current tag: "a" of <a ...>, <a/> and </a>, with its prefix if it has one.
  std::string_view name() const { return name_; }
  bool begins() const { return !is_end_; }         // <a ...> or <a/>
  bool ends() const { return is_end_ || alone_; }  // </a> or <a/>
  // The value of an attribute as it stands, which may have references (see xml_text); nullopt if
  // there is none of that name.
  std::optional<std::string_view> attribute(std::string_view name) const;

  // Calls take(name, value) with each attribute.
  template <class Take>
  void each_attribute(const Take& take) const {
    std::string_view rest = attributes_, name, value;
    while (take_attribute(rest, name, value)) take(name, value);
  }

  // What stands between the current tag and the next '<'.
  std::string_view text_after() const;

  std::size_t begin() const { return begin_; }  // of the current tag
  std::size_t end() const { return end_; }      // the byte after it
  // The line on which a byte is.
  std::uint64_t line_at(std::size_t offset) const;
  // Throws ParseError with the line of the current tag.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  // Where the first `what` from there on is; throws if there is none.
  std::size_t find(std::string_view what, std::size_t from) const;
  void read_tag();
  // NAME = "VALUE" or 'VALUE'; false at the end, and where there is something else.
  static bool take_attribute(std::string_view& text, std::string_view& name,
                             std::string_view& value);

  std::string_view text_;
  Polling& polling_;
  std::size_t begin_ = 0, end_ = 0;
  std::string_view name_, attributes_;
  bool is_end_ = false, alone_ = false;
};

// How the text's declaration says that it is encoded; empty if it says nothing.
std::string_view xml_encoding(std::string_view text);

// Text with its references to characters replaced ("&lt;", "&#8364;"); other references stay.
std::string xml_text(std::string_view text);

}  // namespace delmesher::io
