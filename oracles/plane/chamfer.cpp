#include "oracles/plane/chamfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tetproof::oracles {
namespace {

using delmesher::PlaneRecord;
using Index = PlaneGraph::Index;
using Piece = PlaneGraph::Piece;
using Point = PlaneGraph::Point;
using Vector = std::array<double, 2>;

// Features closer than this fraction of their coordinates leave no room for points between them, as
// doubles are too coarse. The mesher gives up at 2^-42 between points that it has made, which are
// closer to each other than the features.
constexpr double kNoRoom = 0x1p-34;
constexpr double kNoRoomAtAll = 0x1p-1034;  // among subnormal numbers

struct Stretch {
  Vector a, b;
  double length() const { return std::hypot(b[0] - a[0], b[1] - a[1]); }
  Vector at(double t) const { return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])}; }
  double distance(const Vector& p) const {
    const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    double t = square > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square : 0;
    t = std::clamp(t, 0.0, 1.0);
    const Vector q = at(t);
    return std::hypot(p[0] - q[0], p[1] - q[1]);
  }
};

// The distance of two stretches, and the length of the shorter one that is within four times that.
struct Channel {
  double width = HUGE_VAL, length = 0;
  double squares = 0;  // that fit into it, rounded up
};

Channel channel(Stretch s, Stretch t) {
  if (s.length() > t.length()) std::swap(s, t);
  const auto distance = [&](double x) { return t.distance(s.at(x)); };
  // The distance is convex along s.
  double low = 0, high = 1;
  for (int k = 0; k < 120; ++k) {
    const double third = (high - low) / 3, x = low + third, y = high - third;
    (distance(x) <= distance(y) ? high : low) = distance(x) <= distance(y) ? y : x;
  }
  double best = low;
  for (const double x : {0.0, 1.0, low, high}) {
    if (distance(x) < distance(best)) best = x;
  }
  Channel result;
  result.width = distance(best);
  const auto end = [&](double out) {
    double near = best, away = out;
    if (distance(away) <= 4 * result.width) return away;
    for (int k = 0; k < 60; ++k) {
      const double half = (near + away) / 2;
      (distance(half) <= 4 * result.width ? near : away) = half;
    }
    return away;
  };
  result.length = (end(1) - end(0)) * s.length();
  // In steps in which the width grows by an eighth; from the narrower end of each.
  for (const double out : {0.0, 1.0}) {
    double from = best, width = result.width;
    for (int step = 0; step < 2000 && from != out && width > 0; ++step) {
      double near = from, away = out;
      if (distance(out) <= 1.125 * width) near = out;
      for (int k = 0; k < 60 && near != out; ++k) {
        const double half = (near + away) / 2;
        (distance(half) <= 1.125 * width ? near : away) = half;
      }
      const double to = near == out ? out : away;
      result.squares += std::fabs(to - from) * s.length() / width;
      from = to;
      width = std::max(width, distance(to));
    }
  }
  return result;
}

class ChamferChecker {
 public:
  ChamferChecker(PlaneGraph& graph, const PlaneRecord& record, const std::vector<PieceRest>& rests,
                 const WedgeSide& wedge_side, const Promise& promise)
      : graph_(graph),
        points_(graph.points()),
        record_(record),
        rests_(rests),
        wedge_side_(wedge_side),
        promise_(promise) {}

  void run(VerifyReport& report) {
    check_distances();
    check_need();
    check_cuts();
    check_drops();
    for (OracleReport* r : {&distance_, &need_, &cuts_, &drops_}) {
      report.oracles.push_back(std::move(*r));
    }
  }

 private:
  const std::vector<Piece>& pieces() const { return graph_.pieces(); }
  static std::string corner_name(Index v) { return "corner " + std::to_string(v); }

