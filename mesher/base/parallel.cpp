#include "mesher/base/parallel.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

namespace delmesher::base {
namespace {

// Thrown out of a chunk that is no longer needed.
struct Unwanted {};

}  // namespace

// The state that the threads of one loop share.
class SharedLoop {
 public:
  using Work = std::function<bool(Worker&, const Chunk&)>;

  SharedLoop(Control& control, std::size_t count, std::size_t size, const Work& work)
      : control_(control),
        count_(count),
        size_(size),
        work_(work),
        end_((count + size - 1) / size) {}

  void run() {
    const std::size_t wanted = std::min<std::size_t>(control_.threads(), end_);
    std::vector<std::thread> threads;
    try {
      for (std::size_t n = 1; n < wanted; ++n) {
        threads.emplace_back([this, n] {
          Worker worker(*this, nullptr, n);
          run_chunks(worker);
          const std::lock_guard<std::mutex> lock(mutex_);
          ++ended_;
          ended_changed_.notify_one();
        });
      }
    } catch (const std::system_error&) {
      // The threads that could be started do all the work.
    } catch (...) {
      stop_at(0);
      failed(0);
    }
    Worker caller(*this, &control_, 0);
    run_chunks(caller);
    wait_for(threads.size());
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

  void poll(const Worker& worker) {
    if (worker.control_ == nullptr) {
      if (worker.chunk_ >= end_.load(std::memory_order_relaxed)) throw Unwanted{};
      return;
    }
    try {
      worker.control_->poll();
    } catch (...) {
      stop_at(0);  // of all threads
      throw;
    }
    if (worker.chunk_ >= end_.load(std::memory_order_relaxed)) throw Unwanted{};
  }

 private:
  void run_chunks(Worker& worker) {
    for (;;) {
      const std::size_t n = next_++;
      if (n >= end_) return;
      worker.chunk_ = n;
      try {
        const Chunk chunk{n, n * size_, std::min(count_, (n + 1) * size_)};
        if (!work_(worker, chunk)) stop_at(n + 1);
      } catch (const Unwanted&) {
        return;
      } catch (...) {
        failed(n);
        return;
      }
    }
  }

  // Until so many other threads have ended. Limits and cancellation hold meanwhile.
  void wait_for(std::size_t threads) {
    constexpr std::chrono::milliseconds kPatience(10);
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_changed_.wait_for(lock, kPatience, [&] { return ended_ == threads; })) {
      lock.unlock();
      try {
        if (end_ > 0) control_.poll_now(0, -1);
      } catch (...) {
        stop_at(0);
        failed(0);
      }
      lock.lock();
    }
  }

  // Chunks from this one on are not wanted.
  void stop_at(std::size_t chunk) {
    std::size_t end = end_;
    while (chunk < end && !end_.compare_exchange_weak(end, chunk)) {
    }
  }

  // Called while an exception is handled.
  void failed(std::size_t chunk) {
    stop_at(chunk);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_ && failed_chunk_ <= chunk) return;
    failure_ = std::current_exception();
    failed_chunk_ = chunk;
  }

  Control& control_;
  const std::size_t count_, size_;
  const Work& work_;
  std::atomic<std::size_t> next_ = 0, end_;
  std::mutex mutex_;
  std::condition_variable ended_changed_;
  std::size_t ended_ = 0;  // threads other than the caller's
  std::exception_ptr failure_;
  std::size_t failed_chunk_ = 0;
};

void Worker::poll() {
  loop_.poll(*this);
}

void for_chunks(Control& control, std::size_t count, std::size_t size,
                const std::function<bool(Worker&, const Chunk&)>& work) {
  SharedLoop(control, count, size, work).run();
}

}  // namespace delmesher::base
