// A table of text cells, written as Markdown, CSV and LaTeX.
#pragma once

#include <string>
#include <vector>

namespace tetproof {

struct Table {
  std::string name;   // of the CSV file
  std::string title;  // above the table
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes;  // below the table: denominators, conventions
  std::string caption = {};        // below the title: the conditions, such as limits of the runs
  // Columns of commands and the like, which the page shows on request.
  std::vector<std::size_t> folded_columns = {};
  // SVG for each row, which the page shows on request in a row below it; empty ones are none.
  std::vector<std::string> pictures = {};
  // The page colours cells by what they say (a number or the name of a disposition), and sorts by
  // the column whose head is clicked.
  bool heat_map = false;
};

// Has any cell contents other than "-"? Row labels do not count.
bool has_data(const Table& table);

std::string to_markdown(const Table& table);
std::string to_csv(const Table& table);    // RFC 4180
std::string to_latex(const Table& table);  // a table environment; needs the package booktabs

}  // namespace tetproof
