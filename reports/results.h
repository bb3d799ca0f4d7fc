// The results of a campaign: one SQLite file, one row per model, mesher, version, flags and limits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace SQLite {
class Database;
}

namespace tetproof {

enum class Disposition : std::uint8_t {
  ok,          // a mesh was delivered, and the oracles have nothing against it
  unverified,  // a mesh was delivered, but the oracles have not finished with it, or were not asked
  wrong_result,   // a mesh was delivered, but it is broken or has inverted tetrahedra
  rejected,       // the mesher refused the model; `reason` says why
  crash,          // ended by a signal of its own making, or by an internal error it noticed
  timeout,        // wall or processor limit
  out_of_memory,  // memory limit, or it said so itself
  killed          // ended from outside
};

inline constexpr std::size_t kDispositionCount = 8;

const char* disposition_name(Disposition disposition);  // "wrong-result", "out-of-memory", ...
// \throw std::runtime_error for anything that disposition_name() does not return.
Disposition disposition_from_name(const std::string& name);

// Identifies a run. A run with the same key is not repeated.
struct RunKey {
  std::string model_sha256;
  std::string mesher;   // name as given to -m
  std::string version;  // of the tool, with the build's id
  std::string flags;
  std::string limits;
  auto operator<=>(const RunKey&) const = default;
};

// Size, angles and shapes of a written mesh, as measured from the file (reports/mesh_quality.h). Of
// a mesh of the plane (plane_quality.h) the triangles are the tetrahedra, their angles those of
// faces and their area the volume; it has no others.
struct MeshColumns {
  std::uint64_t vertices = 0, tetrahedra = 0;
  double min_face_angle = 0, max_face_angle = 0, min_dihedral = 0, max_dihedral = 0;
  double mean_min_face_angle = 0, mean_max_face_angle = 0;
  double mean_min_dihedral = 0, mean_max_dihedral = 0;
  double shortest_edge = 0, volume = 0;  // 0 where a mesher's own statistics do not tell
  // Nothing in results of versions that did not measure it. Shares are fractions of the tetrahedra.
  std::optional<double> share_below_5, share_below_10, dihedral_percent;
  std::optional<double> min_gamma, mean_gamma, gamma_percent, min_sicn, mean_sicn;

  bool operator==(const MeshColumns&) const = default;
};

// What a solver sees of the tetrahedra inside (reports/poisson.h).
struct SolverColumns {
  std::uint64_t unknowns = 0, iterations = 0;
  bool converged = false;
  double condition = 0, mean_error = 0;
};

struct RunRow {
  RunKey key;
  std::string model_name, model_path;
  std::uint64_t model_bytes = 0;
  Disposition disposition = Disposition::killed;
  std::string reason;  // empty if ok; for an unverified mesh why no oracle vouches for it
  std::optional<int> exit_code, signal;
  double wall_seconds = 0, cpu_seconds = 0;
  std::optional<double> mesh_seconds;  // without reading, checking and writing, by its own account
  std::optional<double> verify_seconds;  // wall time of the oracles; nothing if they were not asked
  std::uint64_t peak_rss_bytes = 0;
  std::optional<MeshColumns> mesh;  // if a readable mesh was written
  std::optional<MeshColumns> inside;
  std::optional<MeshColumns> refined;  // before the enriched CDT, by the mesher's account
  std::optional<std::uint64_t> inverted, flat;
  std::string region;        // that the mesh covers: "hull", "interior", "plane" or empty
  std::string promise;       // of the surface, in words: "exact", ...; empty in older results
  std::string stats_json;    // the mesher's own, empty if none
  std::string mesh_json;     // measured, empty if no readable mesh
  std::string verdict_json;  // the oracles', empty if not asked
  std::string stderr_tail, stdout_tail;
  std::string command, host, started;  // UTC, ISO 8601
  std::string mesh_path;               // where the mesh was kept, empty if it was not
};

// The oracles' verdict: "exact", "rounded", "deviating", "broken"; "unknown" if they could not
// decide, empty if they were not asked.
std::string verdict_of(const RunRow& row);

// No row is ok without a verdict. A row of an earlier version that claims it becomes unverified,
// with the reason. Rows are stored and read like that.
void demand_verdict(RunRow& row);

// Of two rows with one key, does `row` survive a merge, in any order? A row killed from outside
// gives way, then an unverified one, then the earlier one.
bool supersedes(const RunRow& row, const RunRow& other);

// The columns found in a measured object (no member), or in its member `inside`, or in the member
// `refined` of a mesher's statistics; a member without tetrahedra counts as absent.
std::optional<MeshColumns> mesh_columns(const std::string& json_text, const std::string& member);

// Nothing if no solver was asked.
std::optional<SolverColumns> solver_columns(const std::string& mesh_json);

class ResultsDatabase {
 public:
  enum class Mode : std::uint8_t { read, write };

  // Write mode creates the file, and holds a lock so that there is one writer. When the last user
  // is gone, only the file remains, unless that user was killed; the next one cleans up then.
  // \throw std::runtime_error if it cannot be opened, is not ours, or another writer has it.
  ResultsDatabase(const std::filesystem::path& path, Mode mode);
  ~ResultsDatabase();

  bool has(const RunKey& key);
  // Durable against the death of this process once it returns. Replaces a row of the same key.
  void store(const RunRow& row);
  // Stores the row unless the database has one of the same key that stays. Returns whether it was
  // stored.
  bool merge(const RunRow& row);
  std::optional<RunRow> find(const RunKey& key);
  std::vector<RunRow> rows();  // in the order of storing

 private:
  void prepare_for_writing();
  void demand_verdicts();
  // The text between SELECT and FROM for read_row().
  std::string selected_columns() const;
  template <typename Action>
  auto named(const Action& action);

  std::unique_ptr<SQLite::Database> database_;
  std::filesystem::path path_;
  int lock_fd_ = -1;
  int version_ = 0;  // of the file's schema, 0 if it was empty
};

// Sorts by model name, then key, an order that does not depend on how the rows came about.
void sort_rows(std::vector<RunRow>& rows);

}  // namespace tetproof
