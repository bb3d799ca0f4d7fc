// The messages of a run: its progress, its end, and its statistics.
#include <nlohmann/json.hpp>

#include "mesher/cli/progress.h"
#include "mesher/cli/reports.h"
#include "mesher/cli/test_run.h"
#include "mesher/surface/hints.h"

namespace delmesher::cli {
namespace {

std::string keys(const nlohmann::ordered_json& object) {
  std::string out;
  for (const auto& item : object.items()) out += item.key() + " ";
  return out;
}

class Told : public RunTest {};

TEST(ProgressText, SaysWhatIsKnown) {
  EXPECT_EQ(progress_text({Phase::refine, 0.456, 123}), "refine    45 %  123 vertices");
  EXPECT_EQ(progress_text({Phase::check, -1, 0}), "check");
  EXPECT_EQ(progress_text({Phase::refine, -1, 7, 123456}),
            "refine    about 0 %  7 vertices  (about 120000 tetrahedra predicted)");
  EXPECT_EQ(progress_text({Phase::filter, -1, 7, 123456}),
            "filter  7 vertices  (about 120000 tetrahedra predicted)");
  EXPECT_EQ(progress_text({Phase::check, 7, 0}), "check     100 %");
}

// Within a tenth of a second only another phase is shown; at the end the line is empty.
TEST(ProgressLine, IsWrittenOverAndWipedOut) {
  const auto written = [](bool enabled, bool escapes) {
    std::FILE* const file = std::tmpfile();
    EXPECT_NE(file, nullptr);
    {
      ProgressLine line(file, enabled, escapes);
      line.show({Phase::refine, 0.5, 0});
      line.show({Phase::check, -1, 0});
    }
    std::string text(200, ' ');
    std::rewind(file);
    text.resize(std::fread(text.data(), 1, text.size(), file));
    std::fclose(file);
    return text;
  };
  EXPECT_EQ(written(false, true), "");
  EXPECT_EQ(written(true, true), "\rrefine    50 %\x1b[K\rcheck\x1b[K\r\x1b[K\r");
  EXPECT_EQ(written(true, false), "\rrefine    50 %\rcheck         \r     \r");
}

TEST(ProgressText, TellsTheRestOfThePhase) {
  EXPECT_EQ(progress_text({Phase::improve, 0.25, 0}, 30), "improve   25 %, 90 s left");
  EXPECT_EQ(progress_text({Phase::improve, 0.25, 0}, 60), "improve   25 %, 3 min left");
  EXPECT_EQ(progress_text({Phase::improve, 0.5, 0}, 10000), "improve   50 %, 3 h left");
  EXPECT_EQ(progress_text({Phase::refine, -1, 5000, 21000}, 7),
            "refine    about 50 %, 7 s left  5000 vertices  (about 21000 tetrahedra predicted)");
  // Too soon, too little, and beyond the prediction.
  EXPECT_EQ(progress_text({Phase::improve, 0.25, 0}, 1), "improve   25 %");
  EXPECT_EQ(progress_text({Phase::improve, 0.04, 0}, 30), "improve   4 %");
  EXPECT_EQ(progress_text({Phase::refine, -1, 20000, 21000}, 7),
            "refine    about 99 %  20000 vertices  (about 21000 tetrahedra predicted)");
}

TEST(Reports, DefectsAreCountedInWords) {
  SurfaceReport report;
  const auto count = [&](Defect::Kind kind) -> std::uint64_t& {
    return report.defect_counts[static_cast<std::size_t>(kind)];
  };
  count(Defect::Kind::non_manifold_vertex) = 2;
  EXPECT_EQ(surface::defects_line(report), "2 non-manifold vertices");
  count(Defect::Kind::open_edge) = 1;
  EXPECT_EQ(surface::defects_line(report),
            "3 defects of 2 kinds (1 open edge, 2 non-manifold vertices)");
}

TEST(Reports, LimitsThatStruckHaveALineEach) {
  EXPECT_TRUE(limits_texts({}).empty());
  Statistics s;
  s.ladder[Rung::chamfers_everywhere] = 1;
  s.refinement_capped = true;
  s.cdt_restarts = 1;
  s.rounding_thinned = 7;
  const std::vector<std::string> texts = limits_texts(s);
  ASSERT_EQ(texts.size(), 4U);
  EXPECT_NE(texts[0].find("would not end"), std::string::npos);
  EXPECT_NE(texts[3].find("7 points"), std::string::npos);
}

TEST(Reports, VerticesLeftOnAKeptSurfaceAreTold) {
  Statistics s;
  s.left_on_surface = 3;
  ASSERT_EQ(limits_texts(s).size(), 1U);
  EXPECT_NE(limits_texts(s)[0].find("but for 3 vertices"), std::string::npos);
}

TEST(Reports, WhatDoesNotGoBackByLocalOperationsIsTold) {
  Statistics s;
  s.diagonals = 9;
  s.planar_given_up = true;
  ASSERT_EQ(limits_texts(s).size(), 1U);
  EXPECT_NE(limits_texts(s)[0].find("did not fit"), std::string::npos);
  s.diagonals_missing = 2;
  EXPECT_NE(limits_texts(s)[0].find("2 of 9 edges"), std::string::npos);
  EXPECT_NE(limits_texts(s)[0].find("without those facets"), std::string::npos);
  s.planar_given_up = false;
  EXPECT_TRUE(limits_texts(s).empty());
  s.ladder[Rung::tetrahedrize_again] = 1;
  ASSERT_EQ(limits_texts(s).size(), 1U);
  EXPECT_NE(limits_texts(s)[0].find("tetrahedrized again"), std::string::npos);
}

TEST_F(Told, EndsWithALineOfQualityUnlessQuiet) {
  MeshStatistics& s = answer_.statistics.final;
  s.tetrahedra = 1;
  s.min_dihedral = 54.736;
  s.max_dihedral = 90;
  s.min_face_angle = 45;
  s.gamma_1_percent = s.mean_gamma = 0.7320508;
  s.min_gamma = 2e-10;
  s.below_5 = 3;
  s.sharpest_dihedral = {1, 2, 0, 3};
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  const std::string counts = path("a.mesh") + ": 4 vertices, 1 tetrahedron in ";
  const std::string quality =
      " s; dihedral angles 54.74 to 90.00 degrees, 3 tetrahedra below 5, the smallest at (0.5, "
      "0.5, "
      "0); smallest face angle 45.00; mean shape 0.73 (1 is regular)\n";
  EXPECT_TRUE(error_.starts_with(counts) && error_.ends_with(quality)) << error_;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-o", path("b.vtu")}), kDone);
  EXPECT_TRUE(error_.starts_with(path("a.mesh") + ", " + path("b.vtu") + ": 4 v")) << error_;
  EXPECT_EQ(go({"cdt", path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find(" s; dihedral"), std::string::npos);
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  answer_.statistics.rounding_inverted = 1;  // the failure is told at the very end
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kFailed);
  EXPECT_NE(error_.find("regular)\ndelmesher: "), std::string::npos) << error_;
}

// The tetrahedron in the corner of a cube, squeezed to a height of 0.001, as its own mesh, and as a
// mesh of something larger.
TEST_F(Told, WarnsOfSmallAnglesAndSaysWhetherTheInputForcesThem) {
  answer_.mesh.vertices[3] = {0, 0, 0.001};
  answer_.mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 1, 2, 3};
  answer_.mesh.boundary_labels = {0, 0, 0, 0};
  MeshStatistics& s = answer_.statistics.final;
  s.tetrahedra = 1;
  s.min_dihedral = 0.081;
  s.min_face_angle = 0.0573;
  s.sharpest_dihedral = {1, 2, 0, 3};
  s.sharpest_face_angle = {1, 0, 3};
  const auto lines = [&] { return std::count(error_.begin(), error_.end(), '\n'); };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_EQ(lines(), 3) << error_;
  const std::string start = "delmesher: " + path("in.off") + ": warning: the smallest ";
  EXPECT_TRUE(error_.starts_with(start + "face angle is 0.057 degrees, at (1, 0, 0), where the "
                                         "input has a corner of 0.057\n"))
      << error_;
  EXPECT_NE(
      error_.find(start + "dihedral angle is 0.081 degrees, at (0.5, 0.5, 0), where facets of "
                          "the input meet at 0.081\n"),
      std::string::npos)
      << error_;
  s.sharpest_face_angle = {4, 0, 3};  // a vertex on the sharp edge, in a face across
  answer_.mesh.vertices.push_back({0.5, 0.5, 0});
  answer_.mesh.tetrahedra = {{0, 1, 4, 3}, {0, 4, 2, 3}};
  answer_.mesh.inside = {1, 1};
  answer_.mesh.boundary = {{0, 2, 4}, {0, 4, 1}, {0, 1, 3}, {1, 4, 3}, {4, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 0, 1, 2, 2, 3};
  answer_.mesh.boundary_labels = std::vector<std::int32_t>(6);
  s.tetrahedra = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_TRUE(error_.starts_with(start + "face angle is 0.057 degrees, at (0.5, 0.5, 0), where "
                                         "facets of the input meet at 0.081\n"))
      << error_;
  answer_.mesh.vertices.pop_back();
  answer_.mesh.tetrahedra = {{0, 1, 2, 3}};
  answer_.mesh.inside = {1};
  answer_.mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 1, 2, 3};
  answer_.mesh.boundary_labels = {0, 0, 0, 0};
  s.sharpest_face_angle = {1, 0, 3};
  s.tetrahedra = 1;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  // No angles are promised of these.
  EXPECT_EQ(go({"cdt", path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_EQ(lines(), 1) << error_;
  // Less was asked for.
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "--delta", "0.05"}), kDone);
  EXPECT_EQ(error_.find("face angle is"), std::string::npos) << error_;

  // With a neighbour, the small angles are at no edge and no corner of the input.
  answer_.mesh.vertices.push_back({0.2, 0.2, -1});
  answer_.mesh.tetrahedra.push_back({0, 2, 1, 4});
  answer_.mesh.inside.push_back(1);
  answer_.mesh.boundary = {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 1}, {1, 4, 2}, {2, 4, 0}};
  answer_.mesh.boundary_facets = {1, 2, 3, 1, 2, 3};
  answer_.mesh.boundary_labels = std::vector<std::int32_t>(6);
  s.tetrahedra = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("at (1, 0, 0), not the 14.47 asked for\n"), std::string::npos) << error_;
  EXPECT_NE(error_.find("at (0.5, 0.5, 0)\n"), std::string::npos) << error_;
  // Facets that meet there, but at a much larger angle.
  answer_.mesh.boundary_facets = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("at (0.5, 0.5, 0)\n"), std::string::npos) << error_;
  // Facets that do not touch, near each other: a thin wall.
  answer_.mesh.boundary = {{1, 2, 0}, {3, 5, 6}};
  answer_.mesh.boundary_facets = {1, 2};
  answer_.mesh.boundary_labels = {0, 0};
  answer_.mesh.vertices.push_back({1, 0, 0.001});
  answer_.mesh.vertices.push_back({0, 1, 0.001});
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("at (0.5, 0.5, 0), where the surface is 0.001 from itself\n"),
            std::string::npos)
      << error_;
}

