#include "reports/results.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace tetproof {
namespace {

using Json = nlohmann::json;

constexpr int kSchemaVersion = 5;
constexpr int kApplicationId = 0x74657470;  // "tetp"
constexpr std::array<const char*, kDispositionCount> kDispositions = {
    "ok", "unverified", "wrong-result", "rejected", "crash", "timeout", "out-of-memory", "killed"};

// Columns besides the key, in the order in which they are bound and read. Angles and counts stand
// in columns for queries by hand; histograms and the rest are in the JSON texts.
constexpr const char* kSchema = R"(
CREATE TABLE IF NOT EXISTS runs (
  id INTEGER PRIMARY KEY,
  model_sha256 TEXT NOT NULL, mesher TEXT NOT NULL, version TEXT NOT NULL, flags TEXT NOT NULL,
  limits TEXT NOT NULL,
  model_name TEXT NOT NULL, model_path TEXT NOT NULL, model_bytes INTEGER NOT NULL,
  disposition TEXT NOT NULL, reason TEXT NOT NULL, exit_code INTEGER, signal INTEGER,
  wall_seconds REAL NOT NULL, cpu_seconds REAL NOT NULL, mesh_seconds REAL,
  peak_rss_bytes INTEGER NOT NULL, inverted INTEGER, flat INTEGER, region TEXT NOT NULL,
  tetrahedra INTEGER, vertices INTEGER, min_face_angle REAL, max_face_angle REAL,
  min_dihedral REAL, max_dihedral REAL,
  microseconds_per_tetrahedron REAL, peak_bytes_per_tetrahedron REAL,
  stats_json TEXT NOT NULL, mesh_json TEXT NOT NULL, verdict_json TEXT NOT NULL,
  stderr_tail TEXT NOT NULL, stdout_tail TEXT NOT NULL,
  command TEXT NOT NULL, host TEXT NOT NULL, started TEXT NOT NULL,
  verdict TEXT NOT NULL DEFAULT '', mesh_path TEXT NOT NULL DEFAULT '',
  verify_seconds REAL,
  share_below_5_degrees REAL, share_below_10_degrees REAL, dihedral_1_percent REAL,
  min_gamma REAL, mean_gamma REAL, gamma_1_percent REAL, min_sicn REAL, mean_sicn REAL,
  promise TEXT NOT NULL DEFAULT '',
  UNIQUE (model_sha256, mesher, version, flags, limits)))";

constexpr const char* kColumns =
    "model_sha256, mesher, version, flags, limits, model_name, model_path, model_bytes, "
    "disposition, reason, exit_code, signal, wall_seconds, cpu_seconds, mesh_seconds, "
    "peak_rss_bytes, inverted, flat, region, tetrahedra, vertices, min_face_angle, "
    "max_face_angle, min_dihedral, max_dihedral, microseconds_per_tetrahedron, "
    "peak_bytes_per_tetrahedron, stats_json, mesh_json, verdict_json, stderr_tail, stdout_tail, "
    "command, host, started";
constexpr const char* kLaterColumns = ", verdict, mesh_path, verify_seconds, promise";

// Written for queries by hand only: they are read from the JSON texts.
struct QualityColumn {
  const char* name;
  std::optional<double> MeshColumns::*column;
};
constexpr QualityColumn kQualityColumns[] = {
    {"share_below_5_degrees", &MeshColumns::share_below_5},
    {"share_below_10_degrees", &MeshColumns::share_below_10},
    {"dihedral_1_percent", &MeshColumns::dihedral_percent},
    {"min_gamma", &MeshColumns::min_gamma},
    {"mean_gamma", &MeshColumns::mean_gamma},
    {"gamma_1_percent", &MeshColumns::gamma_percent},
    {"min_sicn", &MeshColumns::min_sicn},
    {"mean_sicn", &MeshColumns::mean_sicn}};
constexpr std::size_t kColumnCount = 39 + std::size(kQualityColumns);

constexpr const char* kWhereKey =
    " WHERE model_sha256 = ? AND mesher = ? AND version = ? AND flags = ? AND limits = ?";

// What programs say may be in any encoding; what is stored goes into JSON, XML and pages.
std::string in_utf8(const std::string& text) {
  const auto plain = [](char c) { return static_cast<unsigned char>(c) < 128; };
  if (std::all_of(text.begin(), text.end(), plain)) return text;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
}

