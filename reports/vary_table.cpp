// Exact copies beside the models that they are copies of (tetproof vary): which meshers change
// their mind.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "reports/measures.h"
#include "reports/relations.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

// "DIR/NAME@t2.off" is a copy of DIR/NAME.
struct CopyName {
  std::string model;
  const RelationName* relation;
};

std::string stem_of(const std::string& file) {
  return file.substr(0, file.rfind('.'));
}

std::optional<CopyName> copy_name(const std::string& file) {
  const std::string stem = stem_of(file);
  const std::size_t at = stem.rfind('@');
  if (at == std::string::npos || at + 2 >= stem.size()) return std::nullopt;
  const bool number = std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(at) + 2, stem.end(),
                                  [](char c) { return c >= '0' && c <= '9'; });
  const auto* relation =
      std::find_if(kRelations.begin(), kRelations.end(),
                   [&](const RelationName& name) { return name.letter == stem[at + 1]; });
  if (!number || relation == kRelations.end()) return std::nullopt;
  return CopyName{stem.substr(0, at), relation};
}

// Did the run end in a way that is the mesher's own?
bool tells(const RunRow& row) {
  return row.disposition != Disposition::killed && row.disposition != Disposition::unverified;
}

struct Pair {
  const RelationName* relation;
  const RunRow *given, *copy;
  bool changed() const { return given->disposition != copy->disposition; }
};

// In the order of the models' names.
std::vector<Pair> pairs_of(const Selection& selection, const std::string& mesher) {
  std::map<std::string, const RunRow*> given;
  for (const auto& [hash, row] : selection.runs.at(mesher)) given[stem_of(row.model_name)] = &row;
  std::vector<Pair> pairs;
  for (const std::string& model : selection.models) {
    const RunRow* row = selection.run(mesher, model);
    if (row == nullptr || !tells(*row)) continue;
    const auto copy = copy_name(row->model_name);
    if (!copy) continue;
    const auto at = given.find(copy->model);
    if (at != given.end() && tells(*at->second)) pairs.push_back({copy->relation, at->second, row});
  }
  return pairs;
}

std::string ending(const RunRow& row) {
  const std::string name = disposition_name(row.disposition);
  return row.reason.empty() ? name : name + ": " + row.reason;
}

}  // namespace

Table vary_table(const Selection& selection) {
  Table table;
  table.name = "vary";
  table.title = "Exact copies: who changes its mind";
  table.header = {"Mesher", "Copy", "Pairs", "as given", "other", "ok only given", "ok only copy"};
  for (const std::string& mesher : selection.meshers) {
    const std::vector<Pair> pairs = pairs_of(selection, mesher);
    for (const RelationName& relation : kRelations) {
      std::size_t all = 0, changed = 0, only_given = 0, only_copy = 0;
      for (const Pair& pair : pairs) {
        if (pair.relation != &relation) continue;
        ++all;
        if (!pair.changed()) continue;
        ++changed;
        only_given += pair.given->disposition == Disposition::ok;
        only_copy += pair.copy->disposition == Disposition::ok;
      }
      if (all == 0) continue;
      table.rows.push_back({mesher, relation.text, std::to_string(all),
                            std::to_string(all - changed), std::to_string(changed),
                            std::to_string(only_given), std::to_string(only_copy)});
    }
  }
  if (table.rows.empty()) return table;
  table.caption = limits_caption(selection, selection.meshers);
  table.notes = {
      "Copies that bound the same solid exactly, up to an exact motion or scale (tetproof vary), "
      "beside the model as given: pairs of runs that both ended by themselves or at a limit, "
      "those with the same disposition as the model as given, those with another one, and among "
      "these those where one of the two is ok."};
  return table;
}

Table vary_changes_table(const Selection& selection) {
  Table table;
  table.name = "vary-changes";
  table.title = "Every change of mind";
  table.header = {"Mesher", "Copy", "What was done", "Model as given", "Copy of it"};
  for (const std::string& mesher : selection.meshers) {
    for (const Pair& pair : pairs_of(selection, mesher)) {
      if (!pair.changed()) continue;
      table.rows.push_back({mesher, short_name(pair.copy->model_name), pair.relation->text,
                            ending(*pair.given), ending(*pair.copy)});
    }
  }
  return table;
}

}  // namespace tetproof
