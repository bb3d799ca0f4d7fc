// All options of all jobs, a row each. Whoever names, reads, writes, checks or scales options takes
// them from here: the command line and its help, C, Python and its docstrings, the statistics
// (--stats), docs/options.md, options_defect() and in_ordinary_units().
//
// A row says what holds for an option, and which members it is: a job has the option if its struct
// has one of these members. The same name may stand in several rows, where it means something else,
// or has other bounds, in another job.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <vector>

#include "options.h"

namespace delmesher::options {

// The values that are accepted; not NaN.
struct Bounds {
  double low = 0, high = 1;
  bool above_low = false;  // low itself is not

  constexpr bool allow(double x) const { return (above_low ? x > low : x >= low) && x <= high; }
};
inline constexpr double kNoBound = HUGE_VAL;
inline constexpr Bounds kAnyLength{.high = kNoBound}, kDegreesToRight{.high = 90};

enum class Unit : std::uint8_t {
  none,
  degrees,
  length,
  seconds,
  // A length, or minus a fraction of the diagonal of the bounding box: on the command line with a d
  // behind it.
  length_or_share
};

// A word that stands for a value.
struct Word {
  std::string_view word;
  double value = 0;
};

struct Text {
  std::string_view name;  // as everywhere; on the command line with - for _
  std::string_view help;
  Bounds bounds = {};  // of switches and choices: 0 and 1
  Unit unit = Unit::none;
  bool zero_is_none = false;       // on the command line one leaves the option out instead
  bool promised = false;           // the oracles check it, if named in --promised
  bool with_kept_surface = false;  // SurfaceChoice::keep uses it
  std::array<Word, 3> words = {};
  // What else its value may be, with commas: names of regions or walls, or also REGION=VALUE.
  enum class Lists : std::uint8_t {
    nothing,
    regions,
    walls,
    values_of_regions
  } lists = Lists::nothing;
};

template <class... Members>
struct Row {
  Text text;
  std::tuple<Members...> members;

