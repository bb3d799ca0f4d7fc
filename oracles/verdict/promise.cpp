#include "oracles/verdict/promise.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;
using delmesher::Region;

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (c != ' ' && c != '\t' && c != '\n') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

enum Tasks : unsigned {
  kMesh = 1,
  kCdt = 2,
  kPlane = 4,
  kImprove = 8,
  kSurface = kMesh | kCdt,
  kSpace = kSurface | kImprove,
  kAll = kSpace | kPlane
};

unsigned bit_of(Task task) {
  switch (task) {
    case Task::mesh:
      return kMesh;
    case Task::cdt:
      return kCdt;
    case Task::plane:
      return kPlane;
    case Task::improve:
      return kImprove;
  }
  return 0;
}

enum class Takes : std::uint8_t {
  nothing,
  number,
  length,             // a number in input units
  length_or_share,    // the same, or a fraction of the diagonal with a d behind it
  word,               // one of two
  regions,            // a word, or names of regions with commas
  walls,              // the same of walls
  length_or_regions,  // a length, and lengths of regions as in copper=0.5, with commas
  file,               // where something is written, or what something is called
  outputs,            // the same, several times
  sizes,              // a file that promises something: a size field
  points,             // or points that become vertices
  list,               // of choices of the paper
  choice              // one of these: no option of its own
};

// What an option of delmesher promises. The oracles read it on their own, from README and
// docs/options.md.
struct Option {
  const char* name;
  unsigned tasks;
  Takes takes;
  // A switch, a file and a choice set a bool; the second word is true, or the hull. Nothing: it
  // says where and how, not what, or changes only the way to the same promises.
  std::variant<std::monostate, double Promise::*, bool Promise::*, Region Promise::*> target = {};
  double low = 0, high = 0;
  bool above_low = false;  // low itself is not allowed
  std::array<const char*, 2> words = {};

  bool allows(double value) const {
    return (above_low ? value > low : value >= low) && value <= high;
  }
};

