// The runs a report speaks of: from one or more databases, one run per model and mesher.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

struct Selection {
  std::vector<std::string> meshers;  // the known ones in the paper's order, then the others by name
  std::vector<std::string> models;   // hashes, by name of the model
  std::map<std::string, std::string> model_names;             // by hash
  std::map<std::string, std::map<std::string, RunRow>> runs;  // by mesher, then model
  std::vector<std::string> notes;  // e.g. that runs of different versions stand side by side
  std::string clock = "wall";      // the kind of the rows' seconds, for captions

  const RunRow* run(const std::string& mesher, const std::string& model) const;
  const RunRow* ok_run(const std::string& mesher, const std::string& model) const;
  bool has(const std::string& mesher) const { return runs.count(mesher) != 0; }
  // Models on which every one of these meshers succeeded.
  std::vector<std::string> common_models(const std::vector<std::string>& meshers) const;
  std::vector<const RunRow*> ok_runs(const std::string& mesher) const;
};

// Among several runs of a model with a mesher (other versions, flags or limits) the latest counts.
Selection select_runs(const std::vector<RunRow>& rows);

// Replaces the wall time of each run by its processor time, because wall time says little on a busy
// machine. Times by the mesher's own account shrink in proportion.
void use_processor_time(Selection& selection);

// A mesher given as a bare command (-m cmd:'PROG ...') is called cmd:PROG from here on, so that
// tables and charts can name it; cmd:PROG-2 if that name is taken. The notes give the command.
void shorten_commands(std::vector<RunRow>& rows, std::vector<std::string>& notes);

// Rows of results files or of exports in JSON. The rows of `base`, if any, stand beside the others
// as meshers NAME@base. \throw std::runtime_error if a file cannot be read.
Selection load_runs(const std::vector<std::filesystem::path>& databases,
                    const std::vector<std::filesystem::path>& base = {});

}  // namespace tetproof
