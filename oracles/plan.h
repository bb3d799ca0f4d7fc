// The steps of a verification: which oracles are asked about what, in which order, and what each
// step needs in memory.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "oracles/mesh/angles.h"
#include "oracles/mesh/split_walls.h"
#include "oracles/shared_data.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {

// What is verified, where its numbers are ordinary: as given, or copies of it (verify.cpp).
struct Subject {
  const Polyhedron& input;
  const MeshFile& mesh;
  const delmesher::ExactRecord* exact;  // or none
  const VerifyOptions& options;
  SharedData& shared;
  Memory& memory;
  double largest_given = 0;  // coordinate of the input, if it is larger than those here
  // Where walls are split, `mesh` has one vertex at each place.
  const MeshFile* split = nullptr;
  const MergedMesh* merged = nullptr;
};

// One step, with a report of its own.
class Step {
 public:
  explicit Step(const Subject& subject)
      : input_(subject.input),
        mesh_(subject.mesh),
        exact_(subject.exact),
        options_(subject.options),
        shared_(subject.shared),
        memory_(subject.memory),
        largest_given_(subject.largest_given) {}
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  virtual ~Step() = default;

  // Why the input bounds no solid, or an empty text.
  virtual std::string run() = 0;
  // Appends this step's report; the last step that knows the diagonal of the input tells it.
  void move_to(VerifyReport& report, double& diagonal);

 protected:
  // The unit in the last place of the largest coordinate as given.
  double ulp_of(const InputSurface& surface) const;
  double delta() const;
  AngleScope scope() const;
  void add(OracleReport oracle, const std::string& prefix = {});

  const Polyhedron& input_;
  const MeshFile& mesh_;
  const delmesher::ExactRecord* exact_;
  const VerifyOptions& options_;
  SharedData& shared_;
  Memory& memory_;
  VerifyReport report_;
  double ulp_ = 0, diagonal_ = 0;
  double largest_given_;
};

using Start = std::unique_ptr<Step> (*)(const Subject&);
std::unique_ptr<Step> check_file(const Subject& subject);              // file_checks.cpp
std::unique_ptr<Step> check_input(const Subject& subject);             // file_checks.cpp
std::unique_ptr<Step> check_regions(const Subject& subject);           // regions_checks.cpp
std::unique_ptr<Step> check_sidecar(const Subject& subject);           // record_checks.cpp
std::unique_ptr<Step> check_final(const Subject& subject);             // record_checks.cpp
std::unique_ptr<Step> check_refined_complex(const Subject& subject);   // refined_checks.cpp
std::unique_ptr<Step> check_refined_angles(const Subject& subject);    // refined_checks.cpp
std::unique_ptr<Step> check_refined_inside(const Subject& subject);    // refined_checks.cpp
std::unique_ptr<Step> check_refined_promises(const Subject& subject);  // refined_checks.cpp

struct PlannedStep {
  Start start;
  bool (*wanted)(const delmesher::ExactRecord* exact, const VerifyOptions& options);
  int reported;    // its place in the report
  unsigned needs;  // bulks that it reads until it ends
  unsigned frees;  // bulks that it reads, and is done with before it takes most of its memory
};

// The steps of this verification, in the order in which they begin.
std::vector<PlannedStep> plan(const delmesher::ExactRecord* exact, const VerifyOptions& options);

}  // namespace tetproof::oracles