constexpr double kMost = 1e308;
constexpr std::array<const char*, 2> kOffOn = {"off", "on"};
constexpr Option kOptions[] = {
    {"--delta", kMesh | kImprove, Takes::number, &Promise::delta, 0, 30, true},
    {"--delta", kPlane, Takes::number, &Promise::delta, 0, 34, true},
    {"--tau", kMesh | kPlane, Takes::number, &Promise::tau, 0, 1},
    {"--planar", kMesh, Takes::number, &Promise::planar, 0, 0.01},  // or auto
    {"--tolerance", kMesh, Takes::length_or_share, &Promise::tolerance, 0, kMost, true},
    {"--feature", kMesh, Takes::number, &Promise::feature, 0, 90},
    {"--acute", kMesh, Takes::number, &Promise::acute, 0, 90},
    {"--acute", kPlane, Takes::number, &Promise::acute, 60, 90},
    {"--corner", kMesh, Takes::number, &Promise::corner, 0, 90},
    {"--label-by-angle", kSurface, Takes::number, &Promise::label_by_angle, 0, 90, true},
    {"--chamfer-radius", kMesh | kPlane, Takes::length, &Promise::chamfer_radius, 0, kMost, true},
    {"--max-edge", kMesh, Takes::length_or_regions, &Promise::max_edge, 0, kMost, true},
    {"--max-edge", kPlane | kImprove, Takes::length, &Promise::max_edge, 0, kMost, true},
    {"--size", kMesh, Takes::length, &Promise::size, 0, kMost, true},
    {"--size-field", kMesh | kImprove, Takes::sizes},
    {"--points", kMesh, Takes::points},
    {"--size-growth", kMesh | kImprove, Takes::number, &Promise::size_growth, 0, 1, true},
    {"--budget", kMesh, Takes::number, &Promise::budget, 1, 4294967294},
    {"--max-vertices", kAll, Takes::number, &Promise::max_vertices, 1, 4294967294},
    {"--time-limit", kAll, Takes::number, {}, 0, kMost, true},
    {"--threads", kSpace, Takes::number, {}, 0, 1024},
    {"--jobs", kAll, Takes::number, {}, 0, 1024},
    {.name = "--region",
     .tasks = kSurface | kPlane,
     .takes = Takes::word,
     .target = &Promise::region,
     .words = {"interior", "hull"}},
    {.name = "--order",
     .tasks = kSpace,
     .takes = Takes::word,
     .target = &Promise::second_order,
     .words = {"1", "2"}},
    {.name = "--surface",
     .tasks = kMesh,
     .takes = Takes::word,
     .target = &Promise::keep,
     .words = {"split", "keep"}},
    {.name = "--regions", .tasks = kMesh, .takes = Takes::regions, .target = &Promise::all_regions},
    {"--split-walls", kMesh, Takes::walls},
    {"--strict", kMesh, Takes::nothing, &Promise::strict},
    {.name = "--improve",
     .tasks = kMesh,
     .takes = Takes::word,
     .target = &Promise::improve,
     .words = kOffOn},
    {.name = "--slivers",
     .tasks = kMesh,
     .takes = Takes::word,
     .target = &Promise::slivers,
     .words = kOffOn},
    {.name = "--msh", .tasks = kAll, .takes = Takes::word, .words = {"2.2", "4.1"}},
    {.name = "--simplify-bridges",
     .tasks = kMesh,
     .takes = Takes::word,
     .target = &Promise::simplify_bridges,
     .words = kOffOn},
    {.name = "--preset",
     .tasks = kMesh | kPlane,
     .takes = Takes::word,
     .words = {"paper", "paper"}},
    {"--as-paper", kMesh | kPlane, Takes::list},
    {"--gabriel", kMesh, Takes::nothing, &Promise::gabriel},
    {"--approximate", kMesh | kPlane, Takes::nothing, &Promise::approximate},
    {"--ascii", kAll, Takes::nothing},
    {"-q", kAll, Takes::nothing},
    {"--quiet", kAll, Takes::nothing},
    {"-v", kAll, Takes::nothing},
    {"--verbose", kAll, Takes::nothing},
    {"-o", kAll, Takes::outputs},
    {"--output", kAll, Takes::outputs},
    {"--stats", kAll, Takes::file},
    {"--exact", kSurface | kPlane, Takes::file},
    {"--save-chamfered", kMesh | kPlane, Takes::file, &Promise::save_chamfered},
    {"--names", kSpace, Takes::file, &Promise::names},
    {"link", kMesh, Takes::choice, &Promise::link},
    {"bridges", kMesh, Takes::choice, &Promise::bridges},
    {"order", kMesh, Takes::choice, &Promise::order},
    {"steiner-point", kMesh | kPlane, Takes::choice, &Promise::steiner_point},
    {"kept-points", kMesh | kPlane, Takes::choice, &Promise::kept_points},
    {"enrichment", kMesh, Takes::choice, &Promise::enrichment},
    {"filter-pairs", kMesh, Takes::choice, &Promise::filter_pairs},
    {"filter-chamfered", kMesh, Takes::choice, &Promise::filter_chamfered},
    {"no-guard", kMesh, Takes::choice, &Promise::no_guard}};

// Null if the task has none of this name; `name` may be that of a choice.
const Option* find_option(const std::string& name, Task task) {
  const auto* found =
      std::find_if(std::begin(kOptions), std::end(kOptions), [&](const Option& option) {
        return name == option.name && (option.tasks & bit_of(task)) != 0;
      });
  return found == std::end(kOptions) ? nullptr : found;
}