TEST_F(Told, ImproveSaysWhatThereWasBefore) {
  std::ofstream(path("in.tet")) << "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
  TetMesh given;
  library_.improve_mesh = [&](const TetMesh& mesh, const ImproveOptions&) {
    given = mesh;
    return answer_;
  };
  MeshStatistics &before = answer_.statistics.refined, &after = answer_.statistics.final;
  after.tetrahedra = 1;
  after.min_dihedral = 54.736;
  after.max_dihedral = 90;
  before.tetrahedra = 7;
  before.min_dihedral = 1.5;
  before.max_dihedral = 175;
  before.min_face_angle = 2;
  before.below_5 = 3;
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("a.mesh"), "--stats", path("s.json")}),
            kDone);
  EXPECT_EQ(given.tetrahedra, answer_.mesh.tetrahedra);
  EXPECT_TRUE(error_.starts_with(path("a.mesh") + ": 4 vertices, 1 tetrahedron in ")) << error_;
  EXPECT_TRUE(
      error_.ends_with("; before: 7 tetrahedra, dihedral angles 1.50 to 175.00 degrees, "
                       "smallest face angle 2.00, 3 below 5 degrees\n"))
      << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1);
  std::ifstream stats(path("s.json"));
  const auto json = nlohmann::json::parse(stats);
  EXPECT_EQ(json["parameters"]["job"], "improve");
  EXPECT_EQ(json["parameters"].size(), 8U);
  EXPECT_EQ(json["input"]["tetrahedra"], 1);
  EXPECT_EQ(json["given"]["tetrahedra"], 7);
  EXPECT_EQ(json["final"]["tetrahedra"], 1);
  EXPECT_EQ(json["flat"], 0);
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  answer_.status = {StatusCode::invalid_mesh, "tetrahedron 0 is wrong"};
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("b.mesh")}), kInvalid);
  EXPECT_EQ(error_, "delmesher: " + path("in.tet") + ": tetrahedron 0 is wrong\n");
  EXPECT_FALSE(fs::exists(path("b.mesh")));
  EXPECT_EQ(go({"improve", path("in.off"), "-o", path("b.mesh")}), kUnreadable);
  EXPECT_TRUE(one_error_line()) << error_;
}

