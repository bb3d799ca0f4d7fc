// A command that misbehaves as asked, for process_test.
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace {

void note_self(const char* file) {
  const std::string line = std::to_string(getpid()) + "\n";
  const int fd = open(file, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (write(fd, line.data(), line.size()) < 0) std::abort();
  close(fd);
}

void ignore_signals() {
  for (int s = 1; s < 32; ++s) {
    if (s != SIGCHLD) signal(s, SIG_IGN);
  }
}

// Runs until this process has used this much processor time.
void burn(double seconds) {
  volatile std::uint64_t sink = 0;
  const auto limit = static_cast<clock_t>(seconds * CLOCKS_PER_SEC);
  while (clock() < limit) {
    for (int i = 0; i < 10000; ++i) sink = sink + 1;
  }
}

// DEPTH processes below one another, each of which starts COUNT processes that burn one after the
// other.
void burn_in_tree(int depth, int count, double seconds) {
  for (int i = 0; i < count; ++i) {
    if (fork() == 0) {
      burn(seconds);
      _exit(0);
    }
    wait(nullptr);
  }
  if (depth > 1 && fork() == 0) {
    burn_in_tree(depth - 1, count, seconds);
    _exit(0);
  }
  wait(nullptr);
}

[[noreturn]] void wait_forever() {
  for (;;) pause();
}

[[noreturn]] void spin() {
  volatile bool on = true;
  while (on) {
  }
  std::abort();
}

std::vector<char*> allocate(std::size_t megabytes) {
  std::vector<char*> blocks;
  for (std::size_t i = 0; i < megabytes; ++i) {
    blocks.push_back(new char[1 << 20]);
    std::memset(blocks.back(), 1, 1 << 20);
  }
  return blocks;
}

void behave(const std::string& how) {
  if (how == "spin") spin();
  if (how == "hold-80") {
    const auto held = allocate(80);
    wait_forever();
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "raise") {
    signal(std::atoi(argv[2]), SIG_DFL);
    raise(std::atoi(argv[2]));
  } else if (mode == "spin") {
    spin();
  } else if (mode == "ignore-signals") {
    ignore_signals();
    note_self(argv[2]);
    wait_forever();
  } else if (mode == "allocate") {
    allocate(std::strtoul(argv[2], nullptr, 10));
  } else if (mode == "allocate-at-once") {
    char* block = new char[std::strtoull(argv[2], nullptr, 10) << 20];
    std::printf("%p\n", static_cast<void*>(block));
  } else if (mode == "grandchildren") {  // COUNT HOW FILE: in sessions of their own
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
      if (fork() == 0) {
        setsid();
        ignore_signals();
        note_self(argv[4]);
        behave(argv[3]);
      }
    }
    wait_forever();
  } else if (mode == "leave-daemons") {  // COUNT FILE: orphans that ignore signals
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
      if (fork() == 0) {
        setsid();
        if (fork() != 0) _exit(0);
        ignore_signals();
        note_self(argv[3]);
        wait_forever();
      }
      wait(nullptr);
    }
    while (true) {  // until all have noted themselves
      std::FILE* file = std::fopen(argv[3], "r");
      int lines = 0;
      for (int c; file != nullptr && (c = std::fgetc(file)) != EOF;) lines += c == '\n';
      if (file != nullptr) std::fclose(file);
      if (lines == std::atoi(argv[2])) break;
      usleep(1000);
    }
  } else if (mode == "burn-in-turn") {  // DEPTH COUNT SECONDS: nobody burns long
    burn_in_tree(std::atoi(argv[2]), std::atoi(argv[3]), std::atof(argv[4]));
  } else if (mode == "burn-forgotten") {  // COUNT SECONDS: children whose time the kernel forgets
    signal(SIGCHLD, SIG_IGN);
    for (int i = 0; i < std::atoi(argv[2]); ++i) {
      if (fork() == 0) {
        burn(std::atof(argv[3]));
        _exit(0);
      }
      while (wait(nullptr) > 0) {
      }
    }
  } else if (mode ==
             "share") {  // MEGABYTES CHILDREN SECONDS [write]: forked children share an array
    auto blocks = allocate(std::strtoul(argv[2], nullptr, 10));
    for (int i = 0; i < std::atoi(argv[3]); ++i) {
      if (fork() == 0) {
        std::size_t sum = 0;
        for (char* block : blocks) {
          if (argc > 5) std::memset(block, 2, 1 << 20);
          sum += static_cast<unsigned char>(block[12345]);
        }
        usleep(static_cast<useconds_t>(1e6 * std::atof(argv[4])));
        _exit(sum == 0);
      }
    }
    while (wait(nullptr) > 0) {
    }
  } else {
    return 2;
  }
  return 0;
}
