#include "mesher/base/control.h"

#include <algorithm>
#include <exception>
#include <new>
#include <thread>

namespace delmesher::base {
namespace {

double seconds_between(std::chrono::steady_clock::time_point a,
                       std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

}  // namespace

namespace {

// The answer of the callback. An exception from it ends the run like the answer no.
bool goes_on(const Limits& limits, const Progress& progress) {
  try {
    return limits.progress(progress);
  } catch (const std::bad_alloc&) {
    throw;  // memory is a limit, whoever asked for it
  } catch (const std::exception& error) {
    throw Stopped{{StatusCode::interrupted,
                   std::string("interrupted: the progress callback threw: ") + error.what()}};
  } catch (...) {
    throw Stopped{{StatusCode::interrupted,
                   "interrupted: the progress callback threw what is not a std::exception"}};
  }
}

}  // namespace

void stop_at_precision(const std::string& where) {
  throw Stopped{{StatusCode::limit_reached,
                 where + ": features there are too close to each other for double precision",
                 Limit::precision}};
}

Control::Control(const Limits& limits)
    : limits_(limits),
      threads_(
          std::max(1U, limits.threads == 0 ? std::thread::hardware_concurrency() : limits.threads)),
      start_(Clock::now()),
      phase_start_(start_) {}

void Control::enter(Phase phase) {
  finish();
  phase_ = phase;
  phase_start_ = Clock::now();
  in_phase_ = true;
  poll_now(0, 0);
}

void Control::finish() {
  if (!in_phase_) return;
  seconds_[static_cast<std::size_t>(phase_)] += seconds_between(phase_start_, Clock::now());
  in_phase_ = false;
}

void Control::poll(std::uint64_t vertices, double done) {
  if ((++calls_ & 0x3fU) == 0) poll_now(vertices, done);
}

void Control::poll_now(std::uint64_t vertices, double done) {
  if (limits_.max_vertices > 0 && vertices > limits_.max_vertices) {
    throw Stopped{
        {StatusCode::limit_reached,
         "vertex limit reached (" + std::to_string(limits_.max_vertices) + "), see --max-vertices",
         Limit::size}};
  }
  if (vertices > allowed_) throw Stopped{beyond_};
  if (limits_.time_limit_seconds > 0 &&
      seconds_between(start_, Clock::now()) > limits_.time_limit_seconds) {
    throw Stopped{{StatusCode::limit_reached, "time limit reached, see --time-limit", Limit::time}};
  }
  if (limits_.progress && !goes_on(limits_, Progress{phase_, done, vertices, predicted_})) {
    throw Stopped{{StatusCode::interrupted, "interrupted"}};
  }
}

}  // namespace delmesher::base
