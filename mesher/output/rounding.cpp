#include "mesher/output/rounding.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mesher/base/climb.h"
#include "mesher/output/local_operations.h"
#include "mesher/output/rounded_mesh.h"
#include "mesher/output/vertex_moves.h"

namespace delmesher::output {
namespace {

// How to get rid of tetrahedra that are not positive. Descending takes only changes that leave
// fewer of them; untangling also moves vertices where that makes others in their stead.
enum class Strategy { descend, descend_and_untangle, untangle_first };

// Repairs from mild to drastic; after each success, the mild ones get another chance.
class Repair {
 public:
  Repair(RoundedMesh& mesh, const PointStore& points, Control& control, RoundingResult& result)
      : mesh_(mesh), control_(control), result_(result), moves_(mesh), operations_(mesh, points) {}

  void run(Strategy strategy) {
    if (strategy == Strategy::descend) descend(kEfforts);
    if (strategy == Strategy::descend_and_untangle) descend(kExactEfforts);
    if (strategy != Strategy::descend) untangle();
    for (const auto& group : mesh_.coincident()) separate(group);
  }

 private:
  static constexpr int kEfforts = 4;
  static constexpr int kExactEfforts = 3;  // these keep all signs on exact coordinates
  static constexpr int kUntanglings = 2;

  void descend(int efforts) {
    for (int effort = 0; effort < efforts;) effort = pass(effort) ? 0 : effort + 1;
  }

  // Flips may help where moves alone do not, and the other way round.
  void untangle() {
    std::size_t fewest = mesh_.bad().size() + 1;
    for (int i = 0; i < kUntanglings && mesh_.bad().size() < fewest; ++i) {
      fewest = mesh_.bad().size();
      if (!moves_.untangle(control_)) descend(kExactEfforts);
    }
  }

  // Every tetrahedron bad at the beginning gets one attempt, unless it failed before and nothing
  // has changed around it. Badness decreases with each success, so passes end.
  bool pass(int effort) {
    const std::vector<std::uint32_t> work(mesh_.bad().begin(), mesh_.bad().end());
    bool success = false;
    for (const std::uint32_t t : work) {
      if (!mesh_.alive(t) || mesh_.sign(t) > 0) continue;
      const auto failed = failed_at_.find({t, effort});
      if (failed != failed_at_.end() && failed->second >= mesh_.last_change(t)) continue;
      effort < 2 ? control_.poll() : control_.poll_now(0, -1);
      if (attempt(t, effort)) {
        success = true;
      } else {
        failed_at_[{t, effort}] = mesh_.clock();
      }
    }
    return success;
  }

  bool attempt(std::uint32_t t, int effort) {
    switch (effort) {
      case 0:
        return moves_.fix(t);
      case 1:
        return count(operations_.fix(t, true), result_.operations);
      case 2:
        return moves_.fix_by_chain(t);
      default:
        return count(operations_.fix(t, false), result_.operations) &&
               count(true, result_.inexact_operations);
    }
  }

  static bool count(bool success, std::uint64_t& counter) {
    counter += success ? 1 : 0;
    return success;
  }

  // All but one vertex of a group must go; vertices of the volume go first.
  void separate(const std::vector<std::uint32_t>& group) {
    std::vector<std::uint32_t> order = group;
    std::stable_partition(order.begin(), order.end(),
                          [&](std::uint32_t v) { return !mesh_.on_surface(v); });
    std::size_t left = order.size();
    for (const std::uint32_t v : order) {
      if (left > 1 && moves_.separate(v)) --left;
    }
  }

