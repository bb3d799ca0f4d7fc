// The meshers a campaign can run, and how each is called.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "corpus/campaigns/disposition.h"

namespace tetproof {

// The paths of the programs.
struct MesherPrograms {
  std::filesystem::path supervisor;  // tetproof-supervise
  std::filesystem::path delmesher;
  // The folder of the adapters of peers (peers.h): tetproof-tetgen, adapters/gmsh, ..., and of
  // tetproof, which scripts call.
  std::filesystem::path adapters;
};

// The files of one run, all in a folder of its own.
struct RunFiles {
  std::filesystem::path input, mesh, stats;
  std::filesystem::path again = {}, exact = {};
  std::filesystem::path chamfered = {};  // for our mesher; empty: not wanted
};

struct Mesher {
  std::string name;     // as given to -m, before any '='
  std::string version;  // of the program, with the first digits of the hash of its file
  std::string flags;    // everything of the command that is not a file of the run
  std::string region;   // what it meshes: "interior", "hull", "plane" or "" if not known
  std::string mesh_extension;
  std::string line;               // for the shell, if it is a command of the user
  double declared_deviation = 0;  // fraction of the diagonal by which it may miss the surface
  // Not 0: its boundary is any surface that is within this fraction of the diagonal of the input.
  double envelope = 0;
  std::string promised = "mesh --planar 0";  // what the oracles are told otherwise
  ExitCodes exit_codes = ExitCodes::unknown;
  std::function<std::vector<std::string>(const RunFiles&)> command;
  // Writes the mesh once more, to `again`, with the sidecar beside it; null if it knows none.
  std::function<std::vector<std::string>(const RunFiles&)> sidecar_command;

  // Are its models planar graphs, and its meshes triangles?
  bool of_plane() const { return region == "plane"; }
  // Is a surface of its own promised?
  bool own_surface() const;

  // The options of `tetproof verify` by which its meshes are held to what it promises. Our mesher
  // is held to the options that it is called with. Other meshers are not asked for planar facets:
  // their surface is the one given, but for the deviation that they declare.
  std::vector<std::string> verify_options() const;

  // In words, for tables: "exact", "planar but for rounding", "within 1e-08", "envelope 0.001",
  // "tolerance 1e-3d".
  std::string promise() const;
};

// Understands
//   delmesher delmesher-e4 safe-delmesher-e4 delmesher-nofilter delmesher-nobridges delmesher-split
//   delmesher-keep cdt plane
//   tetgen tetgen-T0 netgen gmsh-delaunay ...     the peers of peers.h
//   delmesher+NAME                     one departure of delmesher-split from the paper undone:
//   gabriel,
//                                      acute-90, planar-0, improve-off, slivers-off, hull, or a
//                                      name of --as-paper
//   NAME=delmesher:'mesh OPTIONS...'   our mesher with other options
//   cmd:'prog {in} {out.mesh}'         any program; or NAME=cmd:'...' to name it, and
//   NAME=cmd,region=hull,deviation=1e-8:'...'   to say what it meshes (interior, hull or plane) and
//                                               by how much it may miss;
//   NAME=cmd,envelope=1e-3:'...'                if its boundary is a surface of its own, so near
// \throw std::runtime_error for an unknown name or a program that is missing.
Mesher make_mesher(const std::string& name, const MesherPrograms& programs);

// The names above, for help texts, without delmesher+NAME.
std::vector<std::string> mesher_names();

// Empty if the peer can be run here, else what is missing.
std::string why_not_at_hand(const std::string& peer, const MesherPrograms& programs);

// The default, every delmesher+NAME, and the paper's preset.
std::vector<std::string> ablation_names();

}  // namespace tetproof
