#include "corpus/union/unite.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "corpus/union/arrangement.h"
#include "corpus/union/flat_sides.h"
#include "corpus/union/joining.h"
#include "corpus/union/separate.h"
#include "corpus/union/union_run.h"
#include "corpus/union/walls.h"
#include "corpus/union/winding.h"
#include "oracles/cgal/surface_opinion.h"

namespace tetproof::unite {
namespace {

using delmesher::Surface;

// Points that triangles were cut at: where sides cross planes beside triangles, there are more.
std::uint64_t new_corners(const Points& points, const std::vector<Piece>& pieces) {
  std::vector<bool> seen(points.size(), false);
  std::uint64_t count = 0;
  for (const Piece& piece : pieces) {
    for (const Index v : piece.corners) {
      count += !seen[v] && !points.is_given(v) ? 1 : 0;
      seen[v] = true;
    }
  }
  return count;
}

class Uniter : UnionRun {
 public:
  explicit Uniter(const UnionOptions& options) : UnionRun(options.go_on), options_(options) {}

  UnionResult run(const Surface& surface);

 private:
  // Rounding may push points through triangles that are closer than that. Each further round moves
  // new points only, and fewer of them. What meets and is near each other becomes one first, within
  // a reach that grows.
  static constexpr int kRounds = 12;

  bool take(const Surface& surface);
  void turn_if_inside_out();
  bool unite_pieces();
  bool cut_and_round(const std::vector<MeetingPair>& pairs);
  bool is_inside(int winding) const {
    return options_.inside == Inside::positive ? winding > 0 : winding != 0;
  }
  std::vector<Piece> kept_pieces(const Arrangement& arrangement);
  double reach(int rounds) const;
  std::vector<Index> new_needles();
  bool remove_new_needles();
  bool move_apart(const std::string& where);
  void judge();
  void ask_others() const;
  void tell_arrangement();
  void tell_result();

