// The subcommands of tetproof: what each is asked to do, and doing it. They return an exit code:
// 0 done, 1 a check failed, 3 unreadable input, 5 a limit was reached, 130 interrupted.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tetproof {

// A request that makes no sense; exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunArguments {
  std::vector<std::string> paths, meshers;
  std::string database, shard, delmesher, keep;
  double timeout = 600, cpu = 0, stop_after = 0;  // seconds; cpu 0: as timeout
  std::uint64_t memory_mebibytes = 4096;
  unsigned jobs = 1;
  bool verify = false, sidecars = false;
};

struct ReportArguments {
  std::vector<std::string> databases;
  std::string folder;
};

struct MeasureArguments {
  std::string mesh, output;  // no output: standard output
};

struct GenerateArguments {
  std::vector<std::string> families, models;
  std::string folder;
  std::uint64_t seed = 1, first = 0, count = 10;
  bool twins = false, list = false;
};

struct ShrinkArguments {
  std::string input, mesher, output;
  double timeout = 10, seconds = 600;  // per run, in all
  std::uint64_t memory_mebibytes = 2048, runs = 5000;
  bool no_verify = false;
};

int run_command(const RunArguments& arguments);
int report_command(const ReportArguments& arguments);
int measure_command(const MeasureArguments& arguments);
#ifdef TETPROOF_HAS_GENERATE
int generate_command(const GenerateArguments& arguments);
int shrink_command(const ShrinkArguments& arguments);
#endif

}  // namespace tetproof
