// Policy: stricter chamfering where the refinement would not end.
#pragma once

#include "mesher/chamfer/chamfer.h"
#include "mesher/delmesher.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Corners below these angles are chamfered, as the options say.
chamfer::ChamferOptions chamfer_options(const Options& options);

// Section 4 proves that the refinement ends with empty diametral balls and chamfers up to 90
// degrees. By default it has neither, and ends all the same almost always. Where it does not, it
// begins anew with both. Deterministic: the guard looks at lengths, never at time.
class Fallback {
 public:
  explicit Fallback(const Options& options);

  const chamfer::ChamferOptions& chamfering() const { return chamfering_; }
  bool gabriel() const { return gabriel_; }
  InForce in_force(double tau) const;
  // An edge shorter than this means that corners make each other split for ever. 0: there is no
  // guard, because the refinement ends with the thresholds in force, or for --as-paper no-guard.
  double runaway_length(const Session& session, double tau) const;
  void tighten();

 private:
  bool is_tight() const {
    return chamfering_.cosine_squared == 0 && chamfering_.corner_cosine_squared == 0;
  }

  const Options& options_;
  chamfer::ChamferOptions chamfering_;
  bool gabriel_;
};

}  // namespace delmesher::policies
