// From file to file: `tetproof verify` reads and accepts the output of the program `delmesher` in
// every format.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>
#include <sstream>

#include "mesher/delmesher.h"
#include "mesher/delmesher_files.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/test_archives.h"
#include "mesher/io/test_vtu_ways.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/sidecar.h"
#include "oracles/files/surface_file.h"
#include "oracles/plane/file.h"
#include "oracles/verify_command.h"
#include "property_tests/little_memory.h"
#include "property_tests/samples.h"

namespace tetproof::files_test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(TETPROOF_SCRATCH) / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  void write_off(const std::string& name, const oracles::Polyhedron& surface) const {
    std::string text = "OFF\n" + std::to_string(surface.vertices.size()) + " " +
                       std::to_string(surface.triangles.size()) + " 0\n";
    char line[128];
    for (const auto& p : surface.vertices) {
      std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
      text += line;
    }
    for (const auto& t : surface.triangles) {
      std::snprintf(line, sizeof line, "3 %u %u %u\n", t[0], t[1], t[2]);
      text += line;
    }
    write(name, text);
  }

  static int run(const std::string& arguments) {
    return std::system((std::string(DELMESHER_PATH) + " " + arguments).c_str());
  }

  static int verify(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "verify");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    return run_verify(static_cast<int>(argv.size()), argv.data());
  }

  fs::path folder_;
};

template <class Triangle>
Triangle smallest_first(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

constexpr const char* kFormats[] = {"mesh", "msh", "vtu", "node", "tet"};

TEST_F(Files, AllFormatsAndTheSidecarAreVerified) {
  write_off("in.off", samples::skewed(samples::l_shape()).input);
  std::string outputs;
  for (const char* format : kFormats) outputs += " -o " + path(std::string("out.") + format);
  ASSERT_EQ(run("mesh -q " + path("in.off") + outputs + " --exact " + path("out.exact")), 0);
  const oracles::MeshFile first = oracles::read_mesh(path("out.mesh"));
  EXPECT_GT(first.tetrahedra.size(), 5U);
  EXPECT_GT(oracles::read_sidecar(path("out.exact")).refined.size(), first.tetrahedra.size() / 2);
  for (const char* format : kFormats) {
    const std::string file = path(std::string("out.") + format);
    EXPECT_EQ(verify({path("in.off"), file, "--exact", path("out.exact")}), 0) << format;
    EXPECT_EQ(verify({path("in.off"), file, "--exact", path("out.exact"), "--stage", "refined"}),
              0);
    const oracles::MeshFile mesh = oracles::read_mesh(file);
    EXPECT_EQ(mesh.vertices, first.vertices) << format;
    EXPECT_EQ(mesh.tetrahedra.size(), first.tetrahedra.size()) << format;
  }
}

TEST_F(Files, ATolerance) {
  write_off("in.off", samples::l_shape().input);
  ASSERT_EQ(run("mesh -q --tolerance 1e-2d " + path("in.off") + " -o " + path("out.mesh")), 0);
  const std::string promised = "mesh --tolerance 1e-2d";
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--promised", promised}), 0);
  ASSERT_EQ(run("mesh -q " + path("in.off") + " -o " + path("exact.mesh") + " --exact " +
                path("out.exact")),
            0);
  EXPECT_EQ(verify({path("in.off"), path("exact.mesh"), "--promised", promised, "--exact",
                    path("out.exact")}),
            2);
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--promised", promised, "--envelope", "0.1"}),
            2);
}

TEST_F(Files, WhatIsCompressedWithGzipIsVerified) {
  write_off("in.off", samples::l_shape().input);
  write("in.poly", "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n");
  std::string outputs;
  for (const char* format : kFormats) outputs += " -o " + path(std::string("out.") + format);
  ASSERT_EQ(run("mesh -q " + path("in.off") + outputs + " --exact " + path("out.exact")), 0);
  ASSERT_EQ(run("plane -q " + path("in.poly") + " -o " + path("flat.node") + " -o " +
                path("flat.vtu") + " -o " + path("flat.msh") + " --exact " + path("flat.exact")),
            0);
  ASSERT_EQ(
      std::system(("gzip " + path("in.*") + " " + path("out.*") + " " + path("flat.*")).c_str()),
      0);
  for (const char* format : kFormats) {
    const std::string file = path(std::string("out.") + format + ".gz");
    EXPECT_EQ(verify({path("in.off.gz"), file}), 0) << format;
    EXPECT_EQ(verify({path("in.off.gz"), file, "--exact", path("out.exact.gz")}), 0) << format;
  }
  for (const char* format : {"node", "vtu", "msh"}) {
    const std::string file = path(std::string("flat.") + format + ".gz");
    EXPECT_EQ(verify({path("in.poly.gz"), file, "--promised", "plane"}), 0) << format;
    EXPECT_EQ(
        verify({path("in.poly.gz"), file, "--promised", "plane", "--exact", path("flat.exact.gz")}),
        0)
        << format;
  }
}

