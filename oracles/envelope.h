// Meshes whose surface is one of their own, near the input: what meshers with an envelope promise.
//
// Laws: the mesh, judged by the other oracles against its own boundary, passes all of them (so it
// is a complex of positive tetrahedra that fill a valid surface); no point of that surface is
// farther from the input than the envelope, nor a point of the input from it; the volumes differ by
// at most what surfaces so near to each other can enclose; and what is farther from both surfaces
// than the envelope is on the same side of both, in every part of space that is thicker than the
// report says. So no crust around the input passes for the solid. With a promised tolerance also
// what tolerance.h says.
#pragma once

#include <optional>
#include <string>

#include "oracles/files/mesh_file.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verify.h"

namespace tetproof::oracles {

// Fraction of the diagonal: of smaller ones the time has no bound that is worth having.
inline constexpr double kLeastEnvelope = 1e-7;

// An upper bound of the distance from any point of `from` to `to`, in doubles, in input units.
// Exact but for `precision`, or for a tenth of `enough` if that is larger: distances so small are
// not told apart. Neither may be empty, and not both bounds 0. `place` gets a point of `from` that
// is about so far away, if any is farther than a tenth of `enough`.
double farthest(const Polyhedron& from, const Polyhedron& to, double precision, double enough,
                Position* place = nullptr);

// Coordinates in units of 2^exponent, in those given; and in words.
Position in_units(const Position& p, int exponent);
std::string place_name(const Position& given);

// Turns the shells that are inside out: parity decides what is inside. Empty on success, else why
// the surface bounds no solid.
std::string turn_outwards(Polyhedron& surface);

// The faces of one tetrahedron, seen from outside, with the vertices that they use. Their labels,
// if the file lists all of them with one.
Polyhedron boundary_of(const MeshFile& mesh);

// Is nothing wrong with a mesh but that its surface is another one?
bool only_surface_differs(const VerifyReport& report);

// How near it is, and an envelope that such a mesh is in, as a fraction of the diagonal of one
// digit. None if that is above 1.
struct NearSurface {
  double farthest;  // in input units
  char envelope[32];
};
std::optional<NearSurface> nearness(const Polyhedron& input, const MeshFile& mesh);

// Empty on success, else why the input bounds no solid. `share` is the envelope, as a fraction of
// the input's diagonal; the report's deviation is the larger one of the two distances.
std::string verify_envelope(const Polyhedron& input, const MeshFile& mesh, double share,
                            const VerifyOptions& options, VerifyReport& report);

}  // namespace tetproof::oracles
