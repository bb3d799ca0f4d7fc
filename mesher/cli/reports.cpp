#include "mesher/cli/reports.h"

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "mesher/delmesher/option_table.h"
#include "mesher/delmesher/region_name.h"
#include "mesher/io/named_sets.h"
#include "mesher/io/text.h"

namespace delmesher::cli {
namespace {

const char* limit_name(Limit limit) {
  static constexpr const char* kName[] = {"none",   "vertices",  "time",
                                          "memory", "precision", "tetrahedra"};
  return kName[static_cast<std::size_t>(limit)];
}

using Json = nlohmann::ordered_json;

Json mesh_json(const MeshStatistics& s) {
  return {{"vertices", s.vertices},
          {"tetrahedra", s.tetrahedra},
          {"interior_tetrahedra", s.interior_tetrahedra},
          {"min_face_angle", s.min_face_angle},
          {"max_face_angle", s.max_face_angle},
          {"min_dihedral", s.min_dihedral},
          {"max_dihedral", s.max_dihedral},
          {"mean_min_face_angle", s.mean_min_face_angle},
          {"mean_max_face_angle", s.mean_max_face_angle},
          {"mean_min_dihedral", s.mean_min_dihedral},
          {"mean_max_dihedral", s.mean_max_dihedral},
          {"tetrahedra_below_5_degrees", s.below_5},
          {"tetrahedra_below_10_degrees", s.below_10},
          {"dihedral_1_percent", s.dihedral_1_percent},
          {"min_gamma", s.min_gamma},
          {"mean_gamma", s.mean_gamma},
          {"gamma_1_percent", s.gamma_1_percent},
          {"min_sicn", s.min_sicn},
          {"mean_sicn", s.mean_sicn},
          {"face_angle_histogram", s.face_angle_histogram},
          {"dihedral_histogram", s.dihedral_histogram}};
}

Json mesh_json(const PlaneMeshStatistics& s) {
  return {{"vertices", s.vertices},
          {"triangles", s.triangles},
          {"interior_triangles", s.interior_triangles},
          {"edges", s.edges},
          {"min_angle", s.min_angle},
          {"max_angle", s.max_angle},
          {"mean_min_angle", s.mean_min_angle},
          {"mean_max_angle", s.mean_max_angle},
          {"angle_histogram", s.angle_histogram}};
}

Json value_json(const options::Value& option) {
  for (const options::Word& word : option.text.words) {
    if (!word.word.empty() && word.value == option.value) return word.word;
  }
  if (option.kind == options::Kind::on_off) return option.value != 0;
  if (option.kind == options::Kind::count) return static_cast<std::uint64_t>(option.value);
  return option.value;
}

Json parameters_json(const Command& command) {
  static constexpr const char* kJobs[] = {"mesh",    "cdt",    "plane", "check",
                                          "improve", "repair", "remesh"};
  Json parameters = {{"job", kJobs[static_cast<std::size_t>(command.job())]}};
  const auto values =
      std::visit([](const auto& job) { return options::values_of(job); }, command.options);
  for (const options::Value& option : values) {
    const std::string name(option.text.name);
    if (option.is_paper()) {
      Json& choices = parameters["as_paper"];
      if (choices.is_null()) choices = Json::array();
      if (option.value != 0) choices.push_back(options::argument_name(name));
    } else {
      parameters[name] =
          option.kind == options::Kind::sources ? Json(command.sizes_file) : value_json(option);
    }
  }
  if (const auto* mesh = std::get_if<Options>(&command.options)) {
    if (!mesh->region_names.empty()) parameters["regions"] = mesh->region_names;
    if (!mesh->split_wall_names.empty()) parameters["split_walls"] = mesh->split_wall_names;
    for (const RegionSize& size : mesh->region_sizes) {
      parameters["max_edge_in"][size.region] = size.max_edge;
    }
  }
  if (!command.points_file.empty()) parameters["points"] = command.points_file;
  if (command.label_angle > 0) parameters["label_by_angle"] = command.label_angle;
  return parameters;
}

// The first entries of the statistics of every job.
template <class AnyResult>
Json run_json(const Command& command, const AnyResult& result, const RunFacts& facts,
              const char* cell_name) {
  Json phases;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const Phase phase = static_cast<Phase>(i);
    phases[phase_name(phase)] = seconds_of(phase, result.statistics.phase_seconds, facts);
  }
  return {{"input",
           {{"file", command.input},
            {"vertices", facts.input_vertices},
            {cell_name, facts.input_cells},
            {"bbox_diagonal", result.statistics.bbox_diagonal}}},
          {"parameters", parameters_json(command)},
          {"status", status_name(result.status.code)},
          {"phases_seconds", phases},
          {"wall_seconds", facts.wall_seconds},
          {"cpu_seconds", facts.cpu_seconds},
          {"peak_rss_bytes", facts.peak_rss_bytes}};
}

template <class AnyStatistics>
Json rounding_json(const AnyStatistics& s) {
  return {{"inverted", s.rounding_inverted},
          {"flat", s.rounding_flat},
          {"repaired", s.rounding_repaired}};
}

std::string dump(const Json& json) {
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string number(double value) {
  std::string out;
  io::append_double(out, value);
  return out;
}

std::string number_short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::uint64_t total_defects(const SurfaceReport& report) {
  std::uint64_t total = 0;
  for (std::uint64_t count : report.defect_counts) total += count;
  return total;
}

// None where all triangles have one label.
std::vector<LabelledFace> several_faces(const Surface& surface) {
  std::vector<LabelledFace> faces = labelled_faces(surface);
  if (faces.size() == 1) faces.clear();
  return faces;
}

const char* direction_name(const LabelledFace& face) {
  return face.shape == LabelledFace::Shape::planar        ? "normal"
         : face.shape == LabelledFace::Shape::cylindrical ? "axis"
                                                          : "";
}

std::string text_of(const std::array<double, 3>& p, const char* format) {
  char text[96];
  std::snprintf(text, sizeof text, format, p[0] + 0.0, p[1] + 0.0, p[2] + 0.0);  // no -0
  return text;
}

// A table of the first faces.
std::string faces_text(const Surface& surface, const io::LabelNames& names) {
  constexpr std::size_t kMost = 50;
  const std::vector<LabelledFace> faces = several_faces(surface);
  std::string out;
  for (std::size_t n = 0; n < faces.size() && n < kMost; ++n) {
    const LabelledFace& face = faces[n];
    const std::string name = io::label_name(names, face.label);
    const std::string direction =
        face.shape == LabelledFace::Shape::other
            ? ""
            : direction_name(face) + text_of(face.direction, " (%.3f, %.3f, %.3f)");
    char line[160];
    std::snprintf(line, sizeof line, ": %llu triangles, area %.5g, ",
                  static_cast<unsigned long long>(face.triangles), face.area);
    out += "    " + name + line + (direction.empty() ? "" : direction + ", ") + "box " +
           text_of(face.lower, "(%.5g, %.5g, %.5g)") + " to " +
           text_of(face.upper, "(%.5g, %.5g, %.5g)") + "\n";
  }
  if (faces.size() > kMost) {
    out += "    and " + std::to_string(faces.size() - kMost) + " more, see --json\n";
  }
  if (!faces.empty())
    out = "  faces with labels of their own  " + std::to_string(faces.size()) + "\n" + out;
  return out;
}

Json faces_json(const Surface& surface, const io::LabelNames& names) {
  Json faces = Json::array();
  for (const LabelledFace& face : several_faces(surface)) {
    Json json = {{"label", face.label},
                 {"name", io::label_name(names, face.label)},
                 {"triangles", face.triangles},
                 {"area", face.area},
                 {"box", {face.lower, face.upper}}};
    if (face.shape != LabelledFace::Shape::other) json[direction_name(face)] = face.direction;
    faces.push_back(std::move(json));
  }
  return faces;
}

}  // namespace

const char* status_name(StatusCode code) {
  static constexpr const char* kNames[] = {
      "ok",          "invalid-options", "invalid-surface", "limit-reached",
      "interrupted", "internal-error",  "invalid-mesh"};
  return kNames[static_cast<std::size_t>(code)];
}

int exit_code_of(StatusCode code) {
  static constexpr int kCodes[] = {kDone,        kUsage,    kInvalid, kLimit,
                                   kInterrupted, kInternal, kInvalid};
  return kCodes[static_cast<std::size_t>(code)];
}

double seconds_of(Phase phase, const std::array<double, kPhaseCount>& phase_seconds,
                  const RunFacts& facts) {
  if (phase == Phase::read) return facts.read_seconds;
  if (phase == Phase::write) return facts.write_seconds;
  return phase_seconds[static_cast<std::size_t>(phase)];
}

std::string stats_json(const Command& command, const Result& result, const RunFacts& facts) {
  const Statistics& s = result.statistics;
  Json json = run_json(command, result, facts, "triangles");
  json["refined"] = mesh_json(s.refined);
  json["final"] = mesh_json(s.final);
  json["planar"] = {{"facets", s.facets},
                    {"groups", s.planar_groups},
                    {"given_facets", s.given_facets},
                    {"bound", s.planar_bound},
                    {"lines_lost", s.lines_lost},
                    {"deviation", s.planar_deviation},
                    {"diagonals", s.diagonals},
                    {"diagonals_missing", s.diagonals_missing},
                    {"spared", s.diagonals_spared},
                    {"given_up", s.planar_given_up},
                    {"limit", limit_name(s.planar_limit)}};
  json["chosen_size"] = {{"size", s.chosen_size},
                         {"tetrahedra_without", s.tetrahedra_without_size}};
  json["remesh"] = {{"tolerance", s.tolerance}, {"triangles", s.remeshed_triangles}};
  json["filter"] = {{"dropped_triangles", s.dropped_triangles}, {"rounds", s.filter_rounds}};
  json["prediction"] = {{"tetrahedra", s.predicted_tetrahedra}, {"tau", s.tau}};
  json["chamfer"] = {{"acute_vertices", s.acute_vertices}, {"acute_edges", s.acute_edges}};
  json["guarantee"] = {
      {"acute", s.guaranteed_acute}, {"corner", s.guaranteed_corner}, {"gabriel", s.gabriel}};
  for (std::size_t i = 0; i < kRungCount; ++i) {
    json["ladder"][kLadder[i].name] = s.ladder.times[i];
  }
  json["limits"] = {{"refinement_capped", s.refinement_capped},
                    {"cdt_restarts", s.cdt_restarts},
                    {"thinned", s.rounding_thinned}};
  json["steiner"] = {{"on_segments", s.steiner_on_segments},
                     {"on_facets", s.steiner_on_facets},
                     {"in_volume", s.steiner_in_volume},
                     {"in_final_mesh", s.enriched},
                     {"left_on_surface", s.left_on_surface}};
  json["rounding"] = rounding_json(s);
  json["rounding"]["inexact"] = s.rounding_inexact;
  json["rounding"]["signs"] = s.rounding_signs;
  json["rounding"]["thinned"] = s.rounding_thinned;
  json["rounding"]["max_surface_deviation"] = s.max_surface_deviation;
  json["predicates"] = {{"filter", s.predicate_filter},     {"support", s.predicate_by_support},
                        {"extended", s.predicate_extended}, {"fixed", s.predicate_fixed},
                        {"exact", s.predicate_exact},       {"symbolic", s.predicate_symbolic}};
  return dump(json);
}

std::string improve_stats_json(const Command& command, const Result& result,
                               const RunFacts& facts) {
  const Statistics& s = result.statistics;
  Json json = run_json(command, result, facts, "tetrahedra");
  json["given"] = mesh_json(s.refined);
  json["final"] = mesh_json(s.final);
  json["flat"] = s.rounding_flat;
  return dump(json);
}

std::string plane_stats_json(const Command& command, const PlaneResult& result,
                             const RunFacts& facts) {
  const PlaneStatistics& s = result.statistics;
  Json json = run_json(command, result, facts, "segments");
  json["refined"] = mesh_json(s.refined);
  json["final"] = mesh_json(s.final);
  json["filter"] = {{"dropped_segments", s.dropped_segments}, {"rounds", s.filter_rounds}};
  json["chamfer"] = {{"acute_vertices", s.acute_vertices},
                     {"chamfered_segments", s.chamfered_segments}};
  json["guarantee"] = {{"acute", std::get<PlaneOptions>(command.options).acute},
                       {"delta", s.guaranteed_delta}};
  json["steiner"] = {{"on_segments", s.steiner_on_segments}, {"in_faces", s.steiner_in_faces}};
  json["rounding"] = rounding_json(s);
  json["rounding"]["max_segment_deviation"] = s.max_segment_deviation;
  return dump(json);
}

std::string planar_text(const std::string& file, const Statistics& s, bool as_given) {
  const double diagonal = s.bbox_diagonal;
  const std::string facets = file + ": " + std::to_string(s.given_facets) + " facets, ";
  const std::string within =
      " if planar within " + number_short(s.planar_bound / diagonal) + " of the diagonal";
  if (as_given) {
    return facets + std::to_string(s.facets) + within +
           ", as which they were refined; the mesh has all of them";
  }
  return facets + std::to_string(s.facets) + within + "; vertices are up to " +
         number_short(s.planar_deviation / diagonal) +
         " of it from their planes (--planar 0 keeps all facets)";
}

std::string remeshed_text(std::size_t given, std::size_t remeshed, double tolerance) {
  return std::to_string(remeshed) + " triangles in place of " + std::to_string(given) +
         ", within " + number_short(tolerance);
}

std::string kept_text(const std::string& file, const Statistics& s, bool bounds_edges,
                      std::uint64_t budget) {
  const auto predicted = static_cast<std::uint64_t>(s.predicted_tetrahedra);
  return file + ": the surface is kept" + (bounds_edges ? " but for edges that are too long" : "") +
         "; bounded angles (--surface split) would take more than " +
         (budget > 0 ? "the budget" : std::to_string(predicted) + " tetrahedra, as predicted");
}

namespace {

// A sum of roundings.
std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// By number; 0 is the outside.
std::string region_name(const io::LabelNames& names, std::int32_t number) {
  const auto name = names.find(number);
  return number == 0           ? "outside"
         : name != names.end() ? name->second
                               : "region " + std::to_string(number);
}

}  // namespace

io::LabelNames region_names(const std::vector<MeshRegion>& regions, const io::LabelNames& labels) {
  io::LabelNames names;
  for (std::size_t n = 0; n < regions.size(); ++n) {
    std::string name = name_of_region(regions[n], labels);
    if (!name.empty()) names.emplace(static_cast<std::int32_t>(n + 1), std::move(name));
  }
  return io::distinct_names(names);
}

std::string regions_text(const std::string& file, const std::vector<MeshRegion>& regions,
                         const io::LabelNames& names) {
  constexpr std::size_t kMost = 8;
  std::string text =
      file + ": " + std::to_string(regions.size()) + (regions.size() == 1 ? " region" : " regions");
  for (std::size_t n = 0; n < std::min(regions.size(), kMost); ++n) {
    text += (n == 0 ? ": " : ", ") + region_name(names, static_cast<std::int32_t>(n + 1)) +
            " of volume " + rounded(regions[n].volume) +
            (regions[n].tetrahedra == 0 ? " (not written)" : "");
  }
  if (regions.size() > kMost) text += ", and " + std::to_string(regions.size() - kMost) + " more";
  return text;
}

std::vector<std::string> limits_texts(const Statistics& s) {
  std::vector<std::string> texts;
  if (s.ladder[Rung::chamfers_everywhere] > 0) {
    texts.push_back(
        "the refinement would not end: begun anew with empty balls and chamfers up to 90 degrees");
  }
  if (s.planar_given_up || s.ladder[Rung::tetrahedrize_again] > 0) {
    const std::string why = s.diagonals_missing == 0
                                ? "tetrahedra did not fit the surface as given"
                                : std::to_string(s.diagonals_missing) + " of " +
                                      std::to_string(s.diagonals) +
                                      " edges within planar facets found no place";
    texts.push_back(why + (s.planar_given_up ? ": meshed anew without those facets"
                                             : ": tetrahedrized again with the same vertices"));
  }
  if (s.planar_limit != Limit::none) {
    texts.push_back("meshed anew with facets less planar, which ended at the limit of " +
                    std::string(limit_name(s.planar_limit)));
  }
  if (s.refinement_capped) {
    texts.emplace_back(
        "slivers, or angles above the guaranteed ones, were given up at four times the points");
  }
  if (s.left_on_surface > 0) {
    texts.push_back("the surface is kept but for " + std::to_string(s.left_on_surface) +
                    " vertices that found no way off it (--strict makes that a failure)");
  }
  if (s.cdt_restarts > 0) {
    texts.push_back("the constrained tetrahedrization was begun anew " +
                    std::to_string(s.cdt_restarts) + " times");
  }
  if (s.rounding_thinned > 0) {
    texts.push_back(std::to_string(s.rounding_thinned) +
                    " points were taken out where doubles are too coarse for them");
  }
  return texts;
}

namespace {

std::string wall_name(const ComplexReport::Wall& wall, const io::LabelNames& names) {
  const auto& [a, b] = wall.regions;
  return a == b ? region_name(names, a) + " on both sides"  // a sheet
                : region_name(names, a == 0 ? b : a) + "|" + region_name(names, a == 0 ? a : b);
}

std::array<double, 3> middle(const ComplexReport::Open& open) {
  std::array<double, 3> x{};
  for (std::size_t k = 0; k < 3; ++k) x[k] = (open.border[0][k] + open.border[1][k]) / 2;
  return x;
}

std::string open_text(const ComplexReport::Open& open, const io::LabelNames& labels,
                      const io::LabelNames& names) {
  const std::array<double, 3> at = middle(open);
  return "`" + io::label_name(labels, open.label) + "` is open: " +
         (open.region == 0
              ? "one region with the outside, through the gap"
              : region_name(names, open.region) + " is on both of its sides, around the border") +
         " at (" + number(at[0]) + ", " + number(at[1]) + ", " + number(at[2]) + ")";
}

std::string complex_text(const ComplexReport& report, const io::LabelNames& labels) {
  std::string out;
  const io::LabelNames names = region_names(report.regions, labels);
  const auto list = [&](const std::string& title, std::size_t count, const auto& line) {
    constexpr std::size_t kMost = 20;
    if (count > 0) out += "  " + title + ": " + std::to_string(count) + "\n";
    for (std::size_t n = 0; n < std::min(count, kMost); ++n) out += "    " + line(n) + "\n";
    if (count > kMost) out += "    and " + std::to_string(count - kMost) + " more\n";
  };
  list("regions", report.regions.size(), [&](std::size_t n) {
    return region_name(names, static_cast<std::int32_t>(n + 1)) + ", volume " +
           rounded(report.regions[n].volume);
  });
  list("walls", report.walls.size(), [&](std::size_t n) {
    const ComplexReport::Wall& wall = report.walls[n];
    return wall_name(wall, names) + ", area " + rounded(wall.area) + ", " +
           std::to_string(wall.triangles) + (wall.triangles == 1 ? " triangle" : " triangles");
  });
  for (const ComplexReport::Open& open : report.open) {
    out += "  " + open_text(open, labels, names) + "\n";
  }
  return out;
}

void put_complex(const ComplexReport& report, const io::LabelNames& labels, Json& json) {
  if (report.walls.empty()) return;
  const io::LabelNames names = region_names(report.regions, labels);
  Json regions = Json::array(), walls = Json::array(), open = Json::array();
  for (std::size_t n = 0; n < report.regions.size(); ++n) {
    const auto number = static_cast<std::int32_t>(n + 1);
    regions.push_back({{"number", number},
                       {"name", region_name(names, number)},
                       {"volume", report.regions[n].volume}});
  }
  for (const ComplexReport::Wall& wall : report.walls) {
    walls.push_back({{"regions", wall.regions},
                     {"name", wall_name(wall, names)},
                     {"triangles", wall.triangles},
                     {"area", wall.area}});
  }
  for (const ComplexReport::Open& label : report.open) {
    open.push_back({{"name", io::label_name(labels, label.label)},
                    {"label", label.label},
                    {"region", label.region},
                    {"at", middle(label)}});
  }
  json["regions"] = regions;
  json["walls"] = walls;
  json["open"] = open;
}

}  // namespace

std::string check_text(const std::string& file, const Surface& surface, const io::LabelNames& names,
                       const SurfaceReport& report) {
  std::string out = file + ": ";
  out += report.status.ok() ? "a valid surface\n" : "not a valid surface\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    out += "  " + name + std::string(name.size() < 31 ? 31 - name.size() : 1, ' ') + value + "\n";
  };
  line("vertices", std::to_string(report.vertices));
  if (report.unused_vertices > 0) line("unused vertices", std::to_string(report.unused_vertices));
  line("triangles", std::to_string(report.triangles));
  line("components", std::to_string(report.components));
  line("Euler characteristic", std::to_string(report.euler_characteristic));
  line("bounding-box diagonal", number(report.bbox_diagonal));
  if (report.status.ok()) {
    line("volume", number(report.volume));
    line("facets", std::to_string(report.facets));
    if (report.planar_facets < report.facets) {
      line("facets if planar within " + number_short(report.planar_bound / report.bbox_diagonal),
           std::to_string(report.planar_facets));
    }
    line("acute vertices", std::to_string(report.acute_vertices));
    line("acute edges", std::to_string(report.acute_edges));
    line("smallest local feature size", number(report.smallest_local_feature_size));
    out += faces_text(surface, names);
  }
  for (const std::string& warning : report.warnings) out += "  warning: " + warning + "\n";
  for (std::size_t kind = 0; kind < report.defect_counts.size(); ++kind) {
    if (report.defect_counts[kind] == 0) continue;
    out += "  " + std::string(defect_name(static_cast<Defect::Kind>(kind))) + ": " +
           std::to_string(report.defect_counts[kind]) + "\n";
    std::uint64_t listed = 0;
    for (const Defect& defect : report.defects) {
      if (static_cast<std::size_t>(defect.kind) != kind) continue;
      out += "    " + defect.message + "\n";
      ++listed;
    }
    if (listed < report.defect_counts[kind]) {
      out += "    and " + std::to_string(report.defect_counts[kind] - listed) + " more\n";
    }
  }
  out += complex_text(report.complex, names);
  if (!report.status.ok()) {
    for (const std::string& hint : surface_hints(surface, report)) out += "  hint: " + hint + "\n";
  }
  return out;
}

