#include "reports/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "reports/assets.h"
#include "reports/compare.h"
#include "reports/measures.h"
#include "reports/series_style.h"
#include "reports/text.h"

namespace tetproof {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kPhases = {"read",     "check",  "filter", "chamfer", "delaunay",
                                "segments", "facets", "refine", "enrich",  "classify",
                                "improve",  "round",  "write"};

// Inside a script element only "</" and "<!--" matter.
std::string for_script(std::string text) {
  for (auto at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (at + 1 < text.size() && (text[at + 1] == '/' || text[at + 1] == '!')) {
      text.replace(at, 1, "\\u003c");
    }
  }
  return text;
}

std::string dump(const Json& json) {
  return for_script(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

// Keeps words with hyphens, such as the names of meshers, on one line. A text that is longer than a
// line of a phone, such as a path, may break.
std::string whole_words(const std::string& text) {
  constexpr std::size_t kLongest = 36;
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t start = std::min(text.find_first_not_of(" \n\t", at), text.size());
    const std::size_t end = std::min(text.find_first_of(" \n\t", start), text.size());
    const std::string word = text.substr(start, end - start);
    const bool keep = word.size() <= kLongest && word.find('-') != std::string::npos &&
                      word.find_first_not_of('-') != std::string::npos;
    result += text.substr(at, start - at);
    if (word.starts_with("https://")) {
      const std::string host = word.substr(8, word.find('/', 8) - 8);
      result += "<a href=\"" + markup_text(word) + "\">" + markup_text(host) + "</a>";
      at = end;
      continue;
    }
    result += keep ? "<span class=\"whole\">" + markup_text(word) + "</span>" : markup_text(word);
    at = end;
  }
  return result;
}

// Numbers stand on the right; words, which need room, on the left.
bool is_words(const std::string& cell) {
  const auto letters =
      std::count_if(cell.begin(), cell.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  return letters > 3 && 2 * static_cast<std::size_t>(letters) > cell.size();
}

// Commands fold away.
std::string folded(const std::string& text) {
  constexpr std::size_t kShort = 28;
  if (text.size() <= kShort) return "<code class=\"whole\">" + markup_text(text) + "</code>";
  return "<details class=\"fold\"><summary>command</summary><code>" + markup_text(text) +
         "</code></details>";
}

std::string header_row(const Table& table) {
  std::string row = "<tr>";
  for (const std::string& cell : table.header) row += "<th>" + whole_words(cell) + "</th>";
  return row + "</tr>\n";
}

bool has_words(const Table& table, std::size_t column) {
  const auto words = std::count_if(table.rows.begin(), table.rows.end(), [&](const auto& row) {
    return column < row.size() && is_words(row[column]);
  });
  return 3 * static_cast<std::size_t>(words) > table.rows.size();
}

std::string table_row(const Table& table, const std::vector<std::string>& cells) {
  std::string row = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& fold = table.folded_columns;
    if (std::find(fold.begin(), fold.end(), i) != fold.end()) {
      row += "<td class=\"text\">" + folded(cells[i]) + "</td>";
      continue;
    }
    // A column of numbers keeps its side for a word among them. Sentences have room.
    constexpr std::size_t kLong = 30;
    const bool sentence = std::count(cells[i].begin(), cells[i].end(), ' ') > 3;
    const char* kind = sentence && cells[i].size() > kLong           ? " class=\"text prose\""
                       : !is_words(cells[i]) || !has_words(table, i) ? ""
                       : sentence                                    ? " class=\"text prose\""
                                                                     : " class=\"text\"";
    row += fmt::format("<td{}>{}</td>", kind, whole_words(cells[i]));
  }
  return row + "</tr>\n";
}

// An image cannot run what somebody else's results may hold.
std::string picture_row(const Table& table, const std::string& svg) {
  if (svg.empty()) return {};
  return fmt::format(
      "<tr><td class=\"text\" colspan=\"{}\"><details><summary>The place</summary><img alt=\"The "
      "place\" loading=\"lazy\" src=\"data:image/svg+xml;base64,{}\"></details></td></tr>\n",
      table.header.size(), base64(svg.data(), svg.size()));
}

std::string notes_list(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string text = "<ul class=\"notes\">";
  for (const std::string& note : notes) text += "<li>" + whole_words(note) + "</li>\n";
  return text + "</ul>\n";
}

std::string chart_html(const Chart& chart) {
  const bool tall = chart.kind != Chart::Kind::bars;
  return fmt::format(
      "<div class=\"chart{}\"><h3>{}</h3><div class=\"frame\" data-chart=\"{}\"></div></div>\n",
      tall ? " tall" : "", markup_text(chart.title), markup_text(chart.name));
}

// A table whose notes are shown on request, so that more fits on a screen.
std::string compact_html(const Table& table) {
  Table bare = table;
  bare.notes.clear();
  std::string text = to_html(bare);
  const std::string notes =
      "<details><summary>Notes</summary>" + notes_list(table.notes) + "</details>\n";
  if (!table.notes.empty()) text.insert(text.rfind("</div>"), notes);
  return text;
}

// The text in the place of charts that cannot be drawn.
std::string chart_list(const std::vector<Chart>& charts) {
  std::string text =
      "<p class=\"faint\">Not drawn, as this build lacks Chart.js; the numbers are in ";
  for (const Chart& chart : charts) {
    text += (&chart == &charts.front() ? "" : ", ") +
            ("<code>" + markup_text(chart.name) + ".csv</code>");
  }
  return text + ".</p>\n";
}

std::string section_html(const Section& section, bool has_charts) {
  std::string text =
      fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", section.id, markup_text(section.title));
  if (!section.text.empty()) text += "<p class=\"faint\">" + whole_words(section.text) + "</p>\n";
  std::string tables;
  for (const Table& table : section.tables) {
    tables += section.side_by_side ? compact_html(table) : to_html(table);
  }
  if (section.side_by_side) tables = "<div class=\"beside\">" + tables + "</div>\n";
  if (section.folded) {
    tables = "<details><summary>Show the tables</summary>" + tables + "</details>\n";
  }
  std::string charts, notes;
  for (const Chart& chart : section.charts) charts += chart_html(chart);
  if (!charts.empty() && !has_charts)
    return text + tables + chart_list(section.charts) + "</section>\n";
  if (!charts.empty()) charts = "<div class=\"columns\">" + charts + "</div>\n";
  for (const Chart& chart : section.charts) {
    if (!chart.notes.empty() && notes.empty()) notes = notes_list(chart.notes);
  }
  return text + tables + charts + notes + "</section>\n";
}

Json number_or_null(const std::optional<double>& value) {
  return value ? Json(std::stod(fmt::format("{:.6g}", *value))) : Json();
}

Json phases_of(const RunRow& row) {
  const Json json = Json::parse(row.stats_json, nullptr, false);
  if (!json.is_object() || !json.contains("phases_seconds")) return {};
  if (!json.at("phases_seconds").contains("refine")) return {};
  Json seconds = Json::array();
  for (const char* phase : kPhases) {
    seconds.push_back(number_or_null(json.at("phases_seconds").value(phase, 0.0)));
  }
  return seconds;
}

// In percent. Only for runs with 3D parts, because the page would be large with all of them.
Json histogram_of(const RunRow& row, const char* key) {
  const Json json = Json::parse(row.mesh_json, nullptr, false);
  if (!json.is_object() || !json.contains(key)) return {};
  double total = 0;
  for (const Json& count : json.at(key)) total += count.get<double>();
  Json percent = Json::array();
  for (const Json& count : json.at(key)) {
    percent.push_back(number_or_null(total > 0 ? 100 * count.get<double>() / total : 0));
  }
  return percent;
}

// The verdict, and which oracles it failed.
std::string verdict_text(const RunRow& row) {
  std::string text = verdict_of(row);
  const Json json = Json::parse(row.verdict_json, nullptr, false);
  if (!json.is_object()) return text;
  for (const Json& oracle : json.value("oracles", Json::array())) {
    if (!oracle.value("passed", true)) text += ", not " + oracle.value("name", "?");
  }
  if (json.contains("error") && json.at("error").is_string())
    text += ": " + json.value("error", "");
  return text;
}

Json run_json(const RunRow& row, std::size_t model, std::size_t mesher, bool histograms) {
  const auto of_mesh = [&](auto member) -> Json {
    return row.mesh ? number_or_null(static_cast<double>((*row.mesh).*member)) : Json();
  };
  return {model,
          mesher,
          disposition_name(row.disposition),
          verdict_text(row),
          row.reason.substr(0, 300),
          number_or_null(row.wall_seconds),
          number_or_null(row.verify_seconds),
          number_or_null(static_cast<double>(row.peak_rss_bytes) / 1e6),
          of_mesh(&MeshColumns::vertices),
          of_mesh(&MeshColumns::tetrahedra),
          of_mesh(&MeshColumns::min_face_angle),
          of_mesh(&MeshColumns::max_face_angle),
          of_mesh(&MeshColumns::min_dihedral),
          of_mesh(&MeshColumns::max_dihedral),
          of_mesh(&MeshColumns::mean_min_face_angle),
          of_mesh(&MeshColumns::mean_min_dihedral),
          phases_of(row),
          histograms ? histogram_of(row, "face_angle_histogram") : Json(),
          histograms ? histogram_of(row, "dihedral_histogram") : Json(),
          row.region,
          row.command};
}

std::pair<std::string, std::string> first_pair(const Selection& selection) {
  const auto all = pairs_of(selection);
  for (const auto& [first, second] : all) {
    if (first == "tetgen" && second.starts_with("delmesher")) return {first, second};
  }
  return all.empty() ? std::pair<std::string, std::string>() : all.front();
}

Json data_of(const Page& page, const Selection& selection) {
  Json data;
  data["columns"] = {"model",        "mesher",         "disposition",         "verdict",
                     "reason",       "wall_seconds",   "verify_seconds",      "peak_mb",
                     "vertices",     "tetrahedra",     "min_face_angle",      "max_face_angle",
                     "min_dihedral", "max_dihedral",   "mean_min_face_angle", "mean_min_dihedral",
                     "phases",       "face_histogram", "dihedral_histogram",  "region",
                     "command"};
  data["meshers"] = selection.meshers;
  data["phases"] = kPhases;
  data["charts_drawn"] = page.has_charts;
  data["pictures_drawn"] = page.has_pictures;
  data["styles"] = Json::array();
  for (std::size_t i = 0; i < kSeriesStyles; ++i) {
    const SeriesStyle style = series_style(i);
    data["styles"].push_back(
        {fmt::format("#{:06x}", style.light), fmt::format("#{:06x}", style.dark), style.pattern});
  }
  const auto [first, second] = first_pair(selection);
  data["pair"] = {first, second};
  data["models"] = Json::array();
  data["runs"] = Json::array();
  for (std::size_t m = 0; m < selection.models.size(); ++m) {
    const std::string& model = selection.models[m];
    const bool has_view = std::any_of(page.views.begin(), page.views.end(),
                                      [&](const ViewPart& part) { return part.model == m; });
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < selection.meshers.size(); ++i) {
      const RunRow* row = selection.run(selection.meshers[i], model);
      if (row == nullptr) continue;
      bytes = row->model_bytes;
      data["runs"].push_back(run_json(*row, m, i, has_view));
    }
    data["models"].push_back(
        {{"name", selection.model_names.at(model)}, {"sha256", model}, {"bytes", bytes}});
  }
  data["charts"] = Json::array();
  for (const Section& section : page.sections) {
    for (const Chart& chart : section.charts) {
      if (!chart.empty()) data["charts"].push_back(Json::parse(to_json(chart)));
    }
  }
  return data;
}

constexpr const char* kComparison = R"(
<div class="controls">
<label>First <select id="first"></select></label>
<label>Second <select id="second"></select></label>
<label>Measure <select id="measure"></select></label>
<span id="common" class="faint"></span>
</div>
<div class="columns">
<div class="chart tall"><h3>Each common model</h3><div class="frame" id="scatter"></div></div>
<div class="chart tall"><h3>Second against first, quantiles</h3><div class="frame" id="quantiles"></div></div>
</div>
)";

