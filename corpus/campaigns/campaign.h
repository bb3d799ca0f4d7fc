// Runs meshers on models: one supervised child per pair, results in the database as they come.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "corpus/campaigns/progress.h"
#include "corpus/campaigns/runnable.h"
#include "corpus/models/models.h"
#include "corpus/peers/meshers.h"
#include "reports/results.h"

namespace tetproof {

struct CampaignOptions {
  std::filesystem::path supervisor;  // tetproof-supervise
  std::filesystem::path self;        // tetproof, whose `measure` looks at the meshes
  std::filesystem::path database;
  std::filesystem::path keep;         // folder for the meshes; empty: they are not kept
  std::uint64_t keep_tetrahedra = 0;  // keep none with more than this; 0: no bound
  std::set<Disposition> retry;        // rows that ended so are run again
  Limits limits;
  // Limits of the children that look at a mesh. They must not hang or exhaust the machine either,
  // whatever a mesher wrote. Processor time decides, so that a busy machine changes no verdict.
  Limits verify_limits = {.wall_seconds = 7200, .cpu_seconds = 900, .memory_bytes = 8ull << 30};
  unsigned jobs = 1;
  double stop_after_seconds = 0;  // begin no further model after this long; 0: no bound
  bool verify = true;             // ask `tetproof verify` for a verdict on each mesh
  // With `verify`: meshers that know sidecars write one in a second run, and the oracles that need
  // one are asked as well. The second run has to write the same bytes; otherwise it counts for
  // nothing. Without this option there is a second run only where the file alone does not decide
  // conformity.
  bool sidecars = false;
  bool solver = false;    // solve Poisson's equation on each mesh (reports/poisson.h)
  bool terminal = false;  // one live line rather than a line per run
};

struct CampaignSummary {
  std::size_t present = 0;           // rows that were in the database already
  std::vector<MesherCount> meshers;  // rows of this campaign, old and new, in the order given
  double elapsed_seconds = 0;
  bool interrupted = false;
  std::size_t models_left_out = 0;  // not begun because of stop_after_seconds
  // Their files had gone, or had other bytes, before a run or after it: says nothing about a
  // mesher, so that no row is stored.
  std::set<std::string> models_changed;
};

// Ends early, with everything finished so far in the database, once interrupt_campaign() was
// called. \throw std::runtime_error if the database cannot be written, CannotRun if a mesher turns
// out not to be runnable on any model: before the first, or by what its first run says.
CampaignSummary run_campaign(const std::vector<Model>& models, const std::vector<Mesher>& meshers,
                             const CampaignOptions& options);

// To be called from a signal handler.
void interrupt_campaign();
bool campaign_interrupted();

// The limits as part of a row's key.
std::string describe(const Limits& limits);

// The time of meshing alone by a mesher's statistics, in seconds: all phases but read, check and
// write.
std::optional<double> mesh_seconds(const std::string& stats_json);

}  // namespace tetproof
