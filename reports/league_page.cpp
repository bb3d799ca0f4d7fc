#include "reports/league_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

#include "reports/csv.h"
#include "reports/export.h"
#include "reports/measures.h"
#include "reports/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

constexpr const char* kByHand = "<!-- by hand -->";
constexpr std::size_t kHashDigits = 12, kReasonLetters = 160;

const std::vector<std::string> kRunHead = {
    "model",      "sha256",       "mesher",     "version",        "disposition", "reason",
    "tetrahedra", "min_dihedral", "dihedral_1", "min_face_angle", "mean_gamma",  "cpu_s",
    "mb",         "unknowns",     "iterations", "condition",      "error"};
const std::vector<std::string> kMesherHead = {"mesher", "version", "program",
                                              "flags",  "promise", "limits"};

fs::path meshers_beside(const fs::path& csv) {
  return fs::path(csv).replace_extension().string() + "_meshers.csv";
}

bool is_ours(const std::string& mesher) {
  static const std::regex kOurs("cdt|(safe-)?delmesher(-.*)?");
  return std::regex_match(mesher, kOurs);
}

// Short, and another one whenever the program, its flags or the limits are others; our own
// programs are told by their commit.
std::string token_of(const RunRow& row) {
  std::string label, text = row.key.version;
  std::smatch found;
  const auto of = text.rfind(" of ");
  if (is_ours(row.key.mesher) && of != std::string::npos) {
    text = label = text.substr(of + 4);
  } else if (std::regex_search(text, found, std::regex("\\d+(\\.\\d+)+"))) {
    label = found.str();
  }
  const std::string hash = sha256_of(text + "\n" + row.key.flags + "\n" + row.key.limits);
  return (label.empty() ? "" : label + "-") + hash.substr(0, 4);
}

// As short as it can be written with so many digits.
std::string shortest(std::optional<double> value, int digits = 4) {
  if (!value) return "";
  const std::string text = fmt::format("{:.{}g}", *value, digits);
  return text.find("e+") == std::string::npos ? text : fmt::format("{:.0f}", *value);
}

std::optional<double> number_of(const std::string& text, const std::string& where) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::runtime_error(where + ": a number is expected, not " + text);
  }
  return value;
}

std::vector<std::vector<std::string>> rows_of(const fs::path& csv,
                                              const std::vector<std::string>& head) {
  std::ifstream file(csv, std::ios::binary);
  if (!file) throw std::runtime_error(csv.string() + ": cannot be read");
  auto rows = parse_csv({std::istreambuf_iterator<char>(file), {}});
  if (rows.empty() || rows[0] != head) {
    throw std::runtime_error(
        fmt::format("{}: its first line is not {}", csv.string(), fmt::join(head, ",")));
  }
  rows.erase(rows.begin());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() == head.size()) continue;
    throw std::runtime_error(
        fmt::format("{}: row {}: {} cells are expected", csv.string(), i + 1, head.size()));
  }
  return rows;
}

RunRow row_of(const std::vector<std::string>& cells, const std::vector<std::string>& mesher,
              const std::string& where) {
  const auto number = [&](std::size_t column) { return number_of(cells[column], where); };
  RunRow row;
  row.key = {cells[1], cells[2], mesher[2], mesher[3], mesher[5]};
  row.promise = mesher[4];
  row.model_name = cells[0];
  row.disposition = disposition_from_name(cells[4]);
  row.reason = cells[5];
  row.cpu_seconds = row.wall_seconds = number(11).value_or(0);
  row.peak_rss_bytes = static_cast<std::uint64_t>(std::llround(number(12).value_or(0) * 0x1p20));
  if (const auto tetrahedra = number(6)) {
    row.mesh.emplace();
    row.mesh->tetrahedra = static_cast<std::uint64_t>(*tetrahedra);
    row.mesh->min_dihedral = number(7).value_or(0);
    row.mesh->dihedral_percent = number(8);
    row.mesh->min_face_angle = number(9).value_or(0);
    row.mesh->mean_gamma = number(10);
  }
  if (const auto unknowns = number(13)) {
    const auto iterations = number(14);
    row.mesh_json =
        nlohmann::json{{"solver",
                        {{"unknowns", static_cast<std::uint64_t>(*unknowns)},
                         {"iterations", static_cast<std::uint64_t>(iterations.value_or(0))},
                         {"converged", iterations.has_value()},
                         {"condition", number(15).value_or(0)},
                         {"mean_error", number(16).value_or(0)}}}}
            .dump();
  }
  return row;
}

