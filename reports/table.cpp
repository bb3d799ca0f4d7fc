#include "reports/table.h"

#include <algorithm>

namespace tetproof {
namespace {

std::string markdown_cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '<') result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

// Columns are padded so that the source reads as a table too; numbers stand on the right.
std::string markdown_row(const std::vector<std::string>& cells,
                         const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string cell = markdown_cell(cells[i]);
    const std::string padding(widths[i] - std::min(widths[i], cell.size()), ' ');
    line += ' ' + (i == 0 ? cell + padding : padding + cell) + " |";
  }
  return line + '\n';
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string csv_row(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i == 0 ? "" : ",") + csv_cell(cells[i]);
  return line + "\r\n";
}

std::string latex_cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        result += '\\';
        result += c;
        break;
      case '\\':
        result += "\\textbackslash{}";
        break;
      case '~':
        result += "\\textasciitilde{}";
        break;
      case '^':
        result += "\\textasciicircum{}";
        break;
      case '<':
        result += "\\textless{}";
        break;
      case '>':
        result += "\\textgreater{}";
        break;
      default:
        result += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return result;
}

std::string latex_row(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += (i == 0 ? "" : " & ") + latex_cell(cells[i]);
  }
  return line + " \\\\\n";
}

}  // namespace

bool has_data(const Table& table) {
  return std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) {
    return std::any_of(row.begin() + (row.empty() ? 0 : 1), row.end(),
                       [](const std::string& cell) { return !cell.empty() && cell != "-"; });
  });
}

std::string to_markdown(const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 3);
  const auto widen = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      widths[i] = std::max(widths[i], markdown_cell(cells[i]).size());
    }
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);

  std::string text = "### " + table.title + "\n\n";
  if (!table.caption.empty()) text += table.caption + "\n\n";
  text += markdown_row(table.header, widths) + "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text += i == 0 ? ":" + std::string(widths[i] + 1, '-') + "|"
                   : std::string(widths[i] + 1, '-') + ":|";
  }
  text += '\n';
  for (const auto& row : table.rows) text += markdown_row(row, widths);
  if (!table.notes.empty()) text += '\n';
  for (const std::string& note : table.notes) text += "- " + note + '\n';
  return text + '\n';
}

std::string to_csv(const Table& table) {
  std::string text = csv_row(table.header);
  for (const auto& row : table.rows) text += csv_row(row);
  return text;
}

std::string to_latex(const Table& table) {
  std::string text = "\\begin{table}\n\\centering\n\\caption{" + latex_cell(table.title);
  std::vector<std::string> sentences = table.notes;
  if (!table.caption.empty()) sentences.insert(sentences.begin(), table.caption);
  for (const std::string& sentence : sentences) {
    text += (text.back() == '.' ? " " : ". ") + latex_cell(sentence);
  }
  text += "}\n\\label{tab:" + table.name + "}\n\\begin{tabular}{l";
  text += std::string(table.header.empty() ? 0 : table.header.size() - 1, 'r') + "}\n\\toprule\n";
  text += latex_row(table.header) + "\\midrule\n";
  for (const auto& row : table.rows) text += latex_row(row);
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n\n";
}

}  // namespace tetproof