// Kept or not is seen in the refined mesh, in its surface, or in how it was made: not in a file
// alone. The edges of a file are measured.
bool is_of_record(const std::string& option, Task task) {
  constexpr std::string_view kBoth[] = {"--delta",          "--tau",    "--acute",
                                        "--chamfer-radius", "--preset", "--as-paper",
                                        "--approximate"},
                             kOfMesh[] = {"--corner", "--gabriel", "--improve"};
  const auto among = [&](const auto& names) {
    return std::find(std::begin(names), std::end(names), option) != std::end(names);
  };
  if (task != Task::mesh && task != Task::plane) return false;
  return among(kBoth) || (task == Task::mesh && among(kOfMesh));
}

void put(const Option& option, bool value, Promise& p) {
  if (const auto* flag = std::get_if<bool Promise::*>(&option.target)) p.** flag = value;
  if (const auto* region = std::get_if<Region Promise::*>(&option.target)) {
    p.** region = value ? Region::hull : Region::interior;
  }
}

// Whole words only, in no locale, finite.
bool parse_number(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

void choose_all(bool all, Promise& p) {
  for (const Option& option : kOptions) {
    if (option.takes != Takes::choice) continue;
    put(option, all && (option.tasks & bit_of(p.task)) != 0, p);
  }
}

void set_defaults(Task task, bool paper, Promise& p) {
  p = {};
  p.task = task;
  if (task == Task::cdt) p.region = Region::hull;
  p.may_keep = p.improve = task == Task::mesh && !paper;
  if (task != Task::mesh || paper) p.planar = 0;
  if (task == Task::mesh && !paper) p.size = Promise::kSizeAuto;
  if (task == Task::plane) p.delta = 20.7;
  if (!paper) return;
  choose_all(true, p);
  p.acute = p.corner = 90;
  p.region = Region::hull;
  p.gabriel = true;
  if (task == Task::plane) p.tau = 0;
}

// Empty, or the mistake in the list.
std::string choose(const std::string& list, Promise& p) {
  choose_all(list == "all", p);
  if (list == "none" || list == "all") return {};
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::string name = list.substr(at, end - at);
    const Option* choice = find_option(name, p.task);
    if (choice == nullptr || choice->takes != Takes::choice) {
      return "nothing is called \"" + name + "\"";
    }
    put(*choice, true, p);
    at = end + 1;
  }
  return {};
}

void set_kept(Promise& p) {
  p.keep = true;
  p.task = Task::cdt;
  p.planar = 0;
}

// Edges of a length on average are no longer than 1.45 times it.
constexpr double kMostOfSize = 1.45;

void bound_edges(Promise& p) {
  const double most = kMostOfSize * p.size;
  p.edges_by_size = p.size > 0 && !(p.max_edge > 0 && p.max_edge < most);
  if (p.edges_by_size) p.max_edge = most;
}

class PromiseReader {
 public:
  explicit PromiseReader(std::string_view text) : words_(words_of(text)) {}

  std::string read(Promise& p) {
    Task task = Task::mesh;
    if (!words_.empty() && !words_[0].starts_with("-")) {
      const std::string& first = words_[next_++];
      if (first == "cdt") {
        task = Task::cdt;
      } else if (first == "plane") {
        task = Task::plane;
      } else if (first == "improve") {
        task = Task::improve;
      } else if (first != "mesh") {
        return "\"" + first + "\" is not mesh, cdt, plane or improve";
      }
    }
    set_defaults(task, preset(), p);
    while (next_ < words_.size()) {
      std::string option = words_[next_++];
      if (std::string why = apply(std::move(option), p); !why.empty()) return why;
    }
    if (p.tolerance != 0 && (p.all_regions || seen_.contains("--exact"))) {
      return "--tolerance: not with --exact nor --regions all";
    }
    if (!p.all_regions && !p.region_sizes.empty()) return "--max-edge of a region needs --regions";
    bound_edges(p);
    if (p.keep || p.all_regions) set_kept(p);
    return {};
  }

