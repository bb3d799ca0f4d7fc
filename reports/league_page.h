// The league as a page of Markdown, with its runs beside it, from which later pages are made.
//
// Laws: of several runs of a model with a mesher the latest counts; but one of the same version,
// flags and limits stays, unless it was not verified or killed, or only the later one tells what a
// solver sees. A run that took more than the least limits of all runs counts as if it had met them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/league.h"
#include "reports/results.h"

namespace tetproof {

// Runs as write_league() stores them: FILE.csv, and FILE_meshers.csv for what each mesher was.
// \throw std::runtime_error if a file cannot be read or is another table.
std::vector<RunRow> read_league(const std::filesystem::path& csv);

struct LeagueOptions {
  Families families;
  std::string commit;                 // of which our own programs are; empty: not known
  std::vector<std::string> left_out;  // meshers whose runs stay in PAGE.csv alone
};

// Writes PAGE.md, PAGE_tables.md, PAGE.csv and PAGE_meshers.csv from campaigns (results files, or
// .csv of earlier pages) in the order of time. What stands in PAGE.md from the line "<!-- by hand
// -->" on stays. \throw std::runtime_error if there is no run, or a file cannot be read or written.
void write_league(const std::vector<std::filesystem::path>& campaigns,
                  const std::filesystem::path& page, const LeagueOptions& options);

}  // namespace tetproof
