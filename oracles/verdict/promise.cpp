#include "oracles/verdict/promise.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>
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

struct Number {
  const char* name;
  double Promise::*target;  // null: promises nothing
  unsigned tasks;
  double low, high;
  bool above_low = false;  // low itself is not allowed

  bool allows(double value) const {
    return (above_low ? value > low : value >= low) && value <= high;
  }
};

constexpr double kMost = 1e308;
constexpr Number kNumbers[] = {
    {"--delta", &Promise::delta, kMesh | kImprove, 0, 30, true},
    {"--delta", &Promise::delta, kPlane, 0, 34, true},
    {"--tau", &Promise::tau, kMesh | kPlane, 0, 1},
    {"--planar", &Promise::planar, kMesh, 0, 0.01},
    {"--acute", &Promise::acute, kMesh, 0, 90},
    {"--acute", &Promise::acute, kPlane, 60, 90},
    {"--corner", &Promise::corner, kMesh, 0, 90},
    {"--chamfer-radius", &Promise::chamfer_radius, kMesh | kPlane, 0, kMost, true},
    {"--max-edge", &Promise::max_edge, kMesh | kPlane | kImprove, 0, kMost, true},
    {"--size-growth", &Promise::size_growth, kMesh | kImprove, 0, 1, true},
    {"--budget", &Promise::budget, kMesh, 1, 1e15},
    {"--max-vertices", &Promise::max_vertices, kAll, 1, 4294967294},
    {"--time-limit", nullptr, kAll, 0, kMost, true},
    {"--threads", nullptr, kSpace, 0, 1024},
    {"--jobs", nullptr, kAll, 0, 1024}};

constexpr const char* kSizeField = "--size-field";  // the one file that promises something

// These options say where and how, not what; --slivers guarantees nothing.
struct Word {
  const char* name;
  unsigned tasks;
};
constexpr Word kFiles[] = {{"-o", kAll},
                           {"--output", kAll},
                           {"--stats", kAll},
                           {"--exact", kSurface | kPlane},
                           {"--save-chamfered", kMesh | kPlane},
                           {"--names", kSpace},
                           {kSizeField, kMesh | kImprove}};
constexpr Word kSwitches[] = {{"-q", kAll},
                              {"--quiet", kAll},
                              {"-v", kAll},
                              {"--verbose", kAll},
                              {"--ascii", kAll},
                              {"--gabriel", kMesh},
                              {"--approximate", kMesh | kPlane}};
constexpr Word kChosen[] = {
    {"--preset", kMesh | kPlane}, {"--as-paper", kMesh | kPlane}, {"--region", kSurface | kPlane},
    {"--order", kSpace},          {"--improve", kMesh},           {"--slivers", kMesh},
    {"--simplify-bridges", kMesh}};

template <std::size_t N>
bool among(const Word (&words)[N], const std::string& name, Task task) {
  return std::any_of(std::begin(words), std::end(words), [&](const Word& word) {
    return name == word.name && (word.tasks & bit_of(task)) != 0;
  });
}

