// Reading CSV (RFC 4180) with a header line.
#pragma once

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace tetproof {

// Cells by the name of their column. The cell of an unknown column is empty.
class CsvRecord {
 public:
  explicit CsvRecord(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}
  const std::string& at(const std::string& column) const {
    static const std::string kNothing;
    const auto found = cells_.find(column);
    return found == cells_.end() ? kNothing : found->second;
  }

 private:
  std::map<std::string, std::string> cells_;
};

std::vector<std::vector<std::string>> parse_csv(const std::string& text);

// \throw std::runtime_error if the file cannot be read.
std::vector<CsvRecord> read_csv(const std::filesystem::path& path);

}  // namespace tetproof