 private:
  // Other options override the preset, wherever it stands.
  bool preset() const {
    for (std::size_t i = next_; i < words_.size(); ++i) {
      if (words_[i] == "--preset=paper") return true;
      if (words_[i] == "--preset" && i + 1 < words_.size() && words_[i + 1] == "paper") return true;
    }
    return false;
  }

  std::string apply(std::string option, Promise& p) {
    value_.reset();
    if (const auto at = option.find('='); option.starts_with("--") && at != std::string::npos) {
      value_ = option.substr(at + 1);
      option.resize(at);
    }
    const Option* known = find_option(option, p.task);
    if (known == nullptr || known->takes == Takes::choice) return option + ": no such option";
    // Which one counts would be anybody's guess.
    if (known->takes != Takes::outputs && !seen_.insert(option).second) {
      return option + " is there twice";
    }
    if (is_of_record(option, p.task)) p.of_record.push_back(option);
    if (known->takes == Takes::nothing) {
      if (value_) return option + " takes no value";
      put(*known, true, p);
      return {};
    }
    if (!value_ && next_ < words_.size()) value_ = words_[next_++];
    if (!value_ || value_->empty()) return option + " without a value";
    return take(*known, p);
  }

  // Which may be `auto` besides its two words.
  static bool is_surface(const Option& option) {
    return option.target == decltype(option.target)(&Promise::keep);
  }

  std::string take(const Option& option, Promise& p) {
    const std::string name = option.name;
    switch (option.takes) {
      case Takes::list:
        return choose(*value_, p);
      case Takes::sizes:
        return read_size_field(*value_, p.size_field);
      case Takes::points:
        return read_points(*value_, p.points);
      case Takes::word:
        if (is_surface(option)) {
          p.may_keep = *value_ == "auto";
          if (p.may_keep) return {};
          if (*value_ == option.words[0]) p.of_record.push_back(name + " " + *value_);
        }
        put(option, *value_ == option.words[1], p);
        if (*value_ == option.words[0] || *value_ == option.words[1]) return {};
        return name + " is " + option.words[0] + " or " + option.words[1] +
               (is_surface(option) ? " or auto" : "") + ", not \"" + *value_ + "\"";
      case Takes::regions:
        return take_regions(p);
      case Takes::walls:
        return take_walls(p);
      case Takes::length_or_regions:
        return take_lengths(option, p);
      case Takes::number:
      case Takes::length:
      case Takes::length_or_share:
        return take_number(option, p);
      default:
        put(option, true, p);
        return {};
    }
  }

  // Between commas.
  std::vector<std::string> entries() const {
    std::vector<std::string> found(1);
    for (const char c : *value_) {
      if (c == ',') {
        found.emplace_back();
      } else {
        found.back() += c;
      }
    }
    return found;
  }

  std::string take_regions(Promise& p) const {
    p.all_regions = *value_ != "solid";
    p.largest_region = *value_ == "largest";
    if (!p.all_regions || p.largest_region || *value_ == "all") return {};
    p.region_names = entries();
    const bool nameless = std::ranges::find(p.region_names, "") != p.region_names.end();
    return nameless ? "--regions: a name is missing in \"" + *value_ + "\"" : "";
  }

  std::string take_walls(Promise& p) const {
    p.split_walls = *value_ == "none"  ? Promise::Split::none
                    : *value_ == "all" ? Promise::Split::all
                                       : Promise::Split::named;
    if (p.split_walls != Promise::Split::named) return {};
    p.split_wall_names = entries();
    const bool nameless = std::ranges::find(p.split_wall_names, "") != p.split_wall_names.end();
    return nameless ? "--split-walls: a name is missing in \"" + *value_ + "\"" : "";
  }

