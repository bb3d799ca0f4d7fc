#include "mesher/remesh/coarsening.h"

#include <queue>
#include <tuple>
#include <vector>

namespace delmesher::remesh {
namespace {

constexpr double kShare = 1e-2;  // of the length of an edge in the order

class Coarsening {
 public:
  Coarsening(State& state, Control& control) : state_(state), control_(control) {}

  void run() {
    for (VertexId v = 0; v < state_.mesh().vertices(); ++v) push_around(v, v);
    const auto all = static_cast<double>(tasks_.size());
    while (!tasks_.empty()) {
      const Task task = tasks_.top();
      tasks_.pop();
      control_.poll(state_.mesh().count() / 2, 1 - static_cast<double>(tasks_.size()) / all);
      if (!is_current(task)) continue;
      const VertexId p = state_.collapse(task.a, task.b);
      if (p == kNone) continue;
      ++changes_of(p);
      push_around(p, 0);
    }
  }

 private:
  struct Task {
    double key;
    VertexId a, b;
    std::uint32_t changes_of_a, changes_of_b;  // when it was pushed

    bool operator<(const Task& other) const {
      return std::tuple(other.key, other.a, other.b) < std::tuple(key, a, b);
    }
  };

  std::uint32_t& changes_of(VertexId v) {
    if (v >= changes_.size()) changes_.resize(v + 1);
    return changes_[v];
  }
  bool is_current(const Task& task) {
    return !state_.mesh().star(task.a).empty() && !state_.mesh().star(task.b).empty() &&
           changes_of(task.a) == task.changes_of_a && changes_of(task.b) == task.changes_of_b;
  }
  // The edges to its neighbours from `first` on.
  void push_around(VertexId v, VertexId first) {
    for (const VertexId w : state_.mesh().neighbours(v)) {
      if (w >= first) push(std::min(v, w), std::max(v, w));
    }
  }
  void push(VertexId a, VertexId b) {
    const std::vector<Vec3> places = state_.places(a, b);
    if (places.empty()) return;
    const double error = state_.error(a, b, places[0]);
    if (!(error <= 1)) return;
    const double length = state_.length({a, b}) / state_.diagonal();
    tasks_.push({error + kShare * length * length, a, b, changes_of(a), changes_of(b)});
  }

  State& state_;
  Control& control_;
  std::priority_queue<Task> tasks_;
  std::vector<std::uint32_t> changes_;  // by vertex
};

}  // namespace

void coarsen(State& state, Control& control) {
  Coarsening(state, control).run();
}

}  // namespace delmesher::remesh
