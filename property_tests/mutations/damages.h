// Damage to good meshes: the common parts of the three files of tables.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::mutations {

template <class Damage>
std::string test_name(const testing::TestParamInfo<Damage>& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

inline oracles::VerifyReport run(const samples::Sample& sample,
                                 const delmesher::ExactRecord* exact = nullptr,
                                 const oracles::VerifyOptions& options = {}) {
  oracles::VerifyReport report;
  EXPECT_EQ(verify(sample.input, sample.mesh, exact, options, report), "");
  return report;
}

struct RecordDamage {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*apply)(delmesher::ExactRecord&);
};

inline void PrintTo(const RecordDamage& damage, std::ostream* stream) {
  *stream << damage.name;
}

}  // namespace tetproof::mutations