  std::string take_lengths(const Option& option, Promise& p) {
    bool own = false;
    for (const std::string& entry : entries()) {
      const std::size_t at = entry.rfind('=');
      double value = 0;
      const bool region = at != std::string::npos;
      if (!parse_number(region ? entry.substr(at + 1) : entry, value) || !option.allows(value) ||
          at == 0 || (!region && std::exchange(own, true))) {
        return std::string(option.name) + ": \"" + *value_ + "\" is not a list that it takes";
      }
      if (region) {
        p.region_sizes.emplace_back(entry.substr(0, at), value);
      } else {
        p.max_edge = value;
      }
    }
    return {};
  }

  std::string take_number(const Option& option, Promise& p) {
    if (option.target == decltype(option.target)(&Promise::planar) && *value_ == "auto") {
      p.planar = Promise::kPlanarAuto;
      return {};
    }
    if (option.target == decltype(option.target)(&Promise::size) &&
        (*value_ == "auto" || *value_ == "none")) {
      p.size = *value_ == "auto" ? Promise::kSizeAuto : 0;
      return {};
    }
    constexpr double kLargestShare = 0.1;
    std::string text = *value_;
    const bool share = option.takes == Takes::length_or_share && text.ends_with('d');
    if (share) text.pop_back();
    double value = 0;
    if (!parse_number(text, value) || !option.allows(value) || (share && value > kLargestShare)) {
      return std::string(option.name) + ": \"" + *value_ + "\" is not a number that it takes";
    }
    if (share) value = -value;
    if (const auto* number = std::get_if<double Promise::*>(&option.target)) p.** number = value;
    return {};
  }

  std::vector<std::string> words_;
  std::size_t next_ = 0;
  std::optional<std::string> value_;
  std::set<std::string> seen_;  // options
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

constexpr double kRight = 90;  // degrees

// One promise after another, each counted.
class PromiseCheck {
 public:
  PromiseCheck(const Promise& promise, const ExactRecord& record, double diagonal)
      : promise_(promise), record_(record), diagonal_(diagonal) {}

  OracleReport run(unsigned version) {
    demand(version == kRecordVersion, "the record is of version " + std::to_string(version) +
                                          ", what is promised needs version " +
                                          std::to_string(kRecordVersion));
    section("facets", record_.facets.size());
    const bool enriched = promise_.task == Task::cdt || !promise_.approximate;
    if (enriched) {
      // With --approximate the mesh may be empty, because the filter may leave nothing. Then only
      // same-mesh looks at the number of vertices.
      section("mesh_vertices", record_.mesh_vertices.size());
      section("final", record_.final.size());
      section("final_facets", record_.final_facets.size());
    } else {
      demand(record_.final.empty() && record_.final_facets.empty(),
             "the record has a final mesh, or faces of one, promised was --approximate");
    }
    check_numbers();
    check_planar();
    check_unasked();
    if (promise_.task == Task::mesh) {
      section("refined", record_.refined.size());
      check_refined_sections();
      check_parameters();
    }
    return std::move(report_);
  }

 private:
  void demand(bool kept, const std::string& otherwise) {
    ++report_.checked;
    if (!kept) report_.fail(otherwise);
  }
  void section(const std::string& name, std::size_t size) {
    demand(size > 0, "empty section of the record: " + name);
  }
  void as_promised(const std::string& name, double recorded, double promised, bool tightened) {
    demand(
        recorded == promised || (tightened && recorded == kRight),
        "the record has " + name + " " + number(recorded) + ", promised was " + number(promised));
    if (recorded > promised) report_.figures.emplace_back("stricter: " + name, recorded);
  }

  // Nothing is left of the meshes in between, for which the limit also holds.
  void check_numbers() {
    const bool approximate = promise_.approximate;  // with a hull those at the outer box are not
    const auto is_written = [&](const ExactRecord::Tet& tet) {
      return tet.inside || (promise_.region == Region::hull && !approximate);
    };
    const auto& last = approximate ? record_.refined : record_.final;
    at_most(promise_.max_vertices, static_cast<double>(record_.mesh_vertices.size()), "vertices");
    at_most(promise_.budget, static_cast<double>(std::ranges::count_if(last, is_written)),
            "tetrahedra");
  }
  void at_most(double promised, double written, const std::string& what) {
    if (promised == 0) return;
    demand(written <= promised, "the record has " + number(written) + " written " + what +
                                    ", promised were at most " + number(promised));
  }