  void check_distances() {
    constexpr double kSlack = 1e-6;
    const std::size_t vertices = graph_.given().vertices.size();
    distance_.checked += vertices;
    for (const auto& corner : record_.corners) {
      ++distance_.checked;
      const std::string what = corner_name(corner.vertex);
      if (corner.vertex >= vertices) {
        distance_.fail(what + " is not an input vertex");
        continue;
      }
      if (!distance_of_.emplace(corner.vertex, corner.distance).second) {
        distance_.fail(what + " is listed twice");
      }
      if (!(corner.distance > 0) || !std::isfinite(corner.distance)) {
        distance_.fail(what + " is not cut back");
        continue;
      }
      if (promise_.chamfer_radius > 0 && corner.distance > promise_.chamfer_radius * (1 + 1e-9)) {
        distance_.fail(what + " is cut farther out than --chamfer-radius");
      }
      if (3 * corner.distance > feature_size(corner.vertex) * (1 + kSlack)) {
        distance_.fail(what + " is cut beyond a third of its feature size");
      }
    }
  }

  double feature_size(Index v) {
    const auto [at, fresh] = sizes_.emplace(v, 0);
    if (fresh) {
      // Enlarges a guess until the nearest feature has been found.
      double most = 0x1p-10 * graph_.diagonal();
      for (const Index p : graph_.pieces_at()[v]) {
        most = std::min(most, points_.distance(pieces()[p].a, pieces()[p].b));
      }
      double found = graph_.feature_size(v, most);
      while (found > most && most < 2 * graph_.diagonal()) {
        most *= 8;
        found = graph_.feature_size(v, most);
      }
      at->second = found;
    }
    return at->second;
  }

  // ------------------------------------------------------------------------------ acute corners

  Index other_end(Index piece, Index v) const {
    return pieces()[piece].a == v ? pieces()[piece].b : pieces()[piece].a;
  }

  void check_need() {
    // The cosine is rounded. The mesher chamfers only angles that are below the threshold by a
    // billionth, so only these must be chamfered; angles above the threshold may not be.
    const long double cosine = std::cos(promise_.acute * 3.14159265358979323846L / 180);
    const double square = static_cast<double>(cosine * cosine);
    const mpq_class least = square * (1 - 1e-12), certain = square * (1 + 4e-9) + 4e-18;
    for (Index v = 0; v < graph_.given().vertices.size(); ++v) {
      ++need_.checked;
      std::vector<Index> spokes;
      for (const Index p : graph_.pieces_at()[v]) {
        if (rests_[p].kept) spokes.push_back(other_end(p, v));
      }
      std::sort(spokes.begin(), spokes.end(), [&](Index p, Index q) {
        return points_.turns_before(graph_.vertex(v), graph_.vertex(p), graph_.vertex(q));
      });
      bool may = false, must = false;
      for (std::size_t k = 0; spokes.size() > 1 && k < spokes.size(); ++k) {
        const Index u = spokes[k], w = spokes[(k + 1) % spokes.size()];
        const Point &o = graph_.vertex(v), &a = graph_.vertex(u), &b = graph_.vertex(w);
        if (points_.orient(o, a, b) <= 0) continue;
        const mpq_class ux = a.x - o.x, uy = a.y - o.y, wx = b.x - o.x, wy = b.y - o.y,
                        dot = ux * wx + uy * wy;
        if (dot <= 0) continue;
        const mpq_class lengths = (ux * ux + uy * uy) * (wx * wx + wy * wy);
        if (dot * dot < least * lengths) continue;
        if (promise_.region != delmesher::Region::hull && !wedge_side_(v, u, w)) continue;
        may = true;
        must = must || dot * dot > certain * lengths;
      }
      const bool chamfered = distance_of_.contains(v);
      if (chamfered && !may)
        need_.fail("vertex " + std::to_string(v) + " is chamfered without need");
      if (!chamfered && must)
        need_.fail("vertex " + std::to_string(v) + " is acute, not chamfered");
    }
  }

  // --------------------------------------------------------------------------------------- cuts

  void check_cuts() {
    constexpr double kSlack = 1e-5;
    cuts_.checked += pieces().size();
    for (Index p = 0; p < pieces().size(); ++p) {
      if (!rests_[p].kept) continue;
      for (const bool at_a : {true, false}) {
        ++cuts_.checked;
        const Index v = at_a ? pieces()[p].a : pieces()[p].b;
        const double cut = at_a ? rests_[p].cut_a : rests_[p].cut_b;
        const auto corner = distance_of_.find(v);
        const std::string what = "segment " + std::to_string(pieces()[p].segment);
        if (corner == distance_of_.end()) {
          if (cut != 0) {
            cuts_.fail(what + " is cut at vertex " + std::to_string(v) + ", no chamfered corner");
          }
        } else if (!(std::fabs(cut - corner->second) <= kSlack * corner->second)) {
          cuts_.fail(what + " is not cut at the distance of " + corner_name(v));
        }
      }
    }
  }

