// Angles of tetrahedra: the certified bound on face angles, and histograms.
#pragma once

#include <array>
#include <functional>

#include "oracles/input_surface.h"
#include "oracles/tet_complex.h"

namespace tetproof::oracles {

// Which tetrahedra promise the angle bound.
enum class AngleScope : std::uint8_t {
  solid,  // those whose interior meets the solid (region interior)
  all
};

// Angle oracle: every face angle of those tetrahedra is at least `delta` degrees, certified by
// comparing squared cosines in integers; the bound itself is taken 1e-9 (relative, on the squared
// cosine) to the safe side of libm. The report holds the histograms of these tetrahedra.
OracleReport check_angles(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, double delta, AngleScope scope);

// No gate: extremes, means and histograms (15 degrees a bin, decided exactly) of the face angles,
// each face once, and dihedral angles of the tetrahedra with selected[t].
void measure_angles(const TetComplex& complex, const Neighbours& neighbours,
                    const std::vector<std::uint8_t>& selected, OracleReport& report);

// The angle in degrees with this sine and cosine, up to a positive factor that may depend on both
// (the sine is given squared), correct to a few roundings.
double exact_angle(const ExactNumber& sine_squared, const ExactNumber& cosine);

// 0 ... 11: which 15 degrees the angle with cos^2 = dot^2 / norms lies in, and the sign of dot;
// 180 degrees counts for the last. Exact.
int angle_bin(const ExactNumber& dot, const ExactNumber& norms);

}  // namespace tetproof::oracles