  // Sections that no oracle would look at.
  void check_unasked() {
    const ExactRecord& r = record_;
    demand(!r.final.empty() || r.unrepaired.empty(),
           "the record has a mesh before repairs, but none after them");
    demand(!r.unrepaired.empty() || r.unrepaired_facets.empty(),
           "the record has faces on facets before repairs, but no mesh before them");
    if (promise_.task != Task::cdt) return;
    demand(r.refined.empty() && r.refined_facets.empty() && r.segments.empty() &&
               r.corners.empty() && r.chamfer_points.empty() && r.balls.empty(),
           "the record has a refined mesh, promised was a plain tetrahedrization");
    demand(std::all_of(r.facets.begin(), r.facets.end(),
                       [](const ExactRecord::Facet& facet) { return facet.filtered == 0; }),
           "the record has dropped facets, promised was a plain tetrahedrization");
    const ExactRecord::Parameters &p = r.parameters, none;
    demand(p.delta == none.delta && p.acute == none.acute && p.corner == none.corner &&
               p.tolerance == none.tolerance && p.region == none.region &&
               p.gabriel == none.gabriel,
           "the record has parameters, promised was a plain tetrahedrization");
  }

  void check_refined_sections() {
    std::size_t kept = 0;
    for (const ExactRecord::Facet& facet : record_.facets) kept += facet.filtered == 0;
    if (kept > 0) {
      section("segments", record_.segments.size());
      section("refined_facets", record_.refined_facets.size());
    }
    if (!record_.corners.empty()) section("chamfer_points", record_.chamfer_points.size());
  }

  // Only the guard makes anything stricter than was asked for: it demands empty balls, and chamfers
  // up to a right angle.
  void check_parameters() {
    const ExactRecord::Parameters& p = record_.parameters;
    as_promised("delta", p.delta, promise_.guaranteed_delta(), false);
    const bool guarded = !promise_.no_guard && p.gabriel && p.acute == kRight && p.corner == kRight;
    as_promised("acute", p.acute, promise_.acute, guarded);
    as_promised("corner", p.corner, promise_.corner_in_force(), guarded);
    demand(p.gabriel == promise_.gabriel || guarded,
           p.gabriel ? "the record has empty balls that were not asked for"
                     : "the record has no empty balls, promised was --gabriel");
    demand(p.region == promise_.region, "the record is of another region than was promised");
    check_tolerance();
  }

  // tau, or 1e-9 where the surface might have been kept.
  void check_tolerance() {
    constexpr double kFinest = 1e-9, kSlack = 1e-9;
    const double recorded = diagonal_ > 0 ? record_.parameters.tolerance / diagonal_ : 0;
    const auto is = [&](double tau) { return std::fabs(recorded - tau) <= kSlack * tau; };
    demand(is(promise_.tau) || (promise_.may_keep && is(kFinest)),
           "the record has tau " + number(recorded) + ", promised was " + number(promise_.tau));
  }

  // A vertex may be half as far from the plane of a facet as the surface may deviate. Where that
  // may not, the refined mesh alone may be one of a surface with planar facets, within what `auto`
  // may state, if it is not what is written.
  void check_planar() {
    constexpr double kSlack = 1e-9;
    const bool refined_alone = promise_.task == Task::mesh && promise_.planar == 0 &&
                               promise_.improve && !promise_.approximate;
    const double promised = (refined_alone ? Promise::kMostAutomatic : promise_.most_planar()) / 2;
    const double recorded = diagonal_ > 0 ? record_.parameters.planar / diagonal_ : 0;
    demand(recorded >= 0 && recorded <= promised * (1 + kSlack),
           "the record has facets that are planar within " + number(recorded) +
               " of the diagonal, promised was " + number(promised));
    // The share of the smallest numbers is 0.
    demand(record_.planes.empty() == (record_.parameters.planar == 0),
           "the record has planes and no bound for them, or a bound and no planes");
    demand(record_.triangles.empty() || !record_.planes.empty(),
           "the record has triangles of its own, but no planes");
  }