  const UnionOptions& options_;
  std::vector<Position> given_;  // vertices, sorted
  bool settled_ = false;         // did the last round only confirm what was there?
  std::size_t fewest_needles_ = std::numeric_limits<std::size_t>::max();
};

bool Uniter::take(const Surface& surface) {
  if (!take_soup(surface)) return false;
  given_ = soup_.vertices;
  std::sort(given_.begin(), given_.end());
  turn_if_inside_out();
  result_.counts.bodies_before = count_bodies(soup_.triangles);
  result_.counts.volume_before = volume(soup_);
  return true;
}

void Uniter::turn_if_inside_out() {
  if (volume(soup_) >= 0) return;
  for (Triangle& t : soup_.triangles) std::swap(t[1], t[2]);
  result_.done.emplace_back("all triangles turned round: the surface was inside out");
}

std::vector<Piece> Uniter::kept_pieces(const Arrangement& arrangement) {
  const std::vector<int> windings = windings_in_front(arrangement, poll_);
  std::vector<Piece> kept;
  for (std::size_t i = 0; i < windings.size(); ++i) {
    Piece piece = arrangement.pieces[i];
    const bool front = is_inside(windings[i]), back = is_inside(windings[i] + piece.times);
    if (std::min(windings[i], windings[i] + piece.times) < 0) ++result_.counts.inside_out;
    settled_ = settled_ && !front && back;
    if (front == back) continue;
    if (front) std::swap(piece.corners[1], piece.corners[2]);
    piece.times = 1;
    kept.push_back(piece);
  }
  return kept;
}

double Uniter::reach(int rounds) const {
  constexpr int kDigits = 48;
  return std::ldexp(1, std::ilogb(largest_coordinate(soup_)) - kDigits + 2 * rounds);
}

// Triangles with a new corner, as thin as what is joined first. Cutting leaves them where surfaces
// cross within roundings of a vertex or an edge.
std::vector<Index> Uniter::new_needles() {
  const double thin = reach(0);
  std::vector<Index> found;
  for (Index t = 0; t < soup_.triangles.size(); ++t) {
    poll_();
    const Triangle& corners = soup_.triangles[t];
    const auto is_given = [&](Index v) {
      return std::binary_search(given_.begin(), given_.end(), soup_.vertices[v]);
    };
    if (is_needle(soup_, corners, thin) && !std::all_of(corners.begin(), corners.end(), is_given)) {
      found.push_back(t);
    }
  }
  return found;
}

// Whether there were any, and fewer than before: what is left of them may be thin, or meet, again.
bool Uniter::remove_new_needles() {
  const std::vector<Index> needles = new_needles();
  if (needles.empty() || needles.size() >= fewest_needles_ || result_.counts.rounds > kRounds / 2) {
    return false;
  }
  fewest_needles_ = needles.size();
  result_.counts.needles += needles.size();
  // Short edges a little longer than the height go as well: halved instead, others become as short.
  result_.counts.largest_move += remove_needles(soup_, needles, 2 * reach(0), poll_);
  return true;
}

bool Uniter::cut_and_round(const std::vector<MeetingPair>& pairs) {
  const Arrangement arrangement = arrange(soup_, pairs, Cancelled::dropped, poll_);
  UnionCounts& counts = result_.counts;
  const bool first = counts.rounds++ == 0;
  if (const OpenEdges open = find_open_edges(arrangement.pieces); open.count > 0) {
    return fail(
        UnionCode::unsound,
        "the surface is open, or triangles disagree about the outside, at " +
            counted(open.count, "edge", "edges") + ", the first at " +
            place(arrangement.points.approximate(open.place)) +
            ": no union; delmesher repair turns triangles round, with --fill it closes holes");
  }
  settled_ = pairs.empty();
  std::vector<Piece> kept = kept_pieces(arrangement);
  if (settled_ && !first) --counts.rounds;
  const std::size_t dropped = arrangement.pieces.size() - kept.size();
  counts.flat_vertices += restore_flat_sides(soup_, arrangement.points, kept, poll_);
  if (find_open_edges(kept).count > 0) throw InternalError("the union is open");
  if (first) {
    counts.pairs = pairs.size();
    counts.coplanar_pairs = static_cast<std::uint64_t>(std::count_if(
        pairs.begin(), pairs.end(), [](const MeetingPair& pair) { return pair.coplanar; }));
    counts.cut = arrangement.cut;
    counts.new_points = new_corners(arrangement.points, arrangement.pieces);
    counts.dropped = dropped;
    tell_arrangement();
  }
  const auto label = [&](const Piece& piece) { return soup_.labels[piece.parent]; };
  soup_ = soup_of(rounded(arrangement.points, kept, label, counts.largest_move, poll_));
  if (soup_.triangles.empty()) return fail(UnionCode::empty, "nothing is inside");
  return true;
}

// Until nothing meets and nothing is dropped or turned round: rounding may do both around an edge
// of several bodies.
bool Uniter::unite_pieces() {
  while (true) {
    std::vector<MeetingPair> pairs = meeting_pairs(soup_, poll_);
    if (pairs.empty() && settled_) {
      if (!remove_new_needles()) return true;
      pairs = meeting_pairs(soup_, poll_);
    }
    if (result_.counts.rounds == kRounds) {
      return fail(UnionCode::imprecise,
                  pairs.empty()
                      ? "the union has parts that are too thin for doubles"
                      : "the union has " + counted(pairs.size(), "pair", "pairs") +
                            " of triangles that are too close for doubles, the first at " +
                            place(soup_.vertices[soup_.triangles[pairs.front().a][0]]));
    }
    if (!pairs.empty()) {
      result_.counts.largest_move += join_near(soup_, pairs, reach(result_.counts.rounds), poll_);
      pairs = meeting_pairs(soup_, poll_);
    }
    if (!cut_and_round(pairs)) return false;
  }
}

void Uniter::tell_arrangement() {
  const UnionCounts& counts = result_.counts;
  if (counts.pairs > 0) {
    result_.done.push_back(
        counted(counts.pairs, "pair of triangles meets", "pairs of triangles meet") + " (" +
        std::to_string(counts.coplanar_pairs) +
        " in one plane): " + counted(counts.cut, "triangle", "triangles") + " cut, " +
        counted(counts.new_points, "new point", "new points"));
  }
  tell(counts.dropped, "piece dropped, which is not between inside and outside",
       "pieces dropped, which are not between inside and outside");
  if (counts.inside_out > 0 && options_.inside == Inside::positive) {
    result_.done.push_back("some parts are inside out (" +
                           counted(counts.inside_out, "piece", "pieces") +
                           "), and taken for hollow; --nonzero takes them for solid");
  }
}

void Uniter::tell_result() {
  const UnionCounts& counts = result_.counts;
  tell(counts.flat_vertices, "vertex within a flat side or a straight edge dropped",
       "vertices within flat sides and straight edges dropped");
  result_.done.push_back(counted(counts.bodies_before, "body", "bodies") + " of volume " +
                         volume_as_given(counts.volume_before) + " became " +
                         std::to_string(counts.bodies_after) + " of " +
                         volume_as_given(counts.volume_after));
  tell(counts.needles, "triangle removed that was as thin as roundings",
       "triangles removed that were as thin as roundings");
  tell(new_needles().size(), "triangle left that is as thin as roundings",
       "triangles left that are as thin as roundings");
  if (counts.new_points == 0 && counts.largest_move == 0) return;
  result_.done.push_back(
      "points moved by at most " + length(counts.largest_move) + " by rounding" +
      (counts.rounds > 1 ? ", in " + std::to_string(counts.rounds) + " rounds" : ""));
}

// Other libraries have the last word.
void Uniter::ask_others() const {
  const oracles::Polyhedron polyhedron = {soup_.vertices, soup_.triangles, soup_.labels, {}};
  for (const oracles::SurfaceOpinion& opinion :
       {oracles::cgal_surface_opinion(polyhedron), oracles::openmesh_surface_opinion(polyhedron)}) {
    if (!opinion.valid()) throw InternalError("the union is not valid: " + opinion.reason);
  }
}

bool Uniter::move_apart(const std::string& where) {
  const double farthest = options_.separate * diagonal(soup_);
  const Separation separation = separate(soup_, farthest, poll_);
  if (!separation.done) {
    return fail(UnionCode::inseparable, where + "; they could not be moved apart by at most " +
                                            length(farthest) + " at " + place(separation.place));
  }
  UnionCounts& counts = result_.counts;
  counts.halved_edges = separation.halved;
  counts.copies = separation.copies;
  counts.largest_separation = separation.largest_move;
  result_.done.push_back(where);
  tell(separation.halved, "edge halved for that", "edges halved for that");
  result_.done.push_back(
      "moved apart there: " + counted(separation.copies, "copy of a vertex", "copies of vertices") +
      ", each by at most " + length(separation.largest_move) + " (allowed: " + length(farthest) +
      ")");
  return true;
}

void Uniter::judge() {
  UnionCounts& counts = result_.counts;
  const Touching touching = find_touching(soup_.triangles);
  counts.touching_edges = touching.edges;
  counts.touching_vertices = touching.vertices;
  const bool touches = touching.place != kNone;
  const std::string where =
      !touches ? ""
               : "parts of the union touch at " + counted(touching.edges, "edge", "edges") +
                     " and " + counted(touching.vertices, "more vertex", "more vertices") +
                     ", the first at " + place(soup_.vertices[touching.place]);
  if (touches && options_.separate > 0 && !move_apart(where)) return;
  counts.bodies_after = count_bodies(soup_.triangles);
  counts.volume_after = volume(soup_);
  tell_result();
  result_.surface = surface_of(soup_);
  if (!touches || options_.separate > 0) {
    ask_others();
    return;
  }
  fail(UnionCode::touching,
       where + ": no solid can be meshed like that; --separate 1e-4 moves them apart");
}

UnionResult Uniter::run(const Surface& surface) {
  return result_of([&] {
    if (take(surface) && unite_pieces()) judge();
  });
}

}  // namespace

UnionResult unite(const Surface& surface, const UnionOptions& options) {
  return options.walls ? cut_into_walls(surface, options.snap, options.go_on)
                       : Uniter(options).run(surface);
}

}  // namespace tetproof::unite
