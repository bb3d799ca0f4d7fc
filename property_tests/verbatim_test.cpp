// What `tetproof verify` says of stored meshes, and of the same with something changed, word for
// word: figures, counts, findings, exit codes, and what it took. Other tests say why an answer is
// right; this one notices that an answer is another one.
//
// After a change that is meant: TETPROOF_WRITE_VERBATIM=1 laws_test --gtest_filter='*Verbatim*',
// and read the difference.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <ranges>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "oracles/base/steps.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/surface_file.h"
#include "oracles/plane/file.h"
#include "oracles/verify_command.h"

namespace tetproof::verbatim_test {
namespace {

namespace fs = std::filesystem;

struct Case {
  const char* name;
  const char* input;
  const char* mesh;
  const char* promised;  // @: the folder
  const char* more = "";
};

constexpr Case kCases[] = {
    {"approximate", "in.off", "out.vtu", "mesh --approximate"},
    {"cdt", "in.off", "out.msh", "cdt"},
    {"cdt_hull", "in.off", "out.tet", "cdt --region hull"},
    {"chamfered", "in.off", "out.mesh", "mesh --surface split"},
    {"dropped", "in.off", "out.mesh",
     "mesh --surface split --gabriel --improve off --tau 0.001953125"},
    {"edges", "in.off", "out.mesh", "mesh --max-edge 0.9 --surface split"},
    {"envelope", "in.off", "out.tet", "mesh", "--envelope=0.01"},
    {"far", "in.off", "out.mesh", "mesh --surface split"},
    {"finer", "in.vtu", "out.mesh", "improve --max-edge 1"},
    {"huge", "in.off", "out.mesh", "mesh --surface split"},
    {"hull", "in.off", "out.node", "mesh --region hull --gabriel --surface split"},
    {"improved", "in.mesh", "out.vtu", "improve"},
    {"kept", "in.off", "out.vtu", "mesh --surface keep"},
    {"labels", "in.obj", "out.msh", "mesh"},
    {"named", "in.obj", "out.vtu", "mesh --regions all"},
    {"largest", "in.off", "out.tet", "mesh --regions largest"},
    {"order", "in.off", "out.msh", "mesh --order 2"},
    {"paper", "in.off", "out.mesh", "mesh --preset paper --improve off --tau 0.01"},
    {"planar", "in.off", "out.mesh", "mesh"},
    {"plane", "in.poly", "out.node", "plane"},
    {"plane_far", "in.obj", "out.off", "plane --acute 80"},
    {"plane_approximate", "in.poly", "out.vtu", "plane --approximate --max-edge 1"},
    {"plane_paper", "in.poly", "out.msh", "plane --preset paper --tau 0.05"},
    {"poly", "in.poly", "out.node", "mesh --improve off"},
    {"prism", "in.ply", "out.tet", "mesh --surface split --max-edge 0.4"},
    {"regions", "in.off", "out.msh", "mesh --regions all"},
    {"sizes", "in.off", "out.mesh", "mesh --surface split --size-field @sizes.txt"},
    {"slivers", "in.off", "out.vtu", "mesh --surface split --delta 20 --acute 70 --improve off"},
    {"solids", "in.stl", "out.mesh", "mesh --surface keep"},
    {"star", "in.off", "out.msh", "mesh --planar 0.01"},
    {"tolerance", "in.off", "out.mesh", "mesh --tolerance 5e-2d"},
    {"ulps", "in.off", "out.mesh", "mesh --surface split --improve off"},
};

void PrintTo(const Case& one, std::ostream* stream) {
  *stream << one.name;
}

// Files by name: "=== NAME" before each.
std::map<std::string, std::string> files_of(const std::string& path) {
  std::string text;
  const gzFile file = gzopen(path.c_str(), "rb");
  char block[4096];
  for (int n = 0; file != nullptr && (n = gzread(file, block, sizeof block)) > 0;) {
    text.append(block, static_cast<std::size_t>(n));
  }
  gzclose(file);
  std::map<std::string, std::string> files;
  std::istringstream lines(text);
  std::string name;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("=== ")) {
      name = line.substr(4);
    } else {
      files[name] += line + "\n";
    }
  }
  return files;
}

