// zlib is asked what the compressed data are.
#include "mesher/io/inflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <optional>
#include <random>
#include <vector>

#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 24;

int window_bits(Wrapping wrapping) {
  switch (wrapping) {
    case Wrapping::none:
      return -MAX_WBITS;
    case Wrapping::zlib:
      return MAX_WBITS;
    case Wrapping::gzip:
      break;
  }
  return MAX_WBITS + 16;
}

std::string packed(const std::string& text, Wrapping wrapping, int level = 6,
                   int strategy = Z_DEFAULT_STRATEGY, gz_header* header = nullptr) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, level, Z_DEFLATED, window_bits(wrapping), 8, strategy), Z_OK);
  if (header != nullptr) deflateSetHeader(&stream, header);
  std::string out(deflateBound(&stream, text.size()) + 1000, '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

// What zlib makes of them; nullopt if it refuses, or leaves something.
std::optional<std::string> unpacked_by_zlib(std::string bytes, Wrapping wrapping) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, window_bits(wrapping)), Z_OK);
  std::string out(std::size_t{1} << 18, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = inflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  const bool all = code == Z_STREAM_END && stream.avail_in == 0;
  inflateEnd(&stream);
  return all ? std::optional(out) : std::nullopt;
}

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
        EXPECT_TRUE(unpack(packed(text, wrapping, level), wrapping) == text);
      }
      for (const int strategy : {Z_FILTERED, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED}) {
        EXPECT_TRUE(unpack(packed(text, wrapping, 9, strategy), wrapping) == text);
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
  const std::string first = packed("first, ", Wrapping::gzip, 6, Z_DEFAULT_STRATEGY, &header);
  const std::string second = packed("second", Wrapping::gzip);
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
    const std::string all = packed(text, wrapping);
    for (std::size_t n = 0; n < all.size(); ++n) {
      EXPECT_EQ(error_of(all.substr(0, n), wrapping),
                "byte " + std::to_string(n) + ": the compressed data end early");
    }
  }
}

TEST(Inflate, SaysNoMoreThanTheLimit) {
  const std::string bytes = packed(std::string(1000, 'x'), Wrapping::zlib);
  EXPECT_EQ(error_of(bytes, Wrapping::zlib, 999), "unpacks to more than 999 bytes");
  EXPECT_EQ(error_of(packed(std::string(1000, 'x'), Wrapping::zlib, 0), Wrapping::zlib, 999),
            "unpacks to more than 999 bytes");
  EXPECT_EQ(unpack(bytes, Wrapping::zlib, 1000).size(), 1000U);
  Polling impatient([] { return false; });
  EXPECT_THROW(unpacked(packed(samples()[4], Wrapping::none), Wrapping::none, kLimit, impatient),
               ReadingStopped);
}

// Damaged in any manner, they are the same to both.
TEST(Inflate, AgreesWithZlibOnDamagedData) {
  std::mt19937 random(2);
  int refused = 0, accepted = 0;
  const auto compare = [&](const std::string& bytes, Wrapping wrapping) {
    const auto theirs = unpacked_by_zlib(bytes, wrapping);
    ++(theirs ? accepted : refused);
    EXPECT_EQ(unpacked_by_us(bytes, wrapping), theirs);
  };
  const std::string text = samples()[5].substr(0, 600);
  for (const int strategy : {Z_DEFAULT_STRATEGY, Z_FIXED}) {
    for (const Wrapping wrapping : {Wrapping::none, Wrapping::zlib, Wrapping::gzip}) {
      const std::string all = packed(text, wrapping, 9, strategy);
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
