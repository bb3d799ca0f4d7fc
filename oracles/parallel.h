// Independent tasks, shared among threads.
#pragma once

#include <cstddef>
#include <functional>

namespace tetproof::oracles {

// Calls task(0) to task(count - 1), begun in this order, by up to `threads` threads including the
// caller's (0: as many as the machine has cores). Once a task has thrown, no further one begins.
// When all have ended, the exception of the first task in order that threw is thrown on.
void run_tasks(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace tetproof::oracles
