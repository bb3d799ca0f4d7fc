#include "mesher/cli/help.h"

#include <sstream>
#include <vector>

namespace delmesher::cli {
namespace {

constexpr std::size_t kMostIndent = 26;

// "  NAME      text", with the text on as many lines as it takes.
std::string entry(const std::string& name, const std::string& text, std::size_t indent) {
  std::string out = "  " + name;
  if (out.size() + 2 > indent) {
    out += "\n" + std::string(indent, ' ');
  } else {
    out.resize(indent, ' ');
  }
  std::istringstream words(text);
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kHelpWidth) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out + "\n";
}

// "FILE" of "FILE:some check"
std::string type_of(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

// "-o, --output FILE"
std::string name_of(const CLI::Option& option) {
  std::string name;
  for (const std::string& given : option.get_snames()) name += "-" + given + ", ";
  for (const std::string& given : option.get_lnames()) name += "--" + given + ", ";
  name.resize(name.size() - 2);
  const std::string type = type_of(option);
  return type.empty() ? name : name + " " + type;
}

std::string usage(const CLI::App& app, const std::string& name) {
  std::string text = "Usage: " + name;
  if (!app.get_subcommands({}).empty()) return text + " [COMMAND] INPUT... -o OUTPUT [OPTIONS]\n";
  text += " INPUT...";
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_required() || option->get_positional()) continue;
    text += " -" + option->get_snames().front() + " " + type_of(*option);
  }
  return text + " [OPTIONS]\n";
}

}  // namespace

std::string Help::make_help(const CLI::App* app, std::string name,
                            CLI::AppFormatMode /*mode*/) const {
  std::string out = app->get_description() + "\n" + usage(*app, name);
  std::size_t indent = 0;  // short where all names are
  std::vector<std::pair<std::string, std::string>> inputs, options, commands;
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional()) {
      inputs.emplace_back("INPUT", option->get_description());
    } else {
      options.emplace_back(name_of(*option), option->get_description());
    }
  }
  for (const CLI::App* command : app->get_subcommands({})) {
    commands.emplace_back(command->get_name(), command->get_description());
  }
  for (const auto* list : {&inputs, &options, &commands}) {
    for (const auto& [word, text] : *list) indent = std::max(indent, word.size() + 4);
  }
  indent = std::min(indent, kMostIndent);
  for (const auto* list : {&commands, &inputs, &options}) {
    if (list->empty()) continue;
    out += "\n";
    for (const auto& [word, text] : *list) out += entry(word, text, indent);
  }
  return out + "\n" + app->get_footer() + "\n";
}

}  // namespace delmesher::cli
