// The options of option_table.h on the command line: --NAME with - for _, choices of the paper as
// the list of --as-paper.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesher/delmesher/option_table.h"

namespace delmesher::cli {

// The options as the user gave them, by their names in the table: numbers and words as text, so
// that numbers are read like those in files, in no locale; a switch is "on" or "off"; a size field
// is the file's name; "as_paper" is the list, "preset" the preset.
using GivenOptions = std::map<std::string, std::string, std::less<>>;

// Adds the options of a job, whose values are the defaults. `preset`: what --preset paper makes of
// them; empty: there is none.
void add_options(CLI::App& app, GivenOptions& given, const std::vector<options::Value>& defaults,
                 const std::vector<options::Value>& preset);

// A number that the table does not have.
void add_number(CLI::App& app, GivenOptions& given, const std::string& name,
                const std::string& help, const options::Bounds& bounds, bool whole);
double number_of(const std::string& text);
// Of an option with Unit::length_or_share; empty if the text is neither.
std::optional<double> length_or_share_of(std::string_view text);

// The value that an option was given; `value` where it was not.
double value_given(const GivenOptions& given, const options::Value& value);

// Where an option was not given, its value stays.
template <class JobOptions>
void take(const GivenOptions& given, JobOptions& job) {
  for (const options::Value& option : options::values_of(job)) {
    const auto found = given.find(option.text.name);
    const bool is_list = option.text.lists != options::Text::Lists::nothing && found != given.end();
    if (is_list && options::set(job, option.text.name, std::string_view(found->second))) continue;
    options::set(job, option.text.name, value_given(given, option));
  }
}

}  // namespace delmesher::cli