// Binds values to consecutive parameters; absent ones become NULL.
class Binder {
 public:
  explicit Binder(SQLite::Statement& statement) : statement_(statement) {}
  void operator()(const std::string& value) { statement_.bind(++at_, in_utf8(value)); }
  void operator()(double value) { statement_.bind(++at_, value); }
  void operator()(int value) { statement_.bind(++at_, value); }
  void operator()(std::uint64_t value) { statement_.bind(++at_, static_cast<std::int64_t>(value)); }
  template <typename T>
  void operator()(const std::optional<T>& value) {
    if (value) return (*this)(*value);
    statement_.bind(++at_);
  }

 private:
  SQLite::Statement& statement_;
  int at_ = 0;
};

// Reads consecutive columns.
class Reader {
 public:
  explicit Reader(SQLite::Statement& statement) : statement_(statement) {}
  void operator()(std::string& value) { value = next().getString(); }
  void operator()(double& value) { value = next().getDouble(); }
  void operator()(int& value) { value = next().getInt(); }
  void operator()(std::uint64_t& value) { value = static_cast<std::uint64_t>(next().getInt64()); }
  template <typename T>
  void operator()(std::optional<T>& value) {
    value.reset();
    if (statement_.isColumnNull(at_)) {
      ++at_;
    } else {
      (*this)(value.emplace());
    }
  }

 private:
  SQLite::Column next() { return statement_.getColumn(at_++); }
  SQLite::Statement& statement_;
  int at_ = 0;
};

template <typename Visit, typename Key>
void visit_key(Visit& visit, Key& key) {
  visit(key.model_sha256);
  visit(key.mesher);
  visit(key.version);
  visit(key.flags);
  visit(key.limits);
}

template <typename T>
std::optional<double> column(const std::optional<MeshColumns>& mesh, T MeshColumns::*member) {
  return mesh ? std::optional<double>(static_cast<double>((*mesh).*member)) : std::nullopt;
}

// An amount per tetrahedron of the row's mesh; nothing without tetrahedra.
std::optional<double> per_tetrahedron(const RunRow& row, double amount) {
  if (!row.mesh || row.mesh->tetrahedra == 0) return std::nullopt;
  return amount / static_cast<double>(row.mesh->tetrahedra);
}

void bind_row(SQLite::Statement& statement, const RunRow& row) {
  Binder bind(statement);
  visit_key(bind, row.key);
  bind(row.model_name);
  bind(row.model_path);
  bind(row.model_bytes);
  bind(std::string(disposition_name(row.disposition)));
  bind(row.reason);
  bind(row.exit_code);
  bind(row.signal);
  bind(row.wall_seconds);
  bind(row.cpu_seconds);
  bind(row.mesh_seconds);
  bind(row.peak_rss_bytes);
  bind(row.inverted);
  bind(row.flat);
  bind(row.region);
  bind(row.mesh ? std::optional(row.mesh->tetrahedra) : std::nullopt);
  bind(row.mesh ? std::optional(row.mesh->vertices) : std::nullopt);
  bind(column(row.mesh, &MeshColumns::min_face_angle));
  bind(column(row.mesh, &MeshColumns::max_face_angle));
  bind(column(row.mesh, &MeshColumns::min_dihedral));
  bind(column(row.mesh, &MeshColumns::max_dihedral));
  bind(per_tetrahedron(row, 1e6 * row.wall_seconds));
  bind(per_tetrahedron(row, static_cast<double>(row.peak_rss_bytes)));
  bind(row.stats_json);
  bind(row.mesh_json);
  bind(row.verdict_json);
  bind(row.stderr_tail);
  bind(row.stdout_tail);
  bind(row.command);
  bind(row.host);
  bind(row.started);
  bind(verdict_of(row));
  bind(row.mesh_path);
  bind(row.verify_seconds);
  bind(row.promise);
  for (const QualityColumn& quality : kQualityColumns) {
    bind(row.mesh ? (*row.mesh).*quality.column : std::nullopt);
  }
}

