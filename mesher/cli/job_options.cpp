#include "mesher/cli/job_options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>

#include "mesher/io/text.h"

namespace delmesher::cli {
namespace {

using options::argument_name;
using options::Bounds;
using options::Kind;
using options::Value;
using Lists = options::Text::Lists;

constexpr const char* kAsPaper = "as_paper";
constexpr const char* kPreset = "preset";

std::string number_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", number);
  return text;
}

// "1e-3d" of a number with Unit::length_or_share.
std::string share_text(double share) {
  return number_text(-share) + "d";
}

std::string value_text(const Value& option) {
  for (const options::Word& word : option.text.words) {
    if (!word.word.empty() && word.value == option.value) return std::string(word.word);
  }
  if (option.kind == Kind::on_off) return option.value != 0 ? "on" : "off";
  return option.value < 0 ? share_text(option.value) : number_text(option.value);
}

// "0 to 1", "above 0, at most 30"
std::string range_text(const Bounds& bounds) {
  if (!bounds.above_low && bounds.high != options::kNoBound) {
    return number_text(bounds.low) + " to " + number_text(bounds.high);
  }
  const std::string low = (bounds.above_low ? "above " : "at least ") + number_text(bounds.low);
  return bounds.high == options::kNoBound ? low : low + ", at most " + number_text(bounds.high);
}

// Where 0 means none, users leave the option out instead.
Bounds bounds_of(const Value& option) {
  Bounds bounds = option.text.bounds;
  if (!option.text.zero_is_none) return bounds;
  if (option.kind == Kind::count) {
    bounds.low = 1;
  } else {
    bounds.above_low = true;
  }
  return bounds;
}

// A length, or a share of the diagonal.
CLI::Validator length_or_share(const Bounds& bounds) {
  return CLI::Validator(
      [bounds](std::string& text) -> std::string {
        const std::optional<double> value = length_or_share_of(text);
        if (!value) return "not a length, nor a fraction of the diagonal such as 1e-3d: " + text;
        return *value != 0 && bounds.allow(*value) && (*value > 0 || text.back() == 'd')
                   ? ""
                   : "out of range: " + text + " (above 0, at most " + share_text(bounds.low) + ")";
      },
      "NUMBER");
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// A number, or one of the words.
CLI::Validator number_within(const Bounds& bounds, bool whole,
                             const std::vector<std::string>& words = {}) {
  return CLI::Validator(
      [bounds, whole, words](std::string& text) -> std::string {
        double value = 0;
        if (std::find(words.begin(), words.end(), text) != words.end()) return "";
        if (io::parse_double(text, value) != io::NumberStatus::ok) {
          return words.empty() ? "not a number: " + text
                               : "neither a number nor " + joined(words, " nor ") + ": " + text;
        }
        if (whole && value != std::floor(value)) return "not a whole number: " + text;
        return bounds.allow(value) ? "" : "out of range: " + text + " (" + range_text(bounds) + ")";
      },
      "NUMBER");
}

bool takes_names(const Value& option) {
  return option.text.lists == Lists::regions || option.text.lists == Lists::walls;
}

// What the table takes as a list. A number alone is checked as others are.
CLI::Validator list_of(const Value& option) {
  const std::string name(option.text.name);
  const bool names = takes_names(option);
  return CLI::Validator(
      [name, names,
       number = number_within(bounds_of(option), false)](std::string& text) -> std::string {
        if (!names && text.find_first_of("=,") == std::string::npos) return number(text);
        Options any;
        if (options::set(any, name, std::string_view(text))) return "";
        return std::string("not ") + (names ? "names" : "lengths X or REGION=X") +
               " with commas: " + text;
      },
      names ? "NAMES" : "NUMBER");
}

std::vector<std::string> words_of(const Value& option) {
  if (option.kind == Kind::on_off) return {"on", "off"};
  std::vector<std::string> words;
  for (const options::Word& word : option.text.words) {
    if (!word.word.empty()) words.emplace_back(word.word);
  }
  return words;
}

bool is_flag(const Value& option) {
  return option.kind == Kind::on_off && option.value == 0;
}

// "X", "N", "on|off", "FILE"
std::string type_of(const Value& option) {
  if (option.kind == Kind::sources) return "FILE";
  if (takes_names(option)) return joined(words_of(option), "|") + "|NAMES";
  if (option.kind == Kind::number) return "X";
  return option.kind == Kind::count ? "N" : joined(words_of(option), "|");
}

// "smallest face angle, degrees (14.47; above 0, at most 30)"; ranges where there is a limit that
// one may come near.
std::string help_of(const Value& option) {
  constexpr double kFar = 1e6;
  std::string help(option.text.help);
  if (option.text.unit == options::Unit::degrees) help += ", degrees";
  if (option.text.unit == options::Unit::seconds) help += ", seconds";
  if (is_flag(option) || option.kind == Kind::sources || option.text.zero_is_none) return help;
  const bool numeric = option.kind == Kind::number || option.kind == Kind::count;
  help += " (" + value_text(option);
  if (numeric && option.text.bounds.high <= kFar) help += "; " + range_text(option.text.bounds);
  return help + ")";
}

void add_option(CLI::App& app, GivenOptions& given, const Value& option) {
  const std::string name(option.text.name), argument = "--" + argument_name(name);
  if (is_flag(option)) {
    app.add_flag_callback(
        argument, [&given, name] { given[name] = "on"; }, help_of(option));
    return;
  }
  CLI::Option* added = app.add_option_function<std::string>(
      argument, [&given, name](const std::string& text) { given[name] = text; }, help_of(option));
  const bool numeric = option.kind == Kind::number || option.kind == Kind::count;
  const std::vector<std::string> words = words_of(option);
  if (option.text.lists != Lists::nothing) {
    added->check(list_of(option));
  } else if (option.text.unit == options::Unit::length_or_share) {
    added->check(length_or_share(option.text.bounds));
  } else if (numeric) {
    added->check(number_within(bounds_of(option), option.kind == Kind::count, words));
  } else if (option.kind != Kind::sources) {
    added->check(CLI::IsMember(words));
  }
  added->type_name(type_of(option));
}

std::vector<std::string> paper_choices(const std::vector<Value>& values) {
  std::vector<std::string> names;
  for (const Value& option : values) {
    if (option.is_paper()) names.push_back(argument_name(option.text.name));
  }
  return names;
}

// Empty where an entry of the list is none of `all`.
std::vector<std::string> entries_of(const std::string& list, const std::vector<std::string>& all) {
  std::vector<std::string> entries;
  std::istringstream in(list + ",");
  for (std::string name; std::getline(in, name, ',');) {
    if (std::find(all.begin(), all.end(), name) == all.end()) return {};
    entries.push_back(name);
  }
  return entries;
}

void add_as_paper(CLI::App& app, GivenOptions& given, const std::vector<std::string>& all) {
  const std::string names = joined(all, ", ");
  app.add_option_function<std::string>(
         "--as-paper", [&given](const std::string& text) { given[kAsPaper] = text; },
         "choices made as in the paper: " + names + ", with commas, all, or none (none)")
      ->check(CLI::Validator(
          [all, names](std::string& text) -> std::string {
            const bool known = text == "all" || text == "none" || !entries_of(text, all).empty();
            return known ? "" : "none of " + names + ", all, none: " + text;
          },
          "LIST"))
      ->type_name("LIST");
}

// "paper: planar 0, gabriel, improve off, as-paper all; other options override it"
void add_preset(CLI::App& app, GivenOptions& given, const std::vector<Value>& defaults,
                const std::vector<Value>& preset) {
  std::vector<std::string> changes;
  for (std::size_t n = 0; n < preset.size(); ++n) {
    if (preset[n].value == defaults[n].value || preset[n].is_paper()) continue;
    const std::string value = is_flag(defaults[n]) ? "" : " " + value_text(preset[n]);
    changes.push_back(argument_name(preset[n].text.name) + value);
  }
  changes.emplace_back("as-paper all");
  app.add_option_function<std::string>(
         "--preset", [&given](const std::string& text) { given[kPreset] = text; },
         "paper: " + joined(changes, ", ") + "; other options override it")
      ->check(CLI::IsMember({"paper"}))
      ->type_name("paper");
}

}  // namespace

std::optional<double> length_or_share_of(std::string_view text) {
  if (const double share = options::share_of(text); share != 0) return share;
  double value = 0;
  if (io::parse_double(text, value) != io::NumberStatus::ok) return std::nullopt;
  return value;
}

void add_options(CLI::App& app, GivenOptions& given, const std::vector<Value>& defaults,
                 const std::vector<Value>& preset) {
  for (const Value& option : defaults) {
    if (!option.is_paper()) add_option(app, given, option);
  }
  if (preset.empty()) return;
  add_as_paper(app, given, paper_choices(defaults));
  add_preset(app, given, defaults, preset);
}

void add_number(CLI::App& app, GivenOptions& given, const std::string& name,
                const std::string& help, const Bounds& bounds, bool whole) {
  app.add_option_function<std::string>(
         "--" + argument_name(name),
         [&given, name](const std::string& text) { given[name] = text; }, help)
      ->check(number_within(bounds, whole))
      ->type_name(whole ? "N" : "X");
}

double number_of(const std::string& text) {
  double number = 0;
  io::parse_double(text, number);
  return number;
}

double value_given(const GivenOptions& given, const Value& value) {
  if (value.is_paper()) {
    const auto list = given.find(kAsPaper);
    if (list == given.end()) return value.value;
    const std::string name = argument_name(value.text.name);
    std::istringstream in(list->second);
    for (std::string entry; std::getline(in, entry, ',');) {
      if (entry == name || entry == "all") return 1;
    }
    return 0;
  }
  const auto found = given.find(value.text.name);
  if (found == given.end()) return value.value;
  if (value.kind == Kind::on_off) return found->second == "on" ? 1 : 0;
  for (const options::Word& word : value.text.words) {
    if (word.word == found->second) return word.value;
  }
  if (value.text.unit == options::Unit::length_or_share) {
    return length_or_share_of(found->second).value_or(0);
  }
  return number_of(found->second);
}

}  // namespace delmesher::cli
