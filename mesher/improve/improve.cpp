#include "mesher/improve/improve.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/base/validating.h"
#include "mesher/improve/collapse.h"
#include "mesher/improve/edge_removal.h"
#include "mesher/improve/face_removal.h"
#include "mesher/improve/filling.h"
#include "mesher/improve/insertion.h"
#include "mesher/improve/relocation.h"
#include "mesher/improve/shortening.h"
#include "mesher/improve/smoothing.h"
#include "mesher/improve/state.h"
#include "mesher/tetmesh/numbering.h"

namespace delmesher::improve {
namespace {

class Improvement {
 public:
  Improvement(State& state, const SurfaceTopology* topology, const ImproveOptions& options,
              Control& control)
      : state_(state),
        topology_(topology),
        options_(options),
        goals_(goals_of(options)),
        control_(control),
        edges_(state),
        faces_(state),
        collapse_(state),
        smoothing_(state),
        insertion_(state),
        relocation_(state),
        vertices_(static_cast<std::int64_t>(state.mesh.vertices())) {}

  // Vertices that are not needed go first; then less is left to repair. Points are put in when
  // everything else has been tried.
  void run() {
    if (options_.keep_surface) {
      clear_surface();
      if (options_.halve_edges) {
        first_half_ = static_cast<VertexId>(state_.mesh.vertices());
        halve();
      }
      coarsen();
      Filling(state_, goals_, control_).run();
    }
    begin(0.1);
    coarsen();
    begin(0.25);
    repair(kNotGood);
    insert_ = true;
    failed_.tetrahedra.clear();
    begin(0.08);
    coarsen();
    begin(0.05);
    repair();
    in_rounds_ = true;
    coarsen_rounder();
    in_rounds_ = false;
    spare();
    begin(0.1);
    polish_vertices();
    begin(0.03);
    repair();
    if (options_.unfinished) return;
    mend();
    if (options_.keep_surface) clear_rest();
    if (options_.keep_surface || options_.halve_edges) shorten();
  }

  std::uint64_t spared() const { return spared_; }
  // Vertices on the surface that are not of the input, and halve no edge.
  std::uint64_t left() const {
    std::uint64_t left = 0;
    for (VertexId v = 0; v < state_.mesh.vertices(); ++v) left += is_to_leave(v) ? 1 : 0;
    return left;
  }

 private:
  // The score below which tetrahedra are tried in one pass: later ones take as long, but bring
  // less, except to bad tetrahedra.
  static constexpr float kNotGood = 0.7F;
  static constexpr int kPassesForBad = 10;

  // Goes on to a step that takes this part of the time, as measured on scans and printed parts.
  void begin(double part) {
    step_begin_ = step_end_;
    step_end_ += part;
  }
  // `done`: of the step, in [0, 1].
  void poll(double done) {
    control_.poll(static_cast<std::uint64_t>(vertices_ + state_.vertices_gained()),
                  step_begin_ + done * (step_end_ - step_begin_));
  }

  template <class Operation>
  void for_each_vertex(Operation&& operation) {
    const auto limit = static_cast<VertexId>(state_.mesh.vertices());
    for (VertexId v = 0; v < limit; ++v) {
      if (state_.mesh.incident(v) == kNone || state_.mobility(v) == Mobility::fixed) continue;
      poll(static_cast<double>(v) / limit);
      operation(v);
    }
  }

  // Takes out vertices that good tetrahedra do not need.
  void coarsen() {
    for_each_vertex([&](VertexId v) { collapse(v); });
    validate();
  }

  // Rounder tetrahedra have room to become worse again, so that more vertices go: in rounds, until
  // one brings little.
  void coarsen_rounder() {
    constexpr int kMostRounds = 8;
    constexpr std::size_t kLeastGain = 16;  // one tetrahedron in so many
    for (int round = 0; round < kMostRounds; ++round) {
      const auto share = [&](double of_first) { return round == 0 ? of_first : 0; };
      const std::size_t before = state_.mesh.tetrahedra();
      begin(share(0.12));
      polish_vertices();
      begin(share(0.1));
      polish_edges();
      begin(share(0.08));
      coarsen();
      begin(share(0.06));
      repair(kNotGood);
      if (state_.mesh.tetrahedra() >= before - before / kLeastGain) break;
    }
  }

