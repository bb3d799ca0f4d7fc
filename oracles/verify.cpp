#include "oracles/verify.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "oracles/base/parallel.h"
#include "oracles/base/vectors.h"
#include "oracles/envelope.h"
#include "oracles/plan.h"
#include "oracles/record/ordinary_units.h"
#include "oracles/record/record_origin.h"
#include "oracles/surface/angle_labels.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// The part that is checked although more was promised.
std::string scope_of(const VerifyOptions& options, bool recorded) {
  if (options.promised.task != Task::mesh) return {};
  if (!recorded) return options.promised.of_record.empty() ? "" : "the mesh as written";
  if (options.stage == Stage::final) return "the final mesh";
  const bool more = options.stage == Stage::refined && !options.promised.approximate;
  return more ? "the refined mesh" : "";
}

// What is verified: as given, or copies of it where its numbers are ordinary.
struct Frame {
  const Polyhedron* input;
  const MeshFile* mesh;
  const ExactRecord* exact;
  VerifyOptions options;
  Expendable expendable;
  double largest_given = 0;  // coordinate of the input, if it has been moved
  std::optional<BesideOrigin> moved = {};
  std::optional<MergedMesh> merged = {};
  std::optional<InOrdinaryUnits> scaled = {};
  bool text_skipped = false;  // of the record, as it is in the units given
};

// False if the record cannot be moved: then there is nothing to ask.
bool move_beside_origin(Frame& frame, VerifyReport& report) {
  frame.moved = {*frame.input, *frame.mesh, *frame.exact, frame.options.promised};
  report.oracles.push_back(move_to_origin(*frame.moved));
  if (frame.options.progress) frame.options.progress(report.oracles.back());
  frame.input = &frame.moved->input;
  frame.mesh = &frame.moved->mesh;
  frame.exact = &frame.moved->record;
  frame.options.promised = frame.moved->promise;
  frame.expendable = {&frame.moved->mesh, &frame.moved->record};
  frame.largest_given = frame.moved->largest;
  return report.oracles.back().passed();
}

void merge_walls(Frame& frame) {
  const Promise& promise = frame.options.promised;
  if (!promise.all_regions || promise.split_walls == Promise::Split::none) return;
  if (!std::ranges::all_of(frame.mesh->vertices, is_finite)) return;  // reported later
  frame.merged = merge_places(*frame.input, *frame.mesh);
  frame.mesh = &frame.merged->mesh;
  frame.expendable = {&frame.merged->mesh, nullptr};
}

void put_in_ordinary_units(Frame& frame) {
  frame.scaled = in_ordinary_units(*frame.input, *frame.mesh, frame.exact, frame.options.promised);
  if (!frame.scaled) return;
  InOrdinaryUnits& scaled = *frame.scaled;
  frame.input = &scaled.input;
  frame.mesh = &scaled.mesh;
  frame.exact = scaled.record ? &*scaled.record : nullptr;
  frame.options.promised = scaled.promise;
  frame.expendable = {&scaled.mesh, scaled.record ? &*scaled.record : nullptr};
  frame.largest_given = std::ldexp(frame.largest_given, -scaled.exponent);
  frame.text_skipped = frame.exact != nullptr && !frame.options.sidecar.empty();
  frame.options.sidecar.clear();
}

// How far facets may be from planar, as a fraction of the diagonal: the least of what the record
// and the file say. The promise caps it (Promise::most_planar).
std::optional<double> stated_planar(const Frame& frame) {
  std::optional<double> stated;
  if (frame.mesh->planar_within > 0) stated = frame.mesh->planar_within;
  if (frame.exact == nullptr) return stated;
  const double diagonal = diagonal_of(*frame.input);
  const double recorded = diagonal > 0 ? 2 * frame.exact->parameters.planar / diagonal : 0;
  if (!(recorded > 0)) return 0;  // nor if it is not a number
  return std::min(recorded, stated.value_or(recorded));
}

// What the record says and no oracle can decide, where it gives less than was asked for.
void name_what_is_trusted(const Frame& frame, bool may_keep, VerifyReport& report) {
  const Promise& promise = frame.options.promised;
  if (may_keep && promise.keep) {
    report.unproven.emplace_back("that bounded angles were too heavy (the surface is kept)");
  }
  if (promise.task == Task::mesh && promise.delta > promise.guaranteed_delta()) {
    char text[100];
    std::snprintf(text, sizeof text, "--delta above %.6g degrees", promise.guaranteed_delta());
    report.unproven.emplace_back(text);
  }
}