// What the mesher's reader and the oracles' own make of the same file.
TEST_F(Files, ArraysInAllPlacesAreTheSameToBothReaders) {
  for (const delmesher::io::Way& way : delmesher::io::kWays) {
    write("a.vtu", delmesher::io::grid(way));
    const delmesher::io::MeshReadResult ours = delmesher::io::read_mesh(path("a.vtu"));
    ASSERT_TRUE(ours.ok()) << ours.error;
    const oracles::MeshFile theirs = oracles::read_mesh(path("a.vtu"));
    EXPECT_EQ(theirs.vertices, ours.mesh.vertices) << way.name;
    EXPECT_EQ(theirs.tetrahedra, ours.mesh.tetrahedra) << way.name;
    EXPECT_EQ(theirs.boundary, ours.mesh.boundary) << way.name;
    EXPECT_EQ(theirs.labels, ours.mesh.boundary_labels) << way.name;
    EXPECT_EQ(theirs.regions, (std::vector<std::int64_t>{3, -4})) << way.name;
  }
}

TEST_F(Files, PackagesAreTheSameToBothReaders) {
  using delmesher::io::kTet, delmesher::io::model, delmesher::io::package, delmesher::io::Zip;
  std::mt19937 random(3);
  int labelled = 0;
  const auto transform = [&] {
    std::string text = " transform='";
    for (int i = 0; i < 12; ++i) {
      text += std::to_string(static_cast<int>(random() % 2001) - 1000) + "e-3 ";
    }
    return text + "'";
  };
  for (int i = 0; i < 20; ++i) {
    const std::string bytes = package(
        model("<object id='1' name='a'>" + kTet + "</object><object id='2' type='support'>" + kTet +
                  "</object><object id='3'><components><component objectid='1'" + transform() +
                  "/><component objectid='2'/><component objectid='1'/></components></object>" +
                  "<object id='4'>" + kTet + "</object>",
              "<item objectid='3'" + transform() + "/><item objectid='4'" + transform() + "/>"));
    write("a.3mf", bytes);
    const auto ours = delmesher::io::read_surface(path("a.3mf"));
    ASSERT_TRUE(ours.ok()) << ours.error;
    const oracles::Polyhedron theirs = oracles::read_surface(path("a.3mf"));
    EXPECT_EQ(theirs.vertices, ours.surface.vertices);
    EXPECT_EQ(theirs.triangles, ours.surface.triangles);
    EXPECT_EQ(theirs.labels, ours.surface.labels);
  }
  for (int i = 0; i < 20; ++i) {
    std::string text = kTet;
    for (std::size_t at = text.find("<triangle "); at != std::string::npos;
         at = text.find("<triangle ", at + 1)) {
      static constexpr const char* kAttributes[] = {"", "pid='4' p1='0'", "p1='1'",
                                                    "pid='3' p1='0'", "pid='5' p1='0'"};
      text.insert(at + 10, std::string(kAttributes[random() % 5]) + " ");
    }
    text.replace(text.find(" pid='1'/>"), 8, "");
    write("a.3mf",
          package(model(
              "<basematerials id='3'><base name='a'/><base name='b'/></basematerials>"
              "<m:colorgroup id='4'><m:color color='#FFFFFF'/></m:colorgroup>"
              "<object id='1'" +
                  std::string(i % 2 == 0 ? " pid='3' pindex='1'" : "") + ">" + text + "</object>",
              "<item objectid='1'/>",
              "xmlns:m='http://schemas.microsoft.com/3dmanufacturing/material/2015/02'")));
    const auto ours = delmesher::io::read_surface(path("a.3mf"));
    ASSERT_TRUE(ours.ok()) << ours.error;
    EXPECT_EQ(oracles::read_surface(path("a.3mf")).labels, ours.surface.labels);
    labelled += ours.surface.labels.empty() ? 0 : 1;
  }
  EXPECT_GT(labelled, 10);
  // One that can be meshed, and is verified.
  write("a.3mf", package(model("<object id='1'>" + kTet + "</object>",
                               "<item objectid='1'/><item objectid='1' "
                               "transform='0 1 0 1 0 0 0 0 3 5 0 0'/>")));
  ASSERT_EQ(run("mesh -q " + path("a.3mf") + " -o " + path("a.msh")), 0);
  EXPECT_EQ(verify({path("a.3mf"), path("a.msh")}), 0);
  // Within it a modifier of PrusaSlicer, which is not a hollow.
  std::string with_modifier = kTet;
  with_modifier.insert(with_modifier.find("</vertices>"),
                       "<vertex x='.1' y='.1' z='.01'/><vertex x='.2' y='.1' z='.01'/>"
                       "<vertex x='.1' y='.2' z='.01'/><vertex x='.1' y='.1' z='.02'/>");
  with_modifier.insert(with_modifier.find("</triangles>"),
                       "<triangle v1='4' v2='6' v3='5'/><triangle v1='4' v2='5' v3='7'/>"
                       "<triangle v1='5' v2='6' v3='7'/><triangle v1='6' v2='4' v3='7'/>");
  const std::string config =
      "<config><object id='1'><volume firstid='0' lastid='3'/><volume firstid='4' lastid='7'>"
      "<metadata type='volume' key='volume_type' value='ParameterModifier'/></volume></object>"
      "</config>";
  write("a.3mf", Zip()
                     .add("3D/3dmodel.model", model("<object id='1'>" + with_modifier + "</object>",
                                                    "<item objectid='1'/>"))
                     .add("Metadata/Slic3r_PE_model.config", config)
                     .finish());
  EXPECT_EQ(oracles::read_surface(path("a.3mf")).triangles.size(), 4U);
  ASSERT_EQ(run("mesh -q " + path("a.3mf") + " -o " + path("a.mesh")), 0);
  EXPECT_EQ(verify({path("a.3mf"), path("a.mesh")}), 0);
}

