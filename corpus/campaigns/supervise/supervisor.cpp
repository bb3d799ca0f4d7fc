#include "corpus/campaigns/supervise/supervisor.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace tetproof {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollMilliseconds = 20;
constexpr double kGiveUpKillingSeconds = 20;
constexpr std::size_t kTailBytes = 4096;
constexpr std::uint64_t kShareable = 8u << 20;  // resident bytes beside the largest process
constexpr double kProportionalPause = 20;       // times the duration of the last look
constexpr int kLooksInVain = 8;                 // while processes end all the time

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// The state of a process by /proc/PID/stat.
struct ProcessState {
  pid_t parent = 0;
  char state = '?';
  double cpu_seconds = 0;  // its own and that of the children it has waited for
  std::uint64_t resident_bytes = 0;
};

bool read_state(pid_t pid, ProcessState& result) {
  std::array<char, 64> path;
  std::snprintf(path.data(), path.size(), "/proc/%d/stat", static_cast<int>(pid));
  const int fd = open(path.data(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  std::array<char, 2048> text;
  const ssize_t size = read(fd, text.data(), text.size() - 1);
  close(fd);
  if (size <= 0) return false;
  text[static_cast<std::size_t>(size)] = 0;
  // The command's name may hold spaces and parentheses, so fields count from the last ')'.
  const char* rest = std::strrchr(text.data(), ')');
  if (rest == nullptr) return false;
  long parent = 0, resident_pages = 0;
  unsigned long user = 0, system = 0;
  long children_user = 0, children_system = 0;
  const int fields = std::sscanf(rest + 1,
                                 " %c %ld %*s %*s %*s %*s %*s %*s %*s %*s %*s %lu %lu %ld %ld "
                                 "%*s %*s %*s %*s %*s %*s %ld",
                                 &result.state, &parent, &user, &system, &children_user,
                                 &children_system, &resident_pages);
  if (fields != 7) return false;
  static const double ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  static const long page = sysconf(_SC_PAGESIZE);
  result.parent = static_cast<pid_t>(parent);
  result.cpu_seconds =
      (static_cast<double>(user + system) + static_cast<double>(children_user + children_system)) /
      ticks;
  result.resident_bytes = static_cast<std::uint64_t>(resident_pages) * page;
  return true;
}

// Resident bytes with pages shared by N processes counted as 1/N of a page, so that a sum over
// processes counts every page once. Slow (the kernel walks the page tables), and not available on
// every kernel.
std::optional<std::uint64_t> proportional_bytes(pid_t pid) {
  std::array<char, 64> path;
  std::snprintf(path.data(), path.size(), "/proc/%d/smaps_rollup", static_cast<int>(pid));
  FILE* file = std::fopen(path.data(), "re");
  if (file == nullptr) return std::nullopt;
  std::optional<std::uint64_t> bytes;
  std::array<char, 256> line;
  unsigned long long kibibytes = 0;
  while (!bytes && std::fgets(line.data(), line.size(), file) != nullptr) {
    if (std::sscanf(line.data(), "Pss: %llu kB", &kibibytes) == 1) bytes = kibibytes << 10;
  }
  std::fclose(file);
  return bytes;
}

template <typename Visit>
void for_each_number_in(const char* directory, Visit visit) {
  DIR* dir = opendir(directory);
  if (dir == nullptr) return;
  while (const dirent* entry = readdir(dir)) {
    char* end = nullptr;
    const long number = std::strtol(entry->d_name, &end, 10);
    if (number > 0 && *end == 0) visit(static_cast<pid_t>(number));
  }
  closedir(dir);
}

// Appends the children of a process as listed by the kernel; false if it does not list them.
bool append_listed_children(pid_t pid, std::vector<pid_t>& children) {
  std::array<char, 64> tasks;
  std::snprintf(tasks.data(), tasks.size(), "/proc/%d/task", static_cast<int>(pid));
  bool listed = false;
  for_each_number_in(tasks.data(), [&](pid_t task) {
    std::array<char, 96> path;
    std::snprintf(path.data(), path.size(), "%s/%d/children", tasks.data(), static_cast<int>(task));
    FILE* file = std::fopen(path.data(), "re");
    if (file == nullptr) return;
    listed = true;
    int child = 0;
    while (std::fscanf(file, "%d", &child) == 1) children.push_back(child);
    std::fclose(file);
  });
  return listed;
}

std::vector<pid_t> descendants_by_scan(pid_t root) {
  std::multimap<pid_t, pid_t> children;
  for_each_number_in("/proc", [&](pid_t pid) {
    ProcessState state;
    if (read_state(pid, state)) children.emplace(state.parent, pid);
  });
  std::vector<pid_t> found = {root};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [first, last] = children.equal_range(found[i]);
    for (auto it = first; it != last; ++it) found.push_back(it->second);
  }
  found.erase(found.begin());
  return found;
}

// Every process below this one, parents before their children. Orphans are adopted by the
// subreaper, so nothing escapes.
std::vector<pid_t> descendants() {
  const pid_t self = getpid();
  std::vector<pid_t> found;
  if (!append_listed_children(self, found)) return descendants_by_scan(self);
  for (std::size_t i = 0; i < found.size(); ++i) append_listed_children(found[i], found);
  return found;
}

// The end of a stream, read without ever blocking.
class Tail {
 public:
  explicit Tail(int fd) : fd_(fd) { fcntl(fd_, F_SETFL, O_NONBLOCK); }

  void drain() {
    std::array<char, 4096> buffer;
    // Bounded, so that a child that writes without end cannot keep this process from watching its
    // limits.
    for (int round = 0; fd_ >= 0 && round < 64; ++round) {
      const ssize_t size = read(fd_, buffer.data(), buffer.size());
      if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
      if (size <= 0) {
        close(fd_);
        fd_ = -1;
        return;
      }
      text_.append(buffer.data(), static_cast<std::size_t>(size));
      if (text_.size() > 2 * kTailBytes) text_.erase(0, text_.size() - kTailBytes);
    }
  }

  std::string take() {
    drain();
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
    if (text_.size() > kTailBytes) text_.erase(0, text_.size() - kTailBytes);
    return text_;
  }

  int fd() const { return fd_; }

 private:
  int fd_;
  std::string text_;
};

void set_limit(int resource, std::uint64_t soft, std::uint64_t hard) {
  const rlimit limit = {soft, hard};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

class Job {
 public:
  Job(const std::vector<std::string>& argv, const Limits& limits, int control_fd)
      : argv_(argv), limits_(limits), control_fd_(control_fd) {}

  Outcome run() {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    block_signals();
    if (start()) {
      watch();
      end_everything();
      collect();
    }
    close(signal_fd_);
    return outcome_;
  }

 private:
  void block_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int s : {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT}) sigaddset(&signals, s);
    sigprocmask(SIG_BLOCK, &signals, &old_mask_);
    signal(SIGPIPE, SIG_IGN);
    signal_fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  }

  // In the forked child: own session, limits, streams, exec.
  [[noreturn]] void become_command(int out, int err, int exec_error) {
    setsid();
    const int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
    dup2(null, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    set_limit(RLIMIT_CORE, 0, 0);
    if (limits_.cpu_seconds > 0) {
      // A backstop only: the polled sum over the job comes first.
      const auto whole = static_cast<std::uint64_t>(std::ceil(limits_.cpu_seconds)) + 2;
      set_limit(RLIMIT_CPU, whole, whole + 2);
    }
    if (limits_.memory_bytes > 0 && kMemoryBackstop) {
      // Also a backstop, for allocations faster than polling. It is a little above the polled
      // limit, so that the usual case is a clear verdict rather than whatever the command does
      // without memory. RLIMIT_AS would not do: allocators and thread pools reserve address space
      // freely.
      const std::uint64_t data = limits_.memory_bytes + limits_.memory_bytes / 8 + (64u << 20);
      set_limit(RLIMIT_DATA, data, data);
    }
    if (limits_.file_bytes > 0) set_limit(RLIMIT_FSIZE, limits_.file_bytes, limits_.file_bytes);
    signal(SIGPIPE, SIG_DFL);
    sigprocmask(SIG_SETMASK, &old_mask_, nullptr);
    std::vector<char*> arguments;
    for (const std::string& argument : argv_)
      arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    const int error = errno;
    [[maybe_unused]] const ssize_t written = write(exec_error, &error, sizeof error);
    _exit(127);
  }

  bool start() {
    std::array<int, 2> out{}, err{}, exec_error{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0 ||
        pipe2(exec_error.data(), O_CLOEXEC) != 0) {
      return fail_to_start(errno);
    }
    start_time_ = Clock::now();
    leader_ = fork();
    if (leader_ < 0) return fail_to_start(errno);
    if (leader_ == 0) become_command(out[1], err[1], exec_error[1]);
    for (const int fd : {out[1], err[1], exec_error[1]}) close(fd);
    stdout_ = Tail(out[0]);
    stderr_ = Tail(err[0]);
    int error = 0;
    const bool failed = read(exec_error[0], &error, sizeof error) == sizeof error;
    close(exec_error[0]);
    if (!failed) return true;
    waitpid(leader_, nullptr, 0);
    return fail_to_start(error);
  }

  bool fail_to_start(int error) {
    outcome_.ending = Ending::not_started;
    outcome_.error = argv_[0] + ": " + std::strerror(error);
    return false;
  }

  // Watches until the command ends or a limit is reached.
  void watch() {
    while (!leader_done_) {
      std::array<pollfd, 4> fds = {pollfd{signal_fd_, POLLIN, 0}, pollfd{control_fd_, POLLIN, 0},
                                   pollfd{stdout_.fd(), POLLIN, 0},
                                   pollfd{stderr_.fd(), POLLIN, 0}};
      poll(fds.data(), fds.size(), next_poll());
      if (fds[0].revents != 0) take_signals();
      stdout_.drain();
      stderr_.drain();
      if (fds[1].revents != 0) take_control();
      reap();
      if (!leader_done_ && outcome_.ending == Ending::lost) check_limits();
      if (!leader_done_ && outcome_.ending != Ending::lost) return;
    }
  }

  int next_poll() const {
    if (limits_.wall_seconds <= 0) return kPollMilliseconds;
    const double left = 1000 * (limits_.wall_seconds - seconds_since(start_time_));
    return std::clamp(static_cast<int>(left) + 1, 1, kPollMilliseconds);
  }

  void take_signals() {
    signalfd_siginfo info;
    while (read(signal_fd_, &info, sizeof info) == sizeof info) {
      if (info.ssi_signo != SIGCHLD) decide(Ending::stopped);
    }
  }

  void take_control() {
    std::array<char, 64> ignored;
    if (read(control_fd_, ignored.data(), ignored.size()) <= 0) {
      control_fd_ = -1;
      decide(Ending::stopped);
    }
  }

  void decide(Ending ending) {
    if (outcome_.ending == Ending::lost) outcome_.ending = ending;
  }

  void check_limits() {
    const double cpu = processor_seconds();
    const std::uint64_t resident = resident_bytes();
    peak_sum_ = std::max(peak_sum_, resident);
    if (limits_.memory_bytes > 0 && resident > limits_.memory_bytes) decide(Ending::memory_limit);
    if (limits_.wall_seconds > 0 && seconds_since(start_time_) >= limits_.wall_seconds) {
      decide(Ending::wall_limit);
    }
    if (limits_.cpu_seconds > 0 && cpu >= limits_.cpu_seconds) decide(Ending::cpu_limit);
  }

  // The processor time of all processes of the job, whichever process has waited for them. A
  // process's time is its own until it is waited for, and then belongs to the children's time of
  // the waiting process, so no time counts twice: parents are read before their children, and a
  // process that ends in between is missing for once rather than doubled. If time is missing in a
  // second look, too, it belonged to processes that nobody waits for (their parent ignores SIGCHLD,
  // and the kernel forgets their time). It stays counted as last seen.
  double processor_seconds() {
    states_.clear();
    double sum = look() + cpu_forgotten_;
    if (sum < cpu_seen_) sum = look() + cpu_forgotten_;
    if (sum < cpu_seen_) {
      cpu_forgotten_ += cpu_seen_ - sum;
      sum = cpu_seen_;
    }
    return cpu_seen_ = sum;
  }

  double look() {
    states_.clear();
    double sum = cpu_of_reaped_;
    for (const pid_t pid : descendants()) {
      ProcessState state;
      if (!read_state(pid, state)) continue;
      sum += state.cpu_seconds;
      states_.emplace_back(pid, state);
    }
    return sum;
  }

  // The resident bytes of all processes seen by the last look(), with shared pages counted once.
  // The sum of the resident sets is an upper bound that costs nothing. The proportional sets are
  // asked only where the bound could matter: it is beyond the peak so far, and by more than the
  // little that a shell shares with the program it started. They are asked seldom enough to take a
  // small part of the time, unless the job is beyond its limit even without the bytes shared at the
  // last look. In between the largest process stands for the job.
  std::uint64_t resident_bytes() {
    std::uint64_t sum = 0, largest = 0;
    for (const auto& [pid, state] : states_) {
      sum += state.resident_bytes;
      largest = std::max(largest, state.resident_bytes);
    }
    if (sum - largest <= kShareable || sum <= peak_sum_) return sum;
    const std::uint64_t guess = std::max(largest, sum - std::min(sum, shared_before_));
    const bool beyond = limits_.memory_bytes > 0 && guess > limits_.memory_bytes;
    if (seconds_since(start_time_) < next_proportional_ && !beyond) return largest;
    const Clock::time_point begin = Clock::now();
    std::uint64_t proportional = 0;
    for (const auto& [pid, state] : states_) {
      // A process that has just ended has no pages any more. A process that cannot be asked counts
      // fully.
      proportional += proportional_bytes(pid).value_or(state.resident_bytes);
    }
    // The bytes that an ended process shared count for itself and for the processes read after its
    // end. A sum over such a time is too large and is not taken, unless processes end all the time.
    if (any_has_ended() && ++looks_in_vain_ < kLooksInVain) return largest;
    looks_in_vain_ = 0;
    proportional = std::clamp(proportional, largest, sum);
    shared_before_ = sum - proportional;
    next_proportional_ = seconds_since(start_time_) + kProportionalPause * seconds_since(begin);
    return proportional;
  }

  // Has any process ended that the last look() saw alive?
  bool any_has_ended() const {
    return std::any_of(states_.begin(), states_.end(), [](const auto& seen) {
      ProcessState now;
      return seen.second.resident_bytes > 0 &&
             (!read_state(seen.first, now) || now.resident_bytes == 0);
    });
  }

  // Collects all processes that have ended; returns false when there are no children any more.
  bool reap() {
    for (;;) {
      int status = 0;
      rusage usage{};
      const pid_t pid = wait4(-1, &status, WNOHANG, &usage);
      if (pid == 0) return true;
      if (pid < 0) return errno != ECHILD;
      cpu_of_reaped_ += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
      peak_single_ = std::max(peak_single_, static_cast<std::uint64_t>(usage.ru_maxrss) * 1024);
      if (pid == leader_) leader_ended(status);
    }
  }

  void leader_ended(int status) {
    leader_done_ = true;
    outcome_.wall_seconds = seconds_since(start_time_);
    if (WIFEXITED(status)) {
      decide(Ending::exited);
      if (outcome_.ending == Ending::exited) outcome_.exit_code = WEXITSTATUS(status);
    } else {
      // The kernel's own processor limit, should it come before ours.
      if (WTERMSIG(status) == SIGXCPU) decide(Ending::cpu_limit);
      decide(Ending::signalled);
      if (outcome_.ending == Ending::signalled) outcome_.signal = WTERMSIG(status);
    }
  }

  // Kills until nothing is left: a process that forks while being killed is caught next round.
  void end_everything() {
    const bool leader_was_done = leader_done_;
    const Clock::time_point begin = Clock::now();
    bool first = true;
    while (reap()) {
      const std::vector<pid_t> left = descendants();
      if (first && leader_was_done) outcome_.leftover_processes = static_cast<int>(left.size());
      first = false;
      if (!leader_done_) kill(-leader_, SIGKILL);
      for (const pid_t pid : left) kill(pid, SIGKILL);
      if (seconds_since(begin) > kGiveUpKillingSeconds) {
        outcome_.unkillable_processes = static_cast<int>(left.size());
        break;
      }
      poll(nullptr, 0, 1);
    }
    if (!leader_done_) outcome_.wall_seconds = seconds_since(start_time_);
  }

  void collect() {
    outcome_.cpu_seconds = cpu_of_reaped_ + cpu_forgotten_;
    outcome_.peak_rss_bytes = std::max(peak_single_, peak_sum_);
    outcome_.stderr_tail = stderr_.take();
    outcome_.stdout_tail = stdout_.take();
  }

  const std::vector<std::string>& argv_;
  Limits limits_;
  int control_fd_;
  int signal_fd_ = -1;
  sigset_t old_mask_{};
  pid_t leader_ = -1;
  bool leader_done_ = false;
  Clock::time_point start_time_;
  std::vector<std::pair<pid_t, ProcessState>> states_;
  double cpu_of_reaped_ = 0, cpu_seen_ = 0, cpu_forgotten_ = 0;
  double next_proportional_ = 0;  // seconds since the start
  std::uint64_t shared_before_ = 0;
  int looks_in_vain_ = 0;
  std::uint64_t peak_single_ = 0, peak_sum_ = 0;
  Tail stdout_{-1}, stderr_{-1};
  Outcome outcome_;  // its ending is `lost` while undecided
};

constexpr std::array<const char*, 8> kEndingNames = {"exited",      "signalled",    "wall_limit",
                                                     "cpu_limit",   "memory_limit", "stopped",
                                                     "not_started", "lost"};

std::string counted(const std::string& text) {
  return std::to_string(text.size()) + "\n" + text + "\n";
}

bool read_counted(std::istream& in, std::string& text) {
  std::size_t size = 0;
  if (!(in >> size) || in.get() != '\n') return false;
  text.resize(size);
  in.read(text.data(), static_cast<std::streamsize>(size));
  return in.gcount() == static_cast<std::streamsize>(size) && in.get() == '\n';
}

}  // namespace