RunRow read_row(SQLite::Statement& statement) {
  RunRow row;
  Reader read(statement);
  visit_key(read, row.key);
  read(row.model_name);
  read(row.model_path);
  read(row.model_bytes);
  std::string disposition;
  read(disposition);
  row.disposition = disposition_from_name(disposition);
  read(row.reason);
  read(row.exit_code);
  read(row.signal);
  read(row.wall_seconds);
  read(row.cpu_seconds);
  read(row.mesh_seconds);
  read(row.peak_rss_bytes);
  read(row.inverted);
  read(row.flat);
  read(row.region);
  std::optional<double> in_json;
  for (int i = 0; i < 8; ++i) read(in_json);
  read(row.stats_json);
  read(row.mesh_json);
  read(row.verdict_json);
  read(row.stderr_tail);
  read(row.stdout_tail);
  read(row.command);
  read(row.host);
  read(row.started);
  std::string in_verdict;
  read(in_verdict);
  read(row.mesh_path);
  read(row.verify_seconds);
  read(row.promise);
  row.mesh = mesh_columns(row.mesh_json, "");
  row.inside = mesh_columns(row.mesh_json, "inside");
  row.refined = mesh_columns(row.stats_json, "refined");
  demand_verdict(row);
  return row;
}

// A file beside the database, locked as long as a process writes and removed by that process. The
// database itself cannot serve: closing a descriptor of it would drop SQLite's own locks, and on
// NFS the two kinds of locks exclude each other.
std::string lock_name(const std::filesystem::path& path) {
  return path.string() + ".lock";
}

// The holder may remove the file before we lock it, and the lock is worth nothing then. So the name
// is looked up again: it must still mean the locked file.
int lock_for_writing(const std::filesystem::path& path) {
  const std::string name = lock_name(path);
  for (;;) {
    const int fd = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (fd < 0) throw std::runtime_error(name + ": cannot be created: " + std::strerror(errno));
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
      close(fd);
      throw std::runtime_error(path.string() + ": another run is writing to it");
    }
    struct stat locked {
    }, named{};
    if (fstat(fd, &locked) == 0 && stat(name.c_str(), &named) == 0 &&
        locked.st_dev == named.st_dev && locked.st_ino == named.st_ino) {
      return fd;
    }
    close(fd);
  }
}

void unlock(const std::filesystem::path& path, int fd) {
  if (fd < 0) return;
  unlink(lock_name(path).c_str());  // while it is ours
  close(fd);
}

std::unique_ptr<SQLite::Database> open_for_reading(const std::filesystem::path& path) {
  // The last connection removes the files of a WAL only if it may write.
  const bool writable = access(path.c_str(), W_OK) == 0 &&
                        access(std::filesystem::absolute(path).parent_path().c_str(), W_OK) == 0;
  return std::make_unique<SQLite::Database>(
      path.string(), writable ? SQLite::OPEN_READWRITE : SQLite::OPEN_READONLY, 10000);
}

}  // namespace

const char* disposition_name(Disposition disposition) {
  return kDispositions[static_cast<std::size_t>(disposition)];
}

Disposition disposition_from_name(const std::string& name) {
  const auto found = std::find(kDispositions.begin(), kDispositions.end(), name);
  if (found == kDispositions.end()) throw std::runtime_error("unknown disposition: " + name);
  return static_cast<Disposition>(found - kDispositions.begin());
}

std::optional<SolverColumns> solver_columns(const std::string& mesh_json) {
  const Json json = Json::parse(mesh_json, nullptr, false);
  if (!json.is_object() || !json.contains("solver")) return std::nullopt;
  const Json& solver = json["solver"];
  if (!solver.is_object()) return std::nullopt;
  return SolverColumns{.unknowns = solver.value("unknowns", std::uint64_t{0}),
                       .iterations = solver.value("iterations", std::uint64_t{0}),
                       .converged = solver.value("converged", false),
                       .condition = solver.value("condition", 0.0),
                       .mean_error = solver.value("mean_error", 0.0)};
}

