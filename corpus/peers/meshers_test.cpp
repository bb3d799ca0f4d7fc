#include "corpus/peers/meshers.h"
#include "corpus/peers/peers.h"
#include "mesher/delmesher/option_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace tetproof {
namespace {

namespace fs = std::filesystem;

class Meshers : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("meshers_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    fs::create_directories(folder_ / "adapters");
    programs_ = {TETPROOF_SUPERVISE_PATH, script("delmesher", "echo delmesher 1.2"), folder_};
    script("tetproof-tetgen", "echo TetGen 9.9");
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path script(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << text << "\n";
    fs::permissions(folder_ / name, fs::perms::owner_all);
    return folder_ / name;
  }

  std::string command(const std::string& name) const {
    std::string text;
    for (const auto& word :
         make_mesher(name, programs_).command({"in.off", "out.mesh", "stats.json"})) {
      text += (text.empty() ? "" : " ") + word;
    }
    return text;
  }

  fs::path folder_;
  MesherPrograms programs_;
};

TEST_F(Meshers, ThePapersExperiments) {
  const std::string own = programs_.delmesher.string();
  const std::string files = " in.off -o out.mesh --stats stats.json -q";
  EXPECT_EQ(command("delmesher"), own + " mesh" + files);
  EXPECT_EQ(command("delmesher-e4"), own + " mesh --preset paper" + files);
  EXPECT_EQ(command("safe-delmesher-e4"), own + " mesh --preset paper --slivers off" + files);
  EXPECT_EQ(command("delmesher-nofilter"), own + " mesh --preset paper --tau 0" + files);
  EXPECT_EQ(command("delmesher-split"), own + " mesh --surface split" + files);
  EXPECT_EQ(command("delmesher-keep"), own + " mesh --surface keep" + files);
  EXPECT_EQ(command("cdt"), own + " cdt --region hull" + files);
  const std::string tetgen = (programs_.adapters / "tetproof-tetgen").string();
  EXPECT_EQ(command("tetgen"), tetgen + " zpcq in.off out.mesh stats.json");
  EXPECT_EQ(command("tetgen-T0"), tetgen + " zpcqT0 in.off out.mesh stats.json");
}

TEST_F(Meshers, OfThePlane) {
  const Mesher mesher = make_mesher("plane", programs_);
  EXPECT_TRUE(mesher.of_plane());
  EXPECT_EQ(mesher.mesh_extension, ".vtu");
  EXPECT_EQ(mesher.promised, "plane");
  EXPECT_FALSE(make_mesher("cdt", programs_).of_plane());
  const Mesher other = make_mesher("own=cmd,region=plane:'mesh {in} {out.off}'", programs_);
  EXPECT_TRUE(other.of_plane());
  EXPECT_EQ(other.promised, "plane");
  EXPECT_THROW(make_mesher("cmd:'mesh {in} {out.off}'", programs_), std::runtime_error);
  EXPECT_THROW(make_mesher("cmd,region=plane:'mesh {in} {out.tet}'", programs_),
               std::runtime_error);
}

TEST_F(Meshers, EveryDeviationAlone) {
  const std::string own = programs_.delmesher.string();
  const std::string files = " in.off -o out.mesh --stats stats.json -q";
  EXPECT_EQ(command("delmesher+order"), own + " mesh --as-paper order" + files);
  EXPECT_EQ(command("delmesher+acute-90"), own + " mesh --acute 90 --corner 90" + files);
  EXPECT_THROW(make_mesher("delmesher+nothing", programs_), std::runtime_error);
  const std::vector<std::string> names = ablation_names();
  EXPECT_EQ(names.front(), "delmesher-split");
  EXPECT_EQ(names.back(), "delmesher-e4");
  EXPECT_EQ(names.size(), 2 + 6 + delmesher::options::paper_choices<delmesher::Options>().size());
  for (const std::string& name : names) EXPECT_EQ(make_mesher(name, programs_).name, name);
}

TEST_F(Meshers, WhatEachCovers) {
  EXPECT_EQ(make_mesher("delmesher", programs_).region, "interior");
  for (const char* name : {"delmesher-e4", "safe-delmesher-e4", "cdt", "tetgen", "tetgen-T0"}) {
    EXPECT_EQ(make_mesher(name, programs_).region, "hull") << name;
  }
}

TEST_F(Meshers, TheVersionChangesWithTheBuild) {
  const std::string before = make_mesher("delmesher", programs_).version;
  EXPECT_TRUE(before.starts_with("delmesher 1.2 (build ")) << before;
  EXPECT_EQ(make_mesher("delmesher", programs_).version, before);
  script("delmesher", "echo delmesher 1.2 # rebuilt");
  EXPECT_NE(make_mesher("delmesher", programs_).version, before);
}

TEST_F(Meshers, Commands) {
  EXPECT_EQ(command("cmd:prog -x {in} {out.mesh}"), "/bin/sh -c prog -x 'in.off' 'out.mesh'");
  const Mesher mesher = make_mesher("mine=cmd:prog {in} {out.mesh} {stats}", programs_);
  EXPECT_EQ(mesher.name, "mine");
  EXPECT_EQ(mesher.mesh_extension, ".mesh");
  EXPECT_EQ(mesher.command({"it's.off", "o.mesh", "s"})[2], "prog 'it'\\''s.off' 'o.mesh' 's'");
  EXPECT_EQ(make_mesher("no-slivers=delmesher:mesh --slivers off", programs_).flags,
            "mesh --slivers off");
}

TEST_F(Meshers, CommandsWriteFilesThatCanBeRead) {
  for (const char* known : {".mesh", ".msh", ".vtu", ".node", ".tet", ".msh.gz"}) {
    const std::string text = "cmd:prog {in} {out" + std::string(known) + "}";
    EXPECT_EQ(make_mesher(text, programs_).mesh_extension, known);
  }
  for (const char* other : {".foo", ".", ".gz", ".vtk"}) {
    const std::string text = "cmd:prog {in} {out" + std::string(other) + "}";
    EXPECT_THROW(make_mesher(text, programs_), std::runtime_error) << other;
  }
}

TEST_F(Meshers, CommandsDeclareWhatTheyMesh) {
  const Mesher mesher =
      make_mesher("g=cmd,region=hull,deviation=1e-8:prog a:b {in} {out.msh}", programs_);
  EXPECT_EQ(mesher.name, "g");
  EXPECT_EQ(mesher.region, "hull");
  EXPECT_EQ(mesher.declared_deviation, 1e-8);
  EXPECT_EQ(mesher.flags, "prog a:b {in} {out.msh}");
  EXPECT_EQ(make_mesher("cmd:prog {in} {out.msh}", programs_).declared_deviation, 0);
  for (const char* text :
       {"g=cmd,region=outside:p {in} {out.msh}", "cmd,deviation=:p {in} {out.msh}",
        "cmd,deviation=-1:p {in} {out.msh}", "cmd,envelope=x:p {in} {out.msh}",
        "cmd,envelope=1e-8:p {in} {out.msh}", "cmd,x:p {in} {out.msh}"}) {
    EXPECT_THROW(make_mesher(text, programs_), std::runtime_error) << text;
  }
}

TEST_F(Meshers, TheVersionOfACommandIsThatOfItsProgram) {
  const std::string line = "cmd:" + script("prog", "true").string() + " {in} {out.msh}";
  const std::string before = make_mesher(line, programs_).version;
  EXPECT_TRUE(before.starts_with("cmd (build ")) << before;
  script("prog", "false");
  EXPECT_NE(make_mesher(line, programs_).version, before);
  EXPECT_TRUE(make_mesher("cmd:sh -c x {in} {out.msh}", programs_).version.starts_with("cmd (b"));
  EXPECT_EQ(make_mesher("cmd:no-such {in} {out.msh}", programs_).version, "cmd");
}

TEST_F(Meshers, TheChamferedSurfaceIsAskedForOnlyWhereThereIsOne) {
  RunFiles files = {"in.off", "out.mesh", "stats.json"};
  files.chamfered = "c.off";
  const auto asks = [&](const std::string& name) {
    const auto argv = make_mesher(name, programs_).command(files);
    return std::find(argv.begin(), argv.end(), "--save-chamfered") != argv.end();
  };
  EXPECT_TRUE(asks("delmesher"));
  EXPECT_TRUE(asks("safe-delmesher-e4"));
  EXPECT_FALSE(asks("cdt"));
  EXPECT_FALSE(asks("tetgen"));
}

// Programs of ours that link a peer, and scripts that run its program, which tells the version even
// if on the error stream.
TEST_F(Meshers, Peers) {
  EXPECT_THROW(make_mesher("netgen", programs_), std::runtime_error);
  EXPECT_FALSE(why_not_at_hand("netgen", programs_).empty());
  script("tetproof-netgen", "echo Netgen 7");
  EXPECT_EQ(why_not_at_hand("netgen", programs_), "");
  const std::string folder = folder_.string();
  EXPECT_EQ(command("netgen-raw"), folder + "/tetproof-netgen raw in.off out.mesh stats.json");
  EXPECT_EQ(make_mesher("netgen", programs_).exit_codes, ExitCodes::ours);

  EXPECT_NE(why_not_at_hand("cgal-mesh3", programs_).find("--target"), std::string::npos);
  script("tetproof-cgal-mesh3", "echo CGAL 5");
  EXPECT_EQ(command("cgal-mesh3"), folder + "/tetproof-cgal-mesh3 - in.off out.mesh stats.json");
  EXPECT_EQ(make_mesher("cgal-mesh3", programs_).promise(), "envelope 0.005");

  EXPECT_NE(why_not_at_hand("cgal-ccdt", programs_).find("CGAL 6.1"), std::string::npos);
  script("tetproof-cgal-ccdt", "echo CGAL 6");
  EXPECT_EQ(command("cgal-ccdt"), folder + "/tetproof-cgal-ccdt - in.off out.mesh stats.json");
  EXPECT_EQ(make_mesher("cgal-ccdt", programs_).promise(), "exact");

  script("adapters/gmsh", "true");
  setenv("GMSH_PROGRAM", (folder_ / "nowhere").c_str(), 1);
  EXPECT_NE(why_not_at_hand("gmsh-hxt", programs_).find("GMSH_PROGRAM"), std::string::npos);
  setenv("GMSH_PROGRAM", script("gmsh", "echo 4.9 >&2").c_str(), 1);
  EXPECT_EQ(command("gmsh-hxt-raw"), "/usr/bin/env TETPROOF=" + folder + "/tetproof " + folder +
                                         "/adapters/gmsh in.off out.mesh -algo hxt -setnumber "
                                         "Mesh.Optimize 0");
  const Mesher gmsh = make_mesher("gmsh-hxt", programs_);
  EXPECT_TRUE(gmsh.version.starts_with("gmsh 4.9 (build ")) << gmsh.version;
  script("adapters/gmsh", "true  # another one");
  EXPECT_NE(make_mesher("gmsh-hxt", programs_).version, gmsh.version);
  EXPECT_EQ(gmsh.mesh_extension, ".msh");
  EXPECT_EQ(why_not_at_hand("gmsh-frontal", programs_), "this build of gmsh is without Netgen");
  script("gmsh", "echo 'Build options     : 64Bit Netgen OpenMP' >&2");
  EXPECT_EQ(why_not_at_hand("gmsh-frontal", programs_), "");
  unsetenv("GMSH_PROGRAM");

  // A Python package: its script tells the version, run by the interpreter.
  fs::create_directories(folder_ / "adapters/wheels");
  script("adapters/wheels/gmsh_wheel.py", "echo 'no package gmsh' >&2; exit 1");
  script("adapters/wheels/contract.py", "");
  setenv("PEERS_PYTHON", script("python", "exec /bin/sh \"$@\"").c_str(), 1);
  EXPECT_NE(why_not_at_hand("gmsh-4.15-hxt", programs_).find("ci/campaigns/peers"),
            std::string::npos);
  script("adapters/wheels/gmsh_wheel.py", "echo gmsh 4.15");
  EXPECT_EQ(why_not_at_hand("gmsh-4.15-hxt", programs_), "");
  EXPECT_EQ(command("gmsh-4.15-hxt"),
            "/usr/bin/env TETPROOF=" + folder + "/tetproof " + folder + "/python " + folder +
                "/adapters/wheels/gmsh_wheel.py Mesh.Algorithm3D=10 in.off out.mesh stats.json");
  const Mesher wheel = make_mesher("gmsh-4.15-hxt", programs_);
  EXPECT_TRUE(wheel.version.starts_with("gmsh 4.15 (adapter ")) << wheel.version;
  script("adapters/wheels/contract.py", "# another one");
  EXPECT_NE(make_mesher("gmsh-4.15-hxt", programs_).version, wheel.version);
  unsetenv("PEERS_PYTHON");
}

TEST_F(Meshers, WhatEachPromises) {
  const auto promise = [&](const std::string& text) {
    return make_mesher(text, programs_).promise();
  };
  EXPECT_EQ(promise("delmesher"), "planar but for rounding");
  EXPECT_EQ(promise("delmesher+planar-0"), "exact");
  EXPECT_EQ(promise("delmesher-e4"), "exact");
  EXPECT_EQ(promise("cdt"), "exact");
  const Mesher near = make_mesher("near=delmesher:mesh --tolerance 1e-3d", programs_);
  EXPECT_EQ(near.promise(), "tolerance 1e-3d");
  EXPECT_EQ(near.verify_options().back(), "mesh --tolerance 1e-3d");
  EXPECT_TRUE(near.own_surface() && !near.sidecar_command);  // it has no record
  EXPECT_EQ(promise("tetgen"), "within 1e-08");
  EXPECT_EQ(promise("tetgen-T0"), "exact");
  EXPECT_EQ(promise("g=cmd,envelope=1e-3:p {in} {out.msh}"), "envelope 0.001");
  for (const Peer& peer : peers()) {
    EXPECT_TRUE(peer.deviation == 0 || peer.envelope == 0) << peer.name;
    EXPECT_EQ(peer_of(peer.name), &peer);
    EXPECT_EQ(std::string(peer.adapter).starts_with("adapters/"), peer.program != nullptr);
  }
}

TEST_F(Meshers, Errors) {
  EXPECT_THROW(make_mesher("nonsense", programs_), std::runtime_error);
  EXPECT_THROW(make_mesher("cmd:prog {in}", programs_), std::runtime_error);
  EXPECT_THROW(make_mesher("cmd:prog {out.mesh}", programs_), std::runtime_error);
  EXPECT_THROW(make_mesher("=cmd:prog {in} {out.mesh}", programs_), std::runtime_error);
  MesherPrograms none = programs_;
  none.adapters = folder_ / "missing";
  EXPECT_THROW(make_mesher("tetgen", none), std::runtime_error);
  none.delmesher = script("broken", "exit 1");
  EXPECT_THROW(make_mesher("delmesher", none), std::runtime_error);
}

}  // namespace
}  // namespace tetproof
