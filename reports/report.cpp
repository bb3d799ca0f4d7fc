#include "reports/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <stdexcept>

#include "reports/assets.h"
#include "reports/compare.h"
#include "reports/export.h"
#include "reports/fidelity.h"
#include "reports/figures.h"
#include "reports/html.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

Table mesher_table(const Selection& selection) {
  Table table;
  table.name = "meshers";
  table.title = "Meshers";
  table.header = {"Mesher", "Version", "Flags", "Limits", "Machine"};
  for (const std::string& mesher : selection.meshers) {
    const auto& runs = selection.runs.at(mesher);
    if (runs.empty()) continue;
    const RunRow& row = runs.begin()->second;
    table.rows.push_back({mesher, row.key.version, row.key.flags, row.key.limits, row.host});
  }
  table.folded_columns = {2};
  table.notes = selection.notes;
  return table;
}

// The hash of the model that Table 3 is about.
std::string table_3_model(const Selection& selection, const std::string& name) {
  if (name.empty()) {
    std::string best;
    std::pair<std::size_t, std::uint64_t> most;
    for (const std::string& model : selection.models) {
      std::pair<std::size_t, std::uint64_t> here;  // successes, tetrahedra
      for (const std::string& mesher : selection.meshers) {
        const RunRow* row = selection.ok_run(mesher, model);
        here.first += row != nullptr;
        if (row != nullptr) here.second = std::max(here.second, row->mesh->tetrahedra);
      }
      if (here > most) {
        most = here;
        best = model;
      }
    }
    return best;
  }
  for (const std::string& model : selection.models) {
    const std::string& full = selection.model_names.at(model);
    if (full == name || short_name(full) == name) return model;
  }
  throw std::runtime_error(name + ": no run is of a model of this name");
}

