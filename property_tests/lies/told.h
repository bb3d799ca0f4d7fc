// Lies about a run: the false account, and the oracle that should see through it.
#pragma once

#include <span>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/lie.h"
#include "property_tests/samples.h"

namespace tetproof::lies {

// A run as it is told, and the options that were asked for.
struct Told {
  samples::Sample sample;
  delmesher::ExactRecord record;
  oracles::Promise promise;
  unsigned version = oracles::kRecordVersion;
};

// The filter takes the slab apart, the wedge is chamfered.
delmesher::Options honest_options();

Told run_of(const delmesher::Options& options, oracles::Task task = oracles::Task::mesh,
            const delmesher::Surface& surface = samples::wedge_and_slab());

// The one run that most lies are about.
const Told& honest();

// A wedge so flat that the filter leaves nothing to refine.
delmesher::Surface flat_wedge();

// The first facet that the filter has kept.
std::size_t kept_facet(const delmesher::ExactRecord& r);

// A blade whose sides meet at an angle of 0.14 degrees: the gap that their chamfers leave is so
// long that the second step of the filter drops one of them.
void dagger(Told& told);

// A run of the hull, told as it was.
void run_hull(Told& told, oracles::Task task = oracles::Task::mesh);

// A run of --approximate, told as it was.
void run_approximate(Told& told, const delmesher::Surface& surface = samples::wedge_and_slab());

// A run far away, where it is meshed beside the origin that the record names; told as it was.
void run_far_away(Told& told);

// The constrained Delaunay tetrahedrization of the hull, told as it was.
void run_cdt(Told& told);

using Lie = LieAbout<Told>;

// Relaxed promises; sections emptied, cut short, out of date; records and files of other runs; mesh
// and record changed together, so that both agree; local operations.
std::span<const Lie> relaxed();
std::span<const Lie> sections();
std::span<const Lie> foreign();
std::span<const Lie> consistent();
std::span<const Lie> improved();
std::span<const Lie> kept();

}  // namespace tetproof::lies
