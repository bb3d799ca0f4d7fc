// zlib is asked what the compressed data are.
#include "mesher/io/inflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <optional>
#include <random>
#include <vector>

#include "mesher/io/reading.h"
#include "mesher/io/test_zlib.h"

namespace delmesher::io {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 24;

std::string unpack(const std::string& bytes, Wrapping wrapping, std::uint64_t limit = kLimit) {
  Polling polling;
  return unpacked(bytes, wrapping, limit, polling);
}

// The message, with the place; empty if there is none.
std::string error_of(const std::string& bytes, Wrapping wrapping, std::uint64_t limit = kLimit) {
  try {
    unpack(bytes, wrapping, limit);
  } catch (const ParseError& error) {
    const bool placed = error.position.unit != Position::Unit::none;
    return (placed ? describe(error.position) + ": " : "") + error.reason;
  }
  return {};
}

std::optional<std::string> unpacked_by_us(const std::string& bytes, Wrapping wrapping) {
  try {
    return unpack(bytes, wrapping);
  } catch (const ParseError&) {
    return {};
  }
}

std::vector<std::string> samples() {
  std::vector<std::string> texts = {"", "a", std::string(70000, 'x'), "abcabcabcabcabc"};
  std::mt19937 random(1);
  std::string noise, numbers, far;
  for (int i = 0; i < 100000; ++i) noise += static_cast<char>(random());
  for (int i = 0; i < 20000; ++i) numbers += std::to_string(random() % 1000) + " \n"[i % 2];
  far = noise.substr(0, 32768);
  far += far.substr(0, 1000);  // as far back as a copy can reach
  texts.insert(texts.end(), {noise, numbers, far});
  return texts;
}

TEST(Inflate, UnpacksWhatZlibPacks) {
  for (const std::string& text : samples()) {
    for (const Wrapping wrapping : {Wrapping::none, Wrapping::zlib, Wrapping::gzip}) {
      for (const int level : {0, 1, 6, 9}) {
        EXPECT_TRUE(unpack(packed_by_zlib(text, wrapping, level), wrapping) == text);
      }
      for (const int strategy : {Z_FILTERED, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED}) {
        EXPECT_TRUE(unpack(packed_by_zlib(text, wrapping, 9, strategy), wrapping) == text);
      }
    }
  }
}

TEST(Inflate, HeadersAndMembersOfGzip) {
  gz_header header{};
  std::string name = "part.stl", comment = "of a part", extra = "extra";
  header.name = reinterpret_cast<Bytef*>(name.data());
  header.comment = reinterpret_cast<Bytef*>(comment.data());
  header.extra = reinterpret_cast<Bytef*>(extra.data());
  header.extra_len = static_cast<uInt>(extra.size());
  header.hcrc = 1;
  const std::string first =
      packed_by_zlib("first, ", Wrapping::gzip, 6, Z_DEFAULT_STRATEGY, &header);
  const std::string second = packed_by_zlib("second", Wrapping::gzip);
  EXPECT_EQ(unpack(first + second, Wrapping::gzip), "first, second");
  std::string renamed = first;
  renamed[first.find("part")] = 'q';
  EXPECT_EQ(error_of(renamed, Wrapping::gzip),
            "byte " + std::to_string(first.find("of a part") + 12) +
                ": damaged compressed data: the checksum of the header differs");
  EXPECT_EQ(error_of(second + "x", Wrapping::gzip),
            "byte " + std::to_string(second.size()) +
                ": the compressed data are followed by something else");
  EXPECT_EQ(error_of(second + second.substr(0, 5), Wrapping::gzip),
            "byte " + std::to_string(second.size() + 5) + ": the compressed data end early");
}

TEST(Inflate, CutDataAreRefused) {
  const std::string text = samples()[5].substr(0, 3000);
  for (const Wrapping wrapping : {Wrapping::none, Wrapping::zlib, Wrapping::gzip}) {
    const std::string all = packed_by_zlib(text, wrapping);
    for (std::size_t n = 0; n < all.size(); ++n) {
      EXPECT_EQ(error_of(all.substr(0, n), wrapping),
                "byte " + std::to_string(n) + ": the compressed data end early");
    }
  }
}

TEST(Inflate, SaysNoMoreThanTheLimit) {
  const std::string bytes = packed_by_zlib(std::string(1000, 'x'), Wrapping::zlib);
  EXPECT_EQ(error_of(bytes, Wrapping::zlib, 999), "unpacks to more than 999 bytes");
  EXPECT_EQ(
      error_of(packed_by_zlib(std::string(1000, 'x'), Wrapping::zlib, 0), Wrapping::zlib, 999),
      "unpacks to more than 999 bytes");
  EXPECT_EQ(unpack(bytes, Wrapping::zlib, 1000).size(), 1000U);
  Polling impatient([] { return false; });
  EXPECT_THROW(
      unpacked(packed_by_zlib(samples()[4], Wrapping::none), Wrapping::none, kLimit, impatient),
      ReadingStopped);
}

// Damaged in any manner, they are the same to both.
TEST(Inflate, AgreesWithZlibOnDamagedData) {
  std::mt19937 random(2);
  int refused = 0, accepted = 0;
  const auto compare = [&](const std::string& bytes, Wrapping wrapping) {
    const auto theirs = unpacked_by_zlib(bytes, wrapping, std::size_t{1} << 18);
    ++(theirs ? accepted : refused);
    EXPECT_EQ(unpacked_by_us(bytes, wrapping), theirs);
  };
  const std::string text = samples()[5].substr(0, 600);
  for (const int strategy : {Z_DEFAULT_STRATEGY, Z_FIXED}) {
    for (const Wrapping wrapping : {Wrapping::none, Wrapping::zlib, Wrapping::gzip}) {
      const std::string all = packed_by_zlib(text, wrapping, 9, strategy);
      for (std::size_t n = 0; n < all.size(); ++n) {
        for (int bit = 0; bit < 8; ++bit) {
          std::string changed = all;
          changed[n] = static_cast<char>(changed[n] ^ 1 << bit);
          compare(changed, wrapping);
        }
      }
    }
  }
  // From nothing: the first bits choose a kind of block, so that all get their share.
  for (int i = 0; i < 40000; ++i) {
    std::string noise;
    for (int n = static_cast<int>(random() % 60); n >= 0; --n) noise += static_cast<char>(random());
    noise[0] = static_cast<char>((noise[0] & ~7) | 1 | 2 * (i % 3));
    compare(noise, Wrapping::none);
  }
  EXPECT_GT(refused, 30000);
  EXPECT_GT(accepted, 300);
}

TEST(Inflate, ChecksumsAreThoseOfZlib) {
  for (const std::string& text : samples()) {
    EXPECT_EQ(crc32_of(text), crc32(0, reinterpret_cast<const Bytef*>(text.data()),
                                    static_cast<uInt>(text.size())));
  }
}

}  // namespace
}  // namespace delmesher::io
