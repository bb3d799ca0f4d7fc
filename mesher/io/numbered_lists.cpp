#include "mesher/io/numbered_lists.h"

namespace delmesher::io {

void NumberedLists::need_line(const char* what) {
  if (!in_.next_line()) fail(here(), std::string("the file ends where ") + what + " is expected");
}

void NumberedLists::need_number_of_item(std::uint64_t i, const std::string& item,
                                        const std::string& items) {
  const auto number = need_integer<std::uint64_t>(item + " number");
  if (i == 0) base_ = number;
  if (base_ > 1) fail(here(), items + " have to be numbered from 0 or 1");
  if (number == base_ + i) return;
  fail(here(), item + " number " + std::to_string(number) + " where " + std::to_string(base_ + i) +
                   " is expected");
}

std::uint32_t NumberedLists::vertex(std::string_view token, std::uint64_t size) const {
  const auto number = integer<std::uint64_t>(token, "vertex index");
  if (number < base_ || number - base_ >= size) {
    fail(here(), "vertex index out of range: " + std::string(token) + " of " +
                     std::to_string(size) + " (numbered from " + std::to_string(base_) + ")");
  }
  return static_cast<std::uint32_t>(number - base_);
}

void NumberedLists::check_count(std::uint64_t count, std::uint64_t limit, const char* items) const {
  if (count <= limit && count <= in_.remaining() / 2 + 1) return;
  fail(here(), "the file is too short for " + std::to_string(count) + " " + items);
}

}  // namespace delmesher::io
