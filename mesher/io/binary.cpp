#include "mesher/io/binary.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint32_t kSixBits = 63;
constexpr std::uint8_t kNoDigit = 255;

// What each character means.
constexpr std::array<std::uint8_t, 256> kValues = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}();

// The four digits of three bytes.
std::array<char, 4> digits_of(std::uint32_t group) {
  return {kDigits[group >> 18U & kSixBits], kDigits[group >> 12U & kSixBits],
          kDigits[group >> 6U & kSixBits], kDigits[group & kSixBits]};
}

}  // namespace

void Base64Writer::write_group() {
  const int missing = 3 - bytes_;
  std::array<char, 4> digits = digits_of(group_ << 8U * static_cast<unsigned>(missing));
  for (int i = 0; i < missing; ++i) digits[static_cast<std::size_t>(3 - i)] = '=';
  out_.text({digits.data(), digits.size()});
  group_ = 0;
  bytes_ = 0;
}

void Base64Writer::finish() {
  if (bytes_ > 0) write_group();
}

std::optional<std::string> from_base64(std::string_view text, bool several) {
  constexpr const char* kSpace = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return std::string();
  text = text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
  if (text.size() % 4 != 0) return {};
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (; !text.empty(); text.remove_prefix(4)) {
    const std::string_view digits = text.substr(0, 4);
    const std::size_t padding = digits.ends_with("==") ? 2 : digits.ends_with('=') ? 1 : 0;
    if (padding > 0 && text.size() > 4 && !several) return {};
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool padded = i + padding >= 4;
      const std::uint8_t digit = padded ? 0 : kValues[static_cast<unsigned char>(digits[i])];
      if (digit == kNoDigit) return {};
      group = group << 6U | digit;
    }
    for (std::size_t i = 0; i < 3 - padding; ++i) {
      bytes += static_cast<char>(group >> (16 - 8 * i) & 255U);
    }
  }
  return bytes;
}

}  // namespace delmesher::io