constexpr const char* kModels = R"(
<section id="models">
<h2>Model by model</h2>
<div class="controls"><label>Model <select id="model"></select></label>
<span class="faint">&#9670; with pictures</span></div>
<h3 id="model-name"></h3><p class="faint"><code id="model-facts"></code></p>
<div id="model-3d" hidden>
<div class="controls">
<label>Show <select id="part"></select></label>
<label>Cut across <select id="axis"><option value="0">x</option><option value="1" selected>y</option>
<option value="2">z</option></select></label>
<label>at <input type="range" id="cut" min="0" max="100" value="52"></label>
<label>Bad below <input type="range" id="bad" min="0" max="30" value="5"> <span id="bad-value"></span>&deg;</label>
<label><input type="checkbox" id="inside"> inside only</label>
<label><input type="checkbox" id="edges" checked> edges</label>
<span class="faint">drag to turn, wheel to zoom</span>
</div>
<div class="view" id="view"></div>
</div>
<p class="faint" id="model-no-3d" hidden></p>
<div class="scroll"><table><thead><tr><th>Mesher</th><th>Disposition</th><th>Verdict</th><th>Seconds</th>
<th>Oracles, s</th><th>MB</th><th>Vertices</th><th>Tetrahedra</th><th>Min face</th><th>Max face</th><th>Min dihedral</th>
<th>Max dihedral</th><th>Avg. min face</th><th>Avg. min dihedral</th><th>Reason and command</th></tr></thead>
<tbody id="model-runs"></tbody></table></div>
<div class="columns" id="model-charts">
<div class="chart"><h3>Seconds by phase</h3><div class="frame" id="model-phases"></div></div>
<div class="chart"><h3>Face angles</h3><div class="frame" id="model-faces"></div></div>
<div class="chart"><h3>Dihedral angles</h3><div class="frame" id="model-dihedrals"></div></div>
</div>
</section>
)";