std::string replaced(std::string in, const std::string& what, const std::string& by) {
  for (std::size_t at = in.find(what); at != std::string::npos; at = in.find(what, at)) {
    in.replace(at, what.size(), by);
  }
  return in;
}

// Numbers of more than six digits, with six: the last ones are those of a machine's mathematics.
std::string shortened(const std::string& text) {
  static const std::regex digits("-?[0-9]+\\.[0-9]{5,}(e[-+]?[0-9]+)?");
  std::string result;
  auto end = text.begin();
  for (std::sregex_iterator at(text.begin(), text.end(), digits), none; at != none; ++at) {
    char number[40];
    std::snprintf(number, sizeof number, "%.6g", std::strtod(at->str().c_str(), nullptr));
    result.append(end, text.begin() + at->position()).append(number);
    end = text.begin() + at->position() + at->length();
  }
  return result.append(end, text.end());
}

// The stored text of that name is this one.
void compare(const std::string& name, const std::string& text) {
  const std::string stored = VERBATIM_FOLDER + std::string("/") + name + ".txt";
  if (std::getenv("TETPROOF_WRITE_VERBATIM") != nullptr) {
    std::ofstream(stored, std::ios::binary) << text;
    return;
  }
  std::ifstream file(stored, std::ios::binary);
  std::istringstream now(text);
  std::string before;  // the last lines that agree
  for (int number = 1;; ++number) {
    std::string expected, line;
    const bool more = !!std::getline(file, expected);
    if (!std::getline(now, line) && !more) return;
    ASSERT_EQ(line, expected) << stored << ":" << number << ", after\n" << before;
    before = line.starts_with("===") ? line + "\n" : before + line + "\n";
  }
}

class Verbatim : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::path(TETPROOF_SCRATCH) / ("verbatim_" + replaced(test, "/", "_"));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    files_ = files_of(VERBATIM_FOLDER + std::string("/") + GetParam().name + ".gz");
    for (const auto& [name, text] : files_) write(name, text);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  // The exit code and all that is said.
  std::string verify(bool record, const std::string& more = "") const {
    std::vector<std::string> arguments = {"verify", path(GetParam().input), path(GetParam().mesh)};
    if (!more.starts_with("--promised")) {
      arguments.push_back("--promised=" + replaced(GetParam().promised, "@", path("")));
    }
    if (record) arguments.insert(arguments.end(), {"--exact", path("out.exact")});
    for (const std::string& argument : {std::string(GetParam().more), more}) {
      if (!argument.empty()) arguments.push_back(argument);
    }
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_verify(static_cast<int>(argv.size()), argv.data());
    const std::string said = testing::internal::GetCapturedStdout();
    return "exit code " + std::to_string(code) + "\n" +
           shortened(replaced(said + testing::internal::GetCapturedStderr(), path(""), ""));
  }

  fs::path folder_;
  std::map<std::string, std::string> files_;
};

// With the record and without, of each stage, and what it took.
TEST_P(Verbatim, Reports) {
  std::string text;
  const bool record = files_.contains("out.exact");
  const auto add = [&](const std::string& what, bool with_record, const std::string& more) {
    const std::uint64_t before = oracles::steps;
    text += "=== " + what + "\n" + verify(with_record, more);
    text += "steps " + std::to_string(oracles::steps - before) + "\n";
  };
  add("the file", false, "");
  add("the file, JSON", false, "--json");
  if (record) {
    add("with its record", true, "");
    add("the refined mesh", true, "--stage=refined");
    add("the final mesh", true, "--stage=final");
  }
  compare(GetParam().name, text);
}

