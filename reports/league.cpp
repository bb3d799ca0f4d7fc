#include "reports/league.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

#include "reports/measures.h"
#include "reports/picture.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr const char* kOther = "other";
constexpr const char* kOurs = "delmesher";

bool fits(const char* pattern, const char* text) {
  if (*pattern == 0) return *text == 0;
  if (*pattern != '*') return *text == *pattern && fits(pattern + 1, text + 1);
  for (const char* rest = text;; ++rest) {
    if (fits(pattern + 1, rest)) return true;
    if (*rest == 0) return false;
  }
}

// What its runs were held to; older results do not tell.
std::string promise_of(const Selection& selection, const std::string& mesher) {
  std::set<std::string> all;
  for (const auto& [model, row] : selection.runs.at(mesher)) all.insert(row.promise);
  return all.size() > 1 ? "mixed" : all.begin()->empty() ? "-" : *all.begin();
}

std::string rate_of(std::size_t successes, std::size_t runs) {
  const Interval wilson = wilson_interval(successes, runs);
  return fmt::format("{:.1f} ({:.1f} to {:.1f})",
                     100.0 * static_cast<double>(successes) / static_cast<double>(runs),
                     100 * wilson.low, 100 * wilson.high);
}

// Medians over runs.
struct Median {
  const char* head;
  Value value;
  int digits;
};
std::vector<Median> medians() {
  return {{"tets", of_solid(&MeshColumns::tetrahedra), 0},
          {"min dihedral", of_solid(&MeshColumns::min_dihedral), 2},
          {"1 % of dihedrals", of_solid(&MeshColumns::dihedral_percent), 1},
          {"min face angle", of_solid(&MeshColumns::min_face_angle), 2},
          {"mean gamma", of_solid(&MeshColumns::mean_gamma), 3},
          {"s", wall_seconds(), 2},
          {"MB", peak_megabytes(), 0}};
}

void append_medians(const Rows& rows, std::vector<std::string>& cells) {
  for (const Median& m : medians()) {
    cells.push_back(fixed(quantile(values_of(rows, m.value), 0.5), m.digits));
  }
}
void append_medians(std::vector<std::string>& header) {
  for (const Median& m : medians()) header.emplace_back(m.head);
}

Rows runs_on(const Selection& selection, const std::string& mesher,
             const std::vector<std::string>& models) {
  Rows rows;
  for (const std::string& model : models) rows.push_back(selection.run(mesher, model));
  return rows;
}

// The median of what `theirs` is times `ours`, run by run.
std::optional<double> median_ratio(const Rows& theirs, const Rows& ours, const Value& value) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const auto a = value(*ours[i]), b = value(*theirs[i]);
    if (a && b && *a != 0) ratios.push_back(*b / *a);
  }
  return median(std::move(ratios));
}

std::vector<std::string> league_row(const Selection& selection, const std::string& mesher) {
  const Rows successes = selection.ok_runs(mesher);
  const std::size_t runs = run_count(selection, mesher);
  std::vector<std::string> row = {mesher, promise_of(selection, mesher), std::to_string(runs),
                                  std::to_string(successes.size()),
                                  rate_of(successes.size(), runs)};
  append_dispositions(selection, mesher, row);
  const auto add = [&](const Value& value, double p, int digits) {
    row.push_back(fixed(quantile(values_of(successes, value), p), digits));
  };
  append_medians(successes, row);
  add(of_solid(&MeshColumns::gamma_percent), 0.5, 3);
  add(wall_seconds(), 0.95, 2);
  add(process_microseconds(), 0.5, 0);
  return row;
}

std::vector<std::string> by_success(const Selection& selection) {
  std::vector<std::string> meshers;
  for (const std::string& mesher : selection.meshers) {
    if (run_count(selection, mesher) > 0) meshers.push_back(mesher);
  }
  // What few runs show counts less.
  const auto certain = [&](const std::string& mesher) {
    return wilson_interval(selection.ok_runs(mesher).size(), run_count(selection, mesher)).low;
  };
  std::stable_sort(meshers.begin(), meshers.end(),
                   [&](const auto& a, const auto& b) { return certain(a) > certain(b); });
  return meshers;
}

// A measure of the solver times that power of the number of unknowns; nothing of fewer unknowns
// than tell something, or if the solver gave up.
Value of_solver(double (*measure)(const SolverColumns&), double power) {
  constexpr std::uint64_t kLeastUnknowns = 50;
  return [=](const RunRow& row) -> std::optional<double> {
    const auto solver = solver_columns(row.mesh_json);
    if (!solver || !solver->converged || solver->unknowns < kLeastUnknowns) return std::nullopt;
    return measure(*solver) * std::pow(static_cast<double>(solver->unknowns), power);
  };
}

}  // namespace