std::string check_json(const std::string& file, const Surface& surface, const io::LabelNames& names,
                       const SurfaceReport& report) {
  Json defects = Json::array(), counts = Json::object();
  for (const Defect& defect : report.defects) {
    Json points = Json::array();
    for (const std::uint32_t v : defect.vertices) {
      if (v < surface.vertices.size()) points.push_back(surface.vertices[v]);
    }
    defects.push_back({{"kind", defect_name(defect.kind)},
                       {"vertices", defect.vertices},
                       {"points", points},
                       {"triangles", defect.triangles},
                       {"message", defect.message}});
  }
  for (std::size_t kind = 0; kind < report.defect_counts.size(); ++kind) {
    if (report.defect_counts[kind] == 0) continue;
    counts[defect_name(static_cast<Defect::Kind>(kind))] = report.defect_counts[kind];
  }
  Json json = {{"file", file},
               {"valid", report.status.ok()},
               {"status", status_name(report.status.code)},
               {"message", report.status.message},
               {"vertices", report.vertices},
               {"unused_vertices", report.unused_vertices},
               {"triangles", report.triangles},
               {"components", report.components},
               {"euler_characteristic", report.euler_characteristic},
               {"flipped", report.flipped},
               {"bbox_diagonal", report.bbox_diagonal}};
  if (report.status.ok()) {
    json["volume"] = report.volume;
    json["facets"] = report.facets;
    json["planar_facets"] = report.planar_facets;
    json["planar_bound"] = report.planar_bound;
    json["acute_vertices"] = report.acute_vertices;
    json["acute_edges"] = report.acute_edges;
    json["smallest_local_feature_size"] = report.smallest_local_feature_size;
    json["faces"] = faces_json(surface, names);
  }
  put_complex(report.complex, names, json);
  json["warnings"] = report.warnings;
  json["defect_count"] = total_defects(report);
  json["defect_counts"] = counts;
  json["defects"] = defects;
  json["hints"] = report.status.ok() ? std::vector<std::string>() : surface_hints(surface, report);
  return dump(json);
}