  RoundedMesh& mesh_;
  Control& control_;
  RoundingResult& result_;
  VertexMoves moves_;
  LocalOperations operations_;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> failed_at_;
};

// Upper bound of the distance of a vertex from its exact position. The sum of two roundings up of
// three components each, so a few units in the last place of slack suffice.
double deviation(const RoundedMesh& mesh, std::uint32_t v) {
  const Vec3 p = mesh.position(v), home = mesh.home(v);
  Vec3 d;
  for (int i = 0; i < 3; ++i) d[i] = std::fabs(p[i] - home[i]) + mesh.home_error(v);
  const double largest = std::max({d[0], d[1], d[2]});
  if (largest == 0) return 0;
  double sum = 0;
  for (const double c : d) sum += (c / largest) * (c / largest);
  return largest * std::sqrt(sum) * (1 + 0x1p-48);
}

void export_mesh(const RoundedMesh& mesh, const RoundingInput& input, RoundingResult& result) {
  TetMesh& written = result.mesh;
  std::vector<std::uint32_t> index(mesh.vertices(), kNone);
  written.tetrahedra.reserve(mesh.slots());
  written.inside.reserve(mesh.slots());
  for (std::uint32_t t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    written.tetrahedra.push_back(mesh.tet(t));
    written.inside.push_back(mesh.region(t) != kOutside ? 1 : 0);
    for (const std::uint32_t v : mesh.tet(t)) index[v] = 0;
  }
  std::vector<std::uint32_t> of_store(input.points->size(), kNone);
  for (std::uint32_t v = 0; v < index.size(); ++v) {
    if (index[v] == kNone) continue;
    index[v] = static_cast<std::uint32_t>(result.vertices.size());
    of_store[mesh.store_id(v)] = index[v];
    result.vertices.push_back(mesh.store_id(v));
    written.vertices.push_back(mesh.position(v));
    if (mesh.on_surface(v)) {
      result.max_surface_deviation = std::max(result.max_surface_deviation, deviation(mesh, v));
    }
  }
  for (Tet& t : written.tetrahedra) {
    for (std::uint32_t& v : t) v = index[v];
  }
  for (const auto& [vertices, facet] : input.mesh.boundary) {
    const auto& [a, b, c] = vertices;
    written.boundary.push_back({of_store[a], of_store[b], of_store[c]});
    written.boundary_facets.push_back(facet);
  }
  if (result.operations == 0) result.repeated_faces = input.mesh.repeated_faces;
}

// The tetrahedra of the input are there again afterwards if there was something to repair.
RoundingResult round_once(RoundingInput& input, Strategy strategy, Control& control,
                          std::size_t most) {
  RoundedMesh mesh(input, control);
  RoundingResult result;
  const std::size_t bad_before = mesh.bad().size();
  if (bad_before != 0 || !mesh.coincident().empty()) {
    for (const std::uint32_t t : mesh.bad()) {
      for (const std::uint32_t v : mesh.tet(t)) result.disturbed.push_back(mesh.store_id(v));
    }
    for (std::uint32_t t = 0; t < mesh.slots(); ++t) {
      const auto& [a, b, c, d] = mesh.tet(t);
      input.mesh.tetrahedra.push_back(
          {mesh.store_id(a), mesh.store_id(b), mesh.store_id(c), mesh.store_id(d)});
      input.mesh.region.push_back(mesh.region(t));
    }
    result.tried = bad_before <= most;
    if (result.tried) {
      mesh.prepare_repairs();
      Repair(mesh, *input.points, control, result).run(strategy);
    }
  }
  for (const std::uint32_t t : mesh.bad()) ++(mesh.sign(t) < 0 ? result.inverted : result.flat);
  result.repaired = bad_before - mesh.bad().size();
  result.signs = mesh.signs();
  for (const auto& group : mesh.coincident()) result.coincident += group.size() - 1;
  export_mesh(mesh, input, result);
  return result;
}

// The same order for every run: the state is the only source of it.
void shuffle_tetrahedra(ConformingMesh& mesh, std::uint32_t& state) {
  mesh.repeated_faces.clear();
  for (std::size_t n = mesh.tetrahedra.size(); n > 1; --n) {
    state = state * 1664525U + 1013904223U;
    const std::size_t m = (std::uint64_t{state} * n) >> 32U;
    std::swap(mesh.tetrahedra[n - 1], mesh.tetrahedra[m]);
    std::swap(mesh.region[n - 1], mesh.region[m]);
  }
}

// The best of several attempts. Which repairs are possible depends on those done before: where one
// order of the tetrahedra ends in a dead end, another may not.
struct Repairing {
  RoundingInput& input;
  Control& control;
  const RepairLimits& limits;
  RoundingResult best;
  std::uint64_t signs = 0;  // in all attempts
  std::uint32_t order = 1;
  bool first_strategy = true;

  RoundingResult round(Strategy strategy) {
    RoundingResult result = round_once(input, strategy, control, limits.most);
    signs += result.signs;
    return result;
  }
  bool good_enough() const { return defects(best) == kNoDefects; }
  bool few_defects() const {
    return limits.thorough > 0 && best.tried && defects(best).first <= limits.thorough;
  }

  void descend_in_another_order() {
    shuffle_tetrahedra(input.mesh, order);
    RoundingResult other = round(Strategy::descend);
    if (defects(other).first < defects(best).first) best = std::move(other);
  }
  // Each order with both strategies.
  void untangle() {
    RoundingResult other =
        round(first_strategy ? Strategy::descend_and_untangle : Strategy::untangle_first);
    if (defects(other) < defects(best)) best = std::move(other);
    if (!first_strategy) shuffle_tetrahedra(input.mesh, order);
    first_strategy = !first_strategy;
  }
};

constexpr Step<Repairing> kRepairs[] = {
    {Rung::other_orders,
     [](const Repairing& a) { return a.few_defects() && defects(a.best).first > 0; },
     [](Repairing& a) { a.descend_in_another_order(); }},
    {Rung::untangle, [](const Repairing& a) { return a.few_defects(); },
     [](Repairing& a) { a.untangle(); }},
};

}  // namespace

RoundingResult round_mesh(RoundingInput input, Control& control, const RepairLimits& limits) {
  Repairing attempt{input, control, limits, {}};
  attempt.best = attempt.round(Strategy::descend);
  RungCounts taken;
  climb(attempt, kRepairs, taken);
  attempt.best.signs = attempt.signs;
  attempt.best.ladder = taken;
  return std::move(attempt.best);
}

}  // namespace delmesher::output