TEST_F(Told, StatsHaveExactlyTheDocumentedKeys) {
  answer_.statistics.final.tetrahedra = 42;
  ASSERT_EQ(go({path("in.off"), "-o", path("a.mesh"), "--stats", path("s.json")}), kDone);
  std::ifstream in(path("s.json"));
  const auto json = nlohmann::ordered_json::parse(in);
  EXPECT_EQ(
      keys(json),
      "input parameters status phases_seconds wall_seconds cpu_seconds peak_rss_bytes refined "
      "final planar chosen_size remesh filter prediction chamfer guarantee ladder limits steiner "
      "rounding "
      "predicates ");
  EXPECT_EQ(keys(json["predicates"]), "filter support extended fixed exact symbolic ");
  EXPECT_EQ(keys(json["input"]), "file vertices triangles bbox_diagonal ");
  EXPECT_EQ(keys(json["phases_seconds"]),
            "read check remesh filter chamfer delaunay segments facets refine enrich classify "
            "improve round write ");
  const std::string mesh =
      "vertices tetrahedra interior_tetrahedra min_face_angle max_face_angle min_dihedral "
      "max_dihedral mean_min_face_angle mean_max_face_angle mean_min_dihedral mean_max_dihedral "
      "tetrahedra_below_5_degrees tetrahedra_below_10_degrees dihedral_1_percent min_gamma "
      "mean_gamma gamma_1_percent min_sicn mean_sicn "
      "face_angle_histogram dihedral_histogram ";
  EXPECT_EQ(keys(json["refined"]), mesh);
  EXPECT_EQ(keys(json["final"]), mesh);
  EXPECT_EQ(json["final"]["face_angle_histogram"].size(), 12U);
  EXPECT_EQ(keys(json["planar"]),
            "facets groups given_facets bound lines_lost deviation diagonals diagonals_missing "
            "spared given_up "
            "limit ");
  EXPECT_EQ(keys(json["filter"]), "dropped_triangles rounds ");
  EXPECT_EQ(keys(json["prediction"]), "tetrahedra tau ");
  EXPECT_EQ(keys(json["chamfer"]), "acute_vertices acute_edges ");
  EXPECT_EQ(keys(json["guarantee"]), "acute corner gabriel ");
  EXPECT_EQ(keys(json["ladder"]),
            "larger_tau chamfers_everywhere tetrahedrize_again "
            "other_orders untangle thin_out input_alone keep_surface back_to_given no_planes "
            "default_size fill_budget ");
  EXPECT_EQ(keys(json["limits"]), "refinement_capped cdt_restarts thinned ");
  EXPECT_EQ(keys(json["steiner"]),
            "on_segments on_facets in_volume in_final_mesh left_on_surface ");
  EXPECT_EQ(keys(json["rounding"]),
            "inverted flat repaired inexact signs thinned max_surface_deviation ");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["final"]["tetrahedra"], 42);
  EXPECT_EQ(json["input"]["triangles"], 4);
  EXPECT_GT(json["peak_rss_bytes"], 1000000);
}

