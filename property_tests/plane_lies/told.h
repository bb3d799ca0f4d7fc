// Lies about a run in the plane: the false account, and the oracle that should see through it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane/verify.h"
#include "property_tests/lie.h"

namespace tetproof::plane_lies {

// A run as it is told, and the options that were asked for.
struct Told {
  delmesher::PlanarGraph graph;
  oracles::PlaneFile file;
  delmesher::PlaneRecord record;
  PlaneVerifyOptions how;
};

// A square with a sharp dent and a slender hole: chamfers. Two lines inside with a channel of 1 :
// 2000 between them: one is dropped. Holes decide the inside, not parity.
delmesher::PlanarGraph honest_graph();

delmesher::PlaneOptions honest_options();

Told run_of(const delmesher::PlaneOptions& options,
            const delmesher::PlanarGraph& graph = honest_graph());

// The one run that most lies are about.
const Told& honest();

// With the smallest vertex first.
std::array<std::uint32_t, 3> turned(std::array<std::uint32_t, 3> t);

// The first triangle of that side.
delmesher::PlaneRecord::Triangle& some(std::vector<delmesher::PlaneRecord::Triangle>& triangles,
                                       delmesher::PlaneRecord::Side side);

// The first written vertex that is not of the input.
std::size_t steiner(const Told& told);

using Lie = LieAbout<Told>;

// Relaxed promises; sections emptied, cut short, out of date; records and files of other runs; mesh
// and record changed together, so that both agree.
std::span<const Lie> relaxed();
std::span<const Lie> sections();
std::span<const Lie> foreign();
std::span<const Lie> consistent();

}  // namespace tetproof::plane_lies
