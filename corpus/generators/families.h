// The families of polyhedra. Each drives one kind of near-degeneracy towards zero.
#pragma once

#include <string>
#include <vector>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

struct FamilyMember {
  Random random;
  // Exponents of small quantities are drawn between 1 and this. It is lowered when candidates turn
  // out to be invalid because they were too close to degeneracy.
  int bits = 50;
  // Surfaces that may serve as a start, for the families that change other models.
  const std::vector<delmesher::Surface>* models = nullptr;
};

struct Family {
  const char* name;
  const char* description;
  // Makes a candidate. The certificate says whether it is valid.
  delmesher::Surface (*make)(FamilyMember&);
};

// Angles towards zero: wedges, needles, fans, cones, high valence, notches; and solids that have no
// tetrahedrization without Steiner points (Schoenhardt, Chazelle).
std::vector<Family> sharp_families();
// Distances towards zero: plates, gaps, cavities, spirals, parts one ulp apart, nudged grids.
std::vector<Family> close_families();
// Ties: points on common spheres and cylinders, booleans on common planes; large and small numbers.
std::vector<Family> tied_families();
// Other surfaces, changed: moved, coarse, scaled, damaged, edited; rotated and noisy ones.
std::vector<Family> derived_families();

// All of them, with members small enough for quick tests.
const std::vector<Family>& families();
// Zeros of functions on grids, as images and implicit models give them: a thousand to a million
// triangles. Only by name.
const std::vector<Family>& sampled_families();
// Of both.
const Family* find_family(const std::string& name);

}  // namespace tetproof
