#include "mesher/output/vertex_moves.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "mesher/geometry/vector.h"

namespace delmesher::output {
namespace {

// Most moves that a chain may look at, so that hopeless tetrahedra do not take forever.
constexpr int kChainBudget = 4000;
// The same for all chains together, so that a hopeless mesh ends, too.
constexpr std::int64_t kAllChainsBudget = 10'000'000;
constexpr int kChainDepth = 3;
// Most signs that untangling may decide.
constexpr std::uint64_t kUntangleBudget = 1'000'000;
// Most rounds of untangling that end with all vertices where they were after an earlier one. Each
// makes something heavier, so it may be left after some; those that were left took 4.
constexpr int kMostReturns = 50;

// The distance from |x| to the next larger double; 0 for 0, whose neighbours say nothing about the
// scale of the mesh.
double unit_in_last_place(double x) {
  if (x == 0) return 0;
  int exponent = 0;
  std::frexp(x, &exponent);
  return std::ldexp(1.0, std::max(exponent - 53, -1074));
}

// The sum over all vertices tells different positions of them apart, but for chance.
std::uint64_t fingerprint(std::uint32_t v, const Vec3& p) {
  std::uint64_t h = v;
  for (const double x : p) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U;
    h ^= h >> 32U;
  }
  return h;
}

bool is_finite(const Vec3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// A half space that the vertex must be in to make one tetrahedron of its star positive.
struct HalfSpace {
  Vec3 normal;  // of length 1, inwards
  double offset;
};

// The half spaces of a star in coordinates relative to `origin`, divided by 2^exponent so that they
// are around 1: nothing over- or underflows, and scaling the mesh changes nothing.
struct StarFrame {
  Vec3 origin;
  int exponent = 0;
  std::vector<HalfSpace> half_spaces;

  Vec3 to_mesh(const Vec3& x) const { return add(origin, times_power_of_two(x, exponent)); }
};

StarFrame make_frame(const RoundedMesh& mesh, std::uint32_t v) {
  StarFrame frame;
  frame.origin = mesh.position(v);
  double size = 0;
  for (const std::uint32_t t : mesh.star(v)) {
    for (const std::uint32_t w : mesh.mesh.tet(t)) {
      size = std::max(size, largest_component(subtract(mesh.position(w), frame.origin)));
    }
  }
  std::frexp(size, &frame.exponent);
  const auto local = [&](std::uint32_t w) {
    return times_power_of_two(subtract(mesh.position(w), frame.origin), -frame.exponent);
  };
  // The face opposite vertex i, seen counter-clockwise from vertex i.
  static constexpr int kInward[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  for (const std::uint32_t t : mesh.star(v)) {
    const Tet& q = mesh.mesh.tet(t);
    const auto i = std::find(q.begin(), q.end(), v) - q.begin();
    const Vec3 a = local(q[kInward[i][0]]);
    const Vec3 u = subtract(local(q[kInward[i][1]]), a);
    const Vec3 w = subtract(local(q[kInward[i][2]]), a);
    Vec3 normal = cross(u, w);
    const double length = norm(normal);
    if (!(length > 0) || !std::isfinite(length)) continue;
    for (double& c : normal) c /= length;
    frame.half_spaces.push_back({normal, dot(normal, a)});
  }
  return frame;
}

// A point far inside all half spaces, if there is one (else as little outside as found): steps
// against the worst one, of decreasing length.
Vec3 deepest_point(const StarFrame& frame) {
  Vec3 x{}, best{};
  double best_depth = -INFINITY;
  for (double step = 0.25; step > 0x1p-20; step *= 0.5) {
    x = best;
    for (int i = 0; i < 12; ++i) {
      const HalfSpace* worst = nullptr;
      double depth = INFINITY;
      for (const HalfSpace& h : frame.half_spaces) {
        const double d = dot(h.normal, x) - h.offset;
        if (d < depth) {
          depth = d;
          worst = &h;
        }
      }
      if (worst == nullptr) return best;
      if (depth > best_depth) {
        best_depth = depth;
        best = x;
      }
      for (int j = 0; j < 3; ++j) x[j] += step * worst->normal[j];
    }
  }
  return best;
}

}  // namespace

VertexMoves::VertexMoves(RoundedMesh& mesh) : mesh_(mesh), chains_budget_(kAllChainsBudget) {
  for (const double largest : mesh.nearest().largest_of_facets()) {
    surface_unit_.push_back(unit_in_last_place(largest));
  }
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (x != 0 || y != 0 || z != 0) steps_.push_back({x, y, z});
      }
    }
  }
  const auto squared = [](const std::array<int, 3>& s) {
    return s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
  };
  std::stable_sort(steps_.begin(), steps_.end(),
                   [&](const auto& s, const auto& t) { return squared(s) < squared(t); });
}

