// The format is described in mesher/io/exact_format.md.
#include "oracles/files/sidecar.h"

#include <algorithm>
#include <string>

#include "oracles/base/exact_points.h"
#include "oracles/base/text_reader.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

class SidecarReader {
 public:
  explicit SidecarReader(const std::string& path) : reader_(TextReader::of_file(path)) {}

  ExactRecord read() {
    reader_.expect("delmesher-exact");
    version_ = reader_.index(0, 8);
    if (version_ == 0) reader_.fail("unknown version 0");
    if (version_ >= 2) read_parameters();
    if (version_ >= 6) read_origin();
    if (version_ >= 4) read_surface();
    read_points();
    reader_.list("facets", record_.facets, [&](auto& facet) {
      facet.id = number();
      facet.label = reader_.integer32();
      facet.filtered = static_cast<std::uint8_t>(reader_.index(0, 3));
      numbers(facet.triangles);
    });
    reader_.list("segments", record_.segments, [&](auto& chain) {
      const std::string kind(reader_.required_word("I or A"));
      if (kind != "I" && kind != "A") reader_.fail("unknown kind of segment");
      chain.artificial = kind == "A";
      chain.facet = chain.artificial ? number() : kNone;
      if (!chain.artificial) reader_.expect("-");
      reader_.read_items(chain.vertices, [&](Index& v) { v = point(); });
    });
    reader_.list("corners", record_.corners, [&](auto& corner) {
      corner.vertex = point();
      if (version_ < 7) reader_.exact_number();  // a threshold
      corner.distance = reader_.exact_number();
    });
    read_tets("refined", record_.refined);
    read_faces("refined_facets", record_.refined_facets);
    read_tets("final", record_.final);
    read_faces("final_facets", record_.final_facets);
    reader_.list("mesh_vertices", record_.mesh_vertices, [&](auto& vertex) { vertex = point(); });
    if (version_ >= 2) read_additions();
    reader_.expect_end("end");
    return std::move(record_);
  }
  unsigned version() const { return version_; }

 private:
  void read_parameters() {
    reader_.expect("parameters");
    reader_.expect("1");
    auto& p = record_.parameters;
    p.delta = reader_.exact_number();
    p.acute = reader_.exact_number();
    p.corner = reader_.exact_number();
    p.tolerance = reader_.exact_number();
    p.region = flag() ? delmesher::Region::hull : delmesher::Region::interior;
    p.gabriel = flag();
    if (version_ >= 4) p.planar = reader_.exact_number();
  }

  void read_origin() {
    reader_.expect("origin");
    reader_.expect("1");
    coordinates(record_.origin);
  }

  void read_surface() {
    reader_.list("planes", record_.planes, [&](ExactRecord::Plane& plane) {
      const std::string kind(reader_.required_word("N or T"));
      if (kind != "N" && kind != "T") reader_.fail("unknown kind of plane");
      plane.spanned = kind == "T";
      if (!plane.spanned) coordinates(plane.normal);
      coordinates(plane.through[0]);
      if (!plane.spanned) return;
      coordinates(plane.through[1]);
      coordinates(plane.through[2]);
    });
    reader_.list("triangles", record_.triangles, [&](std::array<Index, 3>& corners) {
      for (Index& v : corners) v = number();
    });
  }
  void coordinates(std::array<double, 3>& x) {
    for (double& value : x) value = reader_.exact_number();
  }

  void read_additions() {
    reader_.list("chamfer_points", record_.chamfer_points, [&](auto& made) {
      for (Index& v : made) v = point();
    });
    reader_.list("balls", record_.balls, [&](auto& ball) {
      ball.vertex = point();
      for (Index& v : ball.tetrahedron) v = point();
    });
    read_tets("unrepaired", record_.unrepaired);
    if (version_ >= 3) read_faces("unrepaired_facets", record_.unrepaired_facets);
  }

  void read_points() {
    reader_.list("points", record_.points, [&](ExactPoint& p) {
      const std::string kind(reader_.required_word("E, S, T or P"));
      if (kind != "E" && kind != "S" && kind != "T" && kind != "P")
        reader_.fail("unknown kind of point");
      p.kind = kind == "E"   ? ExactPoint::Kind::explicit_point
               : kind == "S" ? ExactPoint::Kind::on_segment
               : kind == "T" ? ExactPoint::Kind::on_triangle
                             : ExactPoint::Kind::on_planes;
      if (kind == "P") {
        for (Index* plane : {&p.i, &p.j, &p.k}) *plane = number();
        return;
      }
      if (kind != "E") {
        p.i = number();
        p.j = number();
      }
      if (kind == "T") p.k = number();
      p.x = reader_.exact_number();
      if (kind != "S") p.y = reader_.exact_number();
      if (kind == "E") p.z = reader_.exact_number();
    });
    // A point may be given by points that come later.
    for (const ExactPoint& p : record_.points) {
      if (p.kind == ExactPoint::Kind::on_planes) continue;  // numbers of planes
      const Index last = std::max({p.i, p.j, p.k});
      if (last < record_.points.size()) continue;
      reader_.fail("a point is given by point " + std::to_string(last) + ", which does not exist");
    }
  }

  void read_tets(const std::string& name, std::vector<ExactRecord::Tet>& tets) {
    reader_.list(name, tets, [&](ExactRecord::Tet& tet) {
      for (Index& v : tet.vertices) v = point();
      tet.inside = flag();
    });
  }

  void read_faces(const std::string& name, std::vector<std::array<Index, 4>>& faces) {
    reader_.list(name, faces, [&](std::array<Index, 4>& face) {
      for (int i = 0; i < 3; ++i) face[i] = point();
      face[3] = number();
    });
  }

  Index number() { return reader_.index(0, 0x100000000U); }
  bool flag() { return reader_.index(0, 2) != 0; }
  Index point() { return reader_.index(0, record_.points.size()); }
  void numbers(std::vector<Index>& list) {
    reader_.read_items(list, [&](Index& value) { value = number(); });
  }

  TextReader reader_;
  Index version_ = 0;
  ExactRecord record_;
};

}  // namespace

ExactRecord read_sidecar(const std::string& path, unsigned* version) {
  SidecarReader reader(path);
  ExactRecord record = reader.read();
  if (version != nullptr) *version = reader.version();
  return record;
}

}  // namespace tetproof::oracles