std::vector<Chart> joined(std::vector<Chart> first, const std::vector<Chart>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::vector<Section> sections_of(const Selection& selection, const std::string& model,
                                 const ReportOptions& options) {
  const Families& families = options.families;
  std::vector<Section> sections;
  const auto add = [&](std::string id, std::string title, std::string text,
                       std::vector<Table> tables, std::vector<Chart> charts) -> Section& {
    return sections.emplace_back(Section{std::move(id), std::move(title), std::move(text),
                                         std::move(tables), std::move(charts), false, false});
  };
  if (!options.history.empty()) {
    add("history", "History",
        "Campaigns in the order given. All other sections speak of the last one.",
        {history_table(options.history), history_changes(options.history)},
        {history_size_chart(options.history), history_time_chart(options.history)});
  }
  add("league", "League",
      "Every mesher on every model, judged by the same oracles; the most successful first.",
      {league_table(selection), plane_table(selection), family_table(selection, families),
       solver_table(selection)},
      {cactus_chart(selection), size_cactus_chart(selection)});
  add("matrix", "League: wrong results, and model by model", "",
      {wrong_result_table(selection), league_matrix(selection, families)}, {})
      .folded = true;
  add("figures", "Angles (after Figures 10, 11, 13)",
      "Extreme angles of each model, average angles of each model, all angles of all models, and "
      "gamma of each model. "
      "Same bins for all meshers; each mesher's bars add up to 100 % of its own successes.",
      {},
      joined(joined(extreme_angle_charts(selection), average_angle_charts(selection)),
             joined(angle_charts(selection, ""), gamma_charts(selection))));
  add("success", "Success", "How the runs ended, and what the oracles found in the files.",
      {disposition_table(selection), oracle_table(selection), failure_group_table(selection),
       limit_table(selection), ladder_table(selection)},
      {disposition_chart(selection)});
  add("speed", "Time and memory", "",
      {speed_table(selection), time_table(selection), phase_table(selection)},
      {time_chart(selection), speed_chart(selection), phase_chart(selection)});
  add("compare", "Comparison of two", "", {pairing_table(selection)}, {});
  add("tables", "Tables 1 and 2",
      "Laid out as the paper's Tables 1 and 2, with every mesher of this campaign on its models.",
      {table_1(selection), table_2(selection)}, {})
      .side_by_side = true;
  add("table3", "One model (after Table 3 and Figure 13)", "", {table_3(selection, model)},
      model.empty() ? std::vector<Chart>() : angle_charts(selection, model));
  add("more", "Table 2, other ways", "", {table_2_all(selection), table_2_inside(selection)}, {})
      .side_by_side = true;
  add("chamfering", "Bridges and thin walls",
      "Our own measurements on what the paper's section 4.4 and Figure 8 are about.",
      {ablation_table(selection), figure_8_table(selection)}, {figure_8_chart(selection)});
  add("deviations", "What the departures from the paper are worth",
      "The default, each of its departures undone alone, and the paper's preset (docs/paper.md).",
      {deviation_table(selection)}, {deviation_chart(selection)});
  add("rotated", "Rotated models",
      "A part in another position, with rounded corners, should have about the same mesh.",
      {rotated_table(selection)}, {});
  add("vary", "Exact copies",
      "For the same solid, turned, scaled or renumbered exactly, a mesher should end the same way.",
      {vary_table(selection), vary_changes_table(selection)}, {});
  add("fidelity", "Beside the paper",
      "Columns \"paper\": as printed there. Columns \"here\": measured in this campaign, with "
      "other "
      "models, machines and programs; the notes say what differs.",
      fidelity_tables(selection, model), {});
  add("runs", "Slowest runs, failures, meshers", "",
      {mesher_table(selection), slowest_table(selection)}, {});
  add("failures", "Every run that is not ok", "", {failure_table(selection)}, {}).folded = true;
  for (Section& section : sections) {
    std::erase_if(section.tables, [](const Table& table) { return !has_data(table); });
    std::erase_if(section.charts, [](const Chart& chart) { return chart.empty(); });
  }
  std::erase_if(sections, [](const Section& section) {
    return section.tables.empty() && section.charts.empty();
  });
  return sections;
}

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

// The meshers whose value is the largest one.
struct Best {
  std::vector<std::string> meshers;
  double value = 0;

  void add(const std::string& mesher, double of_mesher) {
    if (of_mesher > value || meshers.empty()) meshers.clear();
    if (meshers.empty()) value = of_mesher;
    if (of_mesher == value) meshers.push_back(mesher);
  }
};

// When, where and with what was run; who is best at what; which paper is meant.
std::vector<std::string> summary_of(const Selection& selection) {
  std::set<std::string> dates, hosts;
  std::vector<std::string> versions;
  Best most, roundest, fastest;
  const std::vector<std::string> common = selection.common_models(selection.meshers);
  for (const std::string& mesher : selection.meshers) {
    std::set<std::string> of_mesher;
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      if (!row.started.empty()) dates.insert(row.started.substr(0, 10));
      if (!row.host.empty()) hosts.insert(row.host);
      if (!row.key.version.empty()) of_mesher.insert(row.key.version);
    }
    versions.push_back(mesher);
    for (const std::string& version : of_mesher) {
      if (version.starts_with(mesher + " ")) versions.back().clear();  // it says whose it is
      versions.back() += (versions.back().empty() ? "" : " ") + version;
    }
    most.add(mesher, static_cast<double>(selection.ok_runs(mesher).size()));
    std::vector<double> angles, seconds;
    for (const std::string& model : common) {
      const RunRow& row = *selection.ok_run(mesher, model);
      angles.push_back((row.inside ? *row.inside : *row.mesh).min_dihedral);
      seconds.push_back(row.wall_seconds);
    }
    if (common.empty()) continue;
    roundest.add(mesher, *median(angles));
    fastest.add(mesher, -*median(seconds));
  }
  std::vector<std::string> summary = {fmt::format("{} models, {} meshers ({})",
                                                  selection.models.size(), selection.meshers.size(),
                                                  listed(versions))};
  if (!dates.empty()) {
    summary[0] +=
        ", run " + (dates.size() == 1 ? "on " + *dates.begin()
                                      : "from " + *dates.begin() + " to " + *dates.rbegin());
  }
  if (!hosts.empty()) summary[0] += ", on " + listed({hosts.begin(), hosts.end()});
  summary[0] += ".";
  if (!most.meshers.empty()) {
    summary.push_back(
        fmt::format("The most meshes, by the oracles' verdict, are of {}: {:.0f} of {} models.",
                    listed(most.meshers), most.value, selection.models.size()));
  }
  const std::string where = fmt::format(" (median of the {} {} on which all succeed)",
                                        common.size(), common.size() == 1 ? "model" : "models");
  if (roundest.value > 0) {
    summary.push_back(
        fmt::format("The largest smallest dihedral angles inside are of {}: {:.3g} degrees{}.",
                    listed(roundest.meshers), roundest.value, where));
  }
  if (fastest.value < 0) {
    summary.push_back(fmt::format("The fastest is {}: {:.2g} s{}.", listed(fastest.meshers),
                                  -fastest.value, where));
  }
  summary.emplace_back(
      "\"The paper\" is Diazzi, Dai, Panozzo, Attene: Surface chamfering for robust tetrahedral "
      "meshing, ACM Transactions on Graphics 45(4), 146 (2026): "
      "https://dl.acm.org/action/doSearch?AllField=Surface+chamfering+for+robust+tetrahedral+"
      "meshing");
  return summary;
}

