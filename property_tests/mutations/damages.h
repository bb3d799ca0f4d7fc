// Damage to good meshes: the common parts of the three files of tables.
#pragma once

#include "oracles/verify.h"
#include "property_tests/lie.h"
#include "property_tests/samples.h"

namespace tetproof::mutations {

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
