// The subcommands of tetproof and their arguments. They return an exit code: 0 done, 1 a check
// failed, 3 unreadable input, 5 a limit was reached, 130 interrupted; union_files.h and
// verify_command.h have more.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "corpus/peers/meshers.h"
#include "reports/gate.h"

namespace tetproof {

// A request that makes no sense; exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunArguments {
  std::vector<std::string> paths, meshers;
  std::string database, shard, tier, delmesher, keep;
  std::vector<std::string> retry;                 // dispositions
  double timeout = 600, cpu = 0, stop_after = 0;  // seconds; cpu 0: as timeout
  std::uint64_t memory_mebibytes = 4096;
  std::uint64_t keep_tetrahedra = 0;
  unsigned jobs = 1;
  bool verify = true, sidecars = false;
  bool ablation = false;  // ablation_names() as well
  bool solver = false;
};

struct MeshersArguments {
  bool at_hand = false;  // the names alone of those of surfaces that can be run here
};

struct ExportArguments {
  std::vector<std::string> databases;
  std::string output;  // .csv, .json or .xml
  bool brief = false, stable = false;
};

struct MergeArguments {
  std::vector<std::string> databases;
  std::string output;
};

struct ConvertArguments {
  std::string input, output;  // surface files
  std::string solids;         // where to write which shells bound each solid; empty: nowhere
};

struct UnionArguments {
  std::string input, output;        // surface files
  bool nonzero = false;             // also inside of what is turned inwards
  double separate = 0;              // fraction of the diagonal
  bool walls = false;               // nothing is dropped
  std::optional<std::string> snap;  // a length, or a fraction of the diagonal
};

struct ReportArguments {
  std::vector<std::string> databases, base, show;
  std::string folder, model, families;
  std::string league, commit;  // the page of the league, instead of a folder
  std::vector<std::string> left_out;
  std::size_t views = 10;
  bool processor_time = false, history = false;
};

struct MeasureArguments {
  std::string mesh, output;  // no output: standard output
  bool solver = false, plane = false;
};

struct PictureArguments {
  std::string input, mesh, verdict, sentence, output;
  bool own_surface = false;  // the mesh is judged by an envelope
};

struct GateArguments {
  std::vector<std::string> base, fresh;
  GateOptions options;
  bool allow_missing = false, allow_fewer = false;
};

struct ClassifyArguments {
  std::vector<std::string> paths;
  std::string output, licences, tier;  // no output: standard output
  bool json = false;
  unsigned jobs = 1;
  double timeout = 300;
  std::uint64_t memory_mebibytes = 4096;
};

struct SlurmArguments {
  RunArguments run;
  unsigned shards = 0, retries = 3;
  double task_minutes = 0;          // of a task; 0: the partition's limit
  bool plan = false;                // tell what it will cost, and submit nothing
  std::size_t of = 0;               // the models are a sample of that many; 0: they are all
  std::vector<std::string> sbatch;  // further options of sbatch
};

struct GenerateArguments {
  std::vector<std::string> families, models;
  std::string folder;
  std::uint64_t seed = 1, first = 0, count = 10;
  bool twins = false, list = false;
};

struct CopiesArguments {
  std::vector<std::string> paths;
  std::string folder;
  std::optional<std::uint64_t> seed;  // rotate: of one rotation in place of the three
};

struct ShrinkArguments {
  std::string input, mesher, output;
  double timeout = 10, seconds = 600;  // per run, in all
  std::uint64_t memory_mebibytes = 2048, runs = 5000;
  unsigned jobs = std::thread::hardware_concurrency();
  bool no_verify = false;
};

// \throw UsageError if the folder of the file does not exist.
void demand_folder_of(const std::string& file, const std::string& option);

// From now on Ctrl-C and other signals to end the program end campaigns cleanly.
void handle_interrupts();

// The meshers that are asked for, one by one. \throw UsageError if there are none.
std::vector<std::string> asked_meshers(const RunArguments& arguments);

// The programs that stand in one folder with the running one.
MesherPrograms programs_here();

int run_command(const RunArguments& arguments);
int meshers_command(const MeshersArguments& arguments);
int report_command(const ReportArguments& arguments);
int measure_command(const MeasureArguments& arguments);
int export_command(const ExportArguments& arguments);
int merge_command(const MergeArguments& arguments);
int convert_command(const ConvertArguments& arguments);
int picture_command(const PictureArguments& arguments);
int gate_command(const GateArguments& arguments);
int classify_command(const ClassifyArguments& arguments);
int slurm_command(const SlurmArguments& arguments);
// Hands the words after `tetproof` to the script of a clone around the current folder; returns only
// by an exception. \throw UsageError if there is none.
int bisect_command(char** argv);
#ifdef TETPROOF_HAS_GENERATE
int generate_command(const GenerateArguments& arguments);
int rotate_command(const CopiesArguments& arguments);
int vary_command(const CopiesArguments& arguments);
int shrink_command(const ShrinkArguments& arguments);
#endif
#ifdef TETPROOF_HAS_UNION
int union_command(const UnionArguments& arguments);
#endif

}  // namespace tetproof
