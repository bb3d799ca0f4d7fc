// Each folder of the mesher is a namespace of its own and sees the names of those that it may
// include (ci/checks/tree.py), as if they were its own. The public namespace, delmesher, holds what
// delmesher.h and its companions declare, and nothing else.
#pragma once

namespace delmesher {

namespace base {}
namespace arithmetic {
using namespace base;  // NOLINT(google-build-using-namespace): the layers, stated once
}
namespace predicates {
using namespace base;        // NOLINT(google-build-using-namespace)
using namespace arithmetic;  // NOLINT(google-build-using-namespace)
}  // namespace predicates
namespace geometry {
using namespace predicates;  // NOLINT(google-build-using-namespace): and the folders that it sees
}
namespace surface {
using namespace geometry;  // NOLINT(google-build-using-namespace)
}
namespace delaunay {
using namespace geometry;  // NOLINT(google-build-using-namespace)
}
namespace tetmesh {
using namespace surface;   // NOLINT(google-build-using-namespace)
using namespace delaunay;  // NOLINT(google-build-using-namespace)
}  // namespace tetmesh

// The folders that all stages share.
namespace foundation {
using namespace surface;   // NOLINT(google-build-using-namespace)
using namespace delaunay;  // NOLINT(google-build-using-namespace)
using namespace tetmesh;   // NOLINT(google-build-using-namespace)
}  // namespace foundation

namespace chamfer {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace refine {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace cdt {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace improve {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace output {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace plane {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace remesh {
using namespace surface;  // NOLINT(google-build-using-namespace)
}
namespace enrich {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace run {
using namespace foundation;  // NOLINT(google-build-using-namespace)
}
namespace planar {
using namespace foundation;  // NOLINT(google-build-using-namespace)
using namespace run;         // NOLINT(google-build-using-namespace)
}  // namespace planar
namespace results {
using namespace foundation;  // NOLINT(google-build-using-namespace)
using namespace run;         // NOLINT(google-build-using-namespace)
using namespace planar;      // NOLINT(google-build-using-namespace)
}  // namespace results
namespace policies {
using namespace foundation;  // NOLINT(google-build-using-namespace)
using namespace run;         // NOLINT(google-build-using-namespace)
using namespace planar;      // NOLINT(google-build-using-namespace)
using namespace results;     // NOLINT(google-build-using-namespace)
}  // namespace policies
namespace io {
using namespace geometry;  // NOLINT(google-build-using-namespace)
}
namespace cli {
using namespace surface;  // NOLINT(google-build-using-namespace)
}

}  // namespace delmesher