// In doubles: how long edges may be need not be exact.
void allow_sizes(const Polyhedron& input, const MeshFile& mesh, Promise& promise) {
  const auto are_there = [](const auto& corners, const std::vector<Position>& vertices) {
    return std::ranges::all_of(corners, [&](Index v) { return v < vertices.size(); });
  };
  const auto normal_of = [](const auto& corners, const std::vector<Position>& vertices) {
    const Position& a = vertices[corners[0]];
    return cross(minus(vertices[corners[1]], a), minus(vertices[corners[2]], a));
  };
  double volume = 0, area = 0;
  std::vector<double> edges;
  for (const Tet& tet : mesh.tetrahedra) {
    if (!are_there(tet, mesh.vertices)) continue;  // reported later
    for (std::size_t i = 0; i < 4 && promise.budget > 0; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        edges.push_back(distance(mesh.vertices[tet[i]], mesh.vertices[tet[j]]));
      }
    }
    const Position height = minus(mesh.vertices[tet[3]], mesh.vertices[tet[0]]);
    volume += std::fabs(dot(normal_of(tet, mesh.vertices), height)) / 6;
  }
  for (const Face& face : input.triangles) {
    if (!are_there(face, input.vertices)) continue;
    area += distance(normal_of(face, input.vertices), {}) / 2;
  }
  std::erase_if(edges, [](double length) { return !std::isfinite(length); });
  constexpr double kCommon = 0.95;
  const auto common = static_cast<std::ptrdiff_t>(kCommon * static_cast<double>(edges.size()));
  std::nth_element(edges.begin(), edges.begin() + common, edges.end());
  promise.allow_sizes(diagonal_of(input), volume, area,
                      edges.empty() ? 0 : edges[static_cast<std::size_t>(common)]);
}

// Every deviation; other figures of lengths stay.
void put_in_given_units(const Frame& frame, VerifyReport& report) {
  if (!frame.scaled) return;
  const int exponent = frame.scaled->exponent;
  report.deviation = std::ldexp(report.deviation, exponent);
  report.slab = std::ldexp(report.slab, exponent);
  for (OracleReport& oracle : report.oracles) {
    oracle.notes.push_back("lengths are in units of 2^" + std::to_string(exponent));
    if (frame.text_skipped && oracle.name.ends_with("second-kernel")) {
      oracle.notes.push_back("the text of the points was not read a second time");
    }
  }
}

// Nothing where a corner does not exist, or is not finite.
template <std::size_t N>
std::optional<Position> middle(const std::vector<Position>& vertices,
                               const std::array<Index, N>& corners, std::size_t count = N) {
  Position sum = {};
  for (std::size_t k = 0; k < count; ++k) {
    if (corners[k] >= vertices.size()) return std::nullopt;
    for (std::size_t d = 0; d < 3; ++d) {
      sum[d] += vertices[corners[k]][d] / static_cast<double>(count);
    }
  }
  return is_finite(sum) ? std::optional(sum) : std::nullopt;
}
template <std::size_t N>
std::optional<Position> middle_of(const std::vector<Position>& vertices,
                                  const std::vector<std::array<Index, N>>& elements, Index number) {
  return number < elements.size() ? middle(vertices, elements[number]) : std::nullopt;
}

std::optional<Position> middle_of(const Site& site, const Polyhedron& input, const MeshFile& mesh) {
  switch (site.kind) {
    case Site::Kind::tetrahedron:
      return middle_of(mesh.vertices, mesh.tetrahedra, site.numbers[0]);
    case Site::Kind::listed_triangle:
      return middle_of(mesh.vertices, mesh.boundary, site.numbers[0]);
    case Site::Kind::input_triangle:
      return middle_of(input.vertices, input.triangles, site.numbers[0]);
    default:
      return middle(site.kind < Site::Kind::input_vertex ? mesh.vertices : input.vertices,
                    site.numbers, kSiteKinds[static_cast<std::size_t>(site.kind)].numbers);
  }
}

}  // namespace