  const Promise& promise_;
  const ExactRecord& record_;
  double diagonal_;
  OracleReport report_{"promise", "promises"};
};

}  // namespace

void Promise::settle(const ExactRecord& record) {
  if (!may_keep) return;
  Promise usual;
  set_defaults(Task::mesh, false, usual);
  const auto same = [&](auto... members) { return ((this->*members == usual.*members) && ...); };
  may_keep =
      same(&Promise::delta, &Promise::tau, &Promise::planar, &Promise::acute, &Promise::corner,
           &Promise::chamfer_radius) &&
      same(&Promise::gabriel, &Promise::approximate, &Promise::improve, &Promise::link,
           &Promise::bridges, &Promise::steiner_point, &Promise::kept_points, &Promise::enrichment,
           &Promise::filter_pairs, &Promise::filter_chamfered, &Promise::no_guard, &Promise::order,
           &Promise::slivers, &Promise::simplify_bridges, &Promise::save_chamfered) &&
      region == usual.region;
  if (!may_keep || !record.refined.empty() || !record.segments.empty()) return;
  halves = true;
  set_kept(*this);
}

void Promise::allow_sizes(double diagonal, double volume, double area, double common_edge) {
  const bool may_choose = size == kSizeAuto && !keep && !all_regions && planar != 0 &&
                          !approximate && region == Region::interior && task == Task::mesh;
  // Of the diagonal, but for the last.
  constexpr double kSmallest = 0.05, kLargest = 0.1, kRounded = 0.999;
  if (budget > 0) {
    longest_unasked = may_choose ? kRounded * common_edge : 0;
    return;
  }
  const bool may_choose_unasked =
      may_choose && tolerance == 0 && max_edge == 0 && size_field.empty() && improve;
  // Planar facets may make the part thinner on both sides.
  const double thickness = kRounded * 2 * volume / area - 2 * most_planar() * diagonal;
  const double least = thickness > kSmallest * diagonal ? std::min(thickness, kLargest * diagonal)
                                                        : kSmallest * diagonal;
  longest_unasked = may_choose_unasked ? kMostOfSize * least : 0;
}

double Promise::most_planar() const {
  return planar == kPlanarAuto ? kMostAutomatic : planar;
}

double Promise::planar_share() const {
  const double unless_stated = planar == kPlanarAuto ? kAutomatic : planar;
  return std::min(most_planar(), stated_planar.value_or(unless_stated));
}

double Promise::guaranteed_delta() const {
  if (task == Task::improve) return delta;  // no smaller angle is made
  const double guaranteed = task == Task::plane ? 20.7 : 14.4775;
  return std::min(delta, guaranteed);
}

double Promise::corner_in_force() const {
  constexpr double kMargin = 5;
  return std::min(acute, std::max(corner, delta + kMargin));
}

std::string parse_promise(std::string_view text, Promise& promise) {
  return PromiseReader(text).read(promise);
}

void for_each_length(Promise& promise, const std::function<void(double&)>& visit) {
  visit(promise.longest_unasked);
  for (const Option& option : kOptions) {
    if (option.takes == Takes::length) visit(promise.*std::get<double Promise::*>(option.target));
    if (option.takes == Takes::length_or_regions) {
      for (auto& region : promise.region_sizes) visit(region.second);
    }
    if (option.takes != Takes::sizes) continue;
    for (delmesher::SizeSource& source : promise.size_field) {
      for (double& x : source.point) visit(x);
      visit(source.size);
    }
  }
}