Families::Families(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const auto comma = line.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == line.size()) {
      throw std::runtime_error(
          fmt::format("{}:{}: PATTERN,FAMILY is expected", file.string(), number));
    }
    patterns_.emplace_back(line.substr(0, comma), line.substr(comma + 1));
  }
}

std::string Families::of(const std::string& model_name) const {
  const std::string name = short_name(model_name);
  for (const auto& [pattern, family] : patterns_) {
    if (fits(pattern.c_str(), name.c_str())) return family;
  }
  return kOther;
}

std::vector<std::string> Families::names() const {
  std::vector<std::string> names;
  for (const auto& [pattern, family] : patterns_) {
    if (std::find(names.begin(), names.end(), family) == names.end()) names.push_back(family);
  }
  if (std::find(names.begin(), names.end(), kOther) == names.end()) names.emplace_back(kOther);
  return names;
}

Table league_table(const Selection& selection) {
  Table table;
  table.name = "league";
  table.title = "The league";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"Mesher", "Promise", "Runs", "Ok", "Ok, % (95 % interval)"};
  append_dispositions(table.header);
  append_medians(table.header);
  for (const char* name : {"1 % of gamma", "s, 95 %", "us per tet"})
    table.header.emplace_back(name);
  for (const std::string& mesher : by_success(selection)) {
    table.rows.push_back(league_row(selection, mesher));
  }
  table.notes = {
      "Ok: the oracles have nothing against the mesh, as measured by its promise: exact, or "
      "vertices "
      "of the surface within a fraction of the diagonal, or a surface of its own within an "
      "envelope. "
      "Intervals: Wilson.",
      "From \"tets\" on medians over the models of its own successes, so of other models for each "
      "mesher; Table 2 has the common ones. Tetrahedra and their shapes are those inside, where a "
      "file tells them apart; microseconds are per tetrahedron written. Seconds are " +
          selection.clock + " seconds of the whole process.",
      kGammaNote};
  return table;
}

std::vector<Table> group_tables(const Selection& selection) {
  static const std::pair<const char*, std::vector<std::string>> kGroups[] = {
      {"of today",
       {"delmesher", "tetgen-1.6-Y", "gmsh-4.15-delaunay", "gmsh-4.15-hxt", "netgen-6.2.26",
        "mmg3d-nosurf"}},
      {"of the paper and its own program", {"delmesher-e4", "published-e4"}},
      {"optimized", {"delmesher", "gmsh-delaunay", "gmsh-hxt", "netgen"}},
      {"without optimization", {"delmesher-e4", "gmsh-delaunay-raw", "gmsh-hxt-raw", "netgen-raw"}},
      {"with TetGen", {"delmesher", "delmesher-e4", "tetgen", "tetgen-T0"}},
      {"with a surface of their own",
       {"delmesher", "cgal-mesh3", "cgal-mesh3-raw", "mmg3d", "ftetwild", "wildmeshing",
        "tetwild"}}};
  std::vector<Table> tables;
  for (const auto& [name, all] : kGroups) {
    std::vector<std::string> members;
    std::copy_if(all.begin(), all.end(), std::back_inserter(members),
                 [&](const auto& m) { return !selection.ok_runs(m).empty(); });
    const bool only_ours =
        std::ranges::all_of(members, [](const auto& m) { return m.starts_with(kOurs); });
    const auto common = selection.common_models(members);
    if (members.size() < 2 || only_ours || common.empty()) continue;
    Table& table = tables.emplace_back();
    table.name = fmt::format("league-group-{}", tables.size());
    table.title =
        fmt::format("Those {}, on the {} models on which all of them succeed", name, common.size());
    table.header = {"Mesher"};
    append_medians(table.header);
    for (const std::string& mesher : members) {
      append_medians(runs_on(selection, mesher, common), table.rows.emplace_back(1, mesher));
    }
  }
  return tables;
}