// Vertices in the volume first: moving them costs no fidelity to the surface.
std::vector<std::uint32_t> VertexMoves::movable(std::uint32_t t) const {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t v : mesh_.mesh.tet(t)) {
    if (!mesh_.fixed(v)) result.push_back(v);
  }
  std::sort(result.begin(), result.end(), [&](std::uint32_t v, std::uint32_t w) {
    return std::pair(mesh_.on_surface(v), v) < std::pair(mesh_.on_surface(w), w);
  });
  return result;
}

bool VertexMoves::allowed(std::uint32_t v, const Vec3& p) const {
  if (!is_finite(p) || p == mesh_.position(v)) return false;
  if (mesh_.moves_far(v)) return true;
  const double surface_unit = surface_unit_[v];
  if (surface_unit == 0) return false;
  const Vec3& home = mesh_.home(v);
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = (std::fabs(p[i] - home[i]) + mesh_.nearest().home_error(v)) / surface_unit;
    sum += d * d;
  }
  return sum <= kSurfaceUlps * kSurfaceUlps;
}

// Neighbouring doubles in each coordinate, then steps of the unit of the vertex's largest
// coordinate; if `wide`, instead of these, steps of the unit of its facets' largest coordinate
// (and, for vertices that may move far, some multiples of it).
void VertexMoves::near_candidates(std::uint32_t v, bool wide) {
  candidates_.clear();
  const Vec3 p = mesh_.position(v);
  const auto add = [&](const Vec3& unit, int reach) {
    for (const auto& s : steps_) {
      if (std::abs(s[0]) > reach || std::abs(s[1]) > reach || std::abs(s[2]) > reach) continue;
      const Vec3 q = mesh_.nearest().frame.written(
          {p[0] + s[0] * unit[0], p[1] + s[1] * unit[1], p[2] + s[2] * unit[2]});
      if (allowed(v, q)) candidates_.push_back(q);
    }
  };
  const Vec3 given = mesh_.nearest().frame.given(p);
  const double own = unit_in_last_place(largest_component(given));
  if (!wide) {
    add({unit_in_last_place(given[0]), unit_in_last_place(given[1]), unit_in_last_place(given[2])},
        1);
    add({own, own, own}, 2);
    return;
  }
  const double surface_unit = surface_unit_[v];
  if (surface_unit != own) add({surface_unit, surface_unit, surface_unit}, 2);
  if (!mesh_.moves_far(v) || surface_unit == 0) return;
  for (double unit = 4 * surface_unit; unit <= 64 * surface_unit; unit *= 4) {
    add({unit, unit, unit}, 2);
  }
}

// Points from here to the middle of the star's kernel: as near as possible, then better and better.
void VertexMoves::far_candidates(std::uint32_t v) {
  candidates_.clear();
  if (!mesh_.moves_far(v) || !mesh_.is_enclosed(v)) return;
  const StarFrame frame = make_frame(mesh_, v);
  const Vec3 target = deepest_point(frame);
  for (int k = 40; k >= 0; k -= 2) {
    Vec3 x = target;
    for (double& c : x) c = std::ldexp(c, -k);
    const Vec3 p = mesh_.nearest().frame.written(frame.to_mesh(x));
    if (allowed(v, p)) candidates_.push_back(p);
  }
}

