#include "mesher/io/binary.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint32_t kSixBits = 63;

}  // namespace

void Base64Writer::write_group() {
  const std::array<char, 4> digits = {kDigits[group_ >> 18U & kSixBits],
                                      kDigits[group_ >> 12U & kSixBits],
                                      kDigits[group_ >> 6U & kSixBits], kDigits[group_ & kSixBits]};
  out_.text({digits.data(), digits.size()});
  group_ = 0;
  bytes_ = 0;
}

void Base64Writer::finish() {
  if (bytes_ == 0) return;
  const int present = bytes_;
  const std::uint32_t group = group_ << 8U * static_cast<unsigned>(3 - present);
  std::array<char, 4> digits = {kDigits[group >> 18U & kSixBits], kDigits[group >> 12U & kSixBits],
                                kDigits[group >> 6U & kSixBits], '='};
  if (present == 1) digits[2] = '=';
  out_.text({digits.data(), digits.size()});
  group_ = 0;
  bytes_ = 0;
}

std::optional<std::string> from_base64(std::string_view text) {
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return std::string();
  text = text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
  if (text.size() % 4 != 0) return {};
  std::size_t padding = 0;
  while (padding < 2 && text[text.size() - 1 - padding] == '=') ++padding;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool padded = i + padding >= text.size();
    const std::size_t digit = padded ? 0 : kDigits.find(text[i]);
    if (digit == std::string_view::npos) return {};
    group = group << 6U | static_cast<std::uint32_t>(digit);
    if (i % 4 != 3) continue;
    for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>(group >> shift & 255U);
    group = 0;
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace delmesher::io
