#include "mesher/cli/batch.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "mesher/cli/signals.h"
#include "mesher/io/output.h"

namespace delmesher::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct Child {
  std::size_t command;
  std::FILE *out, *error;  // its messages, in files without a name
  Clock::time_point start;
};

class Batch {
 public:
  Batch(const std::vector<Command>& commands, const Library& library, const Streams& streams)
      : commands_(commands), library_(library), streams_(streams) {}

  int run(unsigned jobs);

 private:
  std::string folder_error() const;
  bool start(std::size_t command);
  void wait_for_one();
  void count(int code) { ++codes_[code]; }
  void summarize(std::size_t command, int code, const std::string& how) const;

  const std::vector<Command>& commands_;
  const Library& library_;
  const Streams& streams_;
  std::map<pid_t, Child> running_;
  std::map<int, std::size_t> codes_;
};

std::string meaning(int code) {
  switch (code) {
    case kDone:
      return "done";
    case kFailed:
      return "inverted or flat tetrahedra left";
    case kUnreadable:
      return "not readable or writable";
    case kInvalid:
      return "not valid";
    case kLimit:
      return "limit reached";
    case kInterrupted:
      return "interrupted";
    default:
      return "failed";
  }
}

void copy_and_close(std::FILE* from, const std::function<void(const std::string&)>& to) {
  std::rewind(from);
  std::array<char, 4096> piece;
  for (std::size_t n; (n = std::fread(piece.data(), 1, piece.size(), from)) > 0;) {
    to(std::string(piece.data(), n));
  }
  std::fclose(from);
}

bool Batch::start(std::size_t command) {
  Child child = {command, std::tmpfile(), std::tmpfile(), Clock::now()};
  const pid_t pid = child.out != nullptr && child.error != nullptr ? fork_child() : -1;
  if (pid < 0) {
    for (std::FILE* file : {child.out, child.error}) {
      if (file != nullptr) std::fclose(file);
    }
    return false;
  }
  if (pid == 0) {
    Streams streams;
    streams.out = [&](const std::string& text) { std::fputs(text.c_str(), child.out); };
    streams.error = [&](const std::string& text) { std::fputs(text.c_str(), child.error); };
    const int code = cli::run(commands_[command], library_, streams);
    std::fflush(child.out);
    std::fflush(child.error);
    ::_exit(code);  // the parent writes its own buffers
  }
  running_.emplace(pid, child);
  return true;
}

void Batch::summarize(std::size_t command, int code, const std::string& how) const {
  if (commands_[command].quiet) return;
  std::string line = commands_[command].input + ": " + meaning(code);
  if (code != kDone) line += " (exit " + std::to_string(code) + ")";
  streams_.error(line + how + "\n");
}

void Batch::wait_for_one() {
  int status = 0;
  const pid_t pid = ::waitpid(-1, &status, 0);
  const auto found = running_.find(pid);
  if (found == running_.end()) return;
  forget_child(pid);
  const Child child = found->second;
  running_.erase(found);
  copy_and_close(child.out, streams_.out);
  copy_and_close(child.error, streams_.error);
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, ", %.1f s",
                std::chrono::duration<double>(Clock::now() - child.start).count());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : kInternal;
  std::string how = seconds;
  if (WIFSIGNALED(status)) how = ", ended by signal " + std::to_string(WTERMSIG(status)) + how;
  count(code);
  summarize(child.command, code, how);
}

// Why a folder of outputs can neither be written to nor be made; empty if all can.
std::string Batch::folder_error() const {
  std::set<std::filesystem::path> seen;
  for (const Command& command : commands_) {
    for (const std::string& output : command.outputs) {
      if (!seen.insert(std::filesystem::path(output).parent_path()).second) continue;
      const io::WriteStatus status = io::check_writable(output, io::MissingFolder::is_made);
      if (!status.ok()) return status.error;
    }
  }
  return {};
}

int Batch::run(unsigned jobs) {
  // Once, not for every input.
  if (const std::string error = folder_error(); !error.empty()) {
    streams_.error("delmesher: " + error + "\n");
    return kUnreadable;
  }
  std::fflush(stdout);        // or every child would write it, too
  const Deferring deferring;  // those that run are interrupted, and say so
  std::size_t next = 0;
  while ((next < commands_.size() && !interrupted()) || !running_.empty()) {
    const bool room = running_.size() < jobs && next < commands_.size() && !interrupted();
    if (room && start(next)) {
      ++next;
    } else if (room && running_.empty()) {  // no process to be had, and none that would end
      streams_.error("delmesher: " + commands_[next].input + ": cannot start a process\n");
      count(kLimit);
      ++next;
    } else {
      wait_for_one();
    }
  }
  const bool all = codes_.size() == 1 && codes_.begin()->first == kDone;
  if (!commands_.front().quiet) {
    std::string line =
        std::to_string(codes_[kDone]) + " of " + std::to_string(commands_.size()) + " files done";
    for (const auto& [code, files] : codes_) {
      if (code == kDone || files == 0) continue;
      line += ", " + std::to_string(files) + " " + meaning(code) + " (exit " +
              std::to_string(code) + ")";
    }
    if (next < commands_.size()) {
      line += ", " + std::to_string(commands_.size() - next) + " not begun";
    }
    streams_.error(line + "\n");
  }
  if (interrupted()) return kInterrupted;
  return all ? kDone : kFailed;
}

}  // namespace

int run_batch(const std::vector<Command>& commands, unsigned jobs, const Library& library,
              const Streams& streams) {
  return Batch(commands, library, streams).run(jobs);
}

}  // namespace delmesher::cli