std::vector<std::string> cells_of(const RunRow& row) {
  const bool ok = row.disposition == Disposition::ok;
  const auto of = [&](const Value& value, int digits = 4) {
    return ok ? shortest(value(row), digits) : "";
  };
  std::string reason = std::regex_replace(row.reason, std::regex("\\s+"), " ");
  reason.resize(ok ? 0 : std::min(reason.size(), kReasonLetters));
  const auto solver = ok ? solver_columns(row.mesh_json) : std::nullopt;
  const auto seen = [&](double value, int digits = 4) {
    return solver ? shortest(value, digits) : "";
  };
  const SolverColumns s = solver.value_or(SolverColumns());
  return {short_name(row.model_name),
          row.key.model_sha256,
          row.key.mesher,
          token_of(row),
          disposition_name(row.disposition),
          reason,
          of(of_solid(&MeshColumns::tetrahedra), 12),
          of(of_solid(&MeshColumns::min_dihedral)),
          of(of_solid(&MeshColumns::dihedral_percent)),
          of(of_solid(&MeshColumns::min_face_angle)),
          of(of_solid(&MeshColumns::mean_gamma)),
          fmt::format("{:.2f}", row.cpu_seconds),
          shortest(static_cast<double>(row.peak_rss_bytes) * 0x1p-20, 3),
          seen(static_cast<double>(s.unknowns), 12),
          s.converged ? seen(static_cast<double>(s.iterations), 12) : "",
          seen(s.condition),
          seen(s.mean_error)};
}

// Of a file that does not tell the tetrahedra inside apart: as the oracles have found them.
std::optional<MeshColumns> inside_by_oracles(const RunRow& row) {
  const auto verdict = nlohmann::json::parse(row.verdict_json, nullptr, false);
  if (!row.mesh || !verdict.is_object() || !verdict.contains("oracles")) return std::nullopt;
  for (const auto& oracle : verdict["oracles"]) {
    if (oracle.value("name", "") != "angles" ||
        oracle.value("checked_what", "") != "tetrahedra inside" ||
        oracle.value("checked", std::uint64_t{0}) == row.mesh->tetrahedra) {
      continue;
    }
    const auto& figures = oracle.at("figures");
    MeshColumns inside = *row.mesh;
    inside.tetrahedra = oracle.at("checked").get<std::uint64_t>();
    inside.min_dihedral = figures.at("smallest dihedral angle").get<double>();
    inside.min_face_angle = figures.at("smallest face angle").get<double>();
    inside.dihedral_percent = figures.at("1 % quantile of smallest dihedral angles").get<double>();
    inside.mean_gamma = figures.at("mean gamma").get<double>();
    return inside;
  }
  return std::nullopt;
}

bool is_undecided(const RunRow& row) {
  return row.disposition == Disposition::unverified || row.disposition == Disposition::killed;
}

std::vector<RunRow> latest_of(const std::vector<RunRow>& rows) {
  std::map<std::pair<std::string, std::string>, RunRow> chosen;
  for (const RunRow& row : rows) {
    const auto [found, is_new] = chosen.try_emplace({row.key.model_sha256, row.key.mesher}, row);
    const RunRow& before = found->second;
    const bool tells_more =
        solver_columns(row.mesh_json).has_value() && !solver_columns(before.mesh_json);
    if (is_new || is_undecided(before) || tells_more || token_of(before) != token_of(row)) {
      found->second = row;
    }
  }
  std::vector<RunRow> latest;
  for (auto& [key, row] : chosen) latest.push_back(std::move(row));
  return latest;
}