  // Takes out points on the edges where they are to be spared, until there are as few tetrahedra as
  // wanted or hardly fewer than before: first those that are missed least, at last those that have
  // to stay in the volume, where other vertices can replace them.
  void spare() {
    constexpr std::size_t kLeastGain = 128;  // one tetrahedron in so many
    if (options_.sparing.edges.empty()) return;
    for (const float score : {0.1F, 0.01F}) spare(score, false);
    for (const bool into_volume : {false, true}) {
      std::size_t before = 0;
      do {
        before = state_.mesh.tetrahedra();
        spare(0, into_volume);
      } while (state_.mesh.tetrahedra() < before - before / kLeastGain);
    }
  }
  // Takes out the points whose removal leaves tetrahedra of this score at least; then other
  // vertices go and tetrahedra are repaired once more, as in run().
  void spare(float score, bool into_volume) {
    if (!is_too_much()) return;
    begin(0);
    for_each_vertex([&](VertexId v) {
      if (!is_too_much() || !is_to_be_spared(v)) return;
      const bool gone =
          collapse_.run(v, state_.to_reach(score)) || (into_volume && relocation_.run(v));
      spared_ += gone ? 1 : 0;
    });
    coarsen();
    repair(kNotGood);
  }
  bool is_too_much() const { return state_.mesh.tetrahedra() > options_.sparing.tetrahedra; }
  bool is_to_be_spared(VertexId v) const {
    if (state_.mobility(v) != Mobility::on_line) return false;
    const PointDefinition d = state_.points().definition(state_.point(v));
    const std::uint32_t edge = edge_between(*topology_, d.corner[0], d.corner[1]);
    return edge != kNone && options_.sparing.edges[edge] != 0;
  }

  // Moves vertices to where tetrahedra are rounder on average.
  void polish_vertices() {
    for_each_vertex([&](VertexId v) {
      unless_tried(v, polish_tried_, [&] { return smoothing_.round_off(v); });
    });
    validate();
  }

  // Removes edges where that makes tetrahedra rounder on average.
  void polish_edges() {
    edges_tried_.resize(state_.mesh.slots(), 0);
    for (TetId t = 0; t < edges_tried_.size(); ++t) {
      if (!state_.mesh.alive(t) || !state_.counts(t) || !changed_since(t, edges_tried_[t]))
        continue;
      poll(static_cast<double>(t) / static_cast<double>(edges_tried_.size()));
      const bool any = std::any_of(std::begin(kEdge), std::end(kEdge), [&](const auto& edge) {
        return edges_.round_off(t, edge[0], edge[1], edges_tried_);
      });
      if (!any) edges_tried_[t] = state_.clock() + 1;
    }
    validate();
  }

  // Tries all operations on the tetrahedra below this score, the worst first, and then on bad ones,
  // pass by pass, until nothing helps or hardly anything is left to gain.
  void repair(float first = State::kBad) {
    std::vector<std::pair<float, TetId>> work;
    double left = 1;  // each pass counts as half of the rest
    const int passes = kPassesForBad + (first > State::kBad ? 1 : 0);
    for (int pass = 0; pass < passes; ++pass) {
      const float limit = pass == 0 ? first : State::kBad;
      failed_.tetrahedra.resize(state_.mesh.slots(), 0);
      failed_.score.resize(state_.mesh.slots(), -1);
      work.clear();
      for (TetId t = 0; t < state_.mesh.slots(); ++t) {
        if (!state_.mesh.alive(t) || !is_to_be_tried(t, limit) ||
            !changed_since(t, failed_.tetrahedra[t]) || is_as_it_failed(t)) {
          continue;
        }
        work.emplace_back(state_.score(t), t);
      }
      std::sort(work.begin(), work.end());
      std::size_t successes = 0, n = 0;
      for (const auto& [score, t] : work) {
        const double done = static_cast<double>(n++) / static_cast<double>(work.size());
        if (!state_.mesh.alive(t) || state_.score(t) != score) continue;
        poll(1 - left + done * left / 2);
        if (attempt(t)) {
          ++successes;
        } else {
          failed_.tetrahedra[t] = state_.clock() + 1;
          failed_.score[t] = score;
        }
      }
      left /= 2;
      validate();
      // Where much is bad and stays bad, the surface leaves no room.
      if (successes == 0 || in_vain(work.size(), successes)) break;
    }
  }