void VertexMoves::find_candidates(VertexId v, Stage stage) {
  stage == Stage::far ? far_candidates(v) : near_candidates(v, stage == Stage::wide);
}

// What the bad tetrahedra around v weigh, or else their badness; and what it is more with v
// elsewhere. Places where other vertices are have no value.
struct VertexMoves::Judge {
  using Value = std::int64_t;

  Judge(VertexMoves& of, VertexId vertex, bool by_weight)
      : moves(of), v(vertex), weigh(by_weight), star(of.mesh_.star(vertex)) {
    std::stable_partition(star.begin(), star.end(),
                          [&](TetId t) { return moves.mesh_.sign(t) <= 0; });
    for (const TetId t : star) now += cost(t, moves.mesh_.sign(t));
  }
  Value cost(TetId t, int sign) const {
    if (!weigh) return badness(sign);
    return sign <= 0 ? moves.weight(t) : 0;
  }
  bool value_at(const Vec3& p, Value best, Value& value) const {
    value = -now;
    for (const TetId t : star) {
      value += cost(t, moves.mesh_.sign_at(t, v, p));
      if (value >= best) return false;
    }
    return !moves.mesh_.occupied(p);
  }
  bool is_enough(Value value) const { return value <= -now; }
  static bool ends_with_failure() { return false; }

  VertexMoves& moves;
  VertexId v;
  bool weigh;
  std::vector<TetId> star;  // bad ones first
  Value now = 0;
};

// Remembers the best candidate, if it is better. Does it leave nothing bad?
bool VertexMoves::find(Stage stage, const Judge& judge, Move& best) {
  find_candidates(judge.v, stage);
  const Vec3* p = MoveVertex::find(candidates_, judge, best.value);
  if (p != nullptr) std::tie(best.vertex, best.position) = std::tie(judge.v, *p);
  return p != nullptr && judge.is_enough(best.value);
}

bool VertexMoves::carry_out(const Move& move) {
  if (move.vertex == kNone) return false;
  positions_ += fingerprint(move.vertex, move.position) -
                fingerprint(move.vertex, mesh_.position(move.vertex));
  mesh_.move(move.vertex, move.position);
  mesh_.note_move(move.vertex);
  return true;
}

bool VertexMoves::fix(TetId t) {
  return improve(t, {Stage::near, Stage::wide}) || improve(t, {Stage::far});
}

// The first move that leaves nothing bad around the vertex, or the one that helps most.
bool VertexMoves::improve(TetId t, std::initializer_list<Stage> stages) {
  Move best;
  for (const Stage stage : stages) {
    for (const VertexId v : movable(t)) {
      if (find(stage, Judge(*this, v, false), best)) return carry_out(best);
    }
  }
  return carry_out(best);
}

bool VertexMoves::separate(VertexId v) {
  if (mesh_.fixed(v)) return false;
  const Judge judge(*this, v, false);
  for (const Stage stage : kStages) {
    find_candidates(v, stage);
    const auto harmless = std::ranges::find_if(candidates_, [&](const Vec3& p) {
      Badness value = 0;
      return judge.value_at(p, 1, value);
    });
    if (harmless != candidates_.end()) return carry_out({0, v, *harmless});
  }
  return false;
}

// Moves made so far by a chain, to be undone if it fails. No vertex moves twice.
struct VertexMoves::Chain {
  std::vector<std::pair<std::uint32_t, Vec3>> earlier;
  int budget = kChainBudget;
};

void VertexMoves::undo(Chain& chain, std::size_t mark) {
  while (chain.earlier.size() > mark) {
    mesh_.move(chain.earlier.back().first, chain.earlier.back().second);
    chain.earlier.pop_back();
  }
}

