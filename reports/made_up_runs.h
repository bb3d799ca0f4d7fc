// A small made-up campaign, for tests: 3 models, 5 meshers, some failures.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

struct Made {
  const char* model;
  const char* mesher;
  Disposition disposition;
  unsigned tets;
  double min_face;
  double wall;
  double refined_min_face;  // 0: none
  unsigned inside_tets;     // 0: none
};

inline RunRow row_of(const Made& made) {
  RunRow row;
  row.key = {std::string("hash-") + made.model, made.mesher, "1", "f", "l"};
  row.model_name = made.model;
  row.disposition = made.disposition;
  row.wall_seconds = made.wall;
  row.mesh_seconds = made.wall / 2;
  row.peak_rss_bytes = made.tets * 100;
  row.started = "2026-01-01T00:00:00Z";
  if (made.disposition != Disposition::ok) {
    row.reason = "a | reason";
    return row;
  }
  row.mesh.emplace();
  row.mesh->tetrahedra = made.tets;
  row.mesh->vertices = made.tets / 5;
  row.mesh->min_face_angle = made.min_face;
  row.mesh->max_face_angle = 170;
  if (made.refined_min_face > 0) {
    row.refined.emplace();
    row.refined->min_face_angle = made.refined_min_face;
  }
  if (made.inside_tets > 0) {
    row.inside.emplace();
    row.inside->tetrahedra = made.inside_tets;
    row.inside->min_face_angle = 2 * made.min_face;
  }
  return row;
}

inline constexpr auto kOk = Disposition::ok;

inline Selection campaign() {
  std::vector<RunRow> rows;
  for (const Made& made :
       std::initializer_list<Made>{{"a", "safe-delmesher-e4", kOk, 1000, 2, 0.10, 14.5, 400},
                                   {"b", "safe-delmesher-e4", kOk, 3000, 4, 0.50, 15.5, 900},
                                   {"c", "safe-delmesher-e4", kOk, 20000, 0.003, 3.0, 14.9, 9000},
                                   {"a", "delmesher-e4", kOk, 1500, 3, 0.2, 14.6, 500},
                                   {"b", "delmesher-e4", Disposition::timeout, 0, 0, 60, 0, 0},
                                   {"c", "delmesher-e4", kOk, 30000, 1, 6.0, 14.7, 10000},
                                   {"a", "tetgen", kOk, 500, 5, 0.01, 0, 200},
                                   {"b", "tetgen", Disposition::crash, 0, 0, 0.02, 0, 0},
                                   {"c", "tetgen", kOk, 10000, 1, 0.4, 0, 4000},
                                   {"a", "tetgen-T0", kOk, 600, 6, 0.012, 0, 250},
                                   {"b", "tetgen-T0", Disposition::rejected, 0, 0, 0.02, 0, 0},
                                   {"c", "tetgen-T0", Disposition::rejected, 0, 0, 0.02, 0, 0},
                                   {"a", "cdt", kOk, 100, 1, 0.005, 0, 50},
                                   {"b", "cdt", kOk, 200, 1, 0.005, 0, 80},
                                   {"c", "cdt", kOk, 300, 1, 0.005, 0, 90}}) {
    rows.push_back(row_of(made));
  }
  return select_runs(rows);
}

// Cells by row label and column header.
inline std::map<std::string, std::map<std::string, std::string>> cells(const Table& table) {
  std::map<std::string, std::map<std::string, std::string>> result;
  for (const auto& row : table.rows) {
    EXPECT_EQ(row.size(), table.header.size());
    for (std::size_t i = 1; i < row.size(); ++i) result[row[0]][table.header[i]] = row[i];
  }
  return result;
}

}  // namespace tetproof
