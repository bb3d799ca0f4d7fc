// The arrays of a .vtu file written as text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tetproof::oracles {

// Nothing may be there twice, and nothing after the end, as readers differ in what they take then.
// All functions throw ReadError.
class VtuText {
 public:
  // The text must outlive this.
  VtuText(std::string path, std::string_view text);

  // The values of the array of that name in a section ("Points", "Cells", "CellData"); of the only
  // one there if the name is empty. Empty if there is none.
  std::vector<double> array(const std::string& section, const std::string& name) const;
  // An integer of at most 53 bits.
  std::int64_t integer(double value) const;
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::string path_;
  std::string_view text_;
};

}  // namespace tetproof::oracles
