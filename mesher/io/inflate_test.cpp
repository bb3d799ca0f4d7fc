// zlib is used to the end of the data and no further, in pieces and within limits.
#include "mesher/io/inflate.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "mesher/io/reading.h"
#include "mesher/io/test_zlib.h"

namespace delmesher::io {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 24;
constexpr Wrapping kWrappings[] = {Wrapping::none, Wrapping::zlib, Wrapping::gzip};

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

std::string numbers(int count) {
  std::mt19937 random(1);
  std::string text;
  for (int i = 0; i < count; ++i) text += std::to_string(random() % 1000) + " \n"[i % 2];
  return text;
}

// Packed they are smaller and larger than a piece.
std::vector<std::string> samples() {
  std::mt19937 random(1);
  std::string noise;
  for (int i = 0; i < 100000; ++i) noise += static_cast<char>(random());
  return {"", "a", std::string(1 << 20, 'x'), noise, numbers(100000)};
}

TEST(Inflate, UnpacksWhatWasPacked) {
  for (const std::string& text : samples()) {
    for (const Wrapping wrapping : kWrappings) {
      for (const int level : {0, 6}) {
        EXPECT_TRUE(unpack(packed_by_zlib(text, wrapping, level), wrapping) == text);
      }
    }
  }
}

// A header with all fields of RFC 1952 and a stored block, by hand.
TEST(Inflate, UnpacksAFileThatZlibDidNotMake) {
  using namespace std::string_literals;
  const std::string bytes =
      "\x1f\x8b\x08\x1c\0\0\0\0\0\xff\x02\0xyname\0comment\0\x01\x09\0\xf6\xff"s
      "123456789\x26\x39\xf4\xcb\x09\0\0\0"s;
  EXPECT_EQ(unpack(bytes, Wrapping::gzip), "123456789");
  EXPECT_EQ(crc32_of("123456789"), 0xcbf43926U);  // the value by which CRC-32 is known
}

TEST(Inflate, MembersOfGzipFollowEachOther) {
  const std::string first = packed_by_zlib(numbers(100000), Wrapping::gzip);
  const std::string second = packed_by_zlib("second", Wrapping::gzip);
  EXPECT_TRUE(unpack(first + second, Wrapping::gzip) == numbers(100000) + "second");
  const std::string end = "byte " + std::to_string(first.size() + second.size()) + ": ";
  EXPECT_EQ(error_of(first + second + "x", Wrapping::gzip),
            end + "the compressed data are followed by something else");
  EXPECT_EQ(error_of(first + second + second.substr(0, 5), Wrapping::gzip),
            "byte " + std::to_string(first.size() + second.size() + 5) +
                ": the compressed data end early");
  EXPECT_EQ(error_of(first + second, Wrapping::gzip, numbers(100000).size() + 5),
            "unpacks to more than " + std::to_string(numbers(100000).size() + 5) + " bytes");
  for (const Wrapping wrapping : {Wrapping::none, Wrapping::zlib}) {
    const std::string one = packed_by_zlib("one", wrapping);
    EXPECT_EQ(error_of(one + one, wrapping),
              "byte " + std::to_string(one.size()) +
                  ": the compressed data are followed by something else");
  }
}

TEST(Inflate, CutDataAreRefused) {
  for (const Wrapping wrapping : kWrappings) {
    const std::string all = packed_by_zlib(numbers(1000), wrapping);
    for (std::size_t n = 0; n < all.size(); ++n) {
      EXPECT_EQ(error_of(all.substr(0, n), wrapping),
                "byte " + std::to_string(n) + ": the compressed data end early");
    }
  }
}

// Also of what unpacks to a thousand times as much, before it has done so.
TEST(Inflate, SaysNoMoreThanTheLimit) {
  const std::string thousand(1000, 'x');
  for (const int level : {0, 6}) {
    const std::string bytes = packed_by_zlib(thousand, Wrapping::zlib, level);
    EXPECT_EQ(error_of(bytes, Wrapping::zlib, 999), "unpacks to more than 999 bytes");
    EXPECT_EQ(unpack(bytes, Wrapping::zlib, 1000), thousand);
  }
  const std::string bomb = packed_by_zlib(std::string(100 << 20, 'x'), Wrapping::gzip);
  int asked = 0;
  Polling counting([&] { return ++asked > 0; });
  EXPECT_THROW(unpacked(bomb, Wrapping::gzip, 1 << 20, counting), ParseError);
  EXPECT_GT(asked, 10);
  EXPECT_LT(asked, 40);
  Polling impatient([] { return false; });
  EXPECT_THROW(unpacked(bomb, Wrapping::gzip, kLimit, impatient), ReadingStopped);
}

// With any bit changed: refused, or the same text (gzip tells the time, for instance).
TEST(Inflate, DamagedDataAreRefused) {
  const std::string text = numbers(300);
  for (const Wrapping wrapping : {Wrapping::zlib, Wrapping::gzip}) {
    const std::string all = packed_by_zlib(text, wrapping);
    std::size_t refused = 0;
    for (std::size_t bit = 0; bit < 8 * all.size(); ++bit) {
      std::string changed = all;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ 1 << bit % 8);
      const std::string error = error_of(changed, wrapping);
      EXPECT_EQ(error.find_first_of("\r\n"), std::string::npos);
      refused += error.empty() ? 0 : 1;
      if (error.empty()) {
        EXPECT_EQ(unpack(changed, wrapping), text);
      }
    }
    EXPECT_GE(refused, 8 * (all.size() - 10));
  }
  std::string changed = packed_by_zlib(text, Wrapping::gzip);
  changed[changed.size() - 8] ^= 1;
  const std::string place = "byte " + std::to_string(changed.size() - 4);
  EXPECT_EQ(error_of(changed, Wrapping::gzip),
            place + ": damaged compressed data: incorrect data check");
  EXPECT_EQ(error_of("\x78\xbb\1\2\3\4", Wrapping::zlib),
            "byte 6: damaged compressed data: a dictionary is needed");
}

}  // namespace
}  // namespace delmesher::io
