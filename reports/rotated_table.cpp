// Rotated copies beside the models that they are copies of (tetproof rotate).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "reports/measures.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

enum Position : std::size_t { as_given, in_doubles, in_float32, kPositions };
constexpr std::array<const char*, kPositions> kNames = {"as given", "rotated", "rotated, float32"};

// "DIR/NAME@r2s.off" is DIR/NAME in float32.
struct Name {
  std::string model;
  Position position;
};
Name parsed(const std::string& file) {
  const std::string stem = file.substr(0, file.rfind('.'));
  const std::size_t at = stem.rfind("@r");
  if (at == std::string::npos) return {stem, as_given};
  std::string rest = stem.substr(at + 2);
  const bool single = rest.ends_with('s');
  if (single) rest.pop_back();
  const bool number = !rest.empty() && std::all_of(rest.begin(), rest.end(),
                                                   [](char c) { return c >= '0' && c <= '9'; });
  if (!number) return {stem, as_given};
  return {stem.substr(0, at), single ? in_float32 : in_doubles};
}

// The mesh inside the model if both files tell it, because the hull around it depends on the
// position.
const MeshColumns& compared(const RunRow& row, const RunRow& other) {
  return row.inside && other.inside ? *row.inside : *row.mesh;
}

struct Copies {
  std::size_t runs = 0, ok = 0, worse = 0;  // worse: not ok, where the model as given is
  std::uint64_t tetrahedra = 0, given_tetrahedra = 0;
  std::vector<double> sizes, face_angles, dihedrals;  // relative to the model as given
};

void add(const RunRow& row, const RunRow* given, Copies& copies) {
  ++copies.runs;
  const bool ok = row.disposition == Disposition::ok;
  if (ok) ++copies.ok;
  if (given == nullptr || given->disposition != Disposition::ok || !given->mesh) return;
  if (!ok || !row.mesh) {
    ++copies.worse;
    return;
  }
  const MeshColumns &a = compared(*given, row), &b = compared(row, *given);
  copies.tetrahedra += b.tetrahedra;
  copies.given_tetrahedra += a.tetrahedra;
  const auto push = [](double now, double before, std::vector<double>& ratios) {
    if (before > 0) ratios.push_back(now / before);
  };
  push(static_cast<double>(b.tetrahedra), static_cast<double>(a.tetrahedra), copies.sizes);
  push(b.min_face_angle, a.min_face_angle, copies.face_angles);
  push(b.min_dihedral, a.min_dihedral, copies.dihedrals);
}

std::string share_within(const std::vector<double>& ratios, double low, double high) {
  if (ratios.empty()) return "-";
  const auto n =
      std::count_if(ratios.begin(), ratios.end(), [&](double r) { return r >= low && r <= high; });
  return fmt::format("{:.1f} %", 100 * static_cast<double>(n) / static_cast<double>(ratios.size()));
}

std::string ratio(const std::optional<double>& value) {
  return significant(value, 3);
}

// The tetrahedra of all copies together, relative to those of the models as given.
std::optional<double> of_all(const Copies& c) {
  if (c.tetrahedra == 0 || c.given_tetrahedra == 0) return std::nullopt;
  return static_cast<double>(c.tetrahedra) / static_cast<double>(c.given_tetrahedra);
}

std::optional<double> largest(const std::vector<double>& ratios) {
  if (ratios.empty()) return std::nullopt;
  return *std::max_element(ratios.begin(), ratios.end());
}

}  // namespace

Table rotated_table(const Selection& selection) {
  Table table;
  table.name = "rotated";
  table.title = "The same models in other positions";
  table.header = {"Mesher", "Position", "Runs",        "ok",        "Tetrahedra", "over given",
                  "median", "largest",  "within 10 %", "below 1.5", "face angle", "dihedral"};
  bool any = false;
  for (const std::string& mesher : selection.meshers) {
    std::map<std::string, const RunRow*> given;
    std::vector<std::pair<Name, const RunRow*>> rows;
    for (const auto& [hash, row] : selection.runs.at(mesher)) {
      rows.emplace_back(parsed(row.model_name), &row);
      if (rows.back().first.position == as_given) given[rows.back().first.model] = &row;
    }
    std::array<Copies, kPositions> copies;
    for (const auto& [name, row] : rows) {
      const auto at = given.find(name.model);
      add(*row, at == given.end() ? nullptr : at->second, copies[name.position]);
    }
    if (copies[in_doubles].runs + copies[in_float32].runs == 0) continue;
    any = true;
    for (std::size_t p = 0; p < kPositions; ++p) {
      const Copies& c = copies[p];
      std::vector<std::string> cells = {mesher, kNames[p], std::to_string(c.runs),
                                        std::to_string(c.ok), std::to_string(c.tetrahedra)};
      if (p == as_given) {
        cells.resize(table.header.size(), "-");
      } else {
        cells.push_back(ratio(of_all(c)));
        cells.push_back(ratio(median(c.sizes)));
        cells.push_back(ratio(largest(c.sizes)));
        cells.push_back(share_within(c.sizes, 0.9, 1.1));
        cells.push_back(share_within(c.sizes, 0, 1.5));
        cells.push_back(ratio(median(c.face_angles)));
        cells.push_back(ratio(median(c.dihedrals)));
      }
      table.rows.push_back(std::move(cells));
      if (c.worse > 0) {
        table.notes.push_back(fmt::format(
            "{}, {}: {} runs are not ok where the model as given is; they are in no ratio.", mesher,
            kNames[p], c.worse));
      }
    }
  }
  if (!any) {
    table.rows.clear();
    return table;
  }
  table.caption = limits_caption(selection, selection.meshers);
  table.notes.insert(table.notes.begin(),
                     "Copies rotated by up to three rotations (tetproof rotate), their coordinates "
                     "rounded to doubles or to float32. Ratios are those of a copy to its model as "
                     "given, both ok, of tetrahedra inside where the file tells them; of the "
                     "smallest face angle and dihedral the medians of the ratios.");
  return table;
}

}  // namespace tetproof