std::string changed(const std::string& text, std::mt19937& random, std::string& what) {
  std::vector<std::pair<std::size_t, std::size_t>> words;
  for (std::size_t at = text.find_first_not_of(" \n"); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    words.emplace_back(at, end - at);
    at = text.find_first_not_of(" \n", end);
  }
  const std::size_t chosen = random() % words.size();
  const auto [at, size] = words[chosen];
  std::string word = text.substr(at, size);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  const bool is_number = *end == '\0', is_integer = word.find_first_of(".en") == std::string::npos;
  std::string result = text;
  const std::size_t way = random() % 7;
  what = "word " + std::to_string(chosen) + " " + word + ": ";
  if (way <= 2 && is_number) {
    char other[40];
    const double by = is_integer ? (way == 0   ? 1
                                    : way == 1 ? -1
                                               : 7)
                                 : value * (static_cast<double>(way) - 0.96875);
    std::snprintf(other, sizeof other, is_integer ? "%.0f" : "%.17g", value + by);
    what += other;
    return result.replace(at, size, other);
  }
  if (way <= 3 && chosen + 1 < words.size()) {
    const auto [next, length] = words[chosen + 1];
    const std::string other = text.substr(next, length);
    what += "exchanged with the next";
    return result.replace(next, length, word).replace(at, size, other);
  }
  const std::size_t begin = text.rfind('\n', at) + 1;
  const std::size_t length = text.find('\n', at) + 1 - begin;  // every line has an end
  if (way == 4) {
    what += "its line twice";
    return result.insert(begin, text.substr(begin, length));
  }
  if (way == 5) {
    what += "without its line";
    return result.erase(begin, length);
  }
  what += "negative";
  return word.starts_with("-") ? result.erase(at, 1) : result.insert(at, "-");
}

// Only what it says otherwise than of the honest mesh.
TEST_P(Verbatim, ReportsOfWhatWasChanged) {
  const bool record = files_.contains("out.exact");
  std::set<std::string> honest;
  std::istringstream lines(verify(record));
  for (std::string line; std::getline(lines, line);) honest.insert(line);
  std::string text;
  for (const auto& [name, bytes] : files_) {
    std::mt19937 random(1);
    const int times = name.ends_with(".exact") ? 60 : name.starts_with("out.") ? 40 : 20;
    for (int i = 0; i < times; ++i) {
      std::string what;
      write(name, changed(bytes, random, what));
      text += "=== " + name + ": " + what + "\n";
      std::istringstream said(verify(record));
      int shown = 0;
      for (std::string line; std::getline(said, line);) {
        if (!honest.contains(line) && ++shown <= 8) text += line + "\n";
      }
      write(name, bytes);
    }
  }
  compare(GetParam().name + std::string(".changed"), text);
}

// ---------------------------------------------------------------------------------------- readers

void show(std::string& text, const std::string& value) {
  text += " \"" + value + "\"";
}
template <class T>
requires std::is_arithmetic_v<T>
void show(std::string& text, T value) {
  char number[40];
  std::snprintf(number, sizeof number, " %.17g", static_cast<double>(value));
  text += number;
}
template <class A, class B>
void show(std::string& text, const std::pair<A, B>& both) {
  show(text, both.first);
  show(text, both.second);
}
void show(std::string& text, const oracles::MeshFile::EdgeNode& node);
void show(std::string& text, const delmesher::PlanarGraph::Region& region);
template <std::ranges::range List>
requires(!std::is_convertible_v<List, std::string>) void show(std::string& text, const List& list) {
  for (const auto& value : list) show(text, value);
  text += ";";
}
void show(std::string& text, const oracles::MeshFile::EdgeNode& node) {
  show(text, node.ends);
  show(text, node.at);
}
void show(std::string& text, const delmesher::PlanarGraph::Region& region) {
  show(text, region.point);
  show(text, region.attribute);
}
template <class... Values>
std::string shown(const Values&... values) {
  std::string text;
  (show(text, values), ...);
  return text;
}

enum class What { surface, plane, mesh };