std::vector<std::string> headline_of(const Selection& selection) {
  std::vector<std::string> facts = {fmt::format("{} models", selection.models.size())};
  for (const std::string& mesher : selection.meshers) {
    const std::size_t unverified = unverified_count(selection, mesher);
    facts.push_back(fmt::format("{}/{} {}{}", selection.ok_runs(mesher).size(),
                                run_count(selection, mesher), mesher,
                                unverified == 0 ? "" : fmt::format(", {} unverified", unverified)));
  }
  return facts;
}

// Warnings that a reader must know before the first number.
std::vector<std::string> warnings_of(const Selection& selection) {
  std::vector<std::string> warnings;
  std::size_t unverified = 0;
  for (const std::string& mesher : selection.meshers) {
    unverified += unverified_count(selection, mesher);
  }
  if (unverified > 0) {
    warnings.push_back(fmt::format(
        "{} {} unverified: the oracles have not finished with {}, or did not run. "
        "Unverified meshes count neither as successes nor in averages.",
        unverified, unverified == 1 ? "mesh is" : "meshes are", unverified == 1 ? "it" : "them"));
  }
  if (limits_differ(selection, selection.meshers)) {
    warnings.push_back(limits_caption(selection, selection.meshers) +
                       " Successes and times are not comparable where they do.");
  }
  return warnings;
}

std::vector<RunRow> all_rows(const Selection& selection) {
  std::vector<RunRow> rows;
  for (const auto& [mesher, runs] : selection.runs) {
    for (const auto& [model, row] : runs) rows.push_back(row);
  }
  return rows;
}

}  // namespace

ReportFiles write_report(const Selection& selection, const std::filesystem::path& folder,
                         const ReportOptions& options) {
  const std::string model = table_3_model(selection, options.model);
  Page page;
  page.title = "Meshing campaign";
  page.summary = summary_of(selection);
  page.headline = headline_of(selection);
  page.sections = sections_of(selection, model, options);
  page.notes = {
      "CSV files of every table and figure, LaTeX (tables.tex) and Markdown (report.md) "
      "stand beside this page."};
  page.warnings = warnings_of(selection);
  page.has_charts = !assets::chart_js().empty();
  page.has_pictures = !assets::three_js().empty() && !assets::orbit_controls_js().empty();
  if (page.has_pictures) page.views = collect_views(selection, options.views, page.notes);

  std::filesystem::create_directories(folder);
  std::string summary;
  for (const std::string& sentence : page.summary) summary += sentence + "\n";
  summary += "\nSuccesses of runs:\n\n";
  for (const std::string& mesher : selection.meshers) {
    summary += fmt::format("- {}: {}\n", mesher, successes_of(selection, mesher));
  }
  summary += "\n";
  for (const std::string& warning : page.warnings) summary += "**" + warning + "**\n\n";
  std::string markdown = "# Meshing campaign\n\n" + summary;
  std::string latex = "% \\usepackage{booktabs}\n";
  for (const Section& section : page.sections) {
    markdown += "## " + section.title + "\n\n";
    for (const Table& table : section.tables) {
      markdown += to_markdown(table);
      latex += to_latex(table);
      write_file(folder / (table.name + ".csv"), to_csv(table));
    }
    for (const Chart& chart : section.charts) {
      write_file(folder / (chart.name + ".csv"), to_csv(to_table(chart)));
    }
  }
  markdown += "Every run, one a line: [runs.csv](runs.csv). Figures: report.html.\n";
  write_file(folder / "runs.csv", rows_to_csv(all_rows(selection)));
  write_file(folder / "tables.tex", latex);
  write_file(folder / "report.md", markdown);
  write_file(folder / "report.html", to_html(page, selection));
  for (const Table& table : {table_1(selection), table_2(selection)}) summary += to_markdown(table);
  return {folder / "report.html", folder / "report.md", summary};
}

}  // namespace tetproof
