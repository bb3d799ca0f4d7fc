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
  static constexpr int kSameReach = 8;

  explicit Fallback(const Options& options);

  const chamfer::ChamferOptions& chamfering() const { return chamfering_; }
  bool gabriel() const { return gabriel_; }
  InForce in_force(double tau) const;
  // An edge shorter than this means that corners make each other split for ever. 0: there is no
  // guard, because the refinement ends with the thresholds in force, or for --as-paper no-guard.
  double runaway_length(const Session& session, double tau);
  void empty_balls() { gabriel_ = true; }
  // With --acute 90 only the threshold of two edges can be stricter; it has one value for all
  // corners, also in records.
  bool can_tighten_nearby() const { return chamfering_.cosine_squared > 0; }
  // After a refinement that ran away near `place`: tightens the nearest corner that is not tight
  // yet, and those up to some edges away from it. That is one edge at first, and one more after
  // every kSameReach times, because each time costs a refinement up to the place.
  void tighten_nearby(const Vec3& place, const Session& session);
  bool is_tight_everywhere() const {
    return chamfering_.cosine_squared == 0 && chamfering_.corner_cosine_squared == 0;
  }
  void tighten_everywhere();

 private:
  const Options& options_;
  chamfer::ChamferOptions chamfering_;
  bool gabriel_;
  int times_nearby_ = 0;
  double feature_length_ = -1;  // smallest local feature size, if tau is 0; below 0: not known yet
};

}  // namespace delmesher::policies
