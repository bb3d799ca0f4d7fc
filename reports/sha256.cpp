#include "reports/sha256.h"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace tetproof {
namespace {

class Sha256 {
 public:
  Sha256() { sha256_init(&state_); }
  void update(const char* data, std::size_t size) {
    sha256_update(&state_, size, reinterpret_cast<const std::uint8_t*>(data));
  }
  std::string finish() {
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> sum;
    sha256_digest(&state_, sum.size(), sum.data());
    std::string text;
    for (const std::uint8_t byte : sum) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  sha256_ctx state_;
};

}  // namespace

std::string sha256_of(std::string_view text) {
  Sha256 hash;
  hash.update(text.data(), text.size());
  return hash.finish();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  Sha256 hash;
  std::vector<char> buffer(1 << 16);
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.update(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw std::runtime_error(path.string() + ": cannot be read");
  return hash.finish();
}

}  // namespace tetproof