Table pair_table(const Selection& selection) {
  Table table;
  table.name = "league-pairs";
  table.title = "Each beside ours";
  table.header = {"Mesher",
                  "Models",
                  "only ours ok",
                  "only it ok",
                  "both ok",
                  "tets, it / ours",
                  "s, it / ours",
                  "MB, it / ours",
                  "min dihedral, ours",
                  "it",
                  "mean gamma, ours",
                  "it",
                  "smallest dihedral larger with ours, %"};
  const Value tets = of_solid(&MeshColumns::tetrahedra), gamma = of_solid(&MeshColumns::mean_gamma),
              dihedral = of_solid(&MeshColumns::min_dihedral);
  for (const std::string& mesher : selection.meshers) {
    if (mesher == kOurs || !selection.has(kOurs)) continue;
    std::size_t asked = 0, only_ours = 0, only_it = 0, better = 0;
    for (const std::string& model : selection.models) {
      if (selection.run(kOurs, model) == nullptr || selection.run(mesher, model) == nullptr)
        continue;
      const bool a = selection.ok_run(kOurs, model) != nullptr;
      const bool b = selection.ok_run(mesher, model) != nullptr;
      ++asked;
      only_ours += a && !b;
      only_it += b && !a;
    }
    const auto common = selection.common_models({kOurs, mesher});
    const Rows a = runs_on(selection, kOurs, common), b = runs_on(selection, mesher, common);
    for (std::size_t i = 0; i < a.size(); ++i) better += dihedral(*a[i]) > dihedral(*b[i]);
    std::vector<std::string> row = {mesher, std::to_string(asked), std::to_string(only_ours),
                                    std::to_string(only_it), std::to_string(common.size())};
    for (const Value& value : {tets, wall_seconds(), peak_megabytes()}) {
      row.push_back(fixed(median_ratio(b, a, value), 2));
    }
    for (const auto& [value, digits] : {std::pair(dihedral, 1), std::pair(gamma, 3)}) {
      for (const Rows& side : {a, b}) row.push_back(fixed(median(values_of(side, value)), digits));
    }
    row.push_back(common.empty() ? "-"
                                 : fmt::format("{:.0f}", 100.0 * static_cast<double>(better) /
                                                             static_cast<double>(common.size())));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "delmesher compared with each other mesher: models on which only one of them succeeds; then, "
      "over the models of both, medians of ratios and values."};
  return table;
}

Table failure_kinds(const Selection& selection) {
  constexpr std::size_t kMostKinds = 2, kMostLetters = 80, kMostModels = 3;
  Table table;
  table.name = "league-failures";
  table.title = "How they fail";
  table.header = {"Mesher", "How", "Runs", "For example"};
  for (const std::string& mesher : selection.meshers) {
    std::map<std::string, std::vector<std::string>> kinds;  // models, in their order
    for (const std::string& model : selection.models) {
      const RunRow* row = selection.run(mesher, model);
      if (row == nullptr || row->disposition == Disposition::ok) continue;
      kinds[failure_kind(*row)].push_back(short_name(row->model_name));
    }
    std::vector<std::pair<std::string, std::vector<std::string>>> listed(kinds.begin(),
                                                                         kinds.end());
    std::stable_sort(listed.begin(), listed.end(), [](const auto& a, const auto& b) {
      return a.second.size() > b.second.size();
    });
    std::size_t others = 0;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      auto& [kind, models] = listed[i];
      others += i < kMostKinds ? 0 : models.size();
      if (i >= kMostKinds) continue;
      const std::size_t count = models.size();
      models.resize(std::min(count, kMostModels));
      table.rows.push_back(
          {mesher, kind.substr(0, kMostLetters), std::to_string(count),
           fmt::format("{}{}", fmt::join(models, ", "), count > kMostModels ? ", ..." : "")});
    }
    if (others > 0) {
      table.rows.push_back({mesher, fmt::format("{} other kinds", listed.size() - kMostKinds),
                            std::to_string(others), ""});
    }
  }
  table.notes = {
      "The most frequent kinds of failure, without numbers; for a wrong result the oracle that "
      "objects."};
  return table;
}

