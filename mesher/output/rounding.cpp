#include "mesher/output/rounding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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
  Repair(RoundedMesh& mesh, Control& control, RoundingResult& result)
      : mesh_(mesh), control_(control), result_(result), moves_(mesh), operations_(mesh) {}

  void run(Strategy strategy) {
    if (strategy == Strategy::descend) descend(kEfforts);
    if (strategy == Strategy::descend_and_untangle) descend(kExactEfforts);
    if (strategy != Strategy::descend) untangle();
    for (const auto& group : mesh_.nearest().coincident(mesh_.positions())) separate(group);
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
      if (!mesh_.mesh.alive(t) || mesh_.sign(t) > 0) continue;
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

// Upper bound of the distance of a vertex at p from its exact position. The sum of two roundings up
// of three components each, so a few units in the last place of slack suffice.
double deviation(const NearestMesh& nearest, VertexId v, const Vec3& p) {
  Vec3 d;
  for (int i = 0; i < 3; ++i) d[i] = std::fabs(p[i] - nearest.home[v][i]) + nearest.home_error(v);
  const double largest = std::max({d[0], d[1], d[2]});
  if (largest == 0) return 0;
  double sum = 0;
  for (const double c : d) sum += (c / largest) * (c / largest);
  return largest * std::sqrt(sum) * (1 + 0x1p-48);
}

// Of the mesh as it is after repairs; null: there were none.
void export_mesh(const NearestMesh& nearest, const RoundedMesh* repaired, RoundingResult& result) {
  TetMesh& written = result.mesh;
  const std::size_t slots = repaired != nullptr ? repaired->mesh.slots() : nearest.sign.size();
  std::vector<VertexId> index(nearest.home.size(), kNone);
  written.tetrahedra.reserve(slots);
  written.inside.reserve(slots);
  const bool several =
      std::ranges::any_of(nearest.mesh.region, [](RegionId r) { return r > kInside; });
  result.repeated_faces =
      repaired != nullptr ? std::vector<std::uint8_t>{} : nearest.mesh.repeated_faces;
  const auto take = [&](const Tet& t, RegionId region, int sign) {
    written.tetrahedra.push_back(t);
    written.inside.push_back(region != kOutside ? 1 : 0);
    if (several) written.regions.push_back(static_cast<std::int32_t>(region));
    if (sign <= 0) ++(sign < 0 ? result.inverted : result.flat);
    for (const VertexId v : t) index[v] = 0;
  };
  for (TetId t = 0; t < slots; ++t) {
    if (repaired == nullptr) {
      take(nearest.mesh.tetrahedra[t], nearest.mesh.region[t], nearest.sign[t]);
    } else if (repaired->mesh.alive(t)) {
      take(repaired->mesh.tet(t), repaired->mesh.region(t), repaired->sign(t));
      result.repeated_faces.push_back(
          repeated_within(Region::hull, repaired->mesh.repeated_faces(t)));
    }
  }
  const std::span<const Vec3> position = repaired != nullptr ? repaired->positions() : nearest.home;
  for (VertexId v = 0; v < index.size(); ++v) {
    if (index[v] == kNone) continue;
    index[v] = static_cast<VertexId>(result.vertices.size());
    result.vertices.push_back(v);
    written.vertices.push_back(position[v]);
    if (nearest.on_surface(v)) {
      result.max_surface_deviation =
          std::max(result.max_surface_deviation, deviation(nearest, v, position[v]));
    }
  }
  for (Tet& t : written.tetrahedra) {
    for (VertexId& v : t) v = index[v];
  }
  for (const auto& [vertices, facet] : nearest.mesh.boundary) {
    const auto& [a, b, c] = vertices;
    written.boundary.push_back({index[a], index[b], index[c]});
    written.boundary_facets.push_back(facet);
  }
  for (const auto& group : nearest.coincident(position)) result.coincident += group.size() - 1;
}

RoundingResult round_once(const NearestMesh& nearest, Strategy strategy, Control& control,
                          std::size_t most) {
  RoundingResult result;
  std::optional<RoundedMesh> mesh;
  for (TetId t = 0; nearest.bad != 0 && t < nearest.sign.size(); ++t) {
    if (nearest.sign[t] > 0) continue;
    const Tet& v = nearest.mesh.tetrahedra[t];
    result.disturbed.insert(result.disturbed.end(), v.begin(), v.end());
  }
  result.tried = nearest.bad <= most;
  if (result.tried && (nearest.bad != 0 || !nearest.coincident(nearest.home).empty())) {
    mesh.emplace(nearest);
    Repair(*mesh, control, result).run(strategy);
    result.signs = mesh->signs();
  }
  export_mesh(nearest, mesh ? &*mesh : nullptr, result);
  result.repaired = nearest.bad - result.inverted - result.flat;
  return result;
}

// The same order for every run: the state is the only source of it.
void shuffle_tetrahedra(NearestMesh& nearest, std::uint32_t& state) {
  ConformingMesh& mesh = nearest.mesh;
  for (std::size_t n = mesh.tetrahedra.size(); n > 1; --n) {
    state = state * 1664525U + 1013904223U;
    const std::size_t m = (std::uint64_t{state} * n) >> 32U;
    std::swap(mesh.tetrahedra[n - 1], mesh.tetrahedra[m]);
    std::swap(mesh.region[n - 1], mesh.region[m]);
    std::swap(nearest.sign[n - 1], nearest.sign[m]);
  }
}

// The best of several attempts. Which repairs are possible depends on those done before: where one
// order of the tetrahedra ends in a dead end, another may not.
struct Repairing {
  NearestMesh nearest;
  Control& control;
  const RepairLimits& limits;
  RoundingResult best;
  std::uint64_t signs = nearest.sign.size();  // in all attempts
  std::uint32_t order = 1;
  bool first_strategy = true;

  RoundingResult round(Strategy strategy) {
    RoundingResult result = round_once(nearest, strategy, control, limits.most);
    signs += result.signs;
    return result;
  }
  bool good_enough() const { return defects(best) == kNoDefects; }
  bool few_defects() const {
    return limits.thorough > 0 && best.tried && defects(best).first <= limits.thorough;
  }

  void descend_in_another_order() {
    shuffle_tetrahedra(nearest, order);
    RoundingResult other = round(Strategy::descend);
    if (defects(other).first < defects(best).first) best = std::move(other);
  }
  // Each order with both strategies.
  void untangle() {
    RoundingResult other =
        round(first_strategy ? Strategy::descend_and_untangle : Strategy::untangle_first);
    if (defects(other) < defects(best)) best = std::move(other);
    if (!first_strategy) shuffle_tetrahedra(nearest, order);
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
  Repairing attempt{NearestMesh(std::move(input), control), control, limits, {}};
  attempt.best = attempt.round(Strategy::descend);
  RungCounts taken;
  climb(attempt, kRepairs, taken);
  attempt.best.signs = attempt.signs;
  attempt.best.ladder = taken;
  return std::move(attempt.best);
}

}  // namespace delmesher::output