// The number before a unit in what a run says of its limits; nothing if it says 0, which is none.
std::optional<double> limit_of(const RunRow& row, const char* kind_and_unit) {
  std::smatch found;
  if (!std::regex_search(row.key.limits, found, std::regex(kind_and_unit))) return std::nullopt;
  const double value = std::stod(found[1]);
  return value > 0 ? std::optional(value) : std::nullopt;
}

void leave_out(const std::vector<std::string>& meshers, Selection& selection) {
  for (const std::string& mesher : meshers) {
    selection.runs.erase(mesher);
    std::erase(selection.meshers, mesher);
  }
  std::erase_if(selection.models, [&](const std::string& model) {
    return std::all_of(selection.meshers.begin(), selection.meshers.end(),
                       [&](const auto& m) { return selection.run(m, model) == nullptr; });
  });
}

struct EqualLimits {
  std::optional<double> seconds, mebibytes;
  std::size_t kinds = 0;
  std::map<std::string, std::size_t> own;  // successes of meshers under their own limits
};

// A run that ended below a limit would have ended in the same way under it.
EqualLimits make_limits_equal(Selection& selection) {
  EqualLimits least;
  std::set<std::string> kinds;
  const auto for_each = [&](auto visit) {
    for (auto& [mesher, runs] : selection.runs) {
      for (auto& [model, row] : runs) visit(row);
    }
  };
  for (const std::string& mesher : selection.meshers) {
    least.own[mesher] = selection.ok_runs(mesher).size();
  }
  for_each([&](const RunRow& row) {
    if (!kinds.insert(row.key.limits).second) return;
    const auto lower = [](std::optional<double>& value, std::optional<double> other) {
      if (other && (!value || *other < *value)) value = other;
    };
    lower(least.seconds, limit_of(row, "\\bcpu ([0-9.]+) s\\b"));
    lower(least.mebibytes, limit_of(row, "\\bmemory ([0-9.]+) MiB\\b"));
  });
  least.kinds = kinds.size();
  for_each([&](RunRow& row) {
    const bool late = least.seconds && row.cpu_seconds > *least.seconds;
    const double used = static_cast<double>(row.peak_rss_bytes) * 0x1p-20;
    if (!late && !(least.mebibytes && used > *least.mebibytes)) return;
    row.disposition = late ? Disposition::timeout : Disposition::out_of_memory;
    row.reason = "above the common limit";
  });
  return least;
}

std::string without_returns(std::string text) {
  std::erase(text, '\r');
  return text;
}