  // -------------------------------------------------------------------------------------- drops

  void check_drops() {
    const std::size_t segments = graph_.given().segments.size();
    std::set<Index> dropped;
    drops_.checked += segments;
    for (const Index s : record_.dropped) {
      if (s >= segments) {
        drops_.fail("segment " + std::to_string(s) + " is not in the input");
      } else if (!dropped.insert(s).second) {
        drops_.fail("segment " + std::to_string(s) + " is called dropped twice");
      }
    }
    std::vector<Index> gone;
    std::set<Index> missing;  // segments
    for (Index p = 0; p < pieces().size(); ++p) {
      if (rests_[p].kept) continue;
      gone.push_back(p);
      missing.insert(pieces()[p].segment);
      if (!dropped.contains(pieces()[p].segment)) {
        drops_.fail("segment " + std::to_string(pieces()[p].segment) +
                    " is missing, and not called dropped");
      }
    }
    for (const Index s : dropped) {
      if (!missing.contains(s)) {
        drops_.fail("segment " + std::to_string(s) + " is called dropped, but it is there");
      }
    }
    find_reasons(gone);
  }

  void find_reasons(const std::vector<Index>& gone) {
    std::uint64_t narrow = 0, crowded = 0, beside = 0, elsewhere = 0;
    std::vector<Index> unexplained;
    std::set<Index> ends;  // of pieces with a reason of their own
    for (const Index p : gone) {
      ++drops_.checked;
      const Reason reason = reason_of(p);
      if (reason != Reason::none) ++(reason == Reason::narrow ? narrow : crowded);
      if (reason != Reason::none) ends.insert({pieces()[p].a, pieces()[p].b});
      if (reason == Reason::none) unexplained.push_back(p);
    }
    // Where the refinement fails at a vertex, all pieces that end there are left to the last step.
    // Beside channels that are nearly too narrow this may happen far from the features that are too
    // close. Where doubles leave no room, it spreads, in the end over the whole input.
    const bool cramped = !unexplained.empty() && (crowded > 0 || no_room_somewhere());
    for (const Index p : unexplained) {
      if (ends.contains(pieces()[p].a) || ends.contains(pieces()[p].b)) {
        ++beside;
      } else if (cramped) {
        ++elsewhere;
      } else {
        drops_.fail("segment " + std::to_string(pieces()[p].segment) + " is dropped for no reason");
      }
    }
    const auto tell = [&](const char* what, std::uint64_t count) {
      if (count > 0) drops_.figures.emplace_back(what, static_cast<double>(count));
    };
    tell("beside a narrow channel", narrow);
    tell("no room between doubles", crowded);
    tell("meet one of these", beside);
    tell("no room elsewhere", elsewhere);
  }

  enum class Reason { none, narrow, crowded };

  double magnitude(Index v) const {
    return std::max(std::fabs(graph_.vertex(v).dx), std::fabs(graph_.vertex(v).dy));
  }
  static bool no_room(double distance, double size) {
    return distance <= kNoRoom * size || distance <= kNoRoomAtAll;
  }

  bool no_room_somewhere() {
    for (Index v = 0; v < graph_.given().vertices.size(); ++v) {
      if (no_room(feature_size(v), magnitude(v))) return true;
    }
    return false;
  }

  Reason reason_of(Index p) {
    const Piece& piece = pieces()[p];
    for (const Index v : {piece.a, piece.b}) {
      if (no_room(feature_size(v), magnitude(v))) return Reason::crowded;
    }
    const double length = points_.distance(piece.a, piece.b);
    const double size = std::max(magnitude(piece.a), magnitude(piece.b));
    if (no_room(length, size)) return Reason::crowded;
    Reason reason = Reason::none;
    const auto box = plane_box({&graph_.vertex(piece.a), &graph_.vertex(piece.b)},
                               promise_.tau * length + kNoRoom * size);
    graph_.near_vertices(box, [&](Index v) {
      if (v == piece.a || v == piece.b || reason != Reason::none) return;
      if (no_room(points_.distance_to_segment(v, piece.a, piece.b), size)) {
        reason = Reason::crowded;
      }
    });
    // One search at a time: reason_between searches for feature sizes as well.
    std::vector<Index> near;
    graph_.near_segments(box, [&](Index s) {
      for (const Index q : graph_.pieces_of()[s]) near.push_back(q);
    });
    for (const Index q : near) {
      if (q != p && reason == Reason::none) reason = reason_between(p, q);
    }
    return reason;
  }

