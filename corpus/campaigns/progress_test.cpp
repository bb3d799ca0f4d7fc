#include "corpus/campaigns/progress.h"

#include <gtest/gtest.h>

#include "corpus/campaigns/printable.h"

namespace tetproof {
namespace {

RunRow row(const std::string& mesher, Disposition disposition, double seconds,
           std::optional<double> verify) {
  RunRow row;
  row.key.mesher = mesher;
  row.disposition = disposition;
  row.wall_seconds = seconds;
  row.verify_seconds = verify;
  return row;
}

TEST(CountTable, ALinePerMesherWithWhatNobodyVouchesFor) {
  MesherCount a = {.mesher = "delmesher"}, b = {.mesher = "cmd:odd\nname"};
  a.add(row("", Disposition::ok, 1.5, 3));
  a.add(row("", Disposition::ok, 60, 0.25));
  a.add(row("", Disposition::timeout, 100, std::nullopt));
  b.add(row("", Disposition::unverified, 1, std::nullopt));
  EXPECT_EQ(a.runs(), 3U);
  EXPECT_EQ(count_table({a, b}),
            "mesher        runs  ok  unverified  wrong-result  timeout   meshing  verifying\n"
            "delmesher        3   2           0             0        1  2:42 min      3.2 s\n"
            "cmd:odd?name     1   0           1             0        0     1.0 s      0.0 s\n");
}

TEST(CountTable, WithoutMeshers) {
  EXPECT_EQ(count_table({}), "mesher  runs  ok  unverified  wrong-result  meshing  verifying\n");
}

TEST(Duration, InReadableUnits) {
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(99.94), "99.9 s");
  EXPECT_EQ(duration_text(99.96), "1:40 min");
  EXPECT_EQ(duration_text(185), "3:05 min");
  EXPECT_EQ(duration_text(5999), "99:59 min");
  EXPECT_EQ(duration_text(7800), "2:10 h");
}

// Two meshers, one ten times as slow as the other: an average over all would be far off.
TEST(RemainingTime, ByMesher) {
  RemainingTime remaining;
  remaining.expect("fast", 10);
  remaining.expect("slow", 10);
  EXPECT_FALSE(remaining.seconds(1).has_value());
  remaining.already_done("fast");
  EXPECT_FALSE(remaining.seconds(1).has_value());
  remaining.done("fast", 1);
  EXPECT_DOUBLE_EQ(*remaining.seconds(1), 8 * 1 + 10 * 1);  // nothing known of the slow one
  remaining.done("slow", 10);
  EXPECT_DOUBLE_EQ(*remaining.seconds(1), 8 * 1 + 9 * 10);
  EXPECT_DOUBLE_EQ(*remaining.seconds(2), 49);
}

TEST(Printable, ControlCharacters) {
  EXPECT_EQ(printable("a\nb\x1b[2J\x7f\tc\xc3\xa9"), "a?b?[2J??c\xc3\xa9");
}

}  // namespace
}  // namespace tetproof
