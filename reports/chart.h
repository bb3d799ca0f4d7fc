// A chart as data: its contents, not its looks. The page draws it (page/charts.js), CSV repeats it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/table.h"

namespace tetproof {

struct Chart {
  enum class Kind : std::uint8_t {
    bars,          // one value per category and series
    stacked_bars,  // likewise, on top of each other
    lines,         // points in the order of x
    steps,         // likewise, constant between points
    points
  };
  struct Series {
    std::string label;
    std::vector<std::optional<double>> values = {};      // bars: one per category
    std::vector<std::pair<double, double>> points = {};  // the others
    std::vector<std::string> point_names = {};           // points: a text for each; may be empty
    std::size_t style = 0;  // index for series_style(), another for each series of a chart
  };

  std::string name;  // of the CSV file and of the element in the page
  std::string title;
  Kind kind = Kind::bars;
  std::string x_title, y_title;
  std::vector<std::string> categories;  // bars
  std::vector<Series> series;
  bool log_x = false, log_y = false;
  bool diagonal = false;  // points: draw x = y
  bool flat = false;      // bars lie, so that long names of categories can be read
  std::vector<std::string> notes;

  bool empty() const;
};

// One object, as page/charts.js reads it.
std::string to_json(const Chart& chart);

// Bars: a row per category; else a row per point.
Table to_table(const Chart& chart);

}  // namespace tetproof