namespace {

// "segments 3 and 7, at (1, 2)", counted from 0.
std::string graph_defect(const PlanarGraph& graph, GraphDefect kind,
                         const std::array<std::uint32_t, 2>& place) {
  const bool vertices = kind == GraphDefect::equal_vertices;
  const std::uint32_t v = vertices ? place[0] : graph.segments[place[0]][0];
  const std::string items =
      place[0] == place[1] ? " " + std::to_string(place[0])
                           : "s " + std::to_string(place[0]) + " and " + std::to_string(place[1]);
  const std::string name = !vertices              ? "segment" + items
                           : place[0] == place[1] ? "vertex" + items
                                                  : "vertice" + items;
  return name + ", from (" + number(graph.vertices[v][0]) + ", " + number(graph.vertices[v][1]) +
         ")";
}

}  // namespace

std::string graph_text(const std::string& file, const PlanarGraph& graph,
                       const GraphReport& report) {
  std::string out = file + (report.status.ok() ? ": a valid planar graph\n"
                                               : ": not a planar graph that can be meshed\n");
  const auto line = [&](const std::string& name, const std::string& value) {
    out += "  " + name + std::string(31 - name.size(), ' ') + value + "\n";
  };
  line("vertices", std::to_string(graph.vertices.size()));
  line("segments", std::to_string(graph.segments.size()));
  if (report.status.ok()) {
    line("bounding-box diagonal", number(report.bbox_diagonal));
    line("area inside", number(report.area));
  }
  for (const std::string& warning : report.warnings) out += "  warning: " + warning + "\n";
  for (std::size_t kind = 0; kind < kGraphDefects; ++kind) {
    const auto& places = report.places[kind];
    if (places.empty()) continue;
    const auto defect = static_cast<GraphDefect>(kind);
    out += std::string("  ") + defect_name(defect) + ": " + std::to_string(places.size()) + "\n";
    for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), 10); ++i) {
      out += "    " + graph_defect(graph, defect, places[i]) + "\n";
    }
    if (places.size() > 10) out += "    and " + std::to_string(places.size() - 10) + " more\n";
  }
  for (const std::string& hint : report.hints) out += "  hint: " + hint + "\n";
  return out;
}

