#include "oracles/record/refinement.h"

#include "oracles/base/ball_side.h"
#include "oracles/mesh/sample.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

class Encroachment {
 public:
  explicit Encroachment(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        complex_(*mesh.complex),
        edges_(edges_of_chains(record_)),
        faces_(faces_on_facets(record_)) {}

  OracleReport run() {
    report_.checked = edges_.size() + faces_.size();
    check_neighbours();
    check_sample();
    report_.figures.emplace_back("edges", edges_.size());
    report_.figures.emplace_back("faces", faces_.size());
    report_.promised = record_.parameters.gabriel;
    if (!report_.promised) report_.figures.emplace_back("vertices in a ball", found_);
    return std::move(report_);
  }

 private:
  void check_neighbours() {
    for (const Tet& t : complex_.tetrahedra) {
      const unsigned among = edges_.corners_among(t);
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          if ((among >> i & among >> j & 1U) == 0 || !edges_.contains({t[i], t[j]})) continue;
          for (int k = 0; k < 4; ++k) {
            if (k != i && k != j) check_edge(t[i], t[j], t[k]);
          }
        }
      }
    }
    for_each_face_in(faces_, complex_.tetrahedra, [this](std::size_t t, int i, std::size_t face) {
      check_face(faces_[face], complex_.tetrahedra[t][i]);
    });
  }

  void check_sample() {
    const std::vector<Index> vertices = used_vertices(complex_);
    Sample sample(edges_.size() + faces_.size(), vertices.size());
    for (std::size_t i = sample.first(); i < edges_.size() + faces_.size(); i += sample.step()) {
      const bool edge = i < edges_.size();
      const auto [a, b] = edge ? edges_[i] : std::array<Index, 2>{};
      const Face face = edge ? Face{} : faces_[i - edges_.size()];
      const BallSide ball =
          edge ? BallSide::diametral(points_, a, b) : BallSide::diametral(points_, face);
      for (const Index v : vertices) {
        if (ball.side(v) > 0) continue;
        edge ? check_edge(a, b, v) : check_face(face, v);
      }
      ++tried_;
    }
    report_.figures.emplace_back("tried against all vertices", tried_);
  }

  void check_edge(Index a, Index b, Index v) {
    if (v == a || v == b || exact::dot_sign(points_, v, a, b) >= 0) return;
    offend(v, "edge " + complex_.vertex_name(a) + " - " + complex_.vertex_name(b));
  }

  void check_face(const Face& f, Index v) {
    if (v == f[0] || v == f[1] || v == f[2]) return;
    const int side = BallSide::diametral(points_, f).side(v);
    if (side > 0) return;
    if (side == 0 && !exact::in_diametral_ball(points_, f[0], f[1], f[2], v)) return;
    offend(v, complex_.face_name(f));
  }

  void offend(Index v, const std::string& what) {
    ++found_;
    if (record_.parameters.gabriel) report_.fail(complex_.vertex_name(v) + " encroaches " + what);
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const TetComplex& complex_;
  const SimplexSet<2> edges_;
  const SimplexSet<3> faces_;
  std::uint64_t tried_ = 0, found_ = 0;
  OracleReport report_{"encroachment", "edges of segments and faces on facets"};
};

}  // namespace

OracleReport check_encroachment(const RefinedMesh& mesh) {
  return Encroachment(mesh).run();
}

}  // namespace tetproof::oracles
