// Puts a new point into the volume where nothing else helps: a cavity around a bad tetrahedron
// grows across the faces that the point would see badly, and is filled from the point (Klingner and
// Shewchuk 2007, "Aggressive tetrahedral mesh improvement").
#pragma once

#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class Insertion {
 public:
  explicit Insertion(State& state) : state_(state) {}

  // Replaces t and tetrahedra around it by the star of a new point, if the worst of that is clearly
  // better than the worst of these.
  bool run(TetId t);

 private:
  struct Face {
    TetId tet;  // in the cavity
    int face;
    Quality quality;  // of its tetrahedron with the new point
  };

  bool try_from(TetId t, Vec3 x);
  Vec3 middle(TetId t) const;
  double shortest_edge(TetId t) const;
  void grow(const Vec3& x);
  void add(TetId t, const Vec3& x);
  void measure(const Vec3& x);
  std::vector<Face>::const_iterator worst() const;
  void settle(Vec3& x);

  State& state_;
  std::vector<TetId> cavity_;
  std::vector<Face> faces_;  // of its skin
  std::vector<CreatedTet> created_;
};

}  // namespace delmesher::improve