  constexpr explicit Row(const Text& row_text, Members... row_members)
      : text(row_text), members(row_members...) {}
};

// Choices of --as-paper have this before their names.
inline constexpr std::string_view kPaper = "paper_";

inline constexpr std::tuple kTable{
    Row({.name = "tolerance",
         .help = "the surface may be another one so near to it, in both directions: a length, or a "
                 "fraction of the diagonal as in 1e-3d",
         .bounds = {.low = -0.1, .high = kNoBound},
         .unit = Unit::length_or_share,
         .zero_is_none = true,
         .promised = true,
         .with_kept_surface = true},
        &Options::tolerance),
    Row({.name = "tolerance",
         .help = "how far the surfaces may be from each other, in both directions: a length, or a "
                 "fraction of the diagonal as in 1e-3d",
         .bounds = {.low = -0.1, .high = kNoBound},
         .unit = Unit::length_or_share},
        &RemeshOptions::tolerance),
    Row({.name = "feature",
         .help = "with a tolerance: edges that bend by more stay lines, but for those of steps "
                 "lower than it",
         .bounds = kDegreesToRight,
         .unit = Unit::degrees,
         .promised = true,
         .with_kept_surface = true},
        &Options::feature, &RemeshOptions::feature),
    Row({.name = "surface",
         .help = "split: add vertices where angles call for them; keep: each triangle is one face, "
                 "for few tetrahedra without a bound on angles; auto: where split takes more than "
                 "four times as many, keep, but halve edges longer than asked for",
         .bounds = {.high = 2},
         .promised = true,
         .with_kept_surface = true,
         .words = {{{"split", 0}, {"keep", 1}, {"auto", 2}}}},
        &Options::surface),
    Row({.name = "regions",
         .help = "solid: what the triangles bound is one; all: each part of space that they divide "
                 "off is one, with walls and sheets, the surface kept; largest, or names with "
                 "commas: only these are written",
         .bounds = {.high = 3},
         .promised = true,
         .with_kept_surface = true,
         .words = {{{"solid", 0}, {"all", 1}, {"largest", 2}}},
         .lists = Text::Lists::regions},
        &Options::regions),
    Row({.name = "split_walls",
         .help =
             "with --regions: the two sides of walls and sheets get vertices of their own, to "
             "part, as in contact or cracks: all, or with commas names as copper|air, and labels",
         .bounds = {.high = 2},
         .promised = true,
         .with_kept_surface = true,
         .words = {{{"none", 0}, {"all", 1}}},
         .lists = Text::Lists::walls},
        &Options::split_walls),
    Row({.name = "strict",
         .help = "with --surface keep: fail where an added vertex cannot leave the surface",
         .promised = true,
         .with_kept_surface = true},
        &Options::strict),
    Row({.name = "delta",
         .help = "smallest face angle, best effort above the default",
         .bounds = {.low = 0, .high = 30, .above_low = true},
         .unit = Unit::degrees,
         .promised = true},
        &Options::delta),
    Row({.name = "delta",
         .help = "no smaller face angle is made",
         .bounds = {.low = 0, .high = 30, .above_low = true},
         .unit = Unit::degrees,
         .promised = true},
        &ImproveOptions::delta),
    Row({.name = "delta",
         .help = "smallest angle, guaranteed up to the default",
         .bounds = {.low = 0, .high = 34, .above_low = true},
         .unit = Unit::degrees,
         .promised = true},
        &PlaneOptions::delta),
    Row({.name = "tau",
         .help = "input filter: facets closer than this fraction of the diagonal wait for the last "
                 "step; 0 is off",
         .promised = true},
        &Options::tau),
    Row({.name = "tau",
         .help = "narrowest channel that is refined, width over length; 0: any",
         .promised = true},
        &PlaneOptions::tau),
    Row({.name = "planar",
         .help = "merge triangles that are coplanar within this fraction of the diagonal; 0: the "
                 "surface as given",
         .bounds = {.high = 0.01},
         .promised = true,
         .words = {{{"auto", kPlanarAuto}}}},
        &Options::planar, &CheckOptions::planar),
    Row({.name = "budget",
         .help =
             "tetrahedra at most; with --size auto edges are so short that nine tenths of them are "
             "made, where one of six lengths does that",
         .bounds = {.high = 4294967294},
         .zero_is_none = true,
         .promised = true,
         .with_kept_surface = true},
        &Options::budget),
    Row({.name = "acute",
         .help = "chamfer corners below this angle",
         .bounds = kDegreesToRight,
         .unit = Unit::degrees,
         .promised = true},
        &Options::acute),
    Row({.name = "acute",
         .help = "chamfer corners below this angle",
         .bounds = {.low = 60, .high = 90},
         .unit = Unit::degrees,
         .promised = true},
        &PlaneOptions::acute),
    Row({.name = "acute",
         .help = "corners below this angle are acute",
         .bounds = kDegreesToRight,
         .unit = Unit::degrees},
        &CheckOptions::acute),
    Row({.name = "corner",
         .help = "the same for corners between two edges",
         .bounds = kDegreesToRight,
         .unit = Unit::degrees,
         .promised = true},
        &Options::corner, &CheckOptions::corner),
    Row({.name = "gabriel",
         .help = "split constraints until their diametral balls are empty",
         .promised = true},
        &Options::gabriel),
    Row({.name = "slivers",
         .help = "treat slivers in the refinement: rounder tetrahedra, some more of them"},
        &Options::slivers),
    Row({.name = "improve",
         .help = "fewer and better tetrahedra by local operations on the same surface",
         .promised = true},
        &Options::improve),
    Row({.name = "approximate",
         .help = "stop before restoring the input: a mesh of the chamfered surface",
         .promised = true},
        &Options::approximate),
    Row({.name = "approximate",
         .help = "stop before restoring the input: a mesh of the chamfered graph",
         .promised = true},
        &PlaneOptions::approximate),
    Row({.name = "simplify_bridges",
         .help = "drop bridges, the paths that replace cut-off corners, that no angle needs "
                 "(section 4.4)"},
        &Options::simplify_bridges),
    Row({.name = "chamfer_radius",
         .help = "how far a chamfer may reach",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true,
         .promised = true},
        &Options::chamfer_radius, &PlaneOptions::chamfer_radius),
    Row({.name = "max_edge",
         .help = "largest edge; with --regions also in some, as in 2,copper=0.5",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true,
         .promised = true,
         .with_kept_surface = true,
         .lists = Text::Lists::values_of_regions},
        &Options::max_edge),
    Row({.name = "max_edge",
         .help = "largest edge",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true,
         .promised = true},
        &PlaneOptions::max_edge),
    Row({.name = "size",
         .help =
             "edges of this length on average, none above 1.45 times it, shorter ones where the "
             "surface has them; auto: a tenth of the diagonal, a twentieth in thin parts, where "
             "meshes are too coarse for a solver without and no option says how fine they are",
         .bounds = {.high = kNoBound, .above_low = true},
         .unit = Unit::length,
         .promised = true,
         .with_kept_surface = true,
         .words = {{{"auto", kSizeAuto}, {"none", 0}}}},
        &Options::size),
    Row({.name = "size",
         .help =
             "edges of this length on average, none above 1.45 times it, shorter ones where the "
             "surface has them",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true},
        &RemeshOptions::size),
    Row({.name = "max_edge",
         .help = "no longer edge is made",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true,
         .promised = true},
        &ImproveOptions::max_edge),
    Row({.name = "max_edge",
         .help = "split longer edges",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true},
        &RemeshOptions::max_edge),
    Row({.name = "size_field",
         .help = "smaller edges in places: lines X Y Z SIZE, or a .pos of Gmsh",
         .unit = Unit::length,
         .promised = true,
         .with_kept_surface = true},
        &Options::size_field, &ImproveOptions::size_field, &RemeshOptions::size_field),
    Row({.name = "size_growth",
         .help = "how much larger edges may be per distance from the sources of the size field",
         .bounds = {.above_low = true},
         .promised = true,
         .with_kept_surface = true},
        &Options::size_growth, &ImproveOptions::size_growth, &RemeshOptions::size_growth),
    Row({.name = "region",
         .help = "where the angle bound holds, and what is written",
         .promised = true,
         .words = {{{"interior", 0}, {"hull", 1}}}},
        &Options::region, &PlaneOptions::region),
    Row({.name = "region",
         .help = "what is written",
         .promised = true,
         .words = {{{"interior", 0}, {"hull", 1}}}},
        &CdtOptions::region),
    Row({.name = "weld",
         .help = "join vertices no farther apart than this",
         .bounds = kAnyLength,
         .unit = Unit::length,
         .zero_is_none = true},
        &RepairOptions::weld),
    Row({.name = "fill",
         .help = "fill holes that are planar, or narrower than a twentieth of the diagonal"},
        &RepairOptions::fill),
    Row({.name = "max_vertices",
         .help = "stop beyond this many vertices",
         .bounds = {.high = 4294967294},  // the largest index
         .zero_is_none = true,
         .promised = true,
         .with_kept_surface = true},
        &Limits::max_vertices, &PlaneOptions::max_vertices),
    Row({.name = "time_limit",
         .help = "stop after this time",
         .bounds = {.high = kNoBound},
         .unit = Unit::seconds,
         .zero_is_none = true,
         .with_kept_surface = true},
        &TimeLimit::time_limit_seconds),
    Row({.name = "threads",
         .help = "threads that share the work, 0: one per core",
         .bounds = {.high = 1024},
         .with_kept_surface = true},
        &Limits::threads, &CheckOptions::threads, &RepairOptions::threads),

    Row({.name = "paper_link",
         .help = "chamfers reach at most a third of the way to the link (section 4.1)",
         .promised = true},
        &AsPaper::link),
    Row({.name = "paper_bridges",
         .help = "every triangle at a chamfered vertex has a bridge of its own (section 4.2)",
         .promised = true},
        &AsPaper::bridges),
    Row({.name = "paper_order",
         .help = "the tetrahedron with the largest radius-edge ratio is split first (section 5.4)"},
        &AsPaper::order),
    Row({.name = "paper_steiner_point",
         .help = "bad tetrahedra, or triangles, are split at their circumcentre (section 5.6)",
         .promised = true},
        &AsPaper::steiner_point, &PlaneAsPaper::steiner_point),
    Row({.name = "paper_kept_points",
         .help = "all vertices outside the chamfers are kept to the end (section 6)",
         .promised = true},
        &AsPaper::kept_points, &PlaneAsPaper::kept_points),
    Row({.name = "paper_enrichment",
         .help = "the surface is always enriched (section 6)",
         .promised = true},
        &AsPaper::enrichment),
    Row({.name = "paper_filter_pairs",
         .help = "the filter drops both sides of every close pair (section 7)",
         .promised = true},
        &AsPaper::filter_pairs),
    Row({.name = "paper_filter_chamfered",
         .help = "the filter drops both sides of chamfered features below tau (section 7)",
         .promised = true},
        &AsPaper::filter_chamfered),
    Row({.name = "paper_no_guard",
         .help = "nothing is stricter than asked for, even where the refinement may not end",
         .promised = true},
        &AsPaper::no_guard)};

// Has a job with these options the member, itself or in its as_paper?
template <class JobOptions, class Class, class T>
constexpr bool is_of(T Class::*) {
  if constexpr (std::is_base_of_v<Class, JobOptions>) return true;
  if constexpr (requires { std::declval<JobOptions>().as_paper; }) {
    return std::is_same_v<Class, decltype(JobOptions::as_paper)>;
  }
  return false;
}

// What has the members of Class: the options themselves, or their as_paper.
template <class Class, class JobOptions>
constexpr auto& part_of(JobOptions& options) {
  if constexpr (std::is_base_of_v<Class, std::remove_const_t<JobOptions>>) {
    return options;
  } else {
    return options.as_paper;
  }
}

// Calls visit(text, member) for each option of the job, in the order of the table.
template <class JobOptions, class Visit>
constexpr void for_each(JobOptions& options, const Visit& visit) {
  using Plain = std::remove_const_t<JobOptions>;
  const auto visit_member = [&]<class Class, class T>(const Text& text, T Class::*member) {
    if constexpr (is_of<Plain>(static_cast<T Class::*>(nullptr))) {
      visit(text, part_of<Class>(options).*member);
    }
  };
  const auto visit_row = [&](const auto& row) {
    std::apply([&](const auto... members) { (visit_member(row.text, members), ...); }, row.members);
  };
  std::apply([&](const auto&... rows) { (visit_row(rows), ...); }, kTable);
}

enum class Kind : std::uint8_t {
  number,
  count,    // a whole number
  on_off,   // 0 or 1
  choice,   // of the row's words
  sources,  // of a size field: no number
};

template <class T>
constexpr Kind kind_of() {
  if constexpr (std::is_same_v<T, double>) return Kind::number;
  if constexpr (std::is_same_v<T, bool>) return Kind::on_off;
  if constexpr (std::is_integral_v<T>) return Kind::count;
  if constexpr (std::is_enum_v<T>) return Kind::choice;
  return Kind::sources;
}

// An option of a job with its value.
struct Value {
  const Text& text;
  Kind kind;
  double value;  // 0 for sources
  bool is_paper() const { return text.name.starts_with(kPaper); }
};

template <class JobOptions>
std::vector<Value> values_of(const JobOptions& options) {
  std::vector<Value> values;
  for_each(options, [&]<class T>(const Text& text, const T& member) {
    double value = 0;
    if constexpr (kind_of<T>() != Kind::sources) value = static_cast<double>(member);
    values.push_back({text, kind_of<T>(), value});
  });
  return values;
}

// The choices of the paper that a job has.
template <class JobOptions>
std::vector<std::string> paper_choices() {
  std::vector<std::string> names;
  for (const Value& option : values_of(JobOptions())) {
    if (option.is_paper()) names.emplace_back(option.text.name);
  }
  return names;
}

// On the command line: "max_edge" -> "max-edge", "paper_steiner_point" -> "steiner-point".
inline std::string argument_name(std::string_view name) {
  if (name.starts_with(kPaper)) name.remove_prefix(kPaper.size());
  std::string argument(name);
  std::replace(argument.begin(), argument.end(), '_', '-');
  return argument;
}

// False if the job has no such option, or if the value is not of its kind: switches are 0 or 1,
// counts whole and within their bounds. The job itself checks the bounds of numbers.
template <class JobOptions>
bool set(JobOptions& options, std::string_view name, double value) {
  bool done = false;
  for_each(options, [&]<class T>(const Text& text, T& member) {
    if (text.name != name) return;
    if constexpr (kind_of<T>() == Kind::number) {
      member = value;
      done = true;
    } else if constexpr (kind_of<T>() != Kind::sources) {
      done = value == std::floor(value) && text.bounds.allow(value);
      if (done) member = static_cast<T>(value);
    }
  });
  return done;
}

// "1e-3d", a fraction of the diagonal, as a number with Unit::length_or_share; 0 if it is none.
inline double share_of(std::string_view text) {
  double share = 0;
  if (!text.ends_with('d')) return 0;
  const char* const end = text.data() + text.size() - 1;
  const auto [stop, error] = std::from_chars(text.data(), end, share);
  return error == std::errc() && stop == end && share > 0 ? -share : 0;
}

// The parts of a list with commas.
inline std::vector<std::string_view> parts_of(std::string_view list) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    parts.push_back(list.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

// A value of its own, at most one, and REGION=VALUE; false if a part is neither.
template <class JobOptions>
bool set_in_regions(JobOptions& options, const Text& text, std::string_view list) {
  bool own = false;
  for (const std::string_view part : parts_of(list)) {
    const std::size_t at = part.rfind('=');
    const bool names_region = at != part.npos;
    const std::string_view number = names_region ? part.substr(at + 1) : part;
    double value = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || end != number.data() + number.size() || !(value > 0) ||
        !text.bounds.allow(value) || at == 0 || (!names_region && own)) {
      return false;
    }
    if (!names_region) {
      own = set(options, text.name, value);
      continue;
    }
    const std::string_view name = part.substr(0, at);
    const auto is_there = [&](const auto& size) { return size.region == name; };
    if (std::ranges::any_of(options.region_sizes, is_there)) return false;
    options.region_sizes.push_back({std::string(name), value});
  }
  return true;
}

// Adds names of a list, none of them empty; its choice becomes `named`.
template <class Choice>
bool set_names(std::string_view list, Choice& choice, std::vector<std::string>& names) {
  for (const std::string_view name : parts_of(list)) {
    if (name.empty()) return false;
    names.emplace_back(name);
  }
  choice = Choice::named;
  return true;
}

// The same by a word of the row, a share, or a list.
template <class JobOptions>
bool set(JobOptions& options, std::string_view name, std::string_view word) {
  for (const Value& option : values_of(options)) {
    if (option.text.name != name) continue;
    for (const Word& known : option.text.words) {
      if (!word.empty() && known.word == word) return set(options, name, known.value);
    }
    const double share = share_of(word);
    if (option.text.unit == Unit::length_or_share && share != 0) return set(options, name, share);
    if constexpr (requires { options.region_names; }) {
      if (option.text.lists == Text::Lists::regions) {
        return set_names(word, options.regions, options.region_names);
      }
      if (option.text.lists == Text::Lists::walls) {
        return set_names(word, options.split_walls, options.split_wall_names);
      }
      if (option.text.lists == Text::Lists::values_of_regions) {
        return set_in_regions(options, option.text, word);
      }
    }
  }
  return false;
}

// Those of another job that this one has, too; its own defaults for the rest.
template <class To, class From>
To taken_from(const From& from) {
  To to;
  for_each(to, [&]<class T>(const Text& to_text, T& to_member) {
    for_each(from, [&]<class U>(const Text& text, const U& member) {
      if constexpr (std::is_same_v<T, U>) {
        if (text.name == to_text.name) to_member = member;
      }
    });
  });
  if constexpr (std::is_base_of_v<TimeLimit, From>) to.progress = from.progress;
  return to;
}

// Multiplies all lengths by 2^exponent.
template <class JobOptions>
void scale_lengths(JobOptions& options, int exponent) {
  for_each(options, [&]<class T>(const Text& text, T& member) {
    if (text.unit != Unit::length && text.unit != Unit::length_or_share) return;
    if constexpr (kind_of<T>() == Kind::number) {
      if (member > 0) member = std::ldexp(member, exponent);
    } else if constexpr (kind_of<T>() == Kind::sources) {
      for (SizeSource& source : member) {
        for (double& x : source.point) x = std::ldexp(x, exponent);
        source.size = std::ldexp(source.size, exponent);
      }
    }
  });
  if constexpr (requires { options.region_sizes; }) {
    for (RegionSize& size : options.region_sizes)
      size.max_edge = std::ldexp(size.max_edge, exponent);
    for (RegionPoint& p : options.region_points) {
      for (double& x : p.point) x = std::ldexp(x, exponent);
      p.max_edge = std::ldexp(p.max_edge, exponent);
    }
  }
}

}  // namespace delmesher::options
