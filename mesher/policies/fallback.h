// Policy: stricter chamfering where the refinement would not end.
#pragma once

#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/delmesher.h"
#include "mesher/results/recorder.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// Corners below these angles are chamfered, as the options say.
chamfer::ChamferOptions chamfer_options(const Options& options);

// Section 4 proves that the refinement ends with empty diametral balls and chamfers up to 90
// degrees. By default it has neither, and ends all the same almost always. Where it does not, it
// begins anew: with empty balls, then with chamfers up to 90 degrees around the place where it ran
// away, at last with them everywhere. Deterministic: the guard looks at lengths, never at time.
class Fallback {
 public:
  // The first kLocalSteps times, only corners near the place are tightened: the nearest one that is
  // not tight yet, and those up to some edges away from it. That is one edge at first, and one more
  // after every kSameReach times.
  static constexpr int kLocalSteps = 32, kSameReach = 8;

  explicit Fallback(const Options& options);

  const chamfer::ChamferOptions& chamfering() const { return chamfering_; }
  bool gabriel() const { return gabriel_; }
  InForce in_force(double tau) const;
  // An edge shorter than this means that corners make each other split for ever. 0: there is no
  // guard, because the refinement ends with the thresholds in force, or for --as-paper no-guard.
  double runaway_length(const Session& session, double tau);
  // The next step, after a refinement that ran away near `place`.
  void tighten(const Vec3& place, const Session& session);

 private:
  bool everywhere() const {
    return chamfering_.cosine_squared == 0 && chamfering_.corner_cosine_squared == 0;
  }

  const Options& options_;
  chamfer::ChamferOptions chamfering_;
  bool gabriel_;
  int local_steps_ = 0;
  std::uint64_t stops_ = 0;
  double feature_length_ = -1;  // smallest local feature size, if tau is 0; below 0: not known yet
};

}  // namespace delmesher::policies
