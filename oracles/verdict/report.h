// The report of an oracle: how much it checked, and which violations it found where. Oracles never
// abort and never throw.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tetproof::oracles {

// The note of an oracle that would ask another library too, in a program built without it.
inline constexpr const char* kNoSecondOpinion =
    "CGAL was not asked: built without second opinions (TETPROOF_SECOND_OPINIONS)";

// What only other libraries decide.
inline constexpr const char* kInputNotAsked =
    "that the surface does not intersect itself (CGAL was not asked)";

// Where a violation is, by numbers of the mesh as given, or of the input.
struct Site {
  enum class Kind : std::uint8_t {
    vertex,
    edge,  // its two vertices
    face,  // its three vertices
    tetrahedron,
    listed_triangle,
    input_vertex,
    input_edge,  // its two vertices
    input_triangle
  };
  Kind kind;
  std::array<std::uint32_t, 3> numbers;
};
struct SiteKind {
  const char* name;
  std::size_t numbers;  // of each place
};
inline constexpr SiteKind kSiteKinds[] = {
    {"vertices", 1},         {"edges", 2},          {"faces", 3},       {"tetrahedra", 1},
    {"listed triangles", 1}, {"input vertices", 1}, {"input edges", 2}, {"input triangles", 1}};

// Where one finding is, as far as it is known.
struct Spot {
  std::optional<Site> site = {};
  std::optional<std::array<double, 3>> at = {};  // its middle, in input units
};

struct OracleReport {
  explicit OracleReport(std::string oracle_name, std::string what = {})
      : name(std::move(oracle_name)), checked_what(std::move(what)) {}

  static constexpr std::size_t kMostSites = 1'000'000;

  std::string name;
  std::string checked_what;  // e.g. "tetrahedra"
  std::uint64_t checked = 0;
  std::uint64_t violations = 0;
  bool promised = true;    // false: only counted and measured, because nobody promised it
  bool undecided = false;  // its input does not tell whether the violations are real
  std::vector<std::string> findings;  // the first violations, each naming its element
  std::vector<Spot> spots;            // where these are
  // All that are known, without a word: up to kMostSites. Some violations are nowhere, and those of
  // a facet are at all its triangles.
  std::vector<Site> sites;
  std::vector<std::array<double, 3>> points;  // the same of what is no element, in input units
  std::vector<std::string> notes;             // no violations, but worth knowing
  std::vector<std::pair<std::string, double>> figures;
  // Counts of angles, 15 degrees a bin.
  std::vector<std::pair<std::string, std::array<std::uint64_t, 12>>> histograms;

  // Counts a violation and keeps the first few in words.
  void fail(const std::string& finding) { fail(finding, Spot()); }
  void fail(const std::string& finding, const Site& site) {
    fail(finding, Spot{site});
    add_site(site);
  }
  void fail_at(const std::array<double, 3>& point, const std::string& finding) {
    fail(finding, Spot{{}, point});
    points.push_back(point);
  }
  // At a place that stands for others.
  void fail(const std::string& finding, const Spot& spot) {
    ++violations;
    if (findings.size() == 5) return;
    findings.push_back(finding);
    spots.push_back(spot);
  }
  void add_site(const Site& site) {
    if (sites.size() < kMostSites) sites.push_back(site);
  }
  // What failed is left to its figures, because it was not promised.
  void only_count() {
    promised = false;
    violations = 0;
    findings.clear();
    spots.clear();
    sites.clear();
    points.clear();
  }
  // What has other numbers than those of the files, by its kinds.
  void forget_sites(Site::Kind first = Site::Kind::vertex,
                    Site::Kind last = Site::Kind::input_triangle) {
    const auto is_other = [&](const Site& site) { return site.kind >= first && site.kind <= last; };
    std::erase_if(sites, is_other);
    for (Spot& spot : spots) {
      if (spot.site && is_other(*spot.site)) spot.site.reset();
    }
  }
  // Nothing if this oracle has no such figure.
  std::optional<double> figure(std::string_view figure_name) const;
  // An oracle that has looked at nothing has not passed.
  bool passed() const { return violations == 0 && checked > 0; }
  // "pass", "FAIL", "info" for what was not promised, or "undecided".
  const char* status() const {
    if (undecided) return "undecided";
    return !passed() ? "FAIL" : promised ? "pass" : "info";
  }
};

// Undecided, for a refined mesh without a record: its surface is not the input's where corners were
// cut off, so the file alone does not show whether it is a mesh of this input at all.
OracleReport surface_not_decided(const std::string& oracle);

// Of so many violations of a complex: what others ask of elements that lie on each other takes time
// by the square of their number, and nobody reads it.
inline constexpr std::uint64_t kHopeless = 1000;
inline bool is_hopeless(OracleReport& complex) {
  if (complex.violations <= kHopeless) return false;
  complex.notes.emplace_back("it fails so often that nothing else was asked");
  return true;
}

enum class Verdict : std::uint8_t { exact, rounded, deviating, undecided, broken };

const char* verdict_name(Verdict verdict);

struct VerifyReport {
  Verdict verdict = Verdict::broken;
  double deviation = 0;  // upper bound for that of the surface as written, in input units
  double slab = 0;       // width of the widest that holds a facet made of several, in input units
  // The largest in ulp of the largest coordinate of the facet (in the plane, of all; 0: unknown).
  double deviation_ulps = 0;
  double deviation_share = 0;  // as a fraction of the bounding-box diagonal
  double planar_share = 0;  // how far facets may be from planar by the promise, as such a fraction
  std::uint64_t inverted = 0, flat = 0;  // cells as written
  const char* cells = "tetrahedra";
  // Promises that were not shown to be kept, each perhaps with what was measured.
  std::vector<std::string> unproven;
  std::string scope;  // the verdict is of this alone ("the final mesh"); empty: of all there is
  std::vector<OracleReport> oracles;

  const OracleReport* find(const std::string& name) const;
  bool all_passed() const;
  bool any_failed() const;  // an undecided one has not failed
};

std::string to_json(const VerifyReport& report);
// The verdict and the numbers of oracles in the first line, then a paragraph for each oracle; no
// line is longer than 120 characters unless a single item is.
std::string to_text(const VerifyReport& report);

}  // namespace tetproof::oracles
