// Long loops over independent items, shared among the threads of one run (Options::threads).
//
// The result is that of one thread, whatever their number: the chunks of a loop depend on its items
// alone, each is worked on by one thread, and their results are put together in their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <iterator>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Consecutive items of a loop.
struct Chunk {
  std::size_t index, begin, end;
};

class SharedLoop;

// One of the threads at work; number 0 is the one that called.
class Worker {
 public:
  Worker(SharedLoop& loop, Control* control, std::size_t number)
      : loop_(loop), control_(control), number_(number) {}

  std::size_t number() const { return number_; }
  // To be called as often as Control::poll(). Throws when the rest of the chunk is not wanted.
  void poll();

 private:
  friend class SharedLoop;

  SharedLoop& loop_;
  Control* control_;  // of the calling thread; null for others, which it does not serve
  std::size_t number_;
  std::size_t chunk_ = 0;
};

// Calls work(worker, chunk) for every chunk of `size` items of `count`, by up to control.threads()
// threads. Calls that write shared data have to write different objects. Chunks are begun in their
// order. When work returns false, later chunks are not wanted: some may be worked on all the same,
// but every earlier one is completed. An exception from work ends the loop in the same way and is
// thrown on (of several, the first chunk's); so do the limits of the control. With one thread, no
// thread is created.
void for_chunks(Control& control, std::size_t count, std::size_t size,
                const std::function<bool(Worker&, const Chunk&)>& work);

// The same, item by item: work(worker, item).
template <class Work>
void for_items(Control& control, std::size_t count, std::size_t size, const Work& work) {
  for_chunks(control, count, size, [&](Worker& worker, const Chunk& chunk) {
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      worker.poll();
      work(worker, i);
    }
    return true;
  });
}

// Collects the entries that work(worker, item, list) appends to `list`, in the order of the items.
template <class T, class Work>
std::vector<T> gather(Control& control, std::size_t count, std::size_t size, const Work& work) {
  std::vector<std::vector<T>> lists((count + size - 1) / size);
  for_chunks(control, count, size, [&](Worker& worker, const Chunk& chunk) {
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      worker.poll();
      work(worker, i, lists[chunk.index]);
    }
    return true;
  });
  std::vector<T> all;
  for (std::vector<T>& list : lists) {
    std::move(list.begin(), list.end(), std::back_inserter(all));
    list = {};
  }
  return all;
}

// An object for each thread, such as predicates with their counters.
template <class T>
class PerWorker {
 public:
  template <class... Arguments>
  explicit PerWorker(const Control& control, Arguments&... arguments) {
    for (unsigned n = 0; n < control.threads(); ++n) slots_.emplace_back(arguments...);
  }
  T& operator[](const Worker& worker) { return slots_[worker.number()].value; }
  // In the order of the workers.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (Slot& slot : slots_) visit(slot.value);
  }

 private:
  // Apart from each other in the processor's caches.
  struct alignas(64) Slot {
    template <class... Arguments>
    explicit Slot(Arguments&... arguments) : value(arguments...) {}
    T value;
  };
  std::deque<Slot> slots_;
};

}  // namespace delmesher::base