std::optional<MeshColumns> mesh_columns(const std::string& json_text, const std::string& member) {
  Json json = Json::parse(json_text, nullptr, false);
  if (!member.empty() && json.is_object()) json = json.value(member, Json());
  if (!json.is_object()) return std::nullopt;
  if (json.contains("triangles") && !json.contains("tetrahedra")) {  // of the plane
    for (const auto& [key, as] : {std::pair("triangles", "tetrahedra"),
                                  {"min_angle", "min_face_angle"},
                                  {"max_angle", "max_face_angle"},
                                  {"mean_min_angle", "mean_min_face_angle"},
                                  {"mean_max_angle", "mean_max_face_angle"},
                                  {"area", "volume"}}) {
      json[as] = json.value(key, Json());
    }
  }
  if (!json.contains("tetrahedra")) return std::nullopt;
  const auto number = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
  };
  MeshColumns columns;
  if (!member.empty() && number("tetrahedra") == 0) return std::nullopt;  // no such mesh
  columns.vertices = static_cast<std::uint64_t>(number("vertices"));
  columns.tetrahedra = static_cast<std::uint64_t>(number("tetrahedra"));
  columns.min_face_angle = number("min_face_angle");
  columns.max_face_angle = number("max_face_angle");
  columns.min_dihedral = number("min_dihedral");
  columns.max_dihedral = number("max_dihedral");
  columns.mean_min_face_angle = number("mean_min_face_angle");
  columns.mean_max_face_angle = number("mean_max_face_angle");
  columns.mean_min_dihedral = number("mean_min_dihedral");
  columns.mean_max_dihedral = number("mean_max_dihedral");
  columns.shortest_edge = number("shortest_edge");
  columns.volume = number("volume");
  const auto told = [&](const char* key) {
    return json.contains(key) ? std::optional(number(key)) : std::nullopt;
  };
  const auto share = [&](const char* key) {
    const auto count = told(key);
    const bool any = count && columns.tetrahedra > 0;
    return any ? std::optional(*count / static_cast<double>(columns.tetrahedra)) : std::nullopt;
  };
  columns.share_below_5 = share("tetrahedra_below_5_degrees");
  columns.share_below_10 = share("tetrahedra_below_10_degrees");
  columns.dihedral_percent = told("dihedral_1_percent");
  columns.min_gamma = told("min_gamma");
  columns.mean_gamma = told("mean_gamma");
  columns.gamma_percent = told("gamma_1_percent");
  columns.min_sicn = told("min_sicn");
  columns.mean_sicn = told("mean_sicn");
  return columns;
}

ResultsDatabase::ResultsDatabase(const std::filesystem::path& path, Mode mode) : path_(path) {
  try {
    if (mode == Mode::write) {
      lock_fd_ = lock_for_writing(path);
      database_ = std::make_unique<SQLite::Database>(
          path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, 10000);
      // A committed row survives the death of the process; NORMAL risks only power failures.
      database_->exec("PRAGMA journal_mode = WAL");
      database_->exec("PRAGMA synchronous = NORMAL");
    } else {
      database_ = open_for_reading(path);
    }
    version_ = database_->execAndGet("PRAGMA user_version").getInt();
    const bool empty = database_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
    const bool known = version_ >= 1 && version_ <= kSchemaVersion;
    if (!known && !(empty && mode == Mode::write)) {
      throw std::runtime_error(path.string() + ": not a results file of this version");
    }
    if (mode == Mode::write) prepare_for_writing();
  } catch (const SQLite::Exception& error) {
    database_.reset();
    unlock(path_, lock_fd_);
    throw std::runtime_error(path.string() + ": " + error.what());
  } catch (...) {
    database_.reset();
    unlock(path_, lock_fd_);
    throw;
  }
}

void ResultsDatabase::prepare_for_writing() {
  SQLite::Transaction transaction(*database_);
  database_->exec(kSchema);
  const bool empty = version_ == 0;
  if (version_ == 1) {
    for (const char* column : {"verdict", "mesh_path"}) {
      database_->exec(std::string("ALTER TABLE runs ADD COLUMN ") + column +
                      " TEXT NOT NULL DEFAULT ''");
    }
  }
  if (!empty && version_ < 3) {
    database_->exec("ALTER TABLE runs ADD COLUMN verify_seconds REAL");
    demand_verdicts();
  }
  if (!empty && version_ < 4) {
    for (const QualityColumn& quality : kQualityColumns) {
      database_->exec(std::string("ALTER TABLE runs ADD COLUMN ") + quality.name + " REAL");
    }
  }
  if (!empty && version_ < 5) {
    database_->exec("ALTER TABLE runs ADD COLUMN promise TEXT NOT NULL DEFAULT ''");
  }
  version_ = kSchemaVersion;
  database_->exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  database_->exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  transaction.commit();
}

// Changes the file for queries by hand; rows that are read obey anyway.
void ResultsDatabase::demand_verdicts() {
  for (const RunRow& row : rows()) {
    if (row.disposition != Disposition::unverified) continue;
    SQLite::Statement update(
        *database_, std::string("UPDATE runs SET disposition = ?, reason = ?") + kWhereKey);
    Binder bind(update);
    bind(std::string(disposition_name(row.disposition)));
    bind(row.reason);
    visit_key(bind, row.key);
    update.exec();
  }
}

