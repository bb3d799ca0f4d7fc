#include "mesher/io/text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace delmesher::io {
namespace {

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

double parsed(std::string_view token) {
  double value = 1234;
  EXPECT_EQ(parse_double(token, value), NumberStatus::ok) << token;
  return value;
}

TEST(ParseDouble, NearestDoubleAtTheEdges) {
  EXPECT_EQ(parsed("0.1"), 0.1);
  EXPECT_EQ(bits(parsed("-0.0")), bits(-0.0));
  EXPECT_EQ(bits(parsed("-0")), bits(-0.0));
  EXPECT_EQ(parsed("1e-310"), 1e-310);
  EXPECT_EQ(parsed("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parsed("1.7976931348623157e308"), std::numeric_limits<double>::max());
  EXPECT_EQ(parsed("+.5"), 0.5);
  EXPECT_EQ(parsed("5."), 5.0);
  EXPECT_EQ(parsed("1E+2"), 100.0);
  // Halfway between two doubles, decided by a digit far behind.
  EXPECT_EQ(parsed("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993.00000000000000000000000000000000000000001"),
            9007199254740994.0);
  EXPECT_EQ(bits(parsed("1e-400")), bits(0.0));
  EXPECT_EQ(bits(parsed("-1e-99999999999999999999")), bits(-0.0));
  EXPECT_EQ(bits(parsed("0e99999999999")), bits(0.0));
  EXPECT_EQ(parsed("0." + std::string(400, '0') + "1e401"), 1.0);
}

TEST(ParseDouble, RefusesWhatIsNoFiniteNumber) {
  double value = 0;
  for (const char* token : {"", "-", "+", "+-1", "-+1", "1x", "x", "1,5", "1.5.2", "0x1p3", "1e",
                            "1.#IND", "--1", ".", "e5"}) {
    EXPECT_EQ(parse_double(token, value), NumberStatus::malformed) << token;
  }
  for (const char* token : {"inf", "-inf", "nan", "NaN", "-nan", "Infinity", "1e309", "-1e99999"}) {
    EXPECT_EQ(parse_double(token, value), NumberStatus::not_finite) << token;
  }
}

TEST(ParseDouble, AgreesWithStrtod) {
  std::mt19937_64 random(1);
  int different_digits = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string token;
    for (int d = static_cast<int>(random() % 30) + 1; d > 0; --d)
      token += "0123456789"[random() % 10];
    token.insert(random() % token.size(), ".");
    token += "e" + std::to_string(static_cast<int>(random() % 600) - 320);
    const double expected = std::strtod(token.c_str(), nullptr);
    if (std::isinf(expected)) continue;
    ASSERT_EQ(bits(parsed(token)), bits(expected)) << token;
    ++different_digits;
  }
  EXPECT_GT(different_digits, 15000);
}

TEST(AppendNumber, RoundTripsEveryDouble) {
  std::mt19937_64 random(2);
  std::vector<double> values = {0.1,
                                1e-310,
                                -0.0,
                                0.0,
                                std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::denorm_min(),
                                1e22,
                                1e23,
                                -1.5};
  while (values.size() < 20000) {
    const double x = std::bit_cast<double>(random());
    if (std::isfinite(x)) values.push_back(x);
  }
  for (double x : values) {
    std::string decimal, hex;
    append_double(decimal, x);
    append_hex(hex, x);
    double back = 1;
    ASSERT_EQ(parse_double(decimal, back), NumberStatus::ok);
    ASSERT_EQ(bits(back), bits(x)) << decimal;
    ASSERT_EQ(parse_hex_double(hex, back), NumberStatus::ok) << hex;
    ASSERT_EQ(bits(back), bits(x)) << hex;
    ASSERT_EQ(bits(std::strtod(hex.c_str(), nullptr)), bits(x)) << hex;
  }
  std::string shortest;
  append_double(shortest, 0.1);
  EXPECT_EQ(shortest, "0.1");
}

TEST(ParseHex, RefusesMalformed) {
  double value = 0;
  for (const char* token : {"", "0x", "1.8p3", "0x-1p3", "0x1.8p3z", "-", "0xinf", "0xnan"}) {
    EXPECT_NE(parse_hex_double(token, value), NumberStatus::ok) << token;
  }
}

TEST(ParseInteger, Ranges) {
  std::uint32_t u = 0;
  EXPECT_TRUE(parse_integer("4294967295", u));
  EXPECT_FALSE(parse_integer("4294967296", u));
  EXPECT_FALSE(parse_integer("-1", u));
  EXPECT_TRUE(parse_integer("-00", u));
  EXPECT_EQ(u, 0U);
  EXPECT_FALSE(parse_integer("-01", u));
  EXPECT_FALSE(parse_integer("1.0", u));
  EXPECT_FALSE(parse_integer("", u));
  EXPECT_TRUE(parse_integer("+7", u));
  EXPECT_EQ(u, 7U);
}

TEST(TextLines, AnyLineEndsCommentsAndNoFinalNewline) {
  TextLines in("\xEF\xBB\xBF\n a\tb # c\r\n#\rd#e f", Comments::anywhere);
  std::string_view token;
  std::string seen;
  while (in.next_line()) {
    seen += std::to_string(in.line()) + ":";
    while (in.next_token(token)) seen += std::string(token) + ",";
  }
  EXPECT_EQ(seen, "2:a,b,4:d,");
  TextLines names("usemtl a#1 # x", Comments::at_token_start);
  ASSERT_TRUE(names.next_line());
  names.next_token(token);
  EXPECT_EQ(names.rest_of_line(), "a#1");
}

// Every character of Unicode, and every two and three bytes, by what the standard says of them.
TEST(Utf8, EveryCharacterStaysAndOtherBytesAreLatin1) {
  for (std::uint32_t code = 0; code < 0x110000; ++code) {
    if (code >= 0xd800 && code < 0xe000) continue;
    std::string text;
    append_utf8(text, code);
    const bool in_xml = code != 0xfffe && code != 0xffff;
    ASSERT_EQ(as_utf8(text) == text, in_xml) << code;
  }
  EXPECT_EQ(as_utf8("caf\xe9 \x80\xff"), "caf\xc3\xa9 \xc2\x80\xc3\xbf");
  for (const char* none :
       {"\xc0\xaf", "\xc1\xbf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf", "\xed\xa0\x80", "\xed\xbf\xbf",
        "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xc3", "\xe2\x82", "\x80", "\xf0\x9f\x98", "\xc3(",
        "\xe2(\xa1", "\xf0\x9f(\x8c", "\xc3\xa9\xe9"}) {
    const std::string converted = as_utf8(none);
    EXPECT_NE(converted, none);
    EXPECT_EQ(as_utf8(converted), converted);
  }
}

TEST(Quoted, IsPrintableAndShort) {
  EXPECT_EQ(in_quotes("a\x01z"), "'a?z'");
  EXPECT_LT(io::in_quotes(std::string_view(std::string(1000, 'x'))).size(), 50U);
}

}  // namespace
}  // namespace delmesher::io