  // The last resort for what is bad by its dihedral angles: they alone count, and points are put in
  // on the surface, too.
  void mend() {
    measure_by(Measure::dihedrals);
    begin(0);
    repair();
  }
  // What failed by one measure may succeed by the other.
  void measure_by(Measure measure) {
    mending_ = measure == Measure::dihedrals;
    state_.measure_by(measure);
    std::swap(failed_, failed_by_other_);
  }

  // Steiner points leave the edges of the surface: along the edge if all tetrahedra stay positive,
  // else into the volume. What went may make room for the next one.
  void clear_surface(bool fine = false) {
    state_.bound_edges(false);
    for (bool any = true; any;) {
      any = false;
      const auto limit = static_cast<VertexId>(state_.mesh.vertices());
      for (VertexId v = 0; v < limit; ++v) {
        poll(0);
        if (!is_to_leave(v)) continue;
        if (leave(v, fine) || (fine && clear_around(v) && leave(v, fine))) any = true;
      }
    }
    state_.bound_edges(true);
    validate();
  }
  bool leave(VertexId v, bool fine) {
    return collapse_.run(v, state_.to_reach(0)) || relocation_.run(v, fine);
  }
  // Takes out neighbours in the volume that leave v no room. Did any go?
  bool clear_around(VertexId v) {
    std::vector<TetId> star;
    state_.mesh.star(v, star);
    std::vector<VertexId> free;
    for (const TetId t : star) {
      std::ranges::copy_if(state_.mesh.tet(t), std::back_inserter(free),
                           [&](VertexId w) { return state_.mobility(w) == Mobility::free; });
    }
    sort_unique(free);
    return std::ranges::count_if(
               free, [&](VertexId w) { return collapse_.run(w, state_.to_reach(0)); }) > 0;
  }
  bool is_to_leave(VertexId v) const {
    return v < first_half_ && state_.mesh.incident(v) != kNone &&
           state_.mobility(v) != Mobility::free && !state_.points().is_corner(state_.point(v));
  }

  // Points on the surface that flat tetrahedra have kept there so far, and what they leave behind.
  void clear_rest() {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds && left() > 0; ++round) {
      measure_by(Measure::shape);
      clear_surface(round > 0);
      repair(kNotGood);
      coarsen();
      mend();
    }
  }

  // Edges that are still too long were there before the filling. What replaces them is repaired.
  void shorten() {
    measure_by(Measure::shape);
    if (halve() == 0) return;
    repair(kNotGood);
    mend();
  }

  std::size_t halve() { return Shortening(state_, options_.halve_edges, control_).run(); }

  bool is_to_be_tried(TetId t, float limit) const {
    return mending_ ? state_.dihedral_score(t) < State::kMended : state_.score(t) < limit;
  }

  // In the rounds most changes are beside tetrahedra that nothing has mended before. They are tried
  // again when the rounds are over.
  bool is_as_it_failed(TetId t) const { return in_rounds_ && failed_.score[t] == state_.score(t); }

  bool in_vain(std::size_t attempts, std::size_t successes) const {
    return attempts > state_.mesh.slots() / 100 && successes < attempts / 6;
  }

  bool changed_since(TetId t, std::uint32_t when) const {
    const Tet& tet = state_.mesh.tet(t);
    return std::any_of(tet.begin(), tet.end(),
                       [&](VertexId v) { return state_.changed_at(v) >= when; });
  }

