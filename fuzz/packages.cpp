#include "fuzz/packages.h"

#include <zlib.h>

#include <cstdint>

namespace tetproof::fuzz {
namespace {

std::string number(std::uint64_t value, int bytes) {
  std::string text;
  for (; bytes > 0; --bytes, value >>= 8) text += static_cast<char>(value & 255);
  return text;
}

}  // namespace

// One file, stored as it is.
std::string package_of(const std::string& model) {
  const std::string name = "3D/3dmodel.model";
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(model.data()), static_cast<uInt>(model.size()));
  const std::string head = number(20, 2) + number(0, 2) + number(0, 2) + number(0, 4) +
                           number(sum, 4) + number(model.size(), 4) + number(model.size(), 4) +
                           number(name.size(), 2) + number(0, 2);
  const std::string file = "PK\x03\x04" + head + name + model;
  const std::string entry = "PK\x01\x02" + number(20, 2) + head + number(0, 14) + name;
  return file + entry + "PK\x05\x06" + number(0, 4) + number(1, 2) + number(1, 2) +
         number(entry.size(), 4) + number(file.size(), 4) + number(0, 2);
}

}  // namespace tetproof::fuzz
