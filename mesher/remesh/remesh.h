// Another surface within a distance: fewer and rounder triangles.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/surface.h"
#include "mesher/geometry/local_frame.h"
#include "mesher/geometry/size_field.h"

namespace delmesher::remesh {

struct RemeshGoals {
  // No point of either surface is farther from the other, nor a point of a line from the lines of
  // the other. A length, or minus a fraction of the diagonal of the bounding box, as in Options.
  double tolerance = 0;
  // Edges that bend by more degrees, however their vertices move by half of the tolerance, are
  // lines, as are borders of labels and edges of other than two triangles. Where lines end, meet,
  // or bend by as much, vertices stay.
  double feature = 40;
  double max_edge = 0;   // 0: no bound
  SizeField sizes = {};  // no longer edges; may be empty
};
// Of the options of a job.
template <class Options>
RemeshGoals goals_of(const Options& options) {
  return {options.tolerance, options.feature, options.max_edge,
          SizeField(options.size_field, options.size_growth)};
}

struct Remeshed {
  Status status;  // of check_validity, or the limit that ended it
  std::vector<std::string> warnings;
  Surface surface;
  double diagonal = 0;   // of the bounding box of the surface as given
  double tolerance = 0;  // the length
};

// The result is valid as well, turned outwards, with the same topology, and everything is on the
// same side of it as before but for what its motion passes over, which is within the tolerance.
// Edges are no longer than asked for where splitting them is possible. Of new vertices
// `frame.given()` is exact.
Remeshed remesh(const Surface& surface, const RemeshGoals& goals, const LocalFrame& frame,
                Control& control);

}  // namespace delmesher::remesh