// Names of parts are the same in upper and lower case.
TEST_F(Files, AModelThatIsThereTwiceIsRefused) {
  using namespace delmesher::io;  // NOLINT: what writes archives
  const std::string one = model("<object id='1'>" + kTet + "</object>", "<item objectid='1'/>");
  for (const char* name : {"3d/3DModel.model", "/3D/3dmodel.model"}) {
    write("a.3mf", Zip().add("3D/3dmodel.model", one).add(name, one).finish());
    EXPECT_THROW(oracles::read_surface(path("a.3mf")), oracles::ReadError) << name;
    EXPECT_FALSE(delmesher::io::read_surface(path("a.3mf")).ok()) << name;
  }
}

TEST_F(Files, WhatSaysNothingIsRefused) {
  write_off("in.off", samples::l_shape().input);
  ASSERT_EQ(run("mesh -q --size none --ascii " + path("in.off") + " -o " + path("out.mesh") +
                " -o " + path("out.vtu") + " --exact " + path("out.exact")),
            0);
  const auto verified = [&](const std::string& mesh, const std::string& exact) {
    return verify({path("in.off"), path(mesh), "--exact", path(exact)});
  };
  ASSERT_EQ(verified("out.mesh", "out.exact"), 0);
  // No deviation is larger than nan, so that would let all pass. It is rejected, as a negative one
  // is.
  for (const char* deviation : {"nan", "-1"}) {
    EXPECT_EQ(verify({path("in.off"), path("out.mesh"),
                      std::string("--declared-deviation=") + deviation}),
              2);
  }
  const auto changed = [&](const std::string& name, const std::string& from,
                           const std::string& to) {
    std::string text = oracles::read_whole_file(path(name));
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    write("changed" + name.substr(name.find('.')), text);
  };
  changed("out.exact", " 0\nrefined_facets", " 2\nrefined_facets");
  if (HasFatalFailure()) return;
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  changed("out.exact", "\nmesh_vertices", "\nfinal 0\nmesh_vertices");
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  changed("out.exact", "\nballs ", "\nballs 99999999999999999999");
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  changed("out.exact", "\nI -", "\nX -");
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  changed("out.exact", "\n0 0 0 ", "\n0 4294967296 0 ");
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  const std::string record = oracles::read_whole_file(path("out.exact"));
  write("changed.exact", record.substr(0, record.size() - 4));
  EXPECT_EQ(verified("out.mesh", "changed.exact"), 3);
  changed("out.vtu", "\"offsets\" format=\"ascii\">\n4", "\"offsets\" format=\"ascii\">\nnan");
  EXPECT_EQ(verified("changed.vtu", "out.exact"), 3);
  changed("out.vtu", "\"connectivity\" format=\"ascii\">\n",
          "\"connectivity\" format=\"ascii\">\n0.");
  EXPECT_EQ(verified("changed.vtu", "out.exact"), 3);
}

