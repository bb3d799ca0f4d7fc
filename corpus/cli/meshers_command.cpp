#include <fmt/core.h>

#include <string_view>

#include "corpus/campaigns/process.h"
#include "corpus/cli/commands.h"
#include "corpus/peers/peers.h"

namespace tetproof {

MesherPrograms programs_here() {
  MesherPrograms programs;
  programs.supervisor = beside_this_program("tetproof-supervise");
  programs.adapters = programs.supervisor.parent_path();
  programs.delmesher = beside_this_program("delmesher");
  return programs;
}

int meshers_command(const MeshersArguments& arguments) {
  const MesherPrograms programs = programs_here();
  for (const Peer& peer : peers()) {
    const std::string missing = why_not_at_hand(peer.name, programs);
    if (arguments.at_hand) {
      const bool plane = peer.region == std::string_view("plane");
      if (missing.empty() && !plane) fmt::print("{}\n", peer.name);
      continue;
    }
    if (!missing.empty()) {
      fmt::print("{:<18} {:<9} not at hand: {}\n", peer.name, peer.licence, missing);
      continue;
    }
    const Mesher mesher = make_mesher(peer.name, programs);
    fmt::print("{:<18} {:<9} {:<14} {}, {}\n", peer.name, peer.licence, mesher.promise(),
               mesher.version, mesher.flags);
  }
  return 0;
}

}  // namespace tetproof
