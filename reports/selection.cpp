#include "reports/selection.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "reports/export.h"

namespace tetproof {
namespace {

// The paper's, with other peers after TetGen.
constexpr const char* kKnownOrder[] = {"tetgen-T0",
                                       "tetgen",
                                       "netgen",
                                       "netgen-raw",
                                       "gmsh-delaunay",
                                       "gmsh-delaunay-raw",
                                       "gmsh-frontal",
                                       "gmsh-frontal-raw",
                                       "gmsh-hxt",
                                       "gmsh-hxt-raw",
                                       "cgal-mesh3",
                                       "cgal-mesh3-raw",
                                       "cgal-ccdt",
                                       "tetgen-1.6-T0",
                                       "tetgen-1.6",
                                       "tetgen-1.6-Y",
                                       "netgen-6.2.26",
                                       "gmsh-4.15-delaunay",
                                       "gmsh-4.15-hxt",
                                       "mmg3d",
                                       "mmg3d-nosurf",
                                       "wildmeshing",
                                       "tetwild",
                                       "ftetwild",
                                       "cdt",
                                       "safe-delmesher-e4",
                                       "published-safe-e4",
                                       "published-e4",
                                       "published",
                                       "delmesher-e4",
                                       "delmesher-nofilter",
                                       "delmesher-nobridges",
                                       "delmesher-split",
                                       "delmesher-keep",
                                       "delmesher",
                                       "plane",
                                       "triangle",
                                       "cgal-mesh2"};

std::vector<std::string> ordered_meshers(
    const std::map<std::string, std::map<std::string, RunRow>>& runs) {
  std::vector<std::string> order;
  for (const char* known : kKnownOrder) {
    if (runs.count(known) != 0) order.emplace_back(known);
  }
  for (const auto& [mesher, ignored] : runs) {
    if (std::find(order.begin(), order.end(), mesher) == order.end()) order.push_back(mesher);
  }
  return order;
}

void note_mixtures(Selection& selection) {
  for (const std::string& mesher : selection.meshers) {
    std::set<std::string> versions, flags, limits, hosts;
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      versions.insert(row.key.version);
      flags.insert(row.key.flags);
      limits.insert(row.key.limits);
      hosts.insert(row.host);
    }
    const auto note = [&](const std::set<std::string>& values, const std::string& what) {
      if (values.size() < 2) return;
      selection.notes.push_back(mesher + ": runs of " + std::to_string(values.size()) + " " + what +
                                " are mixed");
    };
    note(versions, "versions");
    note(flags, "sets of flags");
    note(limits, "sets of limits");
    note(hosts, "machines");
  }
}

}  // namespace

const RunRow* Selection::run(const std::string& mesher, const std::string& model) const {
  const auto by_mesher = runs.find(mesher);
  if (by_mesher == runs.end()) return nullptr;
  const auto found = by_mesher->second.find(model);
  return found == by_mesher->second.end() ? nullptr : &found->second;
}

const RunRow* Selection::ok_run(const std::string& mesher, const std::string& model) const {
  const RunRow* row = run(mesher, model);
  return row != nullptr && row->disposition == Disposition::ok && row->mesh ? row : nullptr;
}

std::vector<std::string> Selection::common_models(const std::vector<std::string>& among) const {
  std::vector<std::string> common;
  std::copy_if(models.begin(), models.end(), std::back_inserter(common), [&](const auto& model) {
    return std::all_of(among.begin(), among.end(),
                       [&](const auto& mesher) { return ok_run(mesher, model) != nullptr; });
  });
  return common;
}

std::vector<const RunRow*> Selection::ok_runs(const std::string& mesher) const {
  std::vector<const RunRow*> found;
  for (const std::string& model : models) {
    if (const RunRow* row = ok_run(mesher, model)) found.push_back(row);
  }
  return found;
}

Selection select_runs(const std::vector<RunRow>& rows) {
  Selection selection;
  for (const RunRow& row : rows) {
    auto& by_model = selection.runs[row.key.mesher];
    const auto found = by_model.find(row.key.model_sha256);
    if (found == by_model.end()) {
      by_model.emplace(row.key.model_sha256, row);
    } else if (row.started >= found->second.started) {
      found->second = row;
    }
    selection.model_names.emplace(row.key.model_sha256, row.model_name);
  }
  for (const auto& [hash, name] : selection.model_names) selection.models.push_back(hash);
  std::sort(selection.models.begin(), selection.models.end(), [&](const auto& a, const auto& b) {
    return std::pair(selection.model_names.at(a), a) < std::pair(selection.model_names.at(b), b);
  });
  selection.meshers = ordered_meshers(selection.runs);
  note_mixtures(selection);
  return selection;
}

void use_processor_time(Selection& selection) {
  for (auto& [mesher, runs] : selection.runs) {
    for (auto& [model, row] : runs) {
      if (row.mesh_seconds && row.wall_seconds > 0) {
        *row.mesh_seconds *= std::min(1.0, row.cpu_seconds / row.wall_seconds);
      }
      row.wall_seconds = row.cpu_seconds;
    }
  }
  selection.clock = "processor";
  selection.notes.emplace_back("Times are processor seconds.");
}

void shorten_commands(std::vector<RunRow>& rows, std::vector<std::string>& notes) {
  std::map<std::string, std::string> labels;  // by the mesher as it was given
  std::set<std::string> taken;
  for (const RunRow& row : rows) taken.insert(row.key.mesher);
  const std::set<std::string> given = taken;
  for (const std::string& mesher : given) {
    const auto colon = mesher.find(':');
    if (!mesher.starts_with("cmd") || colon == std::string::npos) continue;
    const std::string command = mesher.substr(colon + 1);
    const auto from = command.find_first_not_of("'\" ");
    const auto to = command.find_first_of("'\" ", from);
    const std::string program =
        from == std::string::npos
            ? ""
            : std::filesystem::path(command.substr(from, to - from)).filename();
    std::string label = "cmd:" + program;
    for (int i = 2; taken.contains(label); ++i) label = "cmd:" + program + "-" + std::to_string(i);
    taken.insert(label);
    labels[mesher] = label;
    notes.push_back(label + " is the mesher given as " + mesher);
  }
  for (RunRow& row : rows) {
    const auto label = labels.find(row.key.mesher);
    if (label != labels.end()) row.key.mesher = label->second;
  }
}

Selection load_runs(const std::vector<std::filesystem::path>& databases,
                    const std::vector<std::filesystem::path>& base) {
  std::vector<RunRow> rows;
  for (const auto& path : databases) {
    auto more = read_rows(path);
    std::move(more.begin(), more.end(), std::back_inserter(rows));
  }
  for (const auto& path : base) {
    for (RunRow& row : read_rows(path)) {
      row.key.mesher += "@base";
      rows.push_back(std::move(row));
    }
  }
  std::vector<std::string> notes;
  shorten_commands(rows, notes);
  Selection selection = select_runs(rows);
  selection.notes.insert(selection.notes.end(), notes.begin(), notes.end());
  return selection;
}

}  // namespace tetproof
