// How finely the coordinates of a surface are written.
#pragma once

#include "mesher/delmesher/surface.h"

namespace delmesher::planar {

// How far a corner of a plane may be off it because the coordinates were rounded to a format: half
// a unit in the last place on every axis. Decimal numbers have a last place if some are not
// integers. It is the same for all; numbers of six digits or more may also have been printed with
// so many digits, and then it is that of the largest number on the axis. So it is for numbers that
// all are of single precision, which may have been decimals before: the coarser counts. If one that
// is decimal explains more than `most`, it was meant (corners at 0 and 0.1), and precision alone
// counts, with the same limit. In the units of the surface. 0: nothing is known to be coarser than
// doubles.
double rounding_of_coordinates(const Surface& surface, double most);

}  // namespace delmesher::planar