void locate(const Polyhedron& input, const MeshFile& mesh, VerifyReport& report) {
  for (OracleReport& oracle : report.oracles) {
    for (Spot& spot : oracle.spots) {
      if (spot.site && !spot.at) spot.at = middle_of(*spot.site, input, mesh);
    }
  }
}

// Frames the task, runs the steps of the plan, and concludes.
std::string verify(const Polyhedron& input, const MeshFile& mesh, const ExactRecord* exact,
                   const VerifyOptions& options, VerifyReport& report,
                   const Expendable& expendable) {
  Frame frame{&input, &mesh, exact, options, expendable};
  std::optional<Polyhedron> labelled, with_points;
  if (const double degrees = options.promised.label_by_angle; degrees > 0) {
    labelled = input;
    if (std::string why = label_by_angle(*labelled, degrees); !why.empty()) return why;
    frame.input = &*labelled;
  }
  if (const double tolerance = options.promised.tolerance; tolerance != 0) {
    const double share = tolerance < 0 ? -tolerance : tolerance / diagonal_of(input);
    return verify_envelope(*frame.input, mesh, share, options, report);
  }
  if (const std::vector<Position>& points = options.promised.points; !points.empty()) {
    with_points = *frame.input;
    with_points->vertices.insert(with_points->vertices.end(), points.begin(), points.end());
    frame.input = &*with_points;
  }
  Promise& promised = frame.options.promised;
  const bool may_keep = promised.may_keep;
  allow_sizes(*frame.input, mesh, promised);
  if (exact != nullptr) promised.settle(*exact);
  if (promised.keep && frame.options.stage == Stage::both) {
    frame.options.stage = Stage::final;
  }
  report = {};
  if (exact != nullptr && names_origin(*exact) && !move_beside_origin(frame, report)) {
    conclude(0, report);
    return {};
  }
  merge_walls(frame);
  put_in_ordinary_units(frame);
  frame.options.promised.stated_planar = stated_planar(frame);
  report.planar_share = frame.options.promised.planar_share();

  std::unique_ptr<SharedData> shared;
  Memory memory(frame.expendable, [&shared] { shared->forget_refined(); });
  shared = std::make_unique<SharedData>(*frame.input, frame.exact, frame.options.promised, memory);
  const Subject subject{*frame.input,
                        *frame.mesh,
                        frame.exact,
                        frame.options,
                        *shared,
                        memory,
                        frame.largest_given,
                        frame.merged ? &mesh : nullptr,
                        frame.merged ? &*frame.merged : nullptr};
  const std::vector<PlannedStep> planned = plan(frame.exact, frame.options);
  std::vector<std::unique_ptr<Step>> steps;
  for (const PlannedStep& step : planned) {
    steps.push_back(step.start(subject));
    memory.need(step.needs);
    memory.need(step.frees);
  }
  std::vector<std::string> why(planned.size());
  std::atomic<bool> no_solid = false;
  run_tasks(options.threads, planned.size(), [&](std::size_t n) {
    if (no_solid) return;
    why[n] = steps[n]->run();
    if (!why[n].empty()) no_solid = true;
    memory.done_with(planned[n].needs);
  });

  std::vector<std::size_t> order(planned.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t n) { return planned[n].reported; });
  for (const std::size_t n : order) {
    if (!why[n].empty()) return why[n];
  }
  double diagonal = 0;
  for (const std::size_t n : order) steps[n]->move_to(report, diagonal);
  report.scope = scope_of(frame.options, exact != nullptr);
  if (exact == nullptr) {
    std::ranges::copy(options.promised.of_record, std::back_inserter(report.unproven));
  } else {
    name_what_is_trusted(frame, may_keep, report);
  }
  if (options.promised.names) report.unproven.emplace_back(kOtherNames);
#ifndef TETPROOF_SECOND_OPINIONS
  report.unproven.emplace_back(kInputNotAsked);
#endif
  if (frame.merged) {  // their numbers are those of one vertex at each place
    for (OracleReport& oracle : report.oracles) oracle.forget_sites();
  }
  conclude(diagonal, report);
  put_in_given_units(frame, report);
  return {};
}

}  // namespace tetproof::oracles
