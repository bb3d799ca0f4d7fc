#include "oracles/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace tetproof::oracles {

void run_tasks(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& task) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::exception_ptr> failure(count);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t n = next++; n < count; n = next++) {
      try {
        task(n);
      } catch (...) {
        failure[n] = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> others;
  others.reserve(std::min<std::size_t>(threads, count));
  try {
    while (others.size() + 1 < std::min<std::size_t>(threads, count)) others.emplace_back(work);
  } catch (const std::system_error&) {
    // The threads that were started do the work.
  }
  work();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& thrown : failure) {
    if (thrown) std::rethrow_exception(thrown);
  }
}

}  // namespace tetproof::oracles