  // Coordinates relative to the first of these ends, rounded once, in a unit of 2^exponent in which
  // squares of lengths are normal numbers.
  std::array<Vector, 4> relative(const std::array<Index, 4>& ends, int& exponent) const {
    std::array<Vector, 4> at;
    double largest = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Point &p = graph_.vertex(ends[k]), &o = graph_.vertex(ends[0]);
      at[k] = {mpq_class(p.x - o.x).get_d(), mpq_class(p.y - o.y).get_d()};
      for (const double x : at[k]) largest = std::max(largest, std::fabs(x));
    }
    std::frexp(largest, &exponent);
    for (Vector& v : at) {
      for (double& x : v) x = std::ldexp(x, -exponent);
    }
    return at;
  }

  // Is there a channel between the parts that chamfering leaves of two pieces? It is not known
  // which of their ends were chamfered when one was dropped, so all choices are tried; but where
  // the pieces meet they must be cut.
  Reason reason_between(Index p, Index q) {
    const std::array<Index, 4> ends = {pieces()[p].a, pieces()[p].b, pieces()[q].a, pieces()[q].b};
    int exponent = 0;
    const auto [a, b, c, d] = relative(ends, exponent);
    std::array<double, 4> radius;
    for (std::size_t k = 0; k < 4; ++k) {
      radius[k] = feature_size(ends[k]) / 3;
      if (promise_.chamfer_radius > 0) radius[k] = std::min(radius[k], promise_.chamfer_radius);
      radius[k] = std::ldexp(radius[k], -exponent);
    }
    const double size = std::max(magnitude(ends[0]), magnitude(ends[1]));
    for (unsigned cut = 0; cut < 16; ++cut) {
      std::array<double, 4> r{};
      for (std::size_t k = 0; k < 4; ++k) r[k] = (cut >> k & 1U) != 0 ? radius[k] : 0;
      bool meet = false, differ = false;
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 2; j < 4; ++j) {
          if (ends[i] != ends[j]) continue;
          meet = meet || (r[i] == 0 && r[j] == 0);
          differ = differ || r[i] != r[j];
        }
      }
      if (meet || differ) continue;
      const auto rest = [](const Vector& from, const Vector& to, double near, double far) {
        const Stretch whole{from, to};
        const double length = whole.length();
        return Stretch{whole.at(near / length), whole.at(1 - far / length)};
      };
      const Channel between = channel(rest(a, b, r[0], r[1]), rest(c, d, r[2], r[3]));
      if (no_room(std::ldexp(between.width, exponent), size)) return Reason::crowded;
      if (between.length * promise_.tau > between.width * (1 - 1e-6)) return Reason::narrow;
      if (between.squares * promise_.tau > 1) return Reason::narrow;
    }
    return Reason::none;
  }

  PlaneGraph& graph_;
  PlanePoints& points_;
  const PlaneRecord& record_;
  const std::vector<PieceRest>& rests_;
  const WedgeSide& wedge_side_;
  const Promise& promise_;
  std::map<Index, double> distance_of_;
  std::map<Index, double> sizes_;
  OracleReport distance_{"refined-chamfer-distance", "vertices"},
      need_{"refined-chamfer-need", "vertices"}, cuts_{"refined-chamfer-cuts", "ends of pieces"},
      drops_{"refined-drops", "segments"};
};

}  // namespace

void check_plane_chamfers(PlaneGraph& graph, const delmesher::PlaneRecord& record,
                          const std::vector<PieceRest>& rests, const WedgeSide& wedge_side,
                          const Promise& promise, VerifyReport& report) {
  ChamferChecker(graph, record, rests, wedge_side, promise).run(report);
}

}  // namespace tetproof::oracles
