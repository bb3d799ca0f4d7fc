#include "mesher/policies/thinned_rounding.h"

#include "mesher/policies/thinning.h"

namespace delmesher::policies {

void round_and_record(cdt::CdtResult cdt, Session& session, Recorder& recorder) {
  constexpr int kMostRings = 3;
  Control& control = session.control;
  const auto to_write = [&] {
    return conforming_mesh(cdt, session.topology, session.points, session.given,
                           session.options.region);
  };
  MeshToWrite exact = to_write();
  output::RoundingResult rounded = output::round_mesh(std::move(exact.rounding), control);
  std::uint64_t thinned = 0;
  for (int rings = 0; rings <= kMostRings && defects(rounded) != output::kNoDefects; ++rings) {
    const std::size_t gone = thin_out(rounded.disturbed, rings, session.input_vertices(),
                                      session.points, session.predicates, control, cdt);
    thinned += gone;
    if (gone == 0) continue;
    MeshToWrite thinner = to_write();
    output::RoundingResult other =
        output::round_mesh(std::move(thinner.rounding), control, rings == kMostRings);
    if (!(defects(other) < defects(rounded))) continue;
    rounded = std::move(other);
    exact = std::move(thinner);
    recorder.thinned(cdt, thinned);
  }
  recorder.written(exact, std::move(rounded));
}

}  // namespace delmesher::policies
