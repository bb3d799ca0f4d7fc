// The paper's figures beside those of this campaign, and the differences.
#pragma once

#include <string>
#include <vector>

#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

// One table per table or section of the paper, with notes on data and versions, and on where the
// paper's own figures do not add up.
std::vector<Table> fidelity_tables(const Selection& selection, const std::string& table_3_model);

}  // namespace tetproof