std::string graph_json(const std::string& file, const PlanarGraph& graph,
                       const GraphReport& report) {
  Json counts = Json::object(), places = Json::object();
  for (std::size_t kind = 0; kind < kGraphDefects; ++kind) {
    if (report.places[kind].empty()) continue;
    const char* name = defect_name(static_cast<GraphDefect>(kind));
    counts[name] = report.places[kind].size();
    places[name] = report.places[kind];
  }
  Json json = {{"file", file},
               {"valid", report.status.ok()},
               {"status", status_name(report.status.code)},
               {"message", report.status.message},
               {"vertices", graph.vertices.size()},
               {"segments", graph.segments.size()},
               {"warnings", report.warnings},
               {"defect_counts", counts},
               {"places", places},
               {"hints", report.hints}};
  if (report.status.ok()) {
    json["bbox_diagonal"] = report.bbox_diagonal;
    json["area"] = report.area;
  }
  return dump(json);
}

namespace {

// ru_maxrss survives exec on Linux: a small run started by a large program would report the
// large one's memory. 0 if this is not Linux.
std::uint64_t peak_since_exec() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
  }
  return 0;
}

}  // namespace

void measure_process(RunFacts& facts) {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  facts.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  facts.peak_rss_bytes = peak_since_exec();
  if (facts.peak_rss_bytes == 0) {
    facts.peak_rss_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // KiB
  }
}

}  // namespace delmesher::cli