// Whole words only, in no locale, finite.
bool parse_number(const std::string& text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// A choice of --as-paper. Some choices change only the way to the same promises; of these only the
// names must be known.
struct Choice {
  const char* name;
  bool Promise::*target;  // null: promises nothing
  unsigned tasks = kMesh;
};
constexpr Choice kChoices[] = {{"link", &Promise::link},
                               {"bridges", &Promise::bridges},
                               {"order", nullptr},
                               {"steiner-point", &Promise::steiner_point, kMesh | kPlane},
                               {"kept-points", &Promise::kept_points},
                               {"enrichment", &Promise::enrichment},
                               {"filter-pairs", &Promise::filter_pairs},
                               {"filter-chamfered", &Promise::filter_chamfered},
                               {"no-guard", &Promise::no_guard}};

void choose_all(bool all, Promise& p) {
  for (const Choice& choice : kChoices) {
    if (choice.target != nullptr) p.*choice.target = all && (choice.tasks & bit_of(p.task)) != 0;
  }
}

void set_defaults(Task task, bool paper, Promise& p) {
  p = {};
  p.task = task;
  if (task == Task::cdt) p.region = Region::hull;
  p.improve = task == Task::mesh && !paper;
  if (task != Task::mesh || paper) p.planar = 0;
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
    const auto* choice = std::find_if(
        std::begin(kChoices), std::end(kChoices),
        [&](const Choice& c) { return name == c.name && (c.tasks & bit_of(p.task)) != 0; });
    if (choice == std::end(kChoices)) return "nothing is called \"" + name + "\"";
    if (choice->target != nullptr) p.*choice->target = true;
    at = end + 1;
  }
  return {};
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
        return "\"" + first + "\" is none of mesh, cdt, plane and improve";
      }
    }
    set_defaults(task, preset(), p);
    while (next_ < words_.size()) {
      std::string option = words_[next_++];
      if (std::string why = apply(std::move(option), p); !why.empty()) return why;
    }
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
    const bool file = among(kFiles, option, p.task);
    // Which one counts would be anybody's guess; of files there may be several.
    if ((!file || option == kSizeField) && !seen_.insert(option).second)
      return option + " is there twice";
    if (among(kSwitches, option, p.task)) {
      if (value_) return option + " takes no value";
      p.gabriel = p.gabriel || option == "--gabriel";
      p.approximate = p.approximate || option == "--approximate";
      return {};
    }
    if (!value_ && next_ < words_.size()) value_ = words_[next_++];
    if (!value_) return option + ": unknown, or without a value";
    if (file) {
      if (value_->empty()) return option + " without a file";
      p.names = p.names || option == "--names";
      return option == kSizeField ? read_size_field(*value_, p.size_field) : "";
    }
    return among(kChosen, option, p.task) ? apply_choice(option, p) : apply_number(option, p);
  }

  std::string apply_choice(const std::string& option, Promise& p) {
    const auto one_of = [&](const char* first, const char* second) -> std::string {
      if (*value_ == first || *value_ == second) return {};
      return option + " is " + first + " or " + second + ", not \"" + *value_ + "\"";
    };
    if (option == "--preset") return *value_ == "paper" ? "" : "no preset \"" + *value_ + "\"";
    if (option == "--as-paper") return choose(*value_, p);
    if (option == "--region") {
      p.region = *value_ == "hull" ? Region::hull : Region::interior;
      return one_of("interior", "hull");
    }
    if (option == "--order") {
      p.second_order = *value_ == "2";
      return one_of("1", "2");
    }
    if (option == "--improve") p.improve = *value_ == "on";
    return one_of("on", "off");
  }

  std::string apply_number(const std::string& option, Promise& p) {
    if (option == "--planar" && p.task == Task::mesh && *value_ == "auto") {
      p.planar = Promise::kPlanarAuto;
      return {};
    }
    for (const Number& number : kNumbers) {
      if (option != number.name || (number.tasks & bit_of(p.task)) == 0) continue;
      double value = 0;
      if (!parse_number(*value_, value) || !number.allows(value)) {
        return option + ": \"" + *value_ + "\" is no number that it takes";
      }
      if (number.target != nullptr) p.*number.target = value;
      return {};
    }
    return option + ": no such option";
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
    if (promise_.max_vertices > 0) check_vertices();
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
    demand(size > 0, "the record has nothing in its section " + name);
  }
  void as_promised(const std::string& name, double recorded, double promised, bool tightened) {
    demand(
        recorded == promised || (tightened && recorded == kRight),
        "the record has " + name + " " + number(recorded) + ", promised was " + number(promised));
    if (recorded > promised) report_.figures.emplace_back("stricter: " + name, recorded);
  }

  // Nothing is left of the meshes in between, for which the limit also holds.
  void check_vertices() {
    const auto written = static_cast<double>(record_.mesh_vertices.size());
    demand(written <= promise_.max_vertices, "the record has " + number(written) +
                                                 " written vertices, promised were at most " +
                                                 number(promise_.max_vertices));
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

  // Only the guard makes anything stricter than was asked for. It demands empty balls first, then
  // chamfers some corners up to a right angle, in the end all.
  void check_parameters() {
    const ExactRecord::Parameters& p = record_.parameters;
    as_promised("delta", p.delta, promise_.guaranteed_delta(), false);
    as_promised("acute", p.acute, promise_.acute, p.gabriel);
    as_promised("corner", p.corner, promise_.corner_in_force(), p.gabriel && p.acute == kRight);
    demand(p.gabriel || !promise_.gabriel, "the record has no empty balls, promised was --gabriel");
    demand(p.region == promise_.region, "the record is of another region than was promised");
    check_tolerance();
    std::uint64_t tightened = 0;
    for (const ExactRecord::Corner& corner : record_.corners) {
      ++report_.checked;
      const std::string name = "corner " + std::to_string(corner.vertex);
      if (corner.threshold != p.acute && corner.threshold != kRight) {
        report_.fail(name + " has a threshold of " + number(corner.threshold) + " degrees");
      }
      tightened += corner.threshold > promise_.acute;
      if (corner.threshold > promise_.acute && !p.gabriel) {
        report_.fail(name + " is tightened, which comes after empty balls");
      }
    }
    if (promise_.no_guard) {
      demand(p.gabriel == promise_.gabriel && tightened == 0 && p.acute == promise_.acute &&
                 p.corner == promise_.corner_in_force(),
             "the guard was not to act, and something is stricter than was asked for");
    }
    if (tightened > 0) {
      report_.figures.emplace_back("corners tightened", static_cast<double>(tightened));
    }
  }

  // tau, or for a budget the first of tau, 2 tau, 4 tau ... (from 1e-5 if that is more) that fits.
  void check_tolerance() {
    constexpr double kLeast = 1e-5, kLargest = 0.1, kSlack = 1e-9;
    const double recorded = diagonal_ > 0 ? record_.parameters.tolerance / diagonal_ : 0;
    const auto is = [&](double tau) { return std::fabs(recorded - tau) <= kSlack * tau; };
    bool kept = is(promise_.tau);
    if (!kept && promise_.budget > 0) {
      double tau = std::max(2 * promise_.tau, kLeast);
      while (!is(tau) && tau <= kLargest) tau *= 2;
      kept = tau <= kLargest * (1 + kSlack);
      report_.figures.emplace_back("tau for the budget", recorded);
    }
    demand(kept,
           "the record has tau " + number(recorded) + ", promised was " + number(promise_.tau));
  }

  // A vertex may be half as far from the plane of a facet as the surface may deviate. Where that
  // may not, the refined mesh alone may be one of a surface with planar facets, within the default,
  // if it is not what is written.
  void check_planar() {
    constexpr double kSlack = 1e-9;
    const bool refined_alone = promise_.task == Task::mesh && promise_.planar == 0 &&
                               promise_.improve && !promise_.approximate;
    const double promised =
        (refined_alone ? promise_.automatic_planar : promise_.planar_share()) / 2;
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

double Promise::planar_share() const {
  return planar == kPlanarAuto ? automatic_planar : planar;
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
  p.filter_pairs = options.as_paper.filter_pairs;
  p.filter_chamfered = options.as_paper.filter_chamfered;
  p.no_guard = options.as_paper.no_guard;
  p.region = options.region;
  p.chamfer_radius = options.chamfer_radius;
  p.max_edge = options.max_edge;
  p.size_field = options.size_field;
  p.size_growth = options.size_growth;
  p.budget = static_cast<double>(options.budget);
  p.max_vertices = static_cast<double>(options.max_vertices);
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

OracleReport check_written_vertices(const Promise& promise, std::size_t written) {
  OracleReport report("promise", "promises");
  report.checked = 1;
  const auto vertices = static_cast<double>(written);
  if (vertices > promise.max_vertices) {
    report.fail("the file has " + number(vertices) + " vertices, promised were at most " +
                number(promise.max_vertices));
  }
  return report;
}

}  // namespace tetproof::oracles
