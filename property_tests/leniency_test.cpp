// Counters are of a process, so each test looks at those of a child.
#include "property_tests/leniency.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace tetproof::leniency_test {
namespace {

namespace fs = std::filesystem;
using testing::ExitedWithCode;

Leniency often("often", 0.5);
Leniency seldom("seldom", 0.1);

// So many inputs, all judged: every one takes "often", the first ones take "seldom" too, twice.
void run(int inputs, int seldom_of) {
  for (int i = 0; i < inputs; ++i) {
    executed();
    judging({&often, &seldom});
    often.take();
    if (i >= seldom_of) continue;
    seldom.take();
    seldom.take();
  }
}

// Ends the child: with 0 if all holds, else with 1 and the text of the table.
void end(bool all) {
  if (!all) std::fputs(leniency_table().c_str(), stderr);
  std::exit(all ? 0 : 1);
}

bool table_has(const std::string& text) {
  return leniency_table().find(text) != std::string::npos;
}

TEST(Leniency, IsCountedOncePerInput) {
  const auto child = [] {
    run(4, 3);
    end(table_has("4 executions, 4 judged\n") && table_has(" 3 of 4 (75 %, at most 10 %)\n") &&
        often.taken() == 4 && leniencies_within_bounds());
  };
  EXPECT_EXIT(child(), ExitedWithCode(0), "");
}

TEST(Leniency, IsTooOftenBeyondItsBoundOfAHundred) {
  const auto child = [](int inputs, bool within, const std::string& said) {
    run(inputs, 9);
    end(leniencies_within_bounds() == within && table_has(said) &&
        table_has(" at most 10 %)\n"));  // never too often
  };
  EXPECT_EXIT(child(99, true, " 99 of 99 (100 %, at most 50 %)\n"), ExitedWithCode(0), "");
  EXPECT_EXIT(child(100, false, " 100 of 100 (100 %, at most 50 %) TOO OFTEN\n"), ExitedWithCode(0),
              "");
}

TEST(Leniency, HasToBeNamedByTheProperty) {
  EXPECT_DEATH(seldom.take(), "leniency seldom is not named by its property");
}

// The lines of the only file in a folder, without the padding of names and numbers.
std::string counters_in(const fs::path& folder) {
  std::string text;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream file(entry.path());
    std::string name, most;
    std::uint64_t count = 0;
    while (file >> name >> count >> most) text += name + " " + std::to_string(count) + ", ";
  }
  return text;
}

TEST(Leniency, WhatACampaignBeginsWithIsNotCounted) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("leniency_test_" + std::to_string(getpid()));
  const auto child = [&](const char* after) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    setenv("TETPROOF_COUNTERS", folder.c_str(), 1);
    setenv("TETPROOF_COUNTERS_AFTER", after, 1);
    run(5, 3);
    std::exit(0);
  };
  EXPECT_EXIT(child("0"), ExitedWithCode(0), "");
  EXPECT_EQ(counters_in(folder), "executed 5, judged 5, often 5, seldom 3, ");
  EXPECT_EXIT(child("2"), ExitedWithCode(0), "");
  EXPECT_EQ(counters_in(folder), "executed 3, judged 3, often 3, seldom 1, ");
  EXPECT_EXIT(child("5"), ExitedWithCode(0), "");
  EXPECT_EQ(counters_in(folder), "executed 0, judged 0, often 0, seldom 0, ");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tetproof::leniency_test
