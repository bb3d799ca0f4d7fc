#include "reports/export.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "reports/measures.h"
#include "reports/table.h"
#include "reports/text.h"

namespace tetproof {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "tetproof-runs";
constexpr int kFormatVersion = 1;

Json parsed(const std::string& text) {
  return text.empty() ? Json() : Json::parse(text, nullptr, false);
}

// The part of a verdict that a comparison needs: which oracle passed, how far the surface as
// written is off, and the figures that a gate compares.
Json brief_verdict(const std::string& text) {
  const Json full = parsed(text);
  if (!full.is_object()) return nullptr;
  Json result = Json::object();
  for (const char* key : {"verdict", "unproven", "deviation_ulps", "error"}) {
    if (full.contains(key)) result[key] = full.at(key);
  }
  for (const Json& oracle : full.value("oracles", Json::array())) {
    Json& entry = result["oracles"].emplace_back(
        Json({{"name", oracle.value("name", "")}, {"passed", oracle.value("passed", false)}}));
    const Json figures = oracle.value("figures", Json::object());
    for (const char* figure : {"smallest face angle", "input vertices moved"}) {
      if (figures.contains(figure)) entry["figures"][figure] = figures.at(figure);
    }
  }
  return result;
}

void drop_histograms(Json& part) {
  part.erase("face_angle_histogram");
  part.erase("dihedral_histogram");
}

Json brief_mesh(const std::string& text) {
  Json mesh = parsed(text);
  if (!mesh.is_object()) return nullptr;
  // The inner part first: erasing moves the members behind.
  if (mesh.contains("inside")) drop_histograms(mesh["inside"]);
  drop_histograms(mesh);
  return mesh;
}

// The part of a mesher's own statistics that a comparison needs: its settings, and the refined
// mesh.
Json brief_stats(const std::string& text) {
  const Json stats = parsed(text);
  Json result = Json::object();
  if (!stats.is_object()) return result;
  if (stats.contains("parameters")) result["parameters"] = stats.at("parameters");
  if (stats.contains("refined")) result["refined"] = brief_mesh(stats.at("refined").dump());
  return result;
}

template <typename T>
void put(Json& json, const char* key, const std::optional<T>& value) {
  if (value) json[key] = *value;
}

void put_measurements(Json& json, const RunRow& row, bool brief) {
  json["wall_seconds"] = row.wall_seconds;
  json["cpu_seconds"] = row.cpu_seconds;
  put(json, "mesh_seconds", row.mesh_seconds);
  put(json, "verify_seconds", row.verify_seconds);
  json["peak_rss_bytes"] = row.peak_rss_bytes;
  json["started"] = row.started;
  if (brief) return;
  json["model_path"] = row.model_path;
  json["command"] = row.command;
  json["host"] = row.host;
  if (!row.mesh_path.empty()) json["mesh_path"] = row.mesh_path;
}

Json to_object(const RunRow& row, const ExportOptions& options) {
  Json json = {{"model", row.model_name},
               {"model_sha256", row.key.model_sha256},
               {"model_bytes", row.model_bytes},
               {"mesher", row.key.mesher},
               {"version", row.key.version},
               {"flags", row.key.flags},
               {"limits", row.key.limits},
               {"disposition", disposition_name(row.disposition)},
               {"reason", row.reason}};
  put(json, "exit_code", row.exit_code);
  put(json, "signal", row.signal);
  json["region"] = row.region;
  if (!row.promise.empty()) json["promise"] = row.promise;
  put(json, "inverted", row.inverted);
  put(json, "flat", row.flat);
  const bool brief = options.brief;
  if (!row.mesh_json.empty()) {
    json["mesh"] = brief ? brief_mesh(row.mesh_json) : parsed(row.mesh_json);
  }
  if (!row.verdict_json.empty()) {
    json["verdict"] = brief ? brief_verdict(row.verdict_json) : parsed(row.verdict_json);
  }
  if (!options.stable) put_measurements(json, row, brief);
  if (brief && !row.stats_json.empty()) json["stats"] = brief_stats(row.stats_json);
  if (brief || options.stable) return json;
  if (row.disposition != Disposition::ok) json["kind"] = failure_kind(row);
  if (!row.stats_json.empty()) json["stats"] = parsed(row.stats_json);
  json["stderr_tail"] = row.stderr_tail;
  json["stdout_tail"] = row.stdout_tail;
  return json;
}

template <typename T>
void get(const Json& json, const char* key, T& value) {
  if (json.contains(key)) value = json.at(key).get<T>();
}

template <typename T>
void get(const Json& json, const char* key, std::optional<T>& value) {
  if (json.contains(key)) value = json.at(key).get<T>();
}

std::string member_text(const Json& json, const char* key) {
  return json.contains(key) && !json.at(key).is_null() ? json.at(key).dump() : "";
}

RunRow from_object(const Json& json) {
  RunRow row;
  row.model_name = json.at("model").get<std::string>();
  row.key = {json.at("model_sha256").get<std::string>(), json.at("mesher").get<std::string>(),
             json.at("version").get<std::string>(), json.at("flags").get<std::string>(),
             json.at("limits").get<std::string>()};
  row.disposition = disposition_from_name(json.at("disposition").get<std::string>());
  get(json, "model_bytes", row.model_bytes);
  get(json, "reason", row.reason);
  get(json, "exit_code", row.exit_code);
  get(json, "signal", row.signal);
  get(json, "region", row.region);
  get(json, "promise", row.promise);
  get(json, "inverted", row.inverted);
  get(json, "flat", row.flat);
  get(json, "wall_seconds", row.wall_seconds);
  get(json, "cpu_seconds", row.cpu_seconds);
  get(json, "mesh_seconds", row.mesh_seconds);
  get(json, "verify_seconds", row.verify_seconds);
  get(json, "peak_rss_bytes", row.peak_rss_bytes);
  get(json, "model_path", row.model_path);
  get(json, "command", row.command);
  get(json, "host", row.host);
  get(json, "started", row.started);
  get(json, "mesh_path", row.mesh_path);
  get(json, "stderr_tail", row.stderr_tail);
  get(json, "stdout_tail", row.stdout_tail);
  row.mesh_json = member_text(json, "mesh");
  row.verdict_json = member_text(json, "verdict");
  row.stats_json = member_text(json, "stats");
  row.mesh = mesh_columns(row.mesh_json, "");
  row.inside = mesh_columns(row.mesh_json, "inside");
  row.refined = mesh_columns(row.stats_json, "refined");
  demand_verdict(row);
  return row;
}

std::string junit_case(const RunRow& row) {
  const std::string start =
      fmt::format("    <testcase classname=\"tetproof.{}\" name=\"{}\" time=\"{:.3f}\"",
                  markup_text(row.key.mesher), markup_text(row.model_name), row.wall_seconds);
  if (row.disposition == Disposition::ok) return start + "/>\n";
  // JUnit's error is a test that could not be completed; nothing is known of the mesh then.
  const char* element = row.disposition == Disposition::unverified ? "error" : "failure";
  return start + fmt::format(
                     ">\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n"
                     "    </testcase>\n",
                     element, disposition_name(row.disposition), markup_text(row.reason),
                     markup_text("model " + row.key.model_sha256 + "\n" + row.command + "\n" +
                                 row.stderr_tail));
}

std::vector<std::string> csv_header(const ExportOptions& options) {
  std::vector<std::string> header = {"model",
                                     "model_sha256",
                                     "mesher",
                                     "version",
                                     "flags",
                                     "limits",
                                     "disposition",
                                     "reason",
                                     "exit_code",
                                     "signal",
                                     "verdict",
                                     "region",
                                     "promise",
                                     "vertices",
                                     "tetrahedra",
                                     "inside_tetrahedra",
                                     "min_face_angle",
                                     "max_face_angle",
                                     "min_dihedral",
                                     "max_dihedral",
                                     "share_below_5_degrees",
                                     "share_below_10_degrees",
                                     "dihedral_1_percent",
                                     "min_gamma",
                                     "mean_gamma",
                                     "gamma_1_percent",
                                     "min_sicn",
                                     "mean_sicn",
                                     "inside_min_face_angle",
                                     "inverted",
                                     "flat"};
  if (options.stable) return header;
  for (const char* name : {"refined_min_face_angle", "wall_seconds", "cpu_seconds", "mesh_seconds",
                           "verify_seconds", "peak_rss_bytes", "us_per_tetrahedron",
                           "peak_bytes_per_tetrahedron", "host", "started", "command"}) {
    header.emplace_back(name);
  }
  return header;
}

std::vector<std::string> csv_row(const RunRow& row, const ExportOptions& options) {
  const auto text = [](const auto& value) { return value ? fmt::format("{}", *value) : ""; };
  const auto of = [](const std::optional<MeshColumns>& mesh, auto member) {
    return mesh ? fmt::format("{}", (*mesh).*member) : "";
  };
  // Empty in results of versions that did not measure it.
  const auto told = [&](std::optional<double> MeshColumns::*member) {
    return row.mesh ? text((*row.mesh).*member) : "";
  };
  std::vector<std::string> cells = {row.model_name,
                                    row.key.model_sha256,
                                    row.key.mesher,
                                    row.key.version,
                                    row.key.flags,
                                    row.key.limits,
                                    disposition_name(row.disposition),
                                    row.reason,
                                    text(row.exit_code),
                                    text(row.signal),
                                    verdict_of(row),
                                    row.region,
                                    row.promise,
                                    of(row.mesh, &MeshColumns::vertices),
                                    of(row.mesh, &MeshColumns::tetrahedra),
                                    of(row.inside, &MeshColumns::tetrahedra),
                                    of(row.mesh, &MeshColumns::min_face_angle),
                                    of(row.mesh, &MeshColumns::max_face_angle),
                                    of(row.mesh, &MeshColumns::min_dihedral),
                                    of(row.mesh, &MeshColumns::max_dihedral),
                                    told(&MeshColumns::share_below_5),
                                    told(&MeshColumns::share_below_10),
                                    told(&MeshColumns::dihedral_percent),
                                    told(&MeshColumns::min_gamma),
                                    told(&MeshColumns::mean_gamma),
                                    told(&MeshColumns::gamma_percent),
                                    told(&MeshColumns::min_sicn),
                                    told(&MeshColumns::mean_sicn),
                                    of(row.inside, &MeshColumns::min_face_angle),
                                    text(row.inverted),
                                    text(row.flat)};
  if (options.stable) return cells;
  const bool counted = row.mesh && row.mesh->tetrahedra > 0;
  const auto per_tetrahedron = [&](double amount) {
    return counted ? fmt::format("{}", amount / static_cast<double>(row.mesh->tetrahedra)) : "";
  };
  for (std::string& cell : std::vector<std::string>{
           of(row.refined, &MeshColumns::min_face_angle), fmt::format("{}", row.wall_seconds),
           fmt::format("{}", row.cpu_seconds), text(row.mesh_seconds), text(row.verify_seconds),
           fmt::format("{}", row.peak_rss_bytes), per_tetrahedron(1e6 * row.wall_seconds),
           per_tetrahedron(static_cast<double>(row.peak_rss_bytes)), row.host, row.started,
           row.command}) {
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace

std::string rows_to_csv(std::vector<RunRow> rows, const ExportOptions& options) {
  sort_rows(rows);
  Table table;
  table.header = csv_header(options);
  for (const RunRow& row : rows) table.rows.push_back(csv_row(row, options));
  return to_csv(table);
}

std::string rows_to_json(std::vector<RunRow> rows, const ExportOptions& options) {
  sort_rows(rows);
  // One row a line, so that two exports can be compared by eye and in version control.
  std::string text =
      fmt::format("{{\"format\": \"{}\", \"version\": {}, \"rows\": [", kFormat, kFormatVersion);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") +
            to_object(rows[i], options).dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return text + "\n]}\n";
}

std::string rows_to_junit(std::vector<RunRow> rows) {
  sort_rows(rows);
  struct Suite {
    std::size_t tests = 0, failures = 0, errors = 0;
    double seconds = 0;
    std::string cases;
  };
  std::map<std::string, Suite> suites;
  for (const RunRow& row : rows) {
    Suite& suite = suites[row.key.mesher];
    ++suite.tests;
    const bool unverified = row.disposition == Disposition::unverified;
    suite.errors += unverified;
    suite.failures += row.disposition != Disposition::ok && !unverified;
    suite.seconds += row.wall_seconds;
    suite.cases += junit_case(row);
  }
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const auto& [mesher, suite] : suites) {
    text += fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" "
        "time=\"{:.3f}\">\n{}  </testsuite>\n",
        markup_text(mesher), suite.tests, suite.failures, suite.errors, suite.seconds, suite.cases);
  }
  return text + "</testsuites>\n";
}

std::vector<RunRow> rows_from_json(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("format", "") != kFormat) {
    throw std::runtime_error("not an export of tetproof in JSON");
  }
  if (json.value("version", 0) != kFormatVersion) {
    throw std::runtime_error("an export of another version");
  }
  std::vector<RunRow> rows;
  try {
    for (const Json& row : json.at("rows")) rows.push_back(from_object(row));
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("a row is malformed: ") + error.what());
  }
  return rows;
}

std::vector<RunRow> read_rows(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be opened");
  if (file.peek() != '{') return ResultsDatabase(path, ResultsDatabase::Mode::read).rows();
  try {
    return rows_from_json({std::istreambuf_iterator<char>(file), {}});
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

}  // namespace tetproof