constexpr const char* kGallery = R"(
<section id="figure9">
<h2>Gallery (after Figure 9)</h2>
<p class="faint">The input, a mesh cut open, and only its tetrahedra inside the model where the file tells them; under
each picture the mesher whose mesh it is. Red: a face angle below 5 degrees.</p>
<div class="gallery" id="gallery"></div>
</section>
)";

std::string script(std::string_view text) {
  return "<script>" + std::string(text) + "</script>\n";
}

}  // namespace

std::string to_html(const Table& table) {
  std::string text = fmt::format("<div id=\"table-{}\"><h3>{}</h3>\n", markup_text(table.name),
                                 whole_words(table.title));
  if (!table.caption.empty()) {
    text += "<p class=\"caption\">" + whole_words(table.caption) + "</p>\n";
  }
  if (!table.rows.empty()) {
    const char* kind = table.heat_map ? " class=\"heat\"" : "";
    text += fmt::format("<div class=\"scroll\"><table{}><thead>", kind) + header_row(table) +
            "</thead><tbody>\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      text += table_row(table, table.rows[i]);
      if (i < table.pictures.size()) text += picture_row(table, table.pictures[i]);
    }
    text += "</tbody></table></div>\n";
  }
  return text + notes_list(table.notes) + "</div>\n";
}