TEST_F(Told, StatsOfThePlaneHaveExactlyTheDocumentedKeys) {
  std::ofstream(path("in.txt")) << "0 0\n1 0\n0 1\n0 0\n";
  library_.triangulate_polygon = [](const PlanarGraph&, const PlaneOptions&) {
    PlaneResult result;
    result.mesh.vertices = {{0, 0}, {1, 0}, {0, 1}};
    result.mesh.triangles = {{0, 1, 2}};
    result.mesh.inside = {1};
    result.statistics.final.triangles = 42;
    result.statistics.guaranteed_delta = 20.7;
    return result;
  };
  ASSERT_EQ(go({"plane", path("in.txt"), "-o", path("a.off"), "--stats", path("s.json")}), kDone)
      << error_;
  std::ifstream in(path("s.json"));
  const auto json = nlohmann::ordered_json::parse(in);
  EXPECT_EQ(keys(json),
            "input parameters status phases_seconds wall_seconds cpu_seconds peak_rss_bytes "
            "refined final filter chamfer guarantee steiner rounding ");
  EXPECT_EQ(keys(json["input"]), "file vertices segments bbox_diagonal ");
  EXPECT_EQ(keys(json["parameters"]),
            "job delta tau acute approximate chamfer_radius max_edge region max_vertices "
            "time_limit as_paper ");
  for (const char* mesh : {"refined", "final"}) {
    EXPECT_EQ(keys(json[mesh]),
              "vertices triangles interior_triangles edges min_angle max_angle mean_min_angle "
              "mean_max_angle angle_histogram ");
  }
  EXPECT_EQ(keys(json["rounding"]), "inverted flat repaired max_segment_deviation ");
  EXPECT_EQ(json["final"]["triangles"], 42);
  EXPECT_EQ(json["guarantee"]["delta"], 20.7);
  EXPECT_EQ(json["input"]["segments"], 3);
}

TEST_F(Told, CheckReportsAsTextAndJson) {
  report_.facets = 4;
  EXPECT_EQ(go({"check", path("in.off")}), kDone);
  EXPECT_NE(out_.find("a valid surface"), std::string::npos);
  report_.status = {StatusCode::invalid_surface, "triangles 1 and 2 intersect"};
  report_.defects.push_back(
      {Defect::Kind::self_intersection, {}, {1, 2}, "triangles 1 and 2 intersect"});
  report_.defect_counts[static_cast<std::size_t>(Defect::Kind::self_intersection)] = 3;
  EXPECT_EQ(go({"check", path("in.off")}), kInvalid);
  EXPECT_NE(out_.find("self-intersection: 3\n    triangles 1 and 2 intersect\n    and 2 more"),
            std::string::npos)
      << out_;
  EXPECT_TRUE(one_error_line());
  EXPECT_EQ(go({"check", "--json", path("in.off")}), kInvalid);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["defect_counts"]["self-intersection"], 3);
  EXPECT_EQ(json["defects"][0]["triangles"], nlohmann::json({1, 2}));
}

}  // namespace
}  // namespace delmesher::cli