// Moves a vertex of t so that t and all that was good around it are good in the end, moving other
// vertices for the latter.
bool VertexMoves::free_by_chain(Chain& chain, std::uint32_t t, int depth) {
  for (const std::uint32_t v : movable(t)) {
    const auto moved = [&](const auto& m) { return m.first == v; };
    if (std::any_of(chain.earlier.begin(), chain.earlier.end(), moved)) continue;
    const Vec3 here = mesh_.position(v);
    for (const bool wide : {false, true}) {
      near_candidates(v, wide);
      const std::vector<Vec3> candidates = candidates_;
      for (const Vec3& p : candidates) {
        if (--chain.budget < 0) return false;
        if (mesh_.sign_at(t, v, p) <= 0) continue;
        const Judge judge(*this, v, false);
        Badness value = 0;
        if (!judge.value_at(p, depth == 0 ? 0 : 2 * kOneBad, value)) continue;
        std::vector<std::uint32_t> broken;
        for (const TetId u : judge.star) {
          if (mesh_.sign(u) > 0 && mesh_.sign_at(u, v, p) <= 0) broken.push_back(u);
        }
        if (depth == 0 && !broken.empty()) continue;
        const std::size_t mark = chain.earlier.size();
        chain.earlier.push_back({v, here});
        mesh_.move(v, p);
        const auto mend = [&](std::uint32_t u) {
          return mesh_.sign(u) > 0 || free_by_chain(chain, u, depth - 1);
        };
        if (std::all_of(broken.begin(), broken.end(), mend) && mesh_.sign(t) > 0) return true;
        undo(chain, mark);
      }
    }
  }
  return false;
}

bool VertexMoves::fix_by_chain(std::uint32_t t) {
  // Badness of everything: chains reach far, and there are few bad tetrahedra left by now.
  const auto total = [&] {
    Badness sum = 0;
    for (const std::uint32_t b : mesh_.bad()) sum += badness(mesh_.sign(b));
    return sum;
  };
  const Badness before = total();
  Chain chain;
  if (chains_budget_ < 0) return false;
  const bool freed = free_by_chain(chain, t, kChainDepth);
  chains_budget_ -= kChainBudget - chain.budget;
  if (freed && total() < before) {
    for (const auto& [v, earlier] : chain.earlier) mesh_.note_move(v);
    return true;
  }
  undo(chain, 0);
  return false;
}

std::int64_t VertexMoves::weight(std::uint32_t t) const {
  const auto at = weight_.find(t);
  return at == weight_.end() ? 1 : at->second;
}

bool VertexMoves::lighten(TetId t) {
  Move best;
  for (const VertexId v : movable(t)) {
    const Judge judge(*this, v, true);
    for (const Stage stage : kStages) find(stage, judge, best);
  }
  return carry_out(best);
}

// The breakout method of constraint satisfaction (Morris, AAAI 1993): a tetrahedron that stays bad,
// although nothing around it can be moved without harm, becomes heavier, until it pays to exchange
// it for another bad one. Where it goes round between the same few places it will not.
bool VertexMoves::untangle(Control& control) {
  weight_.clear();
  const std::uint64_t last = mesh_.signs() + kUntangleBudget;
  std::unordered_map<std::uint64_t, int> returns;
  while (mesh_.signs() < last && returns[positions_]++ <= kMostReturns) {
    std::vector<std::uint32_t> work(mesh_.bad().begin(), mesh_.bad().end());
    std::erase_if(work, [&](std::uint32_t t) { return movable(t).empty(); });
    if (work.empty()) break;
    for (const std::uint32_t t : work) {
      control.poll();
      if (mesh_.sign(t) <= 0 && !lighten(t)) weight_[t] = weight(t) + 1;
    }
  }
  return mesh_.bad().empty();
}

}  // namespace delmesher::output