// The record of the surface of a run with planar facets, as it comes back from a file.
TEST_F(Files, RecordedPlanesAndTrianglesComeBack) {
  delmesher::Options options;
  options.want_exact = true;
  delmesher::ExactRecord record =
      delmesher::tetrahedralize(samples::to_surface(samples::l_shape().input), options).exact;
  record.planes.resize(2);
  record.planes[0].normal = {0.25, -1, 0x1p-60};
  record.planes[0].through[0] = {1, 2, 3};
  record.planes[1].through = {{{1, 2, 3}, {4, 5, 6}, {7, 8, -0.1}}};
  record.planes[1].spanned = true;
  record.triangles = {{5, 1, 7}, {0, 4, 2}};
  ASSERT_TRUE(delmesher::io::write_exact(path("planes.exact"), record).ok());
  const delmesher::ExactRecord read = oracles::read_sidecar(path("planes.exact"));
  EXPECT_EQ(read.triangles, record.triangles);
  ASSERT_EQ(read.planes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.planes[i].spanned, record.planes[i].spanned);
    EXPECT_EQ(read.planes[i].through, record.planes[i].through);
  }
  EXPECT_EQ(read.planes[0].normal, record.planes[0].normal);
}

// A report for programs leaves standard output to JSON; the reason of a failure is one line on
// standard error. A report as text has given the reason already.
TEST_F(Files, AFailureIsExplainedOnce) {
  write_off("in.off", samples::cube().input);
  write_off("other.off", samples::l_shape().input);
  ASSERT_EQ(run("mesh -q " + path("in.off") + " -o " + path("out.mesh")), 0);
  for (const bool json : {false, true}) {
    std::vector<std::string> arguments = {path("other.off"), path("out.mesh")};
    if (json) arguments.push_back("--json");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = verify(arguments);
    const std::string out = testing::internal::GetCapturedStdout(),
                      err = testing::internal::GetCapturedStderr();
    EXPECT_EQ(code, 1);
    EXPECT_NE(out.find("broken"), std::string::npos);
    EXPECT_EQ(out.starts_with("{"), json);
    if (json) {
      EXPECT_TRUE(err.starts_with("tetproof: " + path("out.mesh") + ": broken: ")) << err;
      EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1);
    } else {
      EXPECT_EQ(err, "");
    }
  }
  testing::internal::CaptureStdout();
  EXPECT_EQ(verify({"--help"}), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("{final|refined}"), std::string::npos);
}

// JSON says where findings are: elements of the mesh and of the input, with their middles.
TEST_F(Files, FindingsHavePlaces) {
  write_off("in.off", samples::cube().input);
  write_off("other.off", samples::l_shape().input);
  ASSERT_EQ(run("mesh -q " + path("in.off") + " -o " + path("out.mesh")), 0);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(verify({path("other.off"), path("out.mesh"), "--json"}), 1);
  testing::internal::GetCapturedStderr();
  const auto report = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  const oracles::Polyhedron other = oracles::read_surface(path("other.off"));
  const oracles::MeshFile mesh = oracles::read_mesh(path("out.mesh"));
  std::set<std::string> kinds;
  for (const auto& oracle : report["oracles"]) {
    ASSERT_EQ(oracle["places"].size(), oracle["findings"].size());
    for (std::size_t n = 0; n < oracle["places"].size(); ++n) {
      const auto& place = oracle["places"][n];
      if (!place.contains("kind")) continue;
      const std::string kind = place["kind"], said = oracle["findings"][n];
      kinds.insert(kind);
      std::vector<oracles::Index> corners = place["numbers"];
      const std::string name = kind == "tetrahedra" ? "tetrahedron " : "input vertex ";
      EXPECT_NE(said.find(name + std::to_string(corners[0]) + " "), std::string::npos) << said;
      if (kind == "tetrahedra") {
        const oracles::Tet& tet = mesh.tetrahedra.at(corners[0]);
        corners.assign(tet.begin(), tet.end());
      }
      const auto& vertices = kind == "tetrahedra" ? mesh.vertices : other.vertices;
      for (std::size_t d = 0; d < 3; ++d) {
        double sum = 0;
        for (const oracles::Index v : corners) sum += vertices.at(v)[d];
        EXPECT_NEAR(place["at"][d], sum / static_cast<double>(corners.size()), 1e-15) << said;
      }
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"input vertices", "tetrahedra"})) << report.dump(1);
}