void write_new(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

std::string by_hand(const fs::path& page) {
  std::ifstream file(page, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto mark = text.find(kByHand);
  return mark == std::string::npos ? std::string(kByHand) + "\n" : text.substr(mark);
}

// Without the columns that say nothing of any mesher, and those named.
std::string section(Table table, const std::vector<std::string>& left_out = {}) {
  for (std::size_t i = table.header.size(); i-- > 1;) {
    const bool tells = std::any_of(table.rows.begin(), table.rows.end(),
                                   [&](const auto& row) { return row[i] != "-" && row[i] != "0"; });
    if (tells && std::find(left_out.begin(), left_out.end(), table.header[i]) == left_out.end()) {
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(i);
    table.header.erase(table.header.begin() + at);
    for (auto& row : table.rows) row.erase(row.begin() + at);
  }
  return table.rows.empty() ? "" : to_markdown(table).substr(1);
}

// Who succeeds, how good, how heavy: the columns of the others that one reads first.
Table short_table(const Selection& selection, const EqualLimits& limits) {
  const Table league = league_table(selection), pairs = pair_table(selection);
  Table table;
  table.title = "Success, shape, weight, time";
  table.header = {"Mesher", "Promise", "Models", "Ok, % (95 % interval)", "Wrong"};
  const std::vector<std::string> taken = {
      "Mesher",       "Promise",      "Runs",      "Ok, % (95 % interval)",
      "wrong-result", "min dihedral", "mean gamma"};
  const auto cell = [](const Table& of, const std::vector<std::string>& row,
                       const std::string& head) {
    const auto at = std::find(of.header.begin(), of.header.end(), head) - of.header.begin();
    return row[static_cast<std::size_t>(at)];
  };
  const std::vector<std::string> ratios = {"tets, it / ours", "s, it / ours"};
  table.header.insert(table.header.end(), {"Smallest dihedral", "Mean gamma"});
  table.header.insert(table.header.end(), ratios.begin(), ratios.end());
  if (limits.kinds > 1) table.header.emplace_back("Ok under its own limits");
  for (const auto& row : league.rows) {
    auto& cells = table.rows.emplace_back();
    for (const std::string& head : taken) cells.push_back(cell(league, row, head));
    const auto pair = std::find_if(pairs.rows.begin(), pairs.rows.end(),
                                   [&](const auto& other) { return other[0] == row[0]; });
    for (const std::string& head : ratios) {
      cells.push_back(pair == pairs.rows.end() ? "1" : cell(pairs, *pair, head));
    }
    if (limits.kinds > 1) cells.push_back(std::to_string(limits.own.at(row[0])));
  }
  return table;
}

// The limits under which runs are compared, as words.
std::string under(const EqualLimits& limits) {
  if (limits.kinds <= 1) return "the same limits";
  std::vector<std::string> least;
  if (limits.seconds) least.push_back(fmt::format("{:g} s of processor time", *limits.seconds));
  if (limits.mebibytes) least.push_back(fmt::format("{:g} MiB", *limits.mebibytes));
  if (least.empty()) return "limits that differ";
  return fmt::format(
      "limits that differ: what took more than the least of them, {}, counts as if it had met them",
      fmt::join(least, " and "));
}

// What one reads in three minutes. The pictures are those of docs/pictures/league.py, if they are
// there.
std::string page_of(const Selection& selection, const EqualLimits& limits, const fs::path& page) {
  std::size_t runs = 0;
  for (const std::string& mesher : selection.meshers) runs += run_count(selection, mesher);
  const auto complete = std::count_if(
      selection.models.begin(), selection.models.end(), [&](const std::string& model) {
        return std::all_of(selection.meshers.begin(), selection.meshers.end(),
                           [&](const auto& m) { return selection.run(m, model) != nullptr; });
      });
  const std::string stem = page.stem().string();
  std::string text = fmt::format(
      "# The league\n\n{} models, {} meshers, {} runs ({} models have a run of each), one process "
      "each on one thread, under {}, judged by the same oracles. Ok: the oracles have nothing "
      "against the mesh, as measured by what the mesher promises. Medians of its own successes; "
      "the last columns are medians over the models on which ours succeeds, too.\n\n",
      selection.models.size(), selection.meshers.size(), runs, complete, under(limits));
  text += section(short_table(selection, limits));
  for (const char* name : {"success", "time", "shape"}) {
    const std::string picture = fmt::format("pictures/{}-{}", stem, name);
    if (!fs::exists(page.parent_path() / (picture + "-light.png"))) continue;
    text += fmt::format(
        "\n<picture><source media=\"(prefers-color-scheme: dark)\" srcset=\"{0}-dark.png\"><img "
        "alt=\"{1} of the meshers\" src=\"{0}-light.png\"></picture>\n",
        picture, name);
  }
  return text + fmt::format(
                    "\n[All tables]({0}_tables.md) · [run by run]({0}.csv) · [versions, flags and "
                    "limits]({0}_meshers.csv). `ci/league` runs it on any collection; `tetproof "
                    "report --league` writes these files.\n\n",
                    stem);
}

// What the page does not have.
std::string tables_of(const Selection& selection, const EqualLimits& limits,
                      const Families& families) {
  Table league = league_table(selection);
  league.caption = "Under " + under(limits) + ".";
  std::string text = "# Tables of the league\n\n" +
                     section(league, {"Promise", "Runs", "Ok, % (95 % interval)", "wrong-result",
                                      "min dihedral", "mean gamma"});
  for (const Table& table : group_tables(selection)) text += section(table);
  return text +
         section(pair_table(selection),
                 {"Models", "tets, it / ours", "s, it / ours", "MB, it / ours"}) +
         section(family_table(selection, families)) + section(failure_kinds(selection)) +
         section(solver_table(selection));
}

}  // namespace

std::vector<RunRow> read_league(const fs::path& csv) {
  const fs::path beside = meshers_beside(csv);
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> meshers;
  for (auto& row : rows_of(beside, kMesherHead)) meshers[{row[0], row[1]}] = row;
  std::vector<RunRow> rows;
  for (const auto& cells : rows_of(csv, kRunHead)) {
    const auto mesher = meshers.find({cells[2], cells[3]});
    if (mesher == meshers.end()) {
      throw std::runtime_error(
          fmt::format("{}: no row for {} of version {}", beside.string(), cells[2], cells[3]));
    }
    rows.push_back(row_of(cells, mesher->second, csv.string() + ": " + cells[0]));
  }
  return rows;
}

void write_league(const std::vector<fs::path>& campaigns, const fs::path& page,
                  const LeagueOptions& options) {
  std::vector<RunRow> rows;
  for (const fs::path& campaign : campaigns) {
    const bool is_page = campaign.extension() == ".csv";
    for (RunRow& row : is_page ? read_league(campaign) : read_rows(campaign)) {
      if (!is_page && is_ours(row.key.mesher) && !options.commit.empty()) {
        row.key.version += " of " + options.commit;
      }
      row.key.model_sha256 = row.key.model_sha256.substr(0, kHashDigits);
      if (!is_page && !row.inside) row.inside = inside_by_oracles(row);
      row.started.clear();  // the order of the campaigns counts
      rows.push_back(row);
    }
  }
  if (rows.empty()) throw std::runtime_error("no runs");
  Selection selection = select_runs(latest_of(rows));
  use_processor_time(selection);
  Table runs, meshers;
  runs.header = kRunHead;
  meshers.header = kMesherHead;
  std::set<std::vector<std::string>> known;
  for (const std::string& model : selection.models) {
    for (const std::string& mesher : selection.meshers) {
      const RunRow* row = selection.run(mesher, model);
      if (row == nullptr) continue;
      runs.rows.push_back(cells_of(*row));
      known.insert({mesher, token_of(*row), row->key.version, row->key.flags, row->promise,
                    row->key.limits});
    }
  }
  // Of builds of one commit the first stands for all.
  for (const auto& row : known) {
    if (meshers.rows.empty() || meshers.rows.back()[0] != row[0] ||
        meshers.rows.back()[1] != row[1]) {
      meshers.rows.push_back(row);
    }
  }
  leave_out(options.left_out, selection);
  if (selection.models.empty()) throw std::runtime_error("no runs");
  const EqualLimits limits = make_limits_equal(selection);
  const fs::path csv = fs::path(page).replace_extension(".csv");
  // All of them or none.
  const std::pair<fs::path, std::string> files[] = {
      {csv, without_returns(to_csv(runs))},
      {meshers_beside(csv), without_returns(to_csv(meshers))},
      {fs::path(page).replace_extension().string() + "_tables.md",
       tables_of(selection, limits, options.families)},
      {page, page_of(selection, limits, page) + by_hand(page)}};
  for (const auto& [path, contents] : files) {
    if (fs::is_directory(path)) throw std::runtime_error(path.string() + ": is a folder");
    write_new(path.string() + ".new", contents);
  }
  for (const auto& [path, contents] : files) fs::rename(path.string() + ".new", path);
}

}  // namespace tetproof