Promise promise_of(const delmesher::Options& options) {
  Promise p;
  p.delta = options.delta;
  p.tau = options.tau;
  p.planar = options.planar;
  p.acute = options.acute;
  p.corner = options.corner;
  p.gabriel = options.gabriel;
  p.approximate = options.approximate;
  p.improve = options.improve;
  p.link = options.as_paper.link;
  p.bridges = options.as_paper.bridges;
  p.steiner_point = options.as_paper.steiner_point;
  p.kept_points = options.as_paper.kept_points;
  p.enrichment = options.as_paper.enrichment;
  p.order = options.as_paper.order;
  p.slivers = options.slivers;
  p.simplify_bridges = options.simplify_bridges;
  p.save_chamfered = options.want_chamfered;
  p.filter_pairs = options.as_paper.filter_pairs;
  p.filter_chamfered = options.as_paper.filter_chamfered;
  p.no_guard = options.as_paper.no_guard;
  p.region = options.region;
  p.chamfer_radius = options.chamfer_radius;
  p.max_edge = options.max_edge;
  p.size = options.size;
  p.size_field = options.size_field;
  p.size_growth = options.size_growth;
  p.budget = static_cast<double>(options.budget);
  p.max_vertices = static_cast<double>(options.max_vertices);
  p.strict = options.strict;
  p.may_keep = options.surface == delmesher::SurfaceChoice::automatic;
  p.keep = options.surface == delmesher::SurfaceChoice::keep;
  p.tolerance = options.tolerance;
  p.feature = options.feature;
  p.all_regions = options.regions != delmesher::Regions::solid;
  p.largest_region = options.regions == delmesher::Regions::largest;
  p.region_names = options.region_names;
  p.split_walls = static_cast<Promise::Split>(options.split_walls);
  p.split_wall_names = options.split_wall_names;
  for (const auto& [name, size] : options.region_sizes) p.region_sizes.emplace_back(name, size);
  bound_edges(p);
  if (p.keep || p.all_regions) set_kept(p);
  return p;
}

Promise promise_of(const delmesher::CdtOptions& options) {
  Promise p;
  set_defaults(Task::cdt, false, p);
  p.region = options.region;
  p.max_vertices = static_cast<double>(options.max_vertices);
  return p;
}

Promise promise_of(const delmesher::PlaneOptions& options) {
  Promise p;
  set_defaults(Task::plane, false, p);
  p.delta = options.delta;
  p.tau = options.tau;
  p.acute = options.acute;
  p.approximate = options.approximate;
  p.steiner_point = options.as_paper.steiner_point;
  p.kept_points = options.as_paper.kept_points;
  p.region = options.region;
  p.chamfer_radius = options.chamfer_radius;
  p.max_edge = options.max_edge;
  p.max_vertices = static_cast<double>(options.max_vertices);
  return p;
}

OracleReport check_promise(const Promise& promise, const ExactRecord& record, unsigned version,
                           double diagonal) {
  return PromiseCheck(promise, record, diagonal).run(version);
}

OracleReport check_written(const Promise& promise, std::size_t vertices, std::size_t tetrahedra,
                           double planar_within) {
  constexpr double kSlack = 1e-9;
  OracleReport report("promise", "promises");
  report.checked = 1;
  const auto at_most = [&](double promised, std::size_t count, const std::string& what) {
    const auto written = static_cast<double>(count);
    if (promised == 0 || written <= promised) return;
    report.fail("the file has " + number(written) + " " + what + ", promised were at most " +
                number(promised));
  };
  at_most(promise.max_vertices, vertices, "vertices");
  at_most(promise.budget, tetrahedra, "tetrahedra");
  if (planar_within > promise.most_planar() * (1 + kSlack)) {
    report.fail("the file says that facets are planar within " + number(planar_within) +
                " of the diagonal, promised were at most " + number(promise.most_planar()));
  }
  return report;
}

}  // namespace tetproof::oracles
