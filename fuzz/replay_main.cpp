// Runs a fuzz target over files and folders, so that every target is also an ordinary test, with
// any compiler. Prints how many inputs there were, and which leniencies they took; no input at all
// is a failure. `TARGET --random SECONDS SEED [FOLDER|- [SEEDS...]]` is a campaign
// without instrumentation.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/random_campaign.h"
#include "property_tests/leniency.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

int campaign(int argc, char** argv) {
  tetproof::fuzz::RandomCampaign campaign;
  campaign.seconds = std::atof(argv[2]);
  if (!(campaign.seconds > 0)) {  // a campaign without inputs must not look green
    std::fprintf(stderr, "--random: seconds above 0 are expected, not %s\n", argv[2]);
    return 2;
  }
  campaign.seed = std::strtoull(argv[3], nullptr, 10);
  if (argc > 4 && std::string_view(argv[4]) != "-") campaign.findings = argv[4];
  if (argc > 5) campaign.seeds.assign(argv + 5, argv + argc);
  try {
    const std::uint64_t found = run_random_campaign(campaign);
    if (campaign.findings.empty()) std::fputs(tetproof::leniency_table().c_str(), stdout);
    return found > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc >= 4 && std::string_view(argv[1]) == "--random") {
    return campaign(argc, argv);
  }
  constexpr double kSlowSeconds = 2;
  const std::vector<std::string> paths(argv + 1, argv + argc);
  const std::vector<fs::path> files = tetproof::fuzz::files_of(paths);
  for (const fs::path& file : files) {
    const std::vector<std::uint8_t> bytes = tetproof::fuzz::bytes_of(file);
    std::fprintf(stderr, "%s\n", file.c_str());  // so that a crash says where
    const auto start = std::chrono::steady_clock::now();
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    if (taken.count() > kSlowSeconds) std::fprintf(stderr, "  slow: %.1f s\n", taken.count());
  }
  // Inputs are chosen, not drawn at random, so the shares of leniencies are only printed.
  std::printf("%zu inputs, no finding\n%s", files.size(), tetproof::leniency_table().c_str());
  return files.empty() ? 1 : 0;
}
