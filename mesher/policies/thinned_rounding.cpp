#include "mesher/policies/thinned_rounding.h"

#include <algorithm>
#include <optional>

#include "mesher/output/thinning.h"
#include "mesher/policies/plain.h"
#include "mesher/results/rounding_input.h"

namespace delmesher::policies {

void round_and_record(ConformingMesh final, Session& session, Recorder& recorder) {
  constexpr int kMostRings = 3;
  // Repairing takes milliseconds for each tetrahedron, and where so many are not positive, they are
  // of features below roundings: taking points out there leaves few to repair.
  constexpr std::size_t kMostRepairs = 1000;
  // So they are where more than this share of a mesh is not positive, unless the mesh is small.
  constexpr std::size_t kShare = 8, kSmall = 100;
  // Other repairs, which take seconds, get rid of what the first ones leave where that is at most
  // this much, and of little more than half of what is beyond (measured on degenerate solids).
  constexpr std::size_t kFew = 8;
  Control& control = session.control;
  const auto input = [&](const ConformingMesh& mesh) {
    return rounding_input(part_within(session.options.region, mesh), session);
  };
  output::RoundingInput exact = input(final);
  const std::size_t most =
      std::min(kMostRepairs, std::max(kSmall, exact.mesh.tetrahedra.size() / kShare));
  output::RoundingResult rounded = output::round_mesh(std::move(exact), control, {kFew, most});
  std::uint64_t signs = rounded.signs;
  // Takes `mesh` instead if fewer of its tetrahedra are not positive when rounded.
  const auto try_instead = [&](const ConformingMesh& mesh, std::uint64_t points_gone,
                               const output::RepairLimits& limits) {
    output::RoundingResult result = output::round_mesh(input(mesh), control, limits);
    signs += result.signs;
    if (!(defects(result) < defects(rounded))) return;
    rounded = std::move(result);
    recorder.thinned(mesh, points_gone);
  };
  std::uint64_t thinned = 0;
  for (int rings = 0; rings <= kMostRings && defects(rounded) != output::kNoDefects; ++rings) {
    const std::size_t gone =
        output::thin_out(rounded.disturbed, rings, session.input_vertices(), session.frame,
                         session.points, session.predicates, control, final);
    thinned += gone;
    const bool last = rings == kMostRings;
    const bool all_tried = thinned == 0 && defects(rounded).first <= kFew;
    if (gone == 0 && (!last || all_tried)) continue;
    try_instead(final, thinned,
                last ? output::RepairLimits{.thorough = kFew}
                     : output::RepairLimits{.thorough = 0, .most = most});
  }
  // In a solid of a few roundings there may be no place for any added point.
  if (defects(rounded).first > 0) {
    if (const std::optional<cdt::CdtResult> plain = plain_without_points(session)) {
      const std::size_t before = rounded.vertices.size();
      try_instead(plain->mesh, thinned + before - std::min(before, session.input_vertices()), {});
    }
  }
  // As a last resort all repairs, however much there is to repair.
  if (defects(rounded).first > kFew) try_instead(final, thinned, {});
  rounded.signs = signs;
  control.poll_now(rounded.vertices.size(), 1);  // small meshes are hardly asked before
  recorder.written(std::move(rounded));
}

}  // namespace delmesher::policies
