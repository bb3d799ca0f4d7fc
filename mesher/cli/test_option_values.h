// Values for tests that try all options of a table.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>

#include "mesher/delmesher/option_table.h"

namespace delmesher::cli {

// Another value than the default, as text and as a number.
inline std::pair<std::string, double> another_value(const options::Value& option) {
  switch (option.kind) {
    case options::Kind::number: {
      const double low = std::max(option.text.bounds.low, 1e-3), high = option.text.bounds.high;
      const double value = option.value == low ? std::min(high, low + 1) : low;
      std::ostringstream text;
      text << value;
      return {text.str(), value};
    }
    case options::Kind::count:
      return {"3", 3};
    case options::Kind::on_off:
      return option.value != 0 ? std::pair("off", 0.0) : std::pair("", 1.0);
    case options::Kind::choice: {
      const auto& word = option.text.words[option.value == option.text.words[0].value ? 1 : 0];
      return {std::string(word.word), word.value};
    }
    case options::Kind::sources:
      return {"sizes.txt", 0};
  }
  return {};
}

}  // namespace delmesher::cli
