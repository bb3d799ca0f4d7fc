// The text of --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace delmesher::cli {

inline constexpr std::size_t kHelpWidth = 80;  // columns of a terminal

// Its lines are as long as a terminal is wide, and it leaves out what goes without saying.
class Help : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace delmesher::cli
