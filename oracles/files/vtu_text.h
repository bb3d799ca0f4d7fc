// The arrays of a .vtu file, written as text or as bytes: in base 64 or raw, in their place or
// appended, compressed with zlib or not.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "oracles/files/set_names.h"
#include "oracles/files/xml_text.h"

namespace tetproof::oracles {

// Nothing that is read may be there twice, or at another place than the format's, as readers differ
// in what they take then.
// All functions throw ReadError.
class VtuText {
 public:
  // The text must outlive this.
  VtuText(std::string path, std::string_view text);
  VtuText(const VtuText&) = delete;

  // The values of the array of that name in a section ("Points", "Cells", "CellData"); of the only
  // one there if the name is empty. Three for each point, one for each cell except for
  // "connectivity". Empty if there is none.
  std::vector<double> array(const std::string& section, const std::string& name) const;
  // The same, but there must be one unless it would be empty.
  std::vector<double> required_array(const std::string& section, const std::string& name) const;
  // Field arrays of two integers, a number and a dimension, by their names.
  SetNames names() const;
  // The number of the field array "PlanarWithin", 0 if there is none.
  double planar_within() const;
  // An integer of at most 53 bits, and of 32.
  std::int64_t integer(double value) const;
  std::int32_t integer32(double value) const;
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::vector<const XmlElement*> field_arrays() const;
  void take_appended(std::string_view text);
  void check(const XmlElement& element);
  // The element of that name; there must be one, and one at most.
  const XmlElement& only(const XmlElement& parent, const std::string& name) const;
  // nullptr if there is none.
  const XmlElement* at_most_one(const XmlElement& parent, const std::string& name) const;
  std::size_t count(const std::string& name) const;
  std::uint64_t size_at(std::string_view& bytes) const;
  std::string unpacked(std::string_view bytes) const;
  std::vector<double> binary_values(const std::string& type, std::string_view bytes,
                                    bool appended) const;
  std::string_view appended_at(std::uint64_t offset) const;
  std::uint64_t offset_of(const XmlElement& array) const;
  std::vector<double> values(const XmlElement& array) const;

  std::string path_;
  std::string_view text_, appended_;  // after the '_'
  bool appended_raw_ = false;
  XmlElement file_;
  const XmlElement *grid_ = nullptr, *piece_ = nullptr;
  std::set<std::uint64_t> offsets_;  // of the arrays that are appended
  std::size_t points_ = 0, cells_ = 0;
};

}  // namespace tetproof::oracles
