// Read before every file of the module: what the mesher uses and Debian's libraries for WASI lack.
// There is one thread, so locks have nothing to do.
#pragma once

#include <charconv>
#include <mutex>
#include <system_error>

extern "C" int dup(int file);
typedef unsigned char sigset_t;

namespace std {

from_chars_result from_chars(const char* first, const char* last, double& value,
                             chars_format format = chars_format::general);
from_chars_result from_chars(const char* first, const char* last, float& value,
                             chars_format format = chars_format::general);

class mutex {
 public:
  void lock() {}
  void unlock() {}
};

template <class Mutex>
class unique_lock {
 public:
  explicit unique_lock(Mutex& /*mutex*/) {}
  void lock() {}
  void unlock() {}
};

class condition_variable {
 public:
  void notify_one() {}
  template <class Lock, class Duration, class Done>
  bool wait_for(Lock& /*lock*/, const Duration& /*duration*/, const Done& done) {
    return done();
  }
};

class thread {
 public:
  template <class Work>
  explicit thread(const Work& /*work*/) {
    throw system_error(make_error_code(errc::resource_unavailable_try_again));
  }
  void join() {}
  static unsigned hardware_concurrency() { return 1; }
};

}  // namespace std
