// The report as one HTML page that needs nothing but itself.
#pragma once

#include <string>
#include <vector>

#include "reports/chart.h"
#include "reports/selection.h"
#include "reports/table.h"
#include "reports/views.h"

namespace tetproof {

// A part of the report, with all that every format shows, in its order.
struct Section {
  std::string id, title, text;  // `text`: a sentence or two, may be empty
  std::vector<Table> tables;
  std::vector<Chart> charts;
  bool side_by_side = false;  // tables stand beside each other where there is room
  bool folded = false;        // tables are long: shown on request
};

struct Page {
  std::string title;
  std::vector<std::string> summary;   // what was run, and who is best at what, in sentences
  std::vector<std::string> headline;  // short facts, each "number words"
  std::vector<std::string> warnings;  // below it, in sentences
  std::vector<Section> sections;
  std::vector<ViewPart> views;
  std::vector<std::string> notes;
  // Does this build hold the libraries that draw charts (Chart.js) and pictures (three.js)? A page
  // without them names the missing ones.
  bool has_charts = true, has_pictures = true;
};

std::string to_html(const Table& table);

std::string to_html(const Page& page, const Selection& selection);

}  // namespace tetproof
