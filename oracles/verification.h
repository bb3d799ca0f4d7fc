// The parts of a verification: which oracles are asked about a mesh, and with which arguments.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "oracles/mesh/angles.h"
#include "oracles/mesh/measures.h"
#include "oracles/verify.h"
#include "oracles/verify_shared.h"

namespace tetproof::oracles {

// One part of a verification, with a report of its own. Each check returns why the input bounds no
// solid, or an empty text.
class Verification {
 public:
  using Check = std::string (Verification::*)();
  struct Part {
    Check check;
    // Parts begin in this order, so that what the first ones need is given up before others need
    // much; they are reported in the order of the list.
    int turn;
    std::vector<Bulk> needs;  // up to its end
    std::vector<Bulk> tells;  // needs, and tells itself when it is done with them
  };
  using FaceOnFacet = std::array<std::uint32_t, 4>;  // of the record

  Verification(const Polyhedron& input, const MeshFile& mesh, const delmesher::ExactRecord* exact,
               const VerifyOptions& options, SharedData& shared)
      : input_(input), mesh_(mesh), exact_(exact), options_(options), shared_(shared) {}

  // The parts of a verification, in the order of their reports.
  static std::vector<Part> parts(const delmesher::ExactRecord* exact, Stage stage);
  // Appends this part's report; the last part that knows them tells the measures of the input.
  void move_to(VerifyReport& report, double& ulp, double& diagonal);

 private:
  // The mesh as written, on its doubles (verify_file.cpp).
  bool check_finite();
  bool check_empty();
  std::string check_file();
  Chains recorded_chains(const InputSurface& surface);
  std::vector<Index> recorded_facets() const;
  ConformityResult conformity_of_file(const TetComplex& complex, const Neighbours& neighbours,
                                      const InputSurface& surface,
                                      std::optional<InputSurface>& united);
  void check_file_surface(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& input);
  void check_file_hull(const TetComplex& complex, const Neighbours& neighbours);
  void check_file_quality(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, const ConformityResult& conformity);
  void turn_all(TetComplex& complex) const;
  BeforeWriting before_writing();

  std::string check_input();

  // The record, and its final mesh (verify_record.cpp).
  std::string check_sidecar();
  OracleReport check_written();
  OracleReport check_facet_list(const InputSurface& surface) const;
  std::string check_exact_final();
  void check_names();
  void check_exact_hull(const TetComplex& complex, const Neighbours& neighbours);
  void check_final_complex(const ExactPoints& points, const InputSurface& surface);
  OracleReport check_facet_ids(const TetComplex& complex, const ConformityResult& conformity,
                               const InputSurface& surface,
                               const std::vector<FaceOnFacet>& listed) const;
  std::vector<Index> returned_vertices() const;
  void check_constrained(const TetComplex& complex, const Neighbours& neighbours,
                         const InputSurface& surface);
  void check_unrepaired();

  // The refined mesh of the record (verify_refined.cpp).
  std::string check_refined_complex();
  std::string check_refined_angles();
  std::string check_refined_inside();
  std::string check_refined_promises();
  void check_promises(const RefinedMesh& mesh);
  OracleReport check_contained(const TetComplex& complex, const Places& places) const;
  template <class Measure>
  void check_edges(const TetComplex& complex, const std::string& option, double most,
                   const std::string& figure, const Measure& measure, OracleReport& report) const;
  OracleReport check_edges(const TetComplex& complex) const;
  OracleReport check_sizes(const TetComplex& complex) const;

  // The unit in the last place of the largest coordinate as given.
  double ulp_of(const InputSurface& surface) const;
  double delta() const;
  AngleScope scope() const;
  void add(OracleReport oracle, const std::string& prefix = {}) {
    oracle.name = prefix + oracle.name;
    if (options_.progress) {
      const std::lock_guard<std::mutex> lock(shared_.progress);
      options_.progress(oracle);
    }
    report_.oracles.push_back(std::move(oracle));
  }

  const Polyhedron& input_;
  const MeshFile& mesh_;
  const delmesher::ExactRecord* exact_;
  const VerifyOptions& options_;
  SharedData& shared_;
  VerifyReport report_;
  double ulp_ = 0, diagonal_ = 0;
  double slack_ = 0;  // how far the surface of the file may be from where it belongs
};

}  // namespace tetproof::oracles
