// Texts in XML, as Expat reads them; VTK reads its files with it as well.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tetproof::oracles {

struct XmlElement {
  std::string name;  // with its prefix, if it has one
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::size_t begin = 0, end = 0;  // the bytes between its tags
  bool has_text_behind_child = false;

  // nullptr if there is none of that name.
  const std::string* attribute(const std::string& key) const;
  // Empty if there is none.
  std::string value(const std::string& key) const;
  // Those of that name.
  std::vector<const XmlElement*> all(const std::string& wanted) const;
};

// The element of which a text consists; `name` stands for it in messages. Comments and instructions
// say nothing. Throws ReadError, with the line: also where there is a document type, which could
// define entities, and where elements are more than 64 deep.
XmlElement read_xml(const std::string& name, std::string_view text);

// The same, but the text ends behind the start of the first element `last` in the top element, and
// bytes that are not XML may follow: they begin at `end`, the size of the text if there is none.
// More than a million elements are rejected.
XmlElement read_xml_until(const std::string& name, std::string_view text, std::string_view last,
                          std::size_t& end);

}  // namespace tetproof::oracles
