#include "reports/league.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "reports/measures.h"
#include "reports/picture.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr const char* kOther = "other";

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
  add(of_solid(&MeshColumns::tetrahedra), 0.5, 0);
  add(of_solid(&MeshColumns::min_dihedral), 0.5, 2);
  add(of_solid(&MeshColumns::dihedral_percent), 0.5, 1);
  add(of_solid(&MeshColumns::gamma_percent), 0.5, 3);
  add(of_solid(&MeshColumns::mean_gamma), 0.5, 3);
  add(wall_seconds(), 0.5, 2);
  add(wall_seconds(), 0.95, 2);
  add(process_microseconds(), 0.5, 0);
  add(peak_megabytes(), 0.5, 0);
  return row;
}

std::vector<std::string> by_success(const Selection& selection) {
  std::vector<std::string> meshers;
  for (const std::string& mesher : selection.meshers) {
    if (run_count(selection, mesher) > 0) meshers.push_back(mesher);
  }
  const auto share = [&](const std::string& mesher) {
    return static_cast<double>(selection.ok_runs(mesher).size()) /
           static_cast<double>(run_count(selection, mesher));
  };
  std::stable_sort(meshers.begin(), meshers.end(),
                   [&](const auto& a, const auto& b) { return share(a) > share(b); });
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
  for (const char* name : {"tets", "min dihedral", "1 % of dihedrals", "1 % of gamma", "mean gamma",
                           "s", "s, 95 %", "us per tet", "MB"}) {
    table.header.emplace_back(name);
  }
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
  Table table;
  table.name = "league-solver";
  table.title = "What a solver sees";
  table.header = {
      "Mesher",         "Meshes", "unknowns n", "iterations / n^(1/3)", "condition / n^(2/3)",
      "error x n^(2/3)"};
  const Value unknowns =
      of_solver([](const SolverColumns& s) { return static_cast<double>(s.unknowns); }, 0);
  const Value iterations =
      of_solver([](const SolverColumns& s) { return static_cast<double>(s.iterations); }, -1.0 / 3);
  const Value condition = of_solver([](const SolverColumns& s) { return s.condition; }, -2.0 / 3);
  const Value error = of_solver([](const SolverColumns& s) { return s.mean_error; }, 2.0 / 3);
  for (const std::string& mesher : by_success(selection)) {
    const Rows successes = selection.ok_runs(mesher);
    const std::size_t meshes = values_of(successes, unknowns).size();
    if (meshes == 0) continue;
    const auto median_of = [&](const Value& value, int digits) {
      return fixed(quantile(values_of(successes, value), 0.5), digits);
    };
    table.rows.push_back({mesher, std::to_string(meshes), median_of(unknowns, 0),
                          median_of(iterations, 2), median_of(condition, 2), median_of(error, 3)});
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