  bool attempt(TetId t) {
    const Tet tet = state_.mesh.tet(t);
    // The ring of an edge has changed only if there was a change at both of its ends.
    for (const auto& [i, j] : kEdge) {
      if (edges_.run(t, i, j, failed_.tetrahedra)) return true;
    }
    for (int i = 0; i < 4; ++i) {
      if (!face_failed(t, i) && faces_.run(t, i)) return true;
    }
    for (const VertexId v : tet) {
      if (smooth(v)) return true;
    }
    // Later on contractions mend one in a thousand; in the rounds those of the vertices follow.
    for (const VertexId v : tet) {
      if (!in_rounds_ && !mending_ && collapse(v)) return true;
    }
    return (insert_ && !in_rounds_ && insertion_.run(t)) ||
           (mending_ && !options_.keep_surface && insertion_.run_on_surface(t));
  }

  // From the other side, and neither side has changed since.
  bool face_failed(TetId t, int i) const {
    const TetId u = state_.mesh.neighbor(t, i);
    return u != kNone && u < failed_.tetrahedra.size() && !changed_since(u, failed_.tetrahedra[u]);
  }

  bool smooth(VertexId v) {
    return unless_tried(v, failed_.smoothing, [&] { return smoothing_.improve_worst(v); });
  }
  bool collapse(VertexId v) {
    return unless_tried(v, failed_.collapse, [&] { return collapse_.run(v); });
  }

  // Not again where nothing has changed since it failed.
  template <class Operation>
  bool unless_tried(VertexId v, std::vector<std::uint32_t>& tried, Operation&& operation) {
    if (v >= tried.size()) tried.resize(state_.mesh.vertices(), 0);
    if (tried[v] > state_.changed_at(v)) return false;
    if (operation()) return true;
    tried[v] = state_.clock() + 1;
    return false;
  }

  void validate() const {
    if (kValidating) state_.mesh.validate();
  }

  State& state_;
  const SurfaceTopology* topology_;
  const ImproveOptions& options_;
  const Goals goals_;
  Control& control_;
  EdgeRemoval edges_;
  FaceRemoval faces_;
  Collapse collapse_;
  Smoothing smoothing_;
  Insertion insertion_;
  Relocation relocation_;
  bool insert_ = false, in_rounds_ = false, mending_ = false;
  std::uint64_t spared_ = 0;
  VertexId first_half_ = kNone;           // the first of those that halve edges of the surface
  std::int64_t vertices_ = 0;             // at the beginning
  double step_begin_ = 0, step_end_ = 0;  // of the stage, in [0, 1]
  // When tetrahedra and vertices were tried in vain: the clock plus 1; per slot and per vertex.
  struct Failed {
    std::vector<std::uint32_t> tetrahedra, smoothing, collapse;
    std::vector<float> score;  // of the tetrahedron of the slot when it was tried last
  };
  Failed failed_, failed_by_other_;  // by what is measured, and by the other measure
  std::vector<std::uint32_t> edges_tried_, polish_tried_;
};

}  // namespace

ImproveResult improve(ConformingMesh mesh, const SurfaceTopology* topology,
                      std::span<const Vec3> given, const ImproveOptions& options,
                      PointStore& points, Predicates& predicates, Control& control) {
  // A face that is a facet of its own has no other triangulation.
  std::vector<FacetId> facets;
  if (topology == nullptr) {
    for (SurfaceFace& face : mesh.boundary) {
      facets.push_back(face.facet);
      face.facet = static_cast<FacetId>(facets.size() - 1);
    }
  }
  ImproveResult result;
  result.became.assign(points.size(), kNone);
  NumberedMesh start = numbered(std::move(mesh), points);
  const std::vector<VertexId> point = start.point;
  State state(std::move(start), topology, given, points, predicates, goals_of(options));
  Improvement improvement(state, topology, options, control);
  improvement.run();
  result.spared = improvement.spared();
  if (options.keep_surface) result.left = improvement.left();
  for (VertexId v = 0; v < point.size(); ++v) {
    if (state.mesh.incident(v) != kNone) result.became[point[v]] = state.point(v);
  }
  result.changed = state.clock() > 0;
  result.mesh = state.conforming();
  if (topology == nullptr) {
    for (SurfaceFace& face : result.mesh.boundary) face.facet = facets[face.facet];
  }
  return result;
}

}  // namespace delmesher::improve