ResultsDatabase::~ResultsDatabase() {
  if (lock_fd_ >= 0) {
    try {
      // Makes the database a single file again, which can be read in folders where nobody may
      // write. An active reader keeps the WAL alive and removes its files when it ends.
      database_->setBusyTimeout(0);
      database_->exec("PRAGMA journal_mode = DELETE");
    } catch (const SQLite::Exception&) {
    }
  }
  database_.reset();
  unlock(path_, lock_fd_);
}

// Errors name the file.
template <typename Action>
auto ResultsDatabase::named(const Action& action) {
  try {
    return action();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path_.string() + ": " + error.what());
  }
}

bool ResultsDatabase::has(const RunKey& key) {
  SQLite::Statement query(*database_, std::string("SELECT 1 FROM runs") + kWhereKey);
  Binder bind(query);
  visit_key(bind, key);
  return query.executeStep();
}

void ResultsDatabase::store(const RunRow& row) {
  std::string places = "?";
  for (std::size_t i = 1; i < kColumnCount; ++i) places += ", ?";
  std::string columns = std::string(kColumns) + kLaterColumns;
  for (const QualityColumn& quality : kQualityColumns) columns += std::string(", ") + quality.name;
  RunRow honest = row;
  demand_verdict(honest);
  named([&] {
    SQLite::Statement insert(
        *database_, "INSERT OR REPLACE INTO runs (" + columns + ") VALUES (" + places + ")");
    bind_row(insert, honest);
    return insert.exec();
  });
}

std::string ResultsDatabase::selected_columns() const {
  const char* later = version_ == 1   ? ", '', '', NULL, ''"
                      : version_ == 2 ? ", verdict, mesh_path, NULL, ''"
                      : version_ < 5  ? ", verdict, mesh_path, verify_seconds, ''"
                                      : kLaterColumns;
  return std::string(kColumns) + later;
}

std::optional<RunRow> ResultsDatabase::find(const RunKey& key) {
  return named([&]() -> std::optional<RunRow> {
    SQLite::Statement query(*database_, "SELECT " + selected_columns() + " FROM runs" + kWhereKey);
    Binder bind(query);
    visit_key(bind, key);
    if (!query.executeStep()) return std::nullopt;
    return read_row(query);
  });
}

bool ResultsDatabase::merge(const RunRow& row) {
  const auto present = find(row.key);
  if (present && !supersedes(row, *present)) return false;
  store(row);
  return true;
}

std::vector<RunRow> ResultsDatabase::rows() {
  return named([&] {
    std::vector<RunRow> result;
    SQLite::Statement query(*database_, "SELECT " + selected_columns() + " FROM runs ORDER BY id");
    while (query.executeStep()) result.push_back(read_row(query));
    return result;
  });
}

std::string verdict_of(const RunRow& row) {
  if (row.verdict_json.empty()) return "";
  const Json json = Json::parse(row.verdict_json, nullptr, false);
  const bool told = json.is_object() && json.contains("verdict") && json.at("verdict").is_string();
  return told ? json.at("verdict").get<std::string>() : "unknown";
}

void demand_verdict(RunRow& row) {
  const std::string verdict = verdict_of(row);
  if (row.disposition != Disposition::ok || !(verdict.empty() || verdict == "unknown")) return;
  row.disposition = Disposition::unverified;
  std::string reason = "no oracle was asked";
  if (!verdict.empty()) {
    const Json json = Json::parse(row.verdict_json, nullptr, false);
    reason = "the oracles have not finished";
    if (json.is_object() && json.contains("error") && json.at("error").is_string()) {
      reason += ": " + json.at("error").get<std::string>();
    }
  }
  row.reason += (row.reason.empty() ? "" : "; ") + reason;
}

bool supersedes(const RunRow& row, const RunRow& other) {
  const auto rank = [](const RunRow& r) {
    return std::tuple(r.disposition != Disposition::killed,
                      r.disposition != Disposition::unverified, r.started, r.disposition,
                      r.verdict_json, r.wall_seconds, r.cpu_seconds, r.peak_rss_bytes, r.host);
  };
  return rank(row) > rank(other);
}

void sort_rows(std::vector<RunRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const RunRow& a, const RunRow& b) {
    return std::tie(a.model_name, a.key) < std::tie(b.model_name, b.key);
  });
}

}  // namespace tetproof
