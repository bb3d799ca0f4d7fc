#include "corpus/campaigns/runnable.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace tetproof::runnable_test {
namespace {

namespace fs = std::filesystem;

const fs::path kSupervisor = TETPROOF_SUPERVISE_PATH;

TEST(Runnable, WhatAShellFinds) {
  for (const char* line : {"sh -c true", "/bin/sh -c true", "exit 4", "exec ls", "cd / && ls", "",
                           "X=1 prog", "( no-such-program )", "\"$HOME/prog\" {in}"}) {
    EXPECT_EQ(why_not_runnable(line, kSupervisor), "") << line;
  }
  EXPECT_EQ(why_not_runnable("no-such-program {in}", kSupervisor), "no-such-program: not found");
  EXPECT_EQ(why_not_runnable("/etc/passwd {in}", kSupervisor), "/etc/passwd: is not executable");
  EXPECT_THROW(why_not_runnable("sh", "/no/such/supervisor"), CannotRun);
}

TEST(Runnable, Interpreters) {
  const fs::path script =
      fs::path(testing::TempDir()) / ("runnable_test_" + std::to_string(getpid()));
  const auto why = [&](const std::string& text) {
    std::ofstream(script, std::ios::binary) << text;
    return why_no_interpreter(script);
  };
  EXPECT_EQ(why(""), "");
  EXPECT_EQ(why("\x7f"
                "ELF"),
            "");
  EXPECT_EQ(why("#!/bin/sh\n"), "");
  EXPECT_EQ(why("#! /bin/sh -e\nexit\n"), "");
  EXPECT_EQ(why("#!/usr/bin/env no-such-language\n"), "");  // seen at the first model
  EXPECT_EQ(why("#!/no/such/shell\n"), "its interpreter /no/such/shell cannot be run");
  EXPECT_EQ(why("#!/bin/sh\r\n"), "its interpreter /bin/sh\r cannot be run");
  fs::remove(script);
}

TEST(Runnable, ExitCodesOfShells) {
  Outcome outcome;
  outcome.ending = Ending::exited;
  for (const int code : {126, 127}) {
    outcome.exit_code = code;
    EXPECT_TRUE(cannot_run(outcome, ExitCodes::unknown, true));
    EXPECT_FALSE(cannot_run(outcome, ExitCodes::unknown, false));
  }
  for (const int code : {0, 1, 2, 125, 128}) {
    outcome.exit_code = code;
    EXPECT_FALSE(cannot_run(outcome, ExitCodes::unknown, true));
  }
  outcome.ending = Ending::not_started;
  EXPECT_TRUE(cannot_run(outcome, ExitCodes::unknown, false));
}

TEST(Runnable, WrongCallsOfOurPrograms) {
  Outcome outcome;
  outcome.ending = Ending::exited;
  for (const int code : {0, 1, 2, 3, 4, 5, 6}) {
    outcome.exit_code = code;
    EXPECT_EQ(cannot_run(outcome, ExitCodes::ours, false), code == 2) << code;
  }
  outcome.exit_code = 2;
  outcome.ending = Ending::wall_limit;
  EXPECT_FALSE(cannot_run(outcome, ExitCodes::ours, false));
}

}  // namespace
}  // namespace tetproof::runnable_test
