// The properties that the fuzz targets (and tests) check, one each. A property returns an empty
// text if it holds, else the finding (fuzz/entry.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fuzz/entry.h"
#include "mesher/delmesher.h"

namespace tetproof::fuzz {

// Every predicate on any mix of points agrees with rational arithmetic.
Finding predicates_agree(Bytes bytes);
// The same with meeting points of planes, and segments and triangles between them.
Finding predicates_on_planes_agree(Bytes bytes);

// A reader rejects in one line or delivers a surface that can be written and read back unchanged.
// `name` gives the format by its extension; of 3MF the text is the model, or the whole archive.
Finding reader_holds(const std::string& text, const std::string& name);

// The same of a reader of meshes of tetrahedra; a mesh that is read is improved or refused. The
// files of TetGen's are parts of one text, separated by form feeds: .node, .ele, .face.
Finding mesh_reader_holds(const std::string& text, const std::string& name);

// Our check of a surface and CGAL's agree on its validity; defects are named.
Finding check_agrees(const delmesher::Surface& surface);

// Facets are those of the oracles; the smallest local feature size is that of all pairs.
Finding features_agree(const delmesher::Surface& surface);

// The tetrahedrization of points passes its own validation and is Delaunay and complete for CGAL.
Finding delaunay_agrees(Bytes bytes);

// Segments and facets are recovered among random points: the stage's own validation, which takes a
// hundredth of the oracles' time, finds nothing.
Finding recovery_holds(const delmesher::Surface& surface);

// The plain constrained tetrahedrization passes the oracles.
Finding cdt_holds(const delmesher::Surface& surface);

// With the surface kept, and edges inside of some size, the mesh passes the oracles; every triangle
// is one face, unless vertices were left on it, which are counted.
Finding keep_holds(const delmesher::Surface& surface);

// Improving the tetrahedrization of a surface and random points leaves positive tetrahedra that fit
// together, all vertices of the surface, and no worse angles than its laws allow.
Finding improvement_holds(const delmesher::Surface& surface);

// No acute angle is left by chamfering, and chamfer distances obey their bound.
Finding chamfer_holds(const delmesher::Surface& surface);

// The kept facets are not closer than the tolerance, and none is dropped if all features are
// farther apart.
Finding filter_holds(const delmesher::Surface& surface);

// The refined mesh is Delaunay, keeps the angle bound, and ends.
Finding refinement_holds(const delmesher::Surface& surface);

// Meshes within a tolerance pass the oracles.
Finding tolerance_holds(const delmesher::Surface& surface);

// The whole pipeline passes all oracles, exactly and as written.
Finding pipeline_holds(const delmesher::Surface& surface);

// The same with the default options: the surface is meshed and passes all oracles.
Finding default_pipeline_holds(const delmesher::Surface& surface);

// Meshing takes no more work per triangle of the input and tetrahedron of the result than other
// surfaces do, by counters.
Finding complexity_holds(const delmesher::Surface& surface);

// Verifying a damaged mesh takes no more steps per element than verifying others.
Finding verification_cost_holds(Bytes bytes);

// A planar graph is rejected exactly if it is invalid; else its mesh passes the oracles.
Finding plane_holds(Bytes bytes);

// A reader of planar graphs rejects in one line or delivers a consistent graph. `name` gives the
// format by its extension.
Finding plane_reader_holds(const std::string& text, const std::string& name);

// Calls of the library, in any order and several at once, answer what each of them answers.
Finding sequences_hold(Bytes bytes);

// Every format reads back the mesh that was written.
Finding writers_hold(Bytes bytes);

// The command line ends with a documented code and says one line.
Finding command_line_holds(const std::string& text);

}  // namespace tetproof::fuzz
