// The meshers of others that campaigns know by name: how each is called, what it promises, and
// under which licence it is. Each is called with the defaults that its own documentation
// recommends, on the doubles of our reader, on one thread.
#pragma once

#include <span>

namespace tetproof {

struct Peer {
  const char* name;  // for -m
  // A program beside tetproof with the contract of corpus/peers/programs/adapter.h; or a script
  // adapters/NAME there: NAME INPUT OUTPUT [SWITCH...]; or, for a peer that is a Python package, a
  // script adapters/wheels/NAME with the contract of adapters/wheels/contract.py.
  const char* adapter;
  const char* switches;
  const char* extension;  // of the mesh
  const char* region;     // "interior", "hull", or "plane": its models are planar graphs
  // What it promises of the surface, as fractions of the diagonal. At most one is not 0: without
  // any, the boundary tiles the input exactly as written; with a deviation it tiles it with
  // vertices that may be off by so much; with an envelope it is any surface that is nowhere farther
  // from the input, nor the input from it.
  double deviation, envelope;
  const char* licence;
  const char* from;  // where one gets it
  // For a script: the program that it runs, which an environment variable may replace, and the
  // option that prints its version ("" if there is none).
  const char* program = nullptr;
  const char* variable = nullptr;
  const char* version_option = nullptr;
  // The Python package of the peer, for which `program` is the interpreter; nullptr: it is none.
  const char* package = nullptr;
  // What the build of Gmsh has to have, by its own account (-info); nullptr: nothing in particular.
  const char* feature = nullptr;
};

std::span<const Peer> peers();

// Nothing if no peer has the name.
const Peer* peer_of(const char* name);

}  // namespace tetproof
