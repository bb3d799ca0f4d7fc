#include "mesher/policies/thinned_rounding.h"

#include <algorithm>
#include <optional>

#include "mesher/base/climb.h"
#include "mesher/output/thinning.h"
#include "mesher/policies/plain.h"
#include "mesher/results/rounding_input.h"

namespace delmesher::policies {
namespace {

// Repairing takes milliseconds for each tetrahedron, and where so many are not positive, they are
// of features below roundings: taking points out there leaves few to repair.
constexpr std::size_t kMostRepairs = 1000;
// So they are where more than this share of a mesh is not positive, unless the mesh is small.
constexpr std::size_t kShare = 8, kSmall = 100;
// Other repairs, which take seconds, get rid of what the first ones leave where that is at most
// this much, and of little more than half of what is beyond (measured on degenerate solids).
constexpr std::size_t kFew = 8;
constexpr int kMostRings = 3;

// The final mesh, and what came of it when it was rounded: the best so far.
struct Rounding {
  ConformingMesh mesh;
  Session& session;
  Recorder& recorder;
  std::size_t most = 0;
  output::RoundingResult best{};
  std::uint64_t thinned = 0, signs = 0;
  int rings = 0;

  bool good_enough() const { return defects(best) == output::kNoDefects; }

  output::RoundingInput input(const ConformingMesh& from) const {
    return rounding_input(part_within(session.options.region, from), session);
  }
  output::RoundingResult round(output::RoundingInput from, const output::RepairLimits& limits) {
    output::RoundingResult result = output::round_mesh(std::move(from), session.control, limits);
    signs += result.signs;
    recorder.ladder() += result.ladder;
    return result;
  }

  void begin() {
    output::RoundingInput exact = input(mesh);
    most = std::min(kMostRepairs, std::max(kSmall, exact.mesh.tetrahedra.size() / kShare));
    best = round(std::move(exact), {kFew, most});
  }

  // Takes `other` instead if fewer of its tetrahedra are not positive when rounded.
  void try_instead(const ConformingMesh& other, std::uint64_t points_gone,
                   const output::RepairLimits& limits) {
    output::RoundingResult result = round(input(other), limits);
    if (!(defects(result) < defects(best))) return;
    best = std::move(result);
    recorder.thinned(other, points_gone);
  }

  void thin_out_next_ring() {
    const std::size_t gone =
        output::thin_out(best.disturbed, rings, session.input_vertices(), session.frame,
                         session.points, session.predicates, session.control, mesh);
    thinned += gone;
    const bool last = rings == kMostRings;
    ++rings;
    const bool all_tried = thinned == 0 && defects(best).first <= kFew;
    if (gone == 0 && (!last || all_tried)) return;
    try_instead(mesh, thinned,
                last ? output::RepairLimits{.thorough = kFew}
                     : output::RepairLimits{.thorough = 0, .most = most});
  }

  // In a solid of a few roundings there may be no place for any added point.
  void try_input_alone() {
    const std::optional<cdt::CdtResult> plain = plain_without_points(session);
    if (!plain) return;
    const std::size_t before = best.vertices.size();
    try_instead(plain->mesh, thinned + before - std::min(before, session.input_vertices()), {});
  }
};

constexpr Step<Rounding> kRounding[] = {
    {Rung::thin_out, [](const Rounding&) { return true; },
     [](Rounding& r) { r.thin_out_next_ring(); }},
    {Rung::input_alone,
     [](const Rounding& r) { return defects(r.best).first > 0 && may_be_plain(r.session); },
     [](Rounding& r) { r.try_input_alone(); }},
};

}  // namespace

void round_and_record(ConformingMesh mesh, Session& session, Recorder& recorder) {
  Rounding rounding{std::move(mesh), session, recorder};
  rounding.begin();
  climb(rounding, kRounding, recorder.ladder());
  rounding.best.signs = rounding.signs;
  // Small meshes are hardly asked before.
  session.control.poll_now(rounding.best.vertices.size(), 1);
  recorder.written(std::move(rounding.best));
}

}  // namespace delmesher::policies
