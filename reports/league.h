// The league: every mesher of a campaign on every model, judged by the same oracles.
//
// Laws: success is a mesh that the oracles have nothing against; an unverified one is none. Rates
// come with Wilson's 95 % interval over all runs of the mesher. Sizes, angles, times and memory are
// those of its own successes, with their number. The matrix has a row for each model and a cell
// for each run.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

// The family of a model by its name: the first pattern (* stands for any text) that fits, else
// "other".
class Families {
 public:
  Families() = default;
  // Lines PATTERN,FAMILY; empty ones and those that begin with # are left out.
  // \throw std::runtime_error if the file cannot be read or a line is otherwise.
  explicit Families(const std::filesystem::path& file);

  bool empty() const { return patterns_.empty(); }
  std::string of(const std::string& model_name) const;
  std::vector<std::string> names() const;  // in the order of the file, "other" last

 private:
  std::vector<std::pair<std::string, std::string>> patterns_;
};

// A row per mesher, by the lower end of the interval of its successes.
Table league_table(const Selection& selection);

// Meshers of a kind, each kind on the models on which all of it succeed.
std::vector<Table> group_tables(const Selection& selection);

// delmesher beside each other mesher: who succeeds alone, and both on the models of both.
Table pair_table(const Selection& selection);

// How runs fail: the most frequent kinds of each mesher.
Table failure_kinds(const Selection& selection);

// Successes of runs, a row per family. No rows without families.
Table family_table(const Selection& selection, const Families& families);

// Poisson's equation on the meshes, in measures that do not grow with the number of unknowns, so
// that meshes of other sizes can be compared. No rows if no solver was asked (run --solver).
Table solver_table(const Selection& selection);

// Every mesh that was delivered and is wrong, with the oracle's sentence, and a picture of the
// place if the campaign made one.
Table wrong_result_table(const Selection& selection);

// Models by meshers: seconds of a success, else the disposition. A heat map in the page.
Table league_matrix(const Selection& selection, const Families& families);

}  // namespace tetproof
