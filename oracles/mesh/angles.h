// Angles of tetrahedra: the certified bound on face angles, and histograms.
#pragma once

#include <array>
#include <functional>

#include "oracles/mesh/places.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

// The tetrahedra that have to keep the angle bound.
enum class AngleScope : std::uint8_t {
  solid,  // only if their interior meets the solid (region interior)
  all
};

// Where the vertices of a file were before they were written: rounded, and those of facets that had
// been made planar put where they were given. With a record these are points of it; without one it
// is only known how far, at most, they are from where they were written.
struct BeforeWriting {
  const ExactPoints* points = nullptr;  // of the record, or none
  std::vector<Index> point;             // per vertex of the file, by its number there
  double farthest = 0;                  // without a record; in input units
};

// Angle oracle: every face angle of these tetrahedra is at least `delta` degrees, decided exactly
// by squared cosines. The bound on the squared cosine is a relative 1e-9 laxer, so that the
// rounding of libm fails no mesh. The report holds the histograms of these tetrahedra.
//
// For a file, `before` says what was promised: its tetrahedra before writing. Angles that are below
// the bound as written alone are counted, and so is how far below. Without a record these are
// undecided, if vertices so far from where they were written can explain them.
OracleReport check_angles(const TetComplex& complex, const Neighbours& neighbours,
                          const Places& places, double delta, AngleScope scope,
                          const BeforeWriting& before = {});

// Adds to the report, without any gate: extremes, means and histograms (15 degrees a bin, decided
// exactly) of the face angles, each face once, and of the dihedral angles of the tetrahedra with
// selected[t], and their shapes. Angles are in degrees.
void measure_angles(const TetComplex& complex, const Neighbours& neighbours,
                    const std::vector<std::uint8_t>& selected, OracleReport& report);

// The smallest face angle of a tetrahedron that is not flat, and the smallest of its dihedral
// angles and of the rests of these to 180 degrees; in degrees, to a relative 1e-9.
struct WorstAngles {
  double face = 180, dihedral = 180;
};
WorstAngles worst_angles(const ExactPoints& points, const Tet& tet);

// The angle in degrees, correct to a few roundings. Sine and cosine may have a common positive
// factor; the sine is given squared, and so is its factor.
double exact_angle(const ExactNumber& sine_squared, const ExactNumber& cosine);

// The bin of 15 degrees, 0 to 11, in which an angle lies, decided exactly. `dot` has the sign of
// the cosine, and dot^2 / norms is its square. 180 degrees belongs to the last bin.
int angle_bin(const ExactNumber& dot, const ExactNumber& norms);

}  // namespace tetproof::oracles