// The output is the refined mesh, of the chamfered wedge. With the sidecar it is taken for that.
TEST_F(Files, ApproximateMeshesAreVerifiedAsRefinedMeshes) {
  for (const samples::NamedSurface& model : samples::surfaces(1)) {
    if (model.name == "wedge") write_off("in.off", samples::to_polyhedron(model.surface));
  }
  ASSERT_EQ(run("mesh -q --approximate " + path("in.off") + " -o " + path("out.mesh") +
                " --exact " + path("out.exact")),
            0);
  const std::string approximate = "mesh --approximate";
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--exact", path("out.exact"), "--promised",
                    approximate}),
            0);
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--exact", path("out.exact")}), 1);
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--stage", "final"}), 1);
  // Without it nothing says whether it is a mesh of the wedge at all, or of a cube.
  EXPECT_EQ(verify({path("in.off"), path("out.mesh"), "--promised", approximate}), 5);
  write_off("cube.off", samples::cube().input);
  ASSERT_EQ(run("mesh -q " + path("cube.off") + " -o " + path("cube.mesh")), 0);
  EXPECT_EQ(
      verify({path("in.off"), path("cube.mesh"), "--promised", approximate + " --region hull"}), 5);
}

TEST_F(Files, HullsCarryTheirRegionsInAllFormats) {
  write_off("in.off", samples::hollow_cube().input);
  std::string outputs;
  for (const char* format : kFormats) outputs += " -o " + path(std::string("out.") + format);
  ASSERT_EQ(run("cdt -q " + path("in.off") + outputs), 0);
  for (const char* format : kFormats) {
    const std::string file = path(std::string("out.") + format);
    EXPECT_EQ(verify({path("in.off"), file}), 0) << format;
    EXPECT_EQ(oracles::read_mesh(file).regions.size(), oracles::read_mesh(file).tetrahedra.size())
        << format;
  }
}

TEST_F(Files, LabelsComeBack) {
  std::string text = "8 3 0 0\n";  // .smesh: a cube whose faces have markers, some not positive
  for (int v = 0; v < 8; ++v) {
    text += std::to_string(v) + " " + std::to_string(v & 1) + " " + std::to_string(v >> 1 & 1) +
            " " + std::to_string(v >> 2) + "\n";
  }
  text +=
      "6 1\n4 0 2 3 1 7\n4 4 5 7 6 -3\n4 0 1 5 4 0\n4 2 6 7 3 7\n4 0 4 6 2 2\n4 1 3 7 5 9\n"
      "0\n0\n";
  write("in.smesh", text);
  const std::map<std::int32_t, int> expected = {{-3, 1}, {0, 1}, {2, 1}, {7, 2}, {9, 1}};
  for (const char* format : {"mesh", "msh", "vtu", "node"}) {
    const std::string file = path(std::string("out.") + format);
    ASSERT_EQ(run("cdt -q " + path("in.smesh") + " -o " + file), 0);
    EXPECT_EQ(verify({path("in.smesh"), file}), 0) << format;
    std::map<std::int32_t, int> triangles;
    for (const std::int32_t label : oracles::read_mesh(file).labels) ++triangles[label];
    for (auto& [label, count] : triangles) count /= 2;  // two triangles a face
    EXPECT_EQ(triangles, expected) << format;
  }
}

TEST_F(Files, AMeshOfAnotherSurfaceIsBroken) {
  write_off("in.off", samples::l_shape().input);
  write_off("other.off", samples::cube().input);
  ASSERT_EQ(run("mesh -q " + path("in.off") + " -o " + path("out.mesh")), 0);
  EXPECT_EQ(verify({path("in.off"), path("out.mesh")}), 0);
  EXPECT_EQ(verify({path("other.off"), path("out.mesh")}), 1);
}

TEST_F(Files, BadFilesAreRefusedNotBelieved) {
  write_off("in.off", samples::cube().input);
  write("empty.mesh", "");
  write("text.mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 1 0 0 zero 1");
  write("lie.mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 99999999999");
  write("range.mesh",
        "MeshVersionFormatted 2 Dimension 3 Vertices 1 0 0 0 0 Tetrahedra 1 1 2 3 4 1");
  write("cut.tet", "4 vertices\n1 tets\n0 0 0\n");
  write("infinite.mesh",
        "MeshVersionFormatted 2 Dimension 3 Vertices 1 inf 0 0 0 Tetrahedra 0 End");
  for (const char* name :
       {"empty.mesh", "text.mesh", "lie.mesh", "range.mesh", "cut.tet", "none.msh"}) {
    EXPECT_EQ(verify({path("in.off"), path(name)}), 3) << name;
  }
  EXPECT_EQ(verify({path("in.off"), path("infinite.mesh")}), 1);
  oracles::Polyhedron open = samples::cube().input;
  open.triangles.pop_back();
  write_off("open.off", open);
  write("one.tet", "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n");
  EXPECT_EQ(verify({path("open.off"), path("one.tet")}), 4);
  EXPECT_EQ(verify({path("in.off"), path("one.tet")}), 1);
  EXPECT_EQ(verify({path("in.off")}), 2);
}