const char* ending_name(Ending ending) {
  return kEndingNames[static_cast<std::size_t>(ending)];
}

Outcome supervise(const std::vector<std::string>& argv, const Limits& limits, int control_fd) {
  return Job(argv, limits, control_fd).run();
}

std::string serialize(const Outcome& o) {
  std::ostringstream out;
  out.precision(17);
  out << ending_name(o.ending) << ' ' << o.exit_code << ' ' << o.signal << ' ' << o.wall_seconds
      << ' ' << o.cpu_seconds << ' ' << o.peak_rss_bytes << ' ' << o.leftover_processes << ' '
      << o.unkillable_processes << '\n'
      << counted(o.error) << counted(o.stderr_tail) << counted(o.stdout_tail);
  return out.str();
}

bool deserialize(const std::string& text, Outcome& o) {
  std::istringstream in(text);
  std::string name;
  in >> name >> o.exit_code >> o.signal >> o.wall_seconds >> o.cpu_seconds >> o.peak_rss_bytes >>
      o.leftover_processes >> o.unkillable_processes;
  const auto found = std::find(kEndingNames.begin(), kEndingNames.end(), name);
  if (!in || found == kEndingNames.end()) return false;
  o.ending = static_cast<Ending>(found - kEndingNames.begin());
  return read_counted(in, o.error) && read_counted(in, o.stderr_tail) &&
         read_counted(in, o.stdout_tail);
}

}  // namespace tetproof
