// Independent tasks, shared among threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

namespace tetproof::oracles {

// Calls task(0) to task(count - 1), begun in this order, by up to `threads` threads including the
// caller's (0: as many as the machine has cores). Once a task has thrown, no further one begins.
// When all have ended, the exception of the first task in order that threw is thrown on.
void run_tasks(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& task);

// A task that the first thread to ask carries out, while the others wait for it. Its exception is
// thrown to all of them; the task is not repeated. std::call_once lets exceptions pass through
// functions in C, for which the C library needs memory: lack of memory would end the program.
class Once {
 public:
  template <class Work>
  void operator()(Work&& work) {
    if (done_.load(std::memory_order_acquire)) return;
    const std::lock_guard lock(mutex_);
    if (thrown_) std::rethrow_exception(thrown_);
    if (done_.load(std::memory_order_relaxed)) return;
    try {
      work();
    } catch (...) {
      thrown_ = std::current_exception();
      throw;
    }
    done_.store(true, std::memory_order_release);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> done_ = false;
  std::exception_ptr thrown_;
};

}  // namespace tetproof::oracles
