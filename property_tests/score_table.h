// The mutation score: the damage and the oracles that caught it, printed as a table when all tests
// of a program have run.
#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "oracles/verify.h"

namespace tetproof {

struct Score {
  std::string base, damage, meant;
  bool caught = false;
  std::string before;  // its fate before its row was there, if that is known
  std::string also;    // other oracles that objected
};

class ScoreTable : public testing::Environment {
 public:
  static std::vector<Score>& rows() {
    static std::vector<Score> rows;  // NOLINT: a test program's own
    return rows;
  }
  void TearDown() override {
    if (rows().empty()) return;
    std::cout << "| mesh | damage | meant to catch it | caught | before | objecting as well |\n"
              << "|---|---|---|---|---|---|\n";
    std::size_t caught = 0;
    for (const Score& s : rows()) {
      caught += s.caught;
      std::cout << "| " << s.base << " | " << s.damage << " | " << s.meant << " | "
                << (s.caught ? "yes" : "NO") << " | " << s.before << " | " << s.also << " |\n";
    }
    std::cout << "mutation score: " << caught << " of " << rows().size() << "\n";
  }
};

[[maybe_unused]] inline const auto* const kTable =
    testing::AddGlobalTestEnvironment(new ScoreTable);

inline void judge(const std::string& base, const std::string& damage, const std::string& meant,
                  const oracles::VerifyReport& report, const std::string& before = {}) {
  Score score{base, damage, meant, false, before, {}};
  for (const oracles::OracleReport& oracle : report.oracles) {
    if (oracle.passed()) continue;
    if (oracle.name == meant) {
      score.caught = !oracle.findings.empty();
    } else {
      score.also += (score.also.empty() ? "" : ", ") + oracle.name;
    }
  }
  EXPECT_TRUE(score.caught) << damage << " is not caught by " << meant << "\n" << to_text(report);
  EXPECT_EQ(report.verdict, oracles::Verdict::broken) << damage;
  ScoreTable::rows().push_back(score);
}

}  // namespace tetproof