Table family_table(const Selection& selection, const Families& families) {
  Table table;
  table.name = "league-families";
  table.title = "Successes of runs by family of models";
  if (families.empty()) return table;
  table.header = {"Family", "Models"};
  const std::vector<std::string> meshers = by_success(selection);
  table.header.insert(table.header.end(), meshers.begin(), meshers.end());
  for (const std::string& family : families.names()) {
    std::vector<std::string> models;
    std::copy_if(selection.models.begin(), selection.models.end(), std::back_inserter(models),
                 [&](const auto& m) { return families.of(selection.model_names.at(m)) == family; });
    if (models.empty()) continue;
    std::vector<std::string> row = {family, std::to_string(models.size())};
    for (const std::string& mesher : meshers) {
      std::size_t ok = 0, runs = 0;
      for (const std::string& model : models) {
        ok += selection.ok_run(mesher, model) != nullptr;
        runs += selection.run(mesher, model) != nullptr;
      }
      row.push_back(runs == 0 ? "-" : fmt::format("{}/{}", ok, runs));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table solver_table(const Selection& selection) {
  struct Measure {
    const char* head;
    Value value;
    int digits;
  };
  const Measure measures[] = {
      {"iterations / n^(1/3)",
       of_solver([](const SolverColumns& s) { return static_cast<double>(s.iterations); },
                 -1.0 / 3),
       2},
      {"condition / n^(2/3)",
       of_solver([](const SolverColumns& s) { return s.condition; }, -2.0 / 3), 2},
      {"error x n^(2/3)", of_solver([](const SolverColumns& s) { return s.mean_error; }, 2.0 / 3),
       3}};
  const Value unknowns =
      of_solver([](const SolverColumns& s) { return static_cast<double>(s.unknowns); }, 0);
  Table table;
  table.name = "league-solver";
  table.title = "What a solver sees";
  table.header = {"Mesher", "Meshes", "unknowns n"};
  for (const Measure& m : measures) table.header.emplace_back(m.head);
  table.header.emplace_back("meshes in common with delmesher");
  for (const Measure& m : measures) table.header.push_back(std::string(m.head) + ", it / ours");
  for (const std::string& mesher : by_success(selection)) {
    const Rows successes = selection.ok_runs(mesher);
    const std::size_t meshes = values_of(successes, unknowns).size();
    if (meshes == 0) continue;
    std::vector<std::string> row = {mesher, std::to_string(meshes),
                                    fixed(median(values_of(successes, unknowns)), 0)};
    for (const Measure& m : measures) {
      row.push_back(fixed(median(values_of(successes, m.value)), m.digits));
    }
    Rows ours, theirs;
    for (const std::string& model : selection.common_models({kOurs, mesher})) {
      const RunRow *a = selection.run(kOurs, model), *b = selection.run(mesher, model);
      if (!unknowns(*a) || !unknowns(*b)) continue;
      ours.push_back(a);
      theirs.push_back(b);
    }
    row.push_back(std::to_string(ours.size()));
    for (const Measure& m : measures) row.push_back(fixed(median_ratio(theirs, ours, m.value), 2));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "Poisson's equation with linear elements on the tetrahedra inside, for a solution that is "
      "known: iterations of conjugate gradients (preconditioned by the diagonal, to 1e-8), the "
      "condition number that they tell, and the error (root of the mean square). Each with the "
      "power of n that a uniform refinement leaves as it is, so that they compare at equal "
      "unknowns: less is better. Medians; meshes with fewer than 50 unknowns are left out."};
  return table;
}

Table wrong_result_table(const Selection& selection) {
  Table table;
  table.name = "league-wrong";
  table.title = "Meshes that were delivered and are wrong";
  table.header = {"Mesher", "Model", "Promise", "What is wrong"};
  for (const std::string& mesher : by_success(selection)) {
    for (const std::string& model : selection.models) {
      const RunRow* row = selection.run(mesher, model);
      if (row == nullptr || row->disposition != Disposition::wrong_result) continue;
      table.rows.push_back({mesher, short_name(row->model_name), row->promise, row->reason});
      table.pictures.push_back(picture_in(row->verdict_json));
    }
  }
  return table;
}

Table league_matrix(const Selection& selection, const Families& families) {
  Table table;
  table.name = "league-matrix";
  table.title = "Model by model";
  table.heat_map = true;
  table.header = {"Model", "Family", "Bytes"};
  const std::vector<std::string> meshers = by_success(selection);
  table.header.insert(table.header.end(), meshers.begin(), meshers.end());
  for (const std::string& model : selection.models) {
    const std::string& name = selection.model_names.at(model);
    std::vector<std::string> row = {short_name(name), families.empty() ? "-" : families.of(name),
                                    "-"};
    for (const std::string& mesher : meshers) {
      const RunRow* run = selection.run(mesher, model);
      if (run != nullptr) row[2] = std::to_string(run->model_bytes);
      row.push_back(run == nullptr                        ? "-"
                    : run->disposition == Disposition::ok ? fmt::format("{:.2f}", run->wall_seconds)
                                                          : disposition_name(run->disposition));
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {"Seconds of a success, else how the run ended. A click on a column's head sorts."};
  return table;
}

}  // namespace tetproof
