#include "oracles/plane/conformity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "oracles/base/union_find.h"
#include "oracles/plane/faces.h"
#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

using Index = PlaneGraph::Index;
using Point = PlaneGraph::Point;
using Edge = std::pair<Index, Index>;

Edge undirected(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

// The edges at a vertex, of which a hub has many, by their directions.
class Spokes {
 public:
  static constexpr double kWindow = 0x1p-24;  // radians

  // Near ones may have any direction.
  void add(Index to, double direction, bool far) {
    if (far) {
      far_.emplace_back(direction, to);
    } else {
      near_.push_back(to);
    }
  }
  void sort() { std::sort(far_.begin(), far_.end()); }

  // Calls meet(end) for those in this direction, and some others.
  template <class Meet>
  void visit(double direction, Meet&& meet) const {
    constexpr double kTurn = 6.283185307179586;
    for (const Index to : near_) meet(to);
    for (const double turns : {-kTurn, 0.0, kTurn}) {
      const double from = direction + turns - 2 * kWindow, end = direction + turns + 2 * kWindow;
      for (auto spoke = std::lower_bound(far_.begin(), far_.end(), std::pair(from, Index{0}));
           spoke != far_.end() && spoke->first <= end; ++spoke) {
        meet(spoke->second);
      }
    }
  }

 private:
  std::vector<std::pair<double, Index>> far_;
  std::vector<Index> near_;
};

class FileChecker {
 public:
  FileChecker(PlaneGraph& graph, const PlaneFile& file, const Promise& promise, double tolerance,
              double declared, bool recorded)
      : graph_(graph),
        inside_(graph),
        file_(file),
        promise_(promise),
        tolerance_(tolerance),
        declared_(declared),
        recorded_(recorded) {}

  void run(VerifyReport& report) {
    check_complex();
    const bool hopeless = is_hopeless(complex_);
    report.oracles.push_back(complex_);
    if (indices_right_ && !hopeless) {
      for (const auto& p : file_.vertices) points_.add({p[0], p[1], p[0], p[1]});
      check_orientation(report);
      measure_angles();
      if (promise_.approximate) {  // nothing is tiled where corners were not restored
        for (OracleReport* r : {&orientation_, &angles_}) report.oracles.push_back(std::move(*r));
        if (!recorded_) report.oracles.push_back(surface_not_decided("conformity"));
        return;
      }
      check_conformity();
      check_sides();
      check_attributes();
      check_list();
      check_lengths(report);
      tell_losses(report);
      for (OracleReport* r : {&orientation_, &conformity_, &sides_, &list_, &angles_}) {
        if (r != &list_ || file_.lists_edges) report.oracles.push_back(std::move(*r));
      }
    }
  }
  double deviation() const { return deviation_; }

 private:
  static std::string name(std::size_t t) { return "triangle " + std::to_string(t); }

  void check_complex() {
    std::vector<std::uint8_t> used(file_.vertices.size(), 0);
    indices_right_ = file_.inside.empty() || file_.inside.size() == file_.triangles.size();
    if (!indices_right_) complex_.fail("sides are not one for each triangle");
    for (std::size_t t = 0; t < file_.triangles.size(); ++t) {
      ++complex_.checked;
      const auto& v = file_.triangles[t];
      if (std::max({v[0], v[1], v[2]}) >= used.size()) {
        complex_.fail(name(t) + " refers to no vertex");
        indices_right_ = false;
        continue;
      }
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
        complex_.fail(name(t) + " has a corner twice");
      for (std::size_t i = 0; i < 3; ++i) {
        used[v[i]] = 1;
        if (!left_of_.emplace(Edge(v[i], v[(i + 1) % 3]), static_cast<Index>(t)).second) {
          complex_.fail(name(t) + " shares a directed edge with another");
        }
      }
    }
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) complex_.fail("vertex " + std::to_string(v) + " is not used");
      if (!std::isfinite(file_.vertices[v][0]) || !std::isfinite(file_.vertices[v][1])) {
        complex_.fail("vertex " + std::to_string(v) + " is not finite");
        indices_right_ = false;
      }
    }
    for (const auto& edge : file_.edges) {
      if (std::max(edge[0], edge[1]) < used.size()) continue;
      complex_.fail("a listed edge refers to no vertex");
      indices_right_ = false;
    }
  }

  void check_orientation(VerifyReport& report) {
    for (std::size_t t = 0; t < file_.triangles.size(); ++t) {
      ++orientation_.checked;
      const auto& [a, b, c] = file_.triangles[t];
      const int sign = points_.orient(a, b, c);
      if (sign > 0) continue;
      orientation_.fail(name(t) + (sign == 0 ? " is flat" : " is inverted"));
      ++(sign == 0 ? report.flat : report.inverted);
    }
  }

  bool inside(Index t) const { return file_.inside.empty() || file_.inside[t] != 0; }
  Index segment_of(Index piece) const { return graph_.pieces()[piece].segment; }
  bool hull() const { return promise_.region == delmesher::Region::hull; }

  double off(Index v, const PlaneGraph::Piece& piece) {
    return distance(points_.all()[v], graph_.vertex(piece.a), graph_.vertex(piece.b));
  }
  // The distance of a point from a segment, right even where both are far from the origin.
  static double distance(const Point& p, const Point& q, const Point& r) {
    PlanePoints three;
    for (const Point* x : {&p, &q, &r}) three.add(*x);
    return three.distance_to_segment(0, 1, 2);
  }

  // The vertices of a chain of edges along a piece, in order; empty if there is none.
  std::vector<Index> chain(const PlaneGraph::Piece& piece) {
    const auto a = at_.find(place(piece.a)), b = at_.find(place(piece.b));
    if (a == at_.end() || b == at_.end()) return {};
    const Point &p = graph_.vertex(piece.a), &q = graph_.vertex(piece.b);
    // The direction is scaled to about unit length, since products of tiny numbers vanish.
    scale_ = -std::max(exponent(p.dx, q.dx), exponent(p.dy, q.dy));
    const double dx = scaled(p.dx, q.dx), dy = scaled(p.dy, q.dy);
    // Depth first and straight on: the next vertex is beyond this one, and near the piece. Few
    // vertices have more than one such neighbour.
    std::vector<Index> path = {a->second};
    std::vector<std::vector<Index>> open = {next_of(a->second, piece, dx, dy)};
    for (std::size_t steps = 0; !path.empty() && steps < 4 * points_.all().size() + 16; ++steps) {
      if (path.back() == b->second) return path;
      if (open.back().empty()) {
        path.pop_back();
        open.pop_back();
        continue;
      }
      const Index v = open.back().back();
      open.back().pop_back();
      path.push_back(v);
      open.push_back(next_of(v, piece, dx, dy));
    }
    return {};
  }

  // Differences are halved only where they would overflow, since subnormal numbers have no halves.
  static int exponent(double from, double to) {
    constexpr int kNothing = -2000;  // below that of any double
    const double d = to - from;
    if (!std::isfinite(d)) return std::ilogb(to / 2 - from / 2) + 1;
    return d == 0 ? kNothing : std::ilogb(d);
  }
  double scaled(double from, double to) const {
    const double d = to - from;
    return std::isfinite(d) ? std::ldexp(d, scale_) : std::ldexp(to / 2 - from / 2, scale_ + 1);
  }

  std::vector<Index> next_of(Index v, const PlaneGraph::Piece& piece, double dx, double dy) {
    std::vector<std::pair<double, Index>> found;
    const Point& p = points_.all()[v];
    spokes_[v].visit(std::atan2(dy, dx), [&](Index w) {
      const Point& q = points_.all()[w];
      const double on = scaled(p.dx, q.dx) * dx + scaled(p.dy, q.dy) * dy;
      if (!(on > 0)) return;
      // A piece has no input vertices but its ends.
      const bool end = place_of(w) == place(piece.b);
      if (!end && input_places_.contains(place_of(w))) return;
      if (end || off(w, piece) <= allowed(q)) found.emplace_back(-on, w);
    });
    std::sort(found.begin(), found.end());  // the nearest is tried first
    std::vector<Index> result;
    for (const auto& [on, w] : found) result.push_back(w);
    return result;
  }

  // How far rounding, and the repair of triangles that it has turned, may move a point: some units
  // in the last place of its own coordinates. A declared deviation is taken at its word.
  double allowed(const Point& p) const {
    constexpr double kSteps = 9;
    if (declared_ > 0) return tolerance_;
    const auto ulp = [](double x) { return std::nextafter(std::fabs(x), HUGE_VAL) - std::fabs(x); };
    return std::min(tolerance_, kSteps * std::hypot(ulp(p.dx), ulp(p.dy)));
  }
  std::array<double, 2> place_of(Index v) const {
    return {file_.vertices[v][0] + 0.0, file_.vertices[v][1] + 0.0};
  }
  std::array<double, 2> place(Index v) const {
    return {graph_.vertex(v).dx + 0.0, graph_.vertex(v).dy + 0.0};
  }

  // Might the point be within the tolerance of the line? In doubles, for what is certainly not.
  bool near_line(const Point& p, const Point& q, const Point& r) const {
    const double x = r.dx - q.dx, y = r.dy - q.dy, u = p.dx - q.dx, v = p.dy - q.dy;
    const double across = std::fabs(x * v - y * u), size = std::fabs(x) + std::fabs(y);
    return !(across > 2 * (tolerance_ + 1e-12 * (size + std::fabs(u) + std::fabs(v))) * size);
  }

  // Is the middle of a piece well within the triangles?
  bool covered(const PlaneGraph::Piece& piece) {
    const Point &p = graph_.vertex(piece.a), &q = graph_.vertex(piece.b);
    Point m;
    m.x = (p.x + q.x) / 2;
    m.y = (p.y + q.y) / 2;
    m.dx = m.x.get_d();
    m.dy = m.y.get_d();
    bool in_one = false, at_border = false;  // of any triangle: m may be one of its vertices
    boxes_.visit(plane_box({&m}, tolerance_), [&](Index t) {
      const auto& v = file_.triangles[t];
      const auto& all = points_.all();
      bool in_this = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = v[i], b = v[(i + 1) % 3];
        in_this = in_this && points_.orient(all[a], all[b], m) >= 0;
        at_border = at_border || (near_line(m, all[a], all[b]) && !left_of_.contains({b, a}) &&
                                  distance(m, all[a], all[b]) <= tolerance_);
      }
      in_one = in_one || in_this;
    });
    return in_one && !at_border;
  }

  void check_conformity() {
    const auto& all = points_.all();
    std::vector<PlaneBoxes::Box> boxes;
    for (const auto& v : file_.triangles) {
      boxes.push_back(plane_box({&all[v[0]], &all[v[1]], &all[v[2]]}, 0));
    }
    boxes_ = PlaneBoxes(boxes);
    for (Index v = 0; v < file_.vertices.size(); ++v) {
      const auto& p = file_.vertices[v];
      if (!at_.emplace(std::array{p[0] + 0.0, p[1] + 0.0}, v).second) {
        conformity_.fail("vertex " + std::to_string(v) + " is where another is");
      }
    }
    for (Index v = 0; v < graph_.given().vertices.size(); ++v) input_places_.insert(place(v));
    // If a file lists the edges on segments, no others count.
    std::set<Edge> listed;
    for (const auto& [a, b] : file_.edges) listed.insert(undirected(a, b));
    std::set<Edge> edges;
    for (const auto& [edge, t] : left_of_) {
      if (file_.lists_edges && !listed.contains(undirected(edge.first, edge.second))) continue;
      edges.insert(edge);
      edges.insert({edge.second, edge.first});
    }
    spokes_.resize(all.size());
    for (const auto& [v, w] : edges) {
      const double x = all[w].dx - all[v].dx, y = all[w].dy - all[v].dy;
      spokes_[v].add(w, std::atan2(y, x), std::hypot(x, y) > tolerance_ / Spokes::kWindow);
    }
    for (Spokes& spokes : spokes_) spokes.sort();
    for (Index p = 0; p < graph_.pieces().size(); ++p) check_piece(p);
    check_vertices();
    check_borders();
    conformity_.figures.emplace_back("deviation", deviation_);
  }

  void check_piece(Index number) {
    ++conformity_.checked;
    const PlaneGraph::Piece& piece = graph_.pieces()[number];
    const std::vector<Index> path = chain(piece);
    const std::string what = "segment " + std::to_string(piece.segment);
    if (path.empty()) {
      // A border between two outside faces is in no file of the interior.
      const bool needed = hull() || inside_.ends_at(number);
      if (needed) return conformity_.fail(what + " is not tiled by edges");
      if (covered(piece)) conformity_.fail(what + " is covered, but not tiled by edges");
      return;
    }
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      chains_.emplace(undirected(path[i], path[i + 1]), number);
      deviation_ = std::max(deviation_, off(path[i], piece));
    }
  }

  // An input vertex strictly inside a triangle, as one on no segment may be, is missing from the
  // file. If the hull was promised none may be missing.
  void check_vertices() {
    for (Index v = 0; v < graph_.given().vertices.size(); ++v) {
      ++conformity_.checked;
      if (at_.contains(place(v))) continue;
      const Point& p = graph_.vertex(v);
      bool within = false;
      boxes_.visit(plane_box({&p}, 0), [&](Index t) {
        const auto& c = file_.triangles[t];
        const auto& all = points_.all();
        within = within || (points_.orient(all[c[0]], all[c[1]], p) > 0 &&
                            points_.orient(all[c[1]], all[c[2]], p) > 0 &&
                            points_.orient(all[c[2]], all[c[0]], p) > 0);
      });
      if (within || hull()) {
        conformity_.fail("input vertex " + std::to_string(v) + " is not a vertex of the mesh");
      }
    }
  }

  void check_borders() {
    std::array<double, 2> low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
    for (const auto& p : file_.vertices) {
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    mpq_class area = 0;
    for (const auto& [edge, t] : left_of_) {
      const Point &p = points_.all()[edge.first], &q = points_.all()[edge.second];
      if (hull()) area += p.x * q.y - p.y * q.x;
      const auto other = left_of_.find({edge.second, edge.first});
      if (other != left_of_.end()) {
        ++conformity_.checked;
        if (inside(t) != inside(other->second) &&
            !chains_.contains(undirected(edge.first, edge.second))) {
          conformity_.fail(name(t) + " and " + name(other->second) +
                           " are on different sides, with no segment between");
        }
        continue;
      }
      ++conformity_.checked;
      const bool on_side = (p.x == q.x && (p.dx == low[0] || p.dx == high[0])) ||
                           (p.y == q.y && (p.dy == low[1] || p.dy == high[1]));
      if (hull() ? !on_side : !chains_.contains(undirected(edge.first, edge.second))) {
        conformity_.fail(name(t) + " has an edge on the border that is on no segment");
      }
    }
    if (!hull()) return;
    ++conformity_.checked;
    const mpq_class x0 = low[0], x1 = high[0], y0 = low[1], y1 = high[1];
    if (area != 2 * (x1 - x0) * (y1 - y0)) {
      conformity_.fail("the triangles do not have the area of their rectangle");
    }
  }

  void check_sides() {
    for (Index t = 0; t < file_.triangles.size(); ++t) {
      ++sides_.checked;
      const auto& [a, b, c] = file_.triangles[t];
      Point m;
      m.x = (points_.all()[a].x + points_.all()[b].x + points_.all()[c].x) / 3;
      m.y = (points_.all()[a].y + points_.all()[b].y + points_.all()[c].y) / 3;
      m.dx = m.x.get_d();
      m.dy = m.y.get_d();
      const bool truth = inside_.contains(m);
      if (truth != (inside(t) && (!hull() || !file_.inside.empty()))) {
        if (hull() && file_.inside.empty()) continue;  // nothing is claimed
        if (near_a_segment(m)) continue;               // thinner than what rounding moves
        sides_.fail(name(t) + (truth ? " is inside" : " is outside"));
      }
    }
    // Exactly one of the two triangles beside an edge where the inside ends is inside. Beside any
    // other one both are there, or none.
    for (const auto& [edge, piece] : chains_) {
      ++sides_.checked;
      int count = 0, there = 0;
      for (const Edge& side : {edge, Edge(edge.second, edge.first)}) {
        const auto found = left_of_.find(side);
        there += found != left_of_.end();
        count += found != left_of_.end() && inside(found->second);
      }
      if (!inside_.ends_at(piece)) {
        if (hull() || there != 1) continue;
        sides_.fail("an edge on segment " + std::to_string(segment_of(piece)) +
                    " has a triangle on one side alone");
        continue;
      }
      if (hull() ? there != 2 || (!file_.inside.empty() && count != 1) : count != 1) {
        sides_.fail("an edge on segment " + std::to_string(segment_of(piece)) +
                    " is not between an inside and an outside");
      }
    }
    if (graph_.given().insideness != delmesher::Insideness::enclosed) return;
    for (const auto& hole : graph_.given().holes) {
      ++sides_.checked;
      if (graph_.on_segment(hole)) continue;
      const Point p{hole[0], hole[1], hole[0], hole[1]};
      boxes_.visit({hole, hole}, [&](Index t) {
        const auto& c = file_.triangles[t];
        const auto& all = points_.all();
        if (inside(t) && (!hull() || !file_.inside.empty()) &&
            points_.orient(all[c[0]], all[c[1]], p) > 0 &&
            points_.orient(all[c[1]], all[c[2]], p) > 0 &&
            points_.orient(all[c[2]], all[c[0]], p) > 0) {
          sides_.fail(name(t) + " covers the point of a hole");
        }
      });
    }
  }

  // Triangles that no segment parts have the attribute of the last region whose point is in one of
  // them, or 0. A point on a segment, or outside, means no region.
  void check_attributes() {
    const auto& regions = graph_.given().regions;
    if (regions.empty() || (file_.attributes.empty() && !file_.has_attributes)) return;
    if (file_.attributes.size() != file_.triangles.size()) {
      const std::string why = "the file does not have the attributes of the regions";
      return recorded_ ? sides_.fail(why) : sides_.notes.push_back(why);
    }
    UnionFind parts(file_.triangles.size());
    for (const auto& [edge, t] : left_of_) {
      const auto other = left_of_.find({edge.second, edge.first});
      if (other == left_of_.end() || chains_.contains(undirected(edge.first, edge.second)))
        continue;
      parts.unite(t, other->second);
    }
    std::map<Index, double> attribute;  // of a part
    std::set<Index> unknown;            // parts that a point may be in
    for (const auto& region : regions) {
      const Point p{region.point[0], region.point[1], region.point[0], region.point[1]};
      if (graph_.on_segment(region.point) || !inside_.contains(p)) continue;
      if (near_a_segment(p)) {
        boxes_.visit(plane_box({&p}, tolerance_), [&](Index t) { unknown.insert(parts.find(t)); });
        continue;
      }
      const auto& all = points_.all();
      boxes_.visit({region.point, region.point}, [&](Index t) {
        const auto& c = file_.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
          if (points_.orient(all[c[i]], all[c[(i + 1) % 3]], p) < 0) return;
        }
        attribute[parts.find(t)] = region.attribute;
      });
    }
    if (!unknown.empty()) {
      sides_.notes.push_back("attributes of " + std::to_string(unknown.size()) +
                             " parts were not compared: a region's point is as close to a segment "
                             "as what rounding moves");
    }
    for (Index t = 0; t < file_.triangles.size(); ++t) {
      if (unknown.contains(parts.find(t))) continue;
      ++sides_.checked;
      const auto found = attribute.find(parts.find(t));
      const double wanted = found == attribute.end() ? 0 : found->second;
      if (file_.attributes[t] != wanted) {
        sides_.fail(name(t) + " does not have the attribute of its region");
      }
    }
  }

  // Is a point so close to a segment that rounding may have moved it across?
  bool near_a_segment(const Point& m) {
    bool near = false;
    graph_.near_segments(plane_box({&m}, tolerance_), [&](Index s) {
      const auto& [a, b] = graph_.given().segments[s];
      near = near || distance(m, graph_.vertex(a), graph_.vertex(b)) <= tolerance_;
    });
    return near;
  }

  void check_list() {
    std::map<Edge, Index> listed;
    const auto& markers = graph_.given().markers;
    for (std::size_t i = 0; i < file_.edges.size(); ++i) {
      ++list_.checked;
      const Edge edge = undirected(file_.edges[i][0], file_.edges[i][1]);
      const std::string what = "listed edge " + std::to_string(i);
      if (!listed.emplace(edge, static_cast<Index>(i)).second) list_.fail(what + " is there twice");
      const auto found = chains_.find(edge);
      if (found == chains_.end()) {
        list_.fail(what + " is on no segment");
        continue;
      }
      const Index segment = segment_of(found->second);
      if (i < file_.segments.size() && file_.segments[i] != segment) {
        list_.fail(what + " is listed on another segment");
      }
      const std::int32_t marker = markers.empty() ? 0 : markers[segment];
      if (i < file_.markers.size() && file_.markers[i] != marker) {
        list_.fail(what + " does not have the marker of its segment");
      }
    }
    for (const auto& [edge, piece] : chains_) {
      ++list_.checked;
      if (!listed.contains(edge)) {
        list_.fail("an edge on segment " + std::to_string(segment_of(piece)) + " is not listed");
      }
    }
    if (file_.lists_holes) check_holes();
  }

  // Chamfered corners that came back are not refined.
  void check_lengths(VerifyReport& report) {
    if (promise_.max_edge == 0) return;
    OracleReport lengths("edges", "triangles");
    double largest = 0;
    std::set<Edge> too_long;
    for (Index t = 0; t < file_.triangles.size(); ++t) {
      ++lengths.checked;
      if (!hull() && !inside(t)) continue;
      const auto& v = file_.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = undirected(v[i], v[(i + 1) % 3]);
        const double over = points_.distance(edge.first, edge.second) / promise_.max_edge;
        largest = std::max(largest, over);
        if (over > EdgeSizes::kMost && too_long.insert(edge).second) {
          lengths.fail(name(t) + " has an edge above --max-edge");
        }
      }
    }
    lengths.figures = {{kTooLong, static_cast<double>(too_long.size())}, {kLargestEdge, largest}};
    excuse_long_edges("--max-edge", recorded_, lengths, report.unproven);
    report.oracles.push_back(std::move(lengths));
  }

  // Not every format has all that the input says.
  void tell_losses(VerifyReport& report) const {
    const auto differ = [](const auto& list, auto member) {
      return std::ranges::adjacent_find(list, std::ranges::not_equal_to(), member) != list.end();
    };
    if (differ(graph_.given().markers, std::identity()) && file_.markers.empty()) {
      report.unproven.emplace_back("markers of the input (the file has none)");
    }
    if (!graph_.given().regions.empty() && file_.attributes.empty()) {
      report.unproven.emplace_back("attributes of regions (the file has none)");
    }
  }

  void check_holes() {
    const auto same = [](const auto& a, const auto& b) {
      return a.point == b.point && a.attribute == b.attribute;
    };
    ++list_.checked;
    if (file_.holes != graph_.given().holes) list_.fail("the holes are not those of the input");
    if (!std::ranges::equal(file_.regions, graph_.given().regions, same)) {
      list_.fail("the regions are not those of the input");
    }
  }

  void measure_angles() {
    angles_.promised = false;
    double least = 180, largest = 0;
    std::array<std::uint64_t, 12> bins{};
    for (const auto& v : file_.triangles) {
      ++angles_.checked;
      for (std::size_t i = 0; i < 3; ++i) {
        const Point &o = points_.all()[v[i]], &p = points_.all()[v[(i + 1) % 3]],
                    &q = points_.all()[v[(i + 2) % 3]];
        // Halves, so that the largest doubles do not overflow; an angle at an edge whose length
        // vanishes is left out.
        const double ux = p.dx / 2 - o.dx / 2, uy = p.dy / 2 - o.dy / 2, wx = q.dx / 2 - o.dx / 2,
                     wy = q.dy / 2 - o.dy / 2, size = std::hypot(ux, uy),
                     other = std::hypot(wx, wy);
        const double cross = ux / size * (wy / other) - uy / size * (wx / other),
                     dot = ux / size * (wx / other) + uy / size * (wy / other);
        const double angle = std::atan2(std::fabs(cross), dot) * 57.29577951308232;
        if (!std::isfinite(angle)) continue;
        least = std::min(least, angle);
        largest = std::max(largest, angle);
        ++bins[std::min<std::size_t>(11, static_cast<std::size_t>(angle / 15))];
      }
    }
    angles_.figures = {{"least", least}, {"largest", largest}};
    angles_.histograms.emplace_back("angles", bins);
  }

  PlaneGraph& graph_;
  PlaneInside inside_;
  const PlaneFile& file_;
  const Promise& promise_;
  double tolerance_, declared_;
  bool recorded_;
  int scale_ = 0;
  PlanePoints points_;
  PlaneBoxes boxes_;
  bool indices_right_ = true;
  double deviation_ = 0;
  std::map<Edge, Index> left_of_;  // directed edge to the triangle on its left
  std::vector<Spokes> spokes_;     // per vertex, to those at the other ends of edges
  std::map<std::array<double, 2>, Index> at_;
  std::set<std::array<double, 2>> input_places_;
  std::map<Edge, Index> chains_;  // edges that tile pieces of segments, with the piece
  OracleReport complex_{"complex", "triangles"}, orientation_{"orientation", "triangles"},
      conformity_{"conformity", "pieces of segments, vertices, edges"},
      sides_{"sides", "triangles, edges"}, list_{"edge-list", "edges"},
      angles_{"angles", "triangles"};
};

}  // namespace

void check_plane_file(PlaneGraph& graph, const PlaneFile& file, const Promise& promise,
                      double declared, bool recorded, VerifyReport& report, double& deviation) {
  constexpr double kUlps = 4;
  const double tolerance = std::max(kUlps * graph.ulp(), declared);
  FileChecker checker(graph, file, promise, tolerance, declared, recorded);
  checker.run(report);
  deviation = checker.deviation();
}

}  // namespace tetproof::oracles
