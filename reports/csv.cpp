#include "reports/csv.h"

#include <fstream>
#include <iterator>
#include <utility>

namespace tetproof {

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row;
  std::string cell;
  bool quoted = false;
  const auto end_row = [&] {
    row.push_back(std::exchange(cell, ""));
    if (row.size() > 1 || !row[0].empty()) rows.push_back(row);
    row.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        cell += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        cell += '"';
        ++i;
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      row.push_back(std::exchange(cell, ""));
    } else if (c == '\n') {
      end_row();
    } else if (c != '\r') {
      cell += c;
    }
  }
  end_row();
  return rows;
}

std::vector<CsvRecord> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be opened");
  const auto rows = parse_csv({std::istreambuf_iterator<char>(file), {}});
  std::vector<CsvRecord> records;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::map<std::string, std::string> cells;
    for (std::size_t k = 0; k < rows[i].size() && k < rows[0].size(); ++k) {
      cells[rows[0][k]] = rows[i][k];
    }
    records.emplace_back(std::move(cells));
  }
  return records;
}

}  // namespace tetproof
