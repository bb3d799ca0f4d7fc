#include "fuzz/random_campaign.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <system_error>

#include "corpus/generators/random.h"

extern "C" {
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// Not every target has its own.
__attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                          std::size_t max_size, unsigned int seed);
__attribute__((weak)) std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1,
                                                            std::size_t size1,
                                                            const std::uint8_t* data2,
                                                            std::size_t size2, std::uint8_t* out,
                                                            std::size_t max_out, unsigned int seed);
}

namespace tetproof::fuzz {
namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

Random plain_mutations(1);

// Overwrites, inserts and erases a few bytes.
std::size_t mutate_bytes(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  Random& random = plain_mutations;
  for (int changes = random.integer(1, 4); changes > 0; --changes) {
    const std::size_t at = size > 0 ? random.below(size) : 0;
    const auto byte = static_cast<std::uint8_t>(random.below(256));
    switch (random.below(4)) {
      case 0:
        if (size == max_size) break;
        std::copy_backward(data + at, data + size, data + size + 1);
        data[at] = byte;
        ++size;
        break;
      case 1:
        if (size < 2) break;
        std::copy(data + at + 1, data + size, data + at);
        --size;
        break;
      case 2:
        if (size > 0) data[at] ^= static_cast<std::uint8_t>(1U << random.below(8));
        break;
      default:
        if (size > 0) data[at] = byte;
    }
  }
  return size;
}

class Campaign {
 public:
  explicit Campaign(const RandomCampaign& campaign) : campaign_(campaign), random_(campaign.seed) {
    plain_mutations = Random(campaign.seed);
    for (const fs::path& path : files_of(campaign.seeds)) seeds_.push_back(bytes_of(path));
    if (campaign.findings.empty()) return;
    fs::create_directories(campaign.findings);
    said_ = fs::path(campaign.findings) / (".running-" + std::to_string(getpid()));
  }

  std::uint64_t run() {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(campaign_.seconds);
    std::uint64_t inputs = 0;
    for (; Clock::now() < end; ++inputs) {
      const Input input = next();
      if (const std::string finding = outcome(input); !finding.empty()) {
        keep(input, finding);
      } else {
        remember(input);
      }
    }
    if (!said_.empty()) fs::remove(said_);
    std::printf("%llu inputs, %llu findings\n", static_cast<unsigned long long>(inputs),
                static_cast<unsigned long long>(found_));
    for (const auto& [what, count] : kinds_) std::printf("%6d  %s\n", count, what.c_str());
    return found_;
  }

 private:
  static constexpr std::size_t kLargest = std::size_t{1} << 20;
  static constexpr std::size_t kPool = 64;

  Input next() {
    Input& input = buffer_;
    std::size_t size = 1;
    input[0] = 0;
    if (!pool_.empty() || !seeds_.empty()) {
      const Input& from = earlier();
      const Input& other = earlier();
      size = 0;
      if (LLVMFuzzerCustomCrossOver != nullptr && random_.chance(0.1)) {
        size = LLVMFuzzerCustomCrossOver(from.data(), from.size(), other.data(), other.size(),
                                         input.data(), kLargest, seed());
      }
      if (size == 0) {
        std::copy(from.begin(), from.end(), input.begin());
        size = from.size();
      }
    }
    for (int changes = random_.integer(1, 3); changes > 0; --changes) {
      size = LLVMFuzzerCustomMutator != nullptr
                 ? LLVMFuzzerCustomMutator(input.data(), size, kLargest, seed())
                 : mutate_bytes(input.data(), size, kLargest);
    }
    return {input.begin(), input.begin() + static_cast<std::ptrdiff_t>(size)};
  }
  const Input& earlier() {
    const bool seed = pool_.empty() || (!seeds_.empty() && random_.chance(0.5));
    const std::vector<Input>& inputs = seed ? seeds_ : pool_;
    return inputs[random_.below(inputs.size())];
  }
  unsigned seed() { return static_cast<unsigned>(random_.below(std::uint64_t{1} << 32)); }

  void remember(const Input& input) {
    if (pool_.size() < kPool) {
      pool_.push_back(input);
    } else if (random_.chance(0.25)) {
      pool_[random_.below(kPool)] = input;
    }
  }

  // Empty, or what the target said of the input before it ended.
  std::string outcome(const Input& input) {
    if (said_.empty()) {
      LLVMFuzzerTestOneInput(input.data(), input.size());
      return {};
    }
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (child == 0) {
      const int file = open(said_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      if (file < 0 || dup2(file, 1) < 0 || dup2(file, 2) < 0) _exit(1);
      alarm(campaign_.seconds_each);
      LLVMFuzzerTestOneInput(input.data(), input.size());
      _exit(0);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
      if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    std::ifstream in(said_, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(in)), {});
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM) {
      return "FINDING slow: above " + std::to_string(campaign_.seconds_each) + " s\n" + text;
    }
    if (!text.empty()) return text;
    return WIFSIGNALED(status) ? "FINDING signal " + std::to_string(WTERMSIG(status))
                               : "FINDING exit code " + std::to_string(WEXITSTATUS(status));
  }

  void keep(const Input& input, const std::string& finding) {
    const std::string name = std::to_string(campaign_.seed) + "-" + std::to_string(found_++);
    const fs::path base = fs::path(campaign_.findings) / name;
    std::ofstream bytes(base.string() + ".input", std::ios::binary);
    bytes.write(reinterpret_cast<const char*>(input.data()),
                static_cast<std::streamsize>(input.size()));
    std::ofstream text(base.string() + ".txt", std::ios::binary);
    text << finding;
    if (!bytes.flush() || !text.flush()) {
      throw std::system_error(errno, std::generic_category(), base.string());
    }
    ++kinds_[kind(finding)];
  }
  // The first line, with a # for each number.
  static std::string kind(const std::string& finding) {
    std::string result;
    for (const char c : finding.substr(0, finding.find('\n'))) {
      const bool digit = c >= '0' && c <= '9';
      if (!digit) result += c;
      if (digit && (result.empty() || result.back() != '#')) result += '#';
    }
    return result;
  }

  RandomCampaign campaign_;
  Random random_;
  fs::path said_;
  std::vector<Input> seeds_, pool_;
  Input buffer_ = Input(kLargest);  // where inputs are made: filling a megabyte takes longer
  std::uint64_t found_ = 0;
  std::map<std::string, int> kinds_;
};

}  // namespace

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(in)), {});
  if (!in) throw std::system_error(errno, std::generic_category(), path.string());
  return bytes;
}

std::vector<fs::path> files_of(std::span<const std::string> paths) {
  std::vector<fs::path> files;
  for (const fs::path path : paths) {
    if (fs::is_directory(path)) {
      for (const auto& entry : fs::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
    } else if (fs::exists(path)) {
      files.push_back(path);
    } else {
      std::fprintf(stderr, "%s: no such file or folder\n", path.c_str());
    }
  }
  std::sort(files.begin(), files.end());
  for (fs::path& file : files) file = fs::absolute(file);  // targets may change the folder
  return files;
}

std::uint64_t run_random_campaign(const RandomCampaign& campaign) {
  return Campaign(campaign).run();
}

}  // namespace tetproof::fuzz

// For mutators that leave some of the work to the fuzzing engine.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size) {
  return tetproof::fuzz::mutate_bytes(data, size, max_size);
}