// All that is in a file, or why it is refused.
std::string read(What what, const std::string& path) {
  try {
    if (what == What::surface) {
      const oracles::Polyhedron s = oracles::read_surface(path);
      return shown(s.vertices, s.triangles, s.labels, s.polygons, s.names_read, s.names);
    }
    if (what == What::plane) {
      const delmesher::PlanarGraph g = oracles::read_plane_graph(path);
      return shown(g.vertices, g.segments, g.markers, g.partitions, g.holes, g.regions);
    }
    const oracles::MeshFile m = oracles::read_mesh(path);
    return shown(m.vertices, m.tetrahedra, m.names_sides, m.regions, m.inside, m.all_called_inside,
                 m.boundary, m.labels, m.facets, m.planar_within, m.has_names, m.names,
                 m.labels_contradict, m.boxes_differ, m.groups_differ, m.tags_shared,
                 m.sides_contradict, m.more_than_single, m.comments_within, m.edge_nodes,
                 m.lists_boundary, m.has_second_order, m.either_orientation);
  } catch (const oracles::ReadError& error) {
    return error.what();
  }
}

// Any bytes: one of them another, or gone, or a few of them twice.
std::string with_other_bytes(const std::string& bytes, std::mt19937& random, std::string& what) {
  const std::size_t at = random() % bytes.size(), way = random() % 4;
  const char other = way == 0 ? static_cast<char>(random() % 256) : "09-. \n\"x"[random() % 8];
  what = "byte " + std::to_string(at);
  std::string result = bytes;
  if (way == 2) return what += " gone", result.erase(at, 1);
  if (way == 3) return what += " and more twice", result.insert(at, bytes.substr(at, 9));
  what += " is " + std::to_string(static_cast<unsigned char>(other));
  result[at] = other;
  return result;
}

struct Reader {
  What what;
  const char* seeds;  // a file, or a folder of files
  const char* extension;
};

void PrintTo(const Reader& reader, std::ostream* stream) {
  *stream << reader.seeds;
}

class VerbatimReaders : public testing::TestWithParam<Reader> {};

// What was changed is told by its length and a sum, since there is much of it; errors are whole.
TEST_P(VerbatimReaders, ReadTheSame) {
  const std::string seeds = GetParam().seeds, extension = GetParam().extension;
  std::vector<fs::path> files;
  const fs::path from = fs::path(TETPROOF_SEEDS) / seeds;
  if (fs::is_directory(from)) {
    for (const auto& entry : fs::directory_iterator(from)) files.push_back(entry.path());
  } else {
    files = {from};
  }
  std::sort(files.begin(), files.end());
  const std::string name = replaced(seeds, "/", "_") + "_" + extension;
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / ("verbatim_" + name);
  fs::create_directories(folder);
  const std::string path = (folder / "in.").string() + extension;
  std::string text;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    // A fuzz target is told the format.
    if (GetParam().what == What::plane && std::isdigit(in.peek()) != 0) in.get();
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const auto said = [&](const std::string& written) {
      std::ofstream(path, std::ios::binary) << written;
      return replaced(read(GetParam().what, path), path, "");
    };
    const std::string honest = said(bytes);
    text += "=== " + file.filename().string() + "\n" + honest + "\n";
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
      std::string change, now;
      const bool words = i % 2 == 0 && bytes.ends_with("\n");
      now = said(words ? changed(bytes, random, change) : with_other_bytes(bytes, random, change));
      if (now == honest) continue;
      if (!now.starts_with(":")) {  // no error
        std::uint64_t sum = 0;
        for (const char c : now) sum = 31 * sum + static_cast<unsigned char>(c);
        now = std::to_string(now.size()) + " characters, " + std::to_string(sum);
      }
      text += change + ": " + now + "\n";
    }
  }
  fs::remove_all(folder);
  compare("read." + name, text);
}

constexpr Reader kReaders[] = {
    {What::surface, "3mf", "3mf"},           {What::surface, "off", "off"},
    {What::surface, "obj", "obj"},           {What::surface, "ply", "ply"},
    {What::surface, "poly", "poly"},         {What::surface, "smesh", "smesh"},
    {What::surface, "stl", "stl"},           {What::mesh, "mesh_files/mesh", "mesh"},
    {What::mesh, "mesh_files/msh", "msh"},   {What::mesh, "mesh_files/tet", "tet"},
    {What::mesh, "mesh_files/vtu", "vtu"},   {What::plane, "plane/obj", "obj"},
    {What::plane, "plane/obj_lines", "obj"}, {What::plane, "plane/off", "off"},
    {What::plane, "plane/poly", "poly"},     {What::plane, "plane/rings", "txt"},
};