TEST_F(Files, SurfacesReadTheSameInEveryFormat) {
  const std::vector<oracles::Position> corners = {
      {0, 0, 0}, {0x1.8p0, 0, 0}, {0, 0x1.4p1, 0}, {0, 0, 0x1p-3}};
  write("a.obj",
        "# c\nv 0 0 0\nv 1.5 0 0\nv 0 2.5 0\nv 0 0 0.125\n"
        "f 1 3 2\nf 1/1 2/2 4/3\nf -3 -2 -1\nf 3//1 1//1 4//1\n");
  write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement face 4\nproperty list uchar int vertex_indices\n"
        "property int label\nend_header\n0 0 0\n1.5 0 0\n0 2.5 0\n0 0 0.125\n"
        "3 0 2 1 5\n3 0 1 3 5\n3 1 2 3 6\n3 2 0 3 5\n");
  const oracles::Polyhedron obj = oracles::read_surface(path("a.obj"));
  const oracles::Polyhedron ply = oracles::read_surface(path("a.ply"));
  EXPECT_EQ(obj.vertices, corners);
  EXPECT_EQ(ply.vertices, corners);
  EXPECT_EQ(obj.triangles, ply.triangles);
  EXPECT_EQ(ply.labels, (std::vector<std::int32_t>{5, 5, 6, 5}));
  std::string text = "solid a\n";
  std::string bytes(80, ' ');
  const std::uint32_t count = 4;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& triangle : ply.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    bytes.append(12, '\0');
    for (const auto v : triangle) {
      for (const double x : ply.vertices[v]) {
        const float value = static_cast<float>(x);
        bytes.append(reinterpret_cast<const char*>(&value), 4);
      }
      const auto& p = ply.vertices[v];
      text += "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
              std::to_string(p[2]) + "\n";
    }
    bytes.append(2, '\0');
    text += "endloop\nendfacet\n";
  }
  write("text.stl", text + "endsolid a\n");
  write("binary.stl", bytes);
  for (const char* name : {"text.stl", "binary.stl"}) {
    const oracles::Polyhedron stl = oracles::read_surface(path(name));
    ASSERT_EQ(stl.triangles.size(), 4U) << name;
    EXPECT_EQ(stl.vertices.size(), 4U) << name;
    for (std::size_t t = 0; t < 4; ++t) {
      for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(stl.vertices[stl.triangles[t][i]], ply.vertices[ply.triangles[t][i]]) << name;
      }
    }
  }
}

// The reader of the oracles and that of the mesher cut faces by the same rule: random star-shaped
// faces of 4 to 12 corners, off their plane or on a grid where diagonals are equal, along all axes.
TEST_F(Files, FacesThatAreNotPlanarAreCutAlikeByBothReaders) {
  std::mt19937_64 random(20);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  int bent = 0;
  for (int round = 0; round < samples::iterations(300); ++round) {
    const int corners = 4 + static_cast<int>(random() % 9), axis = static_cast<int>(random() % 3);
    const bool grid = random() % 2 == 0, backwards = random() % 2 == 0;
    std::string points, face = std::to_string(corners);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * (backwards ? corners - i : i) / corners;
      const double radius = uniform(0.3, 1);
      std::array<double, 3> p = {radius * std::cos(angle), radius * std::sin(angle),
                                 uniform(-0.1, 0.1)};
      if (grid) {
        for (double& x : p) x = std::round(x * 16) / 16;
      }
      std::rotate(p.begin(), p.begin() + axis, p.end());
      char line[128];
      std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
      points += line;
      face += " " + std::to_string(i);
    }
    write("face.off", "OFF\n" + std::to_string(corners) + " 1 0\n" + points + face + "\n");
    const delmesher::io::ReadResult mine = delmesher::io::read_surface(path("face.off"));
    const oracles::Polyhedron theirs = oracles::read_surface(path("face.off"));
    ASSERT_TRUE(mine.ok()) << mine.error;
    ASSERT_EQ(theirs.triangles.size(), corners - 2U);
    if (theirs.polygons[0] == theirs.polygons[1]) continue;  // not simple in any projection
    ++bent;
    for (std::size_t t = 0; t < theirs.triangles.size(); ++t) {
      EXPECT_EQ(smallest_first(theirs.triangles[t]), smallest_first(mine.surface.triangles[t]))
          << points << face;
    }
  }
  EXPECT_GT(bent, 100);
}

// --- the plane

