// What the mesher reads the oracles read, and the other way round, as the same triangles, segments
// or tetrahedra: the seeds of the fuzz targets, as they are and as editors change them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mesher/io/parse_surface.h"
#include "mesher/io/read_mesh.h"
#include "mesher/io/read_plane.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/surface_file.h"
#include "oracles/plane/file.h"

namespace tetproof::both_readers_test {
namespace {

namespace fs = std::filesystem;
using Point = std::array<double, 3>;

struct Read {
  bool ok = false;
  std::string error;
  std::vector<std::vector<Point>> cells;  // by the places of their corners, sorted

  template <class Vertices, class Cells>
  void add(const Vertices& vertices, const Cells& all) {
    for (const auto& cell : all) {
      std::vector<Point> corners;
      for (const auto v : cell) {
        Point p{};
        std::copy(vertices[v].begin(), vertices[v].end(), p.begin());
        for (double& x : p) x += 0.0;
        corners.push_back(p);
      }
      // Which corner is first does not matter; the orientation of triangles does.
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      if (corners.size() != 3) std::sort(corners.begin(), corners.end());
      cells.push_back(corners);
    }
  }
  void sort() { std::sort(cells.begin(), cells.end()); }
};

enum class What { surface, plane, mesh };

Read by_mesher(What what, const std::string& path) {
  Read read;
  const auto take = [&](const auto& file) {
    read.ok = file.ok();
    read.error = file.error;
    return file.ok();
  };
  if (what == What::surface) {
    const auto file = delmesher::io::read_surface(path);
    if (take(file)) read.add(file.surface.vertices, file.surface.triangles);
  } else if (what == What::plane) {
    const auto file = delmesher::io::read_plane(path);
    if (take(file)) read.add(file.graph.vertices, file.graph.segments);
  } else {
    const auto file = delmesher::io::read_mesh(path);
    if (take(file)) read.add(file.mesh.vertices, file.mesh.tetrahedra);
  }
  read.sort();
  return read;
}

Read by_oracles(What what, const std::string& path) {
  Read read;
  try {
    if (what == What::surface) {
      const auto surface = oracles::read_surface(path);
      read.add(surface.vertices, surface.triangles);
    } else if (what == What::plane) {
      const auto graph = oracles::read_plane_graph(path);
      read.add(graph.vertices, graph.segments);
    } else {
      const auto mesh = oracles::read_mesh(path);
      read.add(mesh.vertices, mesh.tetrahedra);
    }
    read.ok = true;
  } catch (const oracles::ReadError& error) {
    read.error = error.what();
  }
  read.sort();
  return read;
}

fs::path scratch() {
  const fs::path folder =
      fs::path(TETPROOF_SCRATCH) / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::create_directories(folder);
  return folder;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

struct Seed {
  What what;
  std::string name;  // with the extension that says the format
  std::string bytes;
};

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  const fs::path folder = TETPROOF_SEEDS;
  const auto add = [&](const fs::path& from, What what, const std::string& extension) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder / from)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      if (fs::is_regular_file(file)) {
        all.push_back({what, file.stem().string() + extension, bytes_of(file)});
      }
    }
  };
  for (const char* format : {"off", "obj", "stl", "ply", "smesh", "poly"}) {
    add(format, What::surface, std::string(".") + format);
  }
  add("surfaces", What::surface, ".off");
  add("twins", What::surface, ".off");
  for (const std::string name : {"obj", "obj_lines", "off", "poly", "rings"}) {
    const std::string extension = name.starts_with("obj") ? "obj" : name == "rings" ? "txt" : name;
    std::string bytes = bytes_of(folder / "plane" / name);
    if (std::isdigit(static_cast<unsigned char>(bytes[0])) != 0) bytes.erase(0, 1);  // the format
    all.push_back({What::plane, name + "." + extension, bytes});
  }
  for (const char* format : {"mesh", "msh", "vtu", "tet"}) {
    add(fs::path("mesh_files") / format, What::mesh, std::string(".") + format);
  }
  return all;
}

// Empty, or how the two disagree.
std::string disagreement(What what, const std::string& name, const std::string& bytes) {
  const fs::path path = scratch() / name;
  write(path, bytes);
  const Read mesher = by_mesher(what, path.string()), oracle = by_oracles(what, path.string());
  if (mesher.ok != oracle.ok) {
    return mesher.ok ? "the oracles refuse: " + oracle.error
                     : "the mesher refuses: " + mesher.error;
  }
  return mesher.cells == oracle.cells ? "" : "they read different cells";
}

TEST(BothReaders, AgreeOnSeeds) {
  int read = 0;
  for (const Seed& seed : seeds()) {
    EXPECT_EQ(disagreement(seed.what, seed.name, seed.bytes), "") << seed.name;
    read += by_mesher(seed.what, (scratch() / seed.name).string()).ok ? 1 : 0;
  }
  EXPECT_GT(read, 60);
}

// What other programs, editors and hands make of a text file.
std::vector<std::pair<std::string, std::string>> variants(const std::string& text) {
  const auto replaced = [](std::string in, const std::string& what, const std::string& by) {
    for (std::size_t at = in.find(what); at != std::string::npos;
         at = in.find(what, at + by.size())) {
      in.replace(at, what.size(), by);
    }
    return in;
  };
  std::string no_end = text;
  while (!no_end.empty() && no_end.back() == '\n') no_end.pop_back();
  return {{"lines end in CR LF", replaced(text, "\n", "\r\n")},
          {"lines end in CR", replaced(text, "\n", "\r")},
          {"tabs", replaced(text, " ", "\t")},
          {"wide", replaced(text, " ", "   ")},
          {"form feeds", replaced(text, " ", " \f ")},
          {"blanks at the ends", replaced(text, "\n", "  \n")},
          {"no last line end", no_end},
          {"more line ends", text + "\n\n  \n"},
          {"comments", replaced(text, "\n", " # 1 2 3\n")},
          {"comments without a blank", replaced(text, "\n", "# 1 2 3\n")},
          {"blank lines", replaced(text, "\n", "\n\n")}};
}

TEST(BothReaders, AgreeOnWhatEditorsMakeOfTexts) {
  const std::vector<std::string> texts = {".off", ".obj", ".stl", ".smesh", ".poly", ".txt"};
  int read = 0;
  for (const Seed& seed : seeds()) {
    const std::string extension = fs::path(seed.name).extension().string();
    const bool is_text = seed.bytes.find('\0') == std::string::npos;
    if (!is_text || std::ranges::find(texts, extension) == texts.end()) continue;
    for (const auto& [name, bytes] : variants(seed.bytes)) {
      if (extension == ".stl" && name.starts_with("comments")) continue;  // STL has none
      EXPECT_EQ(disagreement(seed.what, seed.name, bytes), "") << seed.name << ": " << name;
      read += by_mesher(seed.what, (scratch() / seed.name).string()).ok ? 1 : 0;
    }
  }
  EXPECT_GT(read, 400);
}

}  // namespace
}  // namespace tetproof::both_readers_test