namespace {

// The section after which the models come: the figures, where there are any.
const Section& before_models(const std::vector<Section>& sections) {
  const auto figures = std::find_if(sections.begin(), sections.end(),
                                    [](const Section& section) { return section.id == "figures"; });
  return figures == sections.end() ? sections.front() : *figures;
}

}  // namespace

std::string to_html(const Page& page, const Selection& selection) {
  std::string nav, body;
  for (const Section& section : page.sections) {
    nav += fmt::format("<a href=\"#{}\">{}</a>\n", section.id, markup_text(section.title));
    body += section_html(section, page.has_charts);
    if (section.id == "compare" && page.has_charts) {
      body.insert(body.rfind("</section>"), kComparison);
    }
    if (&section == &before_models(page.sections)) {
      if (!page.views.empty()) {
        nav += "<a href=\"#figure9\">Gallery</a>\n";
        body += kGallery;
      }
      nav += "<a href=\"#models\">Models</a>\n";
      body += kModels;
    }
  }
  std::string facts;
  for (const std::string& fact : page.headline) {
    const auto space = std::min(fact.find(' '), fact.size());
    facts += "<li><b>" + markup_text(fact.substr(0, space)) + "</b>" +
             whole_words(fact.substr(space)) + "</li>\n";
  }
  std::string summary;
  for (const std::string& sentence : page.summary) {
    summary += (summary.empty() ? "" : " ") + whole_words(sentence);
  }
  std::vector<std::string> warnings = page.warnings;
  if (!page.has_charts) {
    warnings.emplace_back("No charts: this build lacks Chart.js (Debian: libjs-chart.js).");
  }
  if (!page.has_pictures) {
    warnings.emplace_back(
        "No gallery and no 3D view: this build lacks three.js (Debian: libjs-three).");
  }
  std::string said;
  for (const std::string& warning : warnings) {
    said += "<p class=\"warning\">" + whole_words(warning) + "</p>\n";
  }
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n<nav>\n{}</nav>\n"
      "<header><h1>{}</h1>\n<p class=\"summary\">{}</p>\n<ul class=\"headline\">\n{}</ul>\n{}"
      "<p class=\"not-ok\" id=\"trouble\" hidden></p></header>\n<main>\n{}{}</main>\n",
      markup_text(page.title), assets::page_css(), nav, markup_text(page.title), summary, facts,
      said, body, notes_list(page.notes));
  for (const ViewPart& part : page.views) {
    text += "<script type=\"application/json\" class=\"part\">" + for_script(to_json(part)) +
            "</script>\n";
  }
  text += "<script type=\"application/json\" id=\"data\">" + dump(data_of(page, selection)) +
          "</script>\n";
  if (page.has_charts) text += script(assets::chart_js());
  if (page.has_pictures) text += script(assets::three_js()) + script(assets::orbit_controls_js());
  for (const std::string_view code : {assets::charts_js(), assets::view_js(), assets::page_js()}) {
    text += script(code);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace tetproof