struct PlaneInput {
  const char *name, *text;
};
constexpr PlaneInput kPlaneInputs[] = {
    {"arrow.txt", "0 0\n4 0\n1 1\n0 4\n"},
    // Comments, commas, borders, a segment; numbers from 1, holes, regions.
    {"rings.txt",
     "# two that share a border\n0 0\n1 0\n1,1\n0 1\n> second\n1 0\n2 0\n2 1\n1 1\n\n"
     "0.2 0.2\n0.4 0.2\n0.3 0.21\n\n1.5 0.5\n1.75 0.75 \n"},
    {"hole.poly",
     "# a square with a hole\n8 2 1 0\n1 0 0 7\n2 4 0 7\n3 4 4 7\n4 0 4 7\n5 1 1 7\n6 3,1 7\n"
     "7 3 3 7\n8 1 3 7\n8 1\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 5\n5 5 6 9\n6 6 7 9\n7 7 8 9\n"
     "8 8 5 9\n1\n1 2 2\n1\n1 0.5 0.5 3 0.1\n"},
    // A loose end, a vertex on a segment, and one alone.
    {"loose.poly",
     "8 2 0 0\n0 0 0\n1 4 0\n2 4 3\n3 0 3\n4 2 0\n5 2 1\n6 3.5 1.5\n7 2.2 1.1\n6 0\n0 0 1\n1 1 2\n"
     "2 2 3\n3 3 0\n4 4 5\n5 4 7\n0\n"},
    {"faces.off",
     "OFF\n8 2 0\n0 0 0\n1 0 0\n1.2 0.6 0\n1 1 0\n0 1 0\n-0.1 0.4 0\n2 0.5 0\n2 2 0\n"
     "6 0 1 2 3 4 5\n4 1 6 7 2\n"},
    {"labels.obj",
     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.2 0\nv 0.8 0.35 0\nusemtl a\nf 1 2 3\n"
     "usemtl b\nf 1 3 4\nl 5 6\n"},
    {"lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.1 0\nl 1 2 3 4 1\nl 1 5\n"}};

constexpr const char* kPlaneFormats[] = {"node", "vtu", "msh", "off"};

TEST_F(Files, EveryMeshOfThePlaneIsVerified) {
  const std::string outputs = " -q -o " + path("o.node") + " -o " + path("o.vtu") + " -o " +
                              path("o.msh") + " -o " + path("o.off") + " --exact " +
                              path("o.exact");
  for (const auto& [name, text] : kPlaneInputs) {
    write(name, text);
    for (const char* options :
         {"", "--region hull", "--approximate", "--approximate --region hull", "--acute 90",
          "--preset paper", "--max-edge 0.3", "--delta 30 --chamfer-radius 0.05", "--tau 0.2"}) {
      ASSERT_EQ(run("plane " + path(name) + outputs + " " + options), 0) << name << options;
      for (const char* format : kPlaneFormats) {
        SCOPED_TRACE(std::string(name) + " " + options + " " + format);
        const std::string mesh = path(std::string("o.") + format), promised = "plane ";
        // For a refined mesh a record decides.
        const bool approximate = std::string(options).find("--approximate") != std::string::npos;
        // A third of an edge at an acute corner is longer.
        const bool long_edges = std::string(options) == "--max-edge 0.3" && name[0] != 'r' &&
                                name[0] != 'h' && !std::string(name).ends_with(".obj");
        EXPECT_EQ(verify({path(name), mesh, "--promised", promised + options}),
                  approximate || long_edges ? 5 : 0);
        EXPECT_EQ(verify({path(name), mesh, "--exact", path("o.exact"), "--promised",
                          promised + options}),
                  0);
      }
    }
  }
}

std::string contents(const std::string& file) {
  return oracles::read_whole_file(file);
}

