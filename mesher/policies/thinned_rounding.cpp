#include "mesher/policies/thinned_rounding.h"

#include <algorithm>
#include <optional>

#include "mesher/policies/plain.h"
#include "mesher/policies/thinning.h"

namespace delmesher::policies {

void round_and_record(cdt::CdtResult cdt, Session& session, Recorder& recorder) {
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
  const auto to_write = [&] { return conforming_mesh(cdt, session); };
  MeshToWrite exact = to_write();
  const std::size_t most =
      std::min(kMostRepairs, std::max(kSmall, exact.rounding.tetrahedra.size() / kShare));
  output::RoundingResult rounded =
      output::round_mesh(std::move(exact.rounding), control, {kFew, most});
  std::uint64_t thinned = 0, signs = rounded.signs;
  for (int rings = 0; rings <= kMostRings && defects(rounded) != output::kNoDefects; ++rings) {
    const std::size_t gone =
        thin_out(rounded.disturbed, rings, session.input_vertices(), session.frame, session.points,
                 session.predicates, control, cdt);
    thinned += gone;
    const bool last = rings == kMostRings;
    const bool all_tried = thinned == 0 && defects(rounded).first <= kFew;
    if (gone == 0 && (!last || all_tried)) continue;
    MeshToWrite thinner = to_write();
    const output::RepairLimits limits =
        last ? output::RepairLimits{} : output::RepairLimits{0, most};
    output::RoundingResult other = output::round_mesh(std::move(thinner.rounding), control, limits);
    signs += other.signs;
    if (!(defects(other) < defects(rounded))) continue;
    rounded = std::move(other);
    exact = std::move(thinner);
    recorder.thinned(cdt, thinned);
  }
  // As a last resort without any added point: in a solid of a few roundings there may be no place
  // for them.
  std::optional<cdt::CdtResult> plain;
  if (defects(rounded).first > 0) plain = plain_without_points(session);
  if (plain) {
    const std::size_t before = rounded.vertices.size();
    cdt = std::move(*plain);
    MeshToWrite bare = to_write();
    output::RoundingResult other = output::round_mesh(std::move(bare.rounding), control);
    signs += other.signs;
    if (defects(other) < defects(rounded)) {
      rounded = std::move(other);
      exact = std::move(bare);
      recorder.thinned(cdt, thinned + before - std::min(before, rounded.vertices.size()));
    }
  }
  rounded.signs = signs;
  control.poll_now(rounded.vertices.size(), 1);  // small meshes are hardly asked before
  recorder.written(exact, std::move(rounded));
}

}  // namespace delmesher::policies