INSTANTIATE_TEST_SUITE_P(Stored, VerbatimReaders, testing::ValuesIn(kReaders), [](const auto& one) {
  return replaced(one.param.seeds, "/", "_") + "_" + one.param.extension;
});

// What else could have been promised, and what cannot.
constexpr const char* kPromises[] = {
    "",
    "--acute 0",
    "--acute 90",
    "--acute 91",
    "--approximate",
    "--as-paper all",
    "--as-paper bridges,kept-points",
    "--as-paper enrichment",
    "--as-paper filter-chamfered",
    "--as-paper filter-pairs",
    "--as-paper link",
    "--as-paper no-guard",
    "--as-paper order",
    "--as-paper steiner-point",
    "--budget 10",
    "--budget 100000",
    "--chamfer-radius 0.01",
    "--corner 89",
    "--delta 14.4775",
    "--delta 14.48",
    "--delta 2",
    "--delta 30",
    "--delta 31",
    "--feature 20",
    "--gabriel",
    "--gabriel=3",
    "--improve off",
    "--label-by-angle 30",
    "--max-edge 0.2",
    "--max-edge 100",
    "--max-edge -1",
    "--max-vertices 5",
    "--max-vertices 100000",
    "--order 2",
    "--planar 0",
    "--planar 0.005",
    "--planar 1e-9",
    "--preset paper",
    "--preset paper --acute 60",
    "--region hull",
    "--regions all",
    "--regions core",
    "--regions core --max-edge 2,core=0.5",
    "--regions largest",
    "--simplify-bridges off",
    "--size-field nothing.txt",
    "--slivers off",
    "--strict",
    "--surface auto",
    "--surface keep",
    "--surface keep --strict",
    "--surface none",
    "--surface split",
    "--tau 0",
    "--tau 0.5",
    "--tau 2",
    "--tolerance 1e-1d",
    "--tolerance 1e-3d --feature 20",
    "--tolerance 1e-3d --surface keep",
    "--delta 2 --delta 3",
    "--nothing",
};

class VerbatimPromises : public Verbatim {};

TEST_P(VerbatimPromises, Report) {
  const std::string promised = GetParam().promised;
  const std::string task = promised.substr(0, promised.find(' '));
  std::string text;
  for (const bool record : {false, true}) {
    if (record && !files_.contains("out.exact")) continue;
    std::set<std::string> honest;
    std::istringstream lines(verify(record));
    for (std::string line; std::getline(lines, line);) honest.insert(line);
    for (const char* other : kPromises) {
      text += std::string("=== ") + (record ? "record, " : "") + other + "\n";
      std::istringstream said(verify(record, std::string("--promised=") + task + " " + other));
      int shown = 0;
      for (std::string line; std::getline(said, line);) {
        if (!honest.contains(line) && ++shown <= 5) text += line + "\n";
      }
    }
  }
  compare(GetParam().name + std::string(".promises"), text);
}

// Of different kinds, and quick.
std::vector<Case> few_cases() {
  const std::set<std::string> names = {"approximate", "cdt",   "chamfered", "edges", "finer",
                                       "improved",    "kept",  "labels",    "named", "order",
                                       "planar",      "plane", "regions",   "solids"};
  std::vector<Case> few;
  for (const Case& one : kCases) {
    if (names.contains(one.name)) few.push_back(one);
  }
  return few;
}

INSTANTIATE_TEST_SUITE_P(Stored, VerbatimPromises, testing::ValuesIn(few_cases()),
                         [](const auto& one) { return std::string(one.param.name); });

INSTANTIATE_TEST_SUITE_P(Stored, Verbatim, testing::ValuesIn(kCases),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace tetproof::verbatim_test