TEST_F(Files, VerifyOfThePlaneTellsInItsExitCode) {
  write("in.txt", kPlaneInputs[0].text);
  const std::string in = path("in.txt"), mesh = path("o.node"), exact = path("o.exact");
  ASSERT_EQ(run("plane " + in + " -q -o " + mesh + " -o " + path("o.off") + " --exact " + exact),
            0);
  const auto verdict = [&](const std::string& promised) {
    return verify({in, mesh, "--exact", exact, "--promised", promised});
  };
  testing::internal::CaptureStdout();
  EXPECT_EQ(verdict("plane"), 0);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(said.starts_with("verdict: ")) << said;
  for (std::size_t at = 0; at < said.size(); at = said.find('\n', at) + 1) {
    EXPECT_LE(said.find('\n', at) - at, 120U) << said.substr(at, 200);
  }
  // Not what was promised.
  EXPECT_EQ(verdict("plane --acute 90"), 1);
  EXPECT_EQ(verdict("plane --max-edge 0.01"), 1);
  EXPECT_EQ(verdict("plane --region hull"), 1);
  EXPECT_EQ(verdict("plane --approximate"), 1);
  EXPECT_EQ(verdict("plane --chamfer-radius 1e-3"), 1);
  // No such promise, no such files.
  EXPECT_EQ(verdict("plain"), 2);
  EXPECT_EQ(verdict("plane --delta x"), 2);
  EXPECT_EQ(verify({in, mesh, "--promised", "plane", "--stage", "refined"}), 2);
  EXPECT_EQ(verdict("mesh"), 3);
  EXPECT_EQ(verify({in, path("o.svg"), "--promised", "plane"}), 3);
  write("empty.poly", "2 2\n0 0 0\n1 0 0\n1 0\n0 0 1\n0\n");  // a segment of no length
  EXPECT_EQ(verify({path("empty.poly"), mesh, "--promised", "plane"}), 4);
  // Records cut short are rejected; to try all lengths would take too long.
  const std::string record = contents(exact);
  for (std::size_t size = 0; size + 1 < record.size(); size += 1 + size / 8) {
    write("o.exact", record.substr(0, size));
    EXPECT_EQ(verdict("plane"), 3) << size;
  }
  write("o.exact", "delmesher-plane-exact 2" + record.substr(record.find('\n')));
  EXPECT_EQ(verdict("plane"), 3);
  write("o.exact", "delmesher-plane-exact 0" + record.substr(record.find('\n')));
  EXPECT_EQ(verdict("plane"), 1);
  write("o.exact", record);
  // An inverted triangle, and one that is flat, never pass, with a record or without.
  const std::string off = contents(path("o.off"));
  const std::size_t face = off.find("\n3 ") + 1, end = off.find('\n', face);
  std::istringstream corners(off.substr(face, end - face));
  std::string three, a, b, c;
  corners >> three >> a >> b >> c;
  for (const std::string& spoilt : {b + " " + a + " " + c, a + " " + a + " " + c}) {
    write("bad.off", off.substr(0, face) + "3 " + spoilt + off.substr(end));
    EXPECT_EQ(verify({in, path("bad.off"), "--promised", "plane"}), 1);
    EXPECT_EQ(verify({in, path("bad.off"), "--exact", exact, "--promised", "plane"}), 1);
  }
}

// The two readers of planar graphs, which share nothing.
TEST_F(Files, GraphsAreReadAlikeByBothReaders) {
  for (const auto& [name, text] : kPlaneInputs) {
    write(name, text);
    const delmesher::io::PlaneReadResult mine = delmesher::io::read_plane(path(name));
    const delmesher::PlanarGraph theirs = oracles::read_plane_graph(path(name));
    ASSERT_TRUE(mine.ok()) << mine.error;
    EXPECT_EQ(mine.graph.vertices, theirs.vertices) << name;
    EXPECT_EQ(mine.graph.markers, theirs.markers) << name;
    EXPECT_EQ(mine.graph.partitions, theirs.partitions) << name;
    EXPECT_EQ(mine.graph.holes, theirs.holes) << name;
    EXPECT_EQ(mine.graph.regions.size(), theirs.regions.size()) << name;
    EXPECT_EQ(mine.graph.insideness, theirs.insideness) << name;
    ASSERT_EQ(mine.graph.segments.size(), theirs.segments.size()) << name;
    for (std::size_t i = 0; i < theirs.segments.size(); ++i) {
      auto one = mine.graph.segments[i], other = theirs.segments[i];
      std::sort(one.begin(), one.end());
      std::sort(other.begin(), other.end());
      EXPECT_EQ(one, other) << name << " " << i;
    }
  }
}

// Whichever step runs out of memory.
TEST_F(Files, VerifyingWithoutEnoughMemoryIsFive) {
  const std::string said = path("said");
  if (!can_be_limited(said)) GTEST_SKIP() << "address space cannot be limited here";
  write_off("in.off", samples::skewed(samples::l_shape()).input);
  ASSERT_EQ(run("mesh -q --max-edge 0.1 " + path("in.off") + " -o " + path("out.mesh") +
                " --exact " + path("out.exact")),
            0);
  int ended = 0;
  for (const std::size_t kibibytes : {64, 128, 256, 512, 1024, 65536}) {
    fs::remove(said);
    const int code = with_more_memory(kibibytes << 10, said, [&] {
      survive_lack_of_memory();
      return verify({path("in.off"), path("out.mesh"), "--exact", path("out.exact")});
    });
    std::ostringstream text;
    text << std::ifstream(said).rdbuf();
    EXPECT_TRUE(code == 0 || (code == 5 && text.str().ends_with("out.mesh: not enough memory\n")))
        << code << " with " << kibibytes << " KiB: " << text.str();
    if (code == 5) ++ended;
  }
  EXPECT_GE(ended, 2);
}

}  // namespace
}  // namespace tetproof::files_test
