// Independent tasks, shared among threads.
#pragma once

#include <cstddef>
#include <functional>

namespace tetproof::oracles {

// Calls task(0) ... task(count - 1), by up to `threads` threads (0: as many as the machine has
// cores), the caller's among them; begun in this order. Of what tasks throw, the first one's is
// thrown on when all have ended; later ones are then not begun.
void run_tasks(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace tetproof::oracles
