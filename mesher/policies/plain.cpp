#include "mesher/policies/plain.h"

#include "mesher/enrich/enrichment.h"
#include "mesher/results/region_statistics.h"

namespace delmesher::policies {

bool may_be_plain(const Session& session) {
  constexpr std::size_t kMostTriangles = 1000;
  const Options& options = session.options;
  return !options.as_paper.enrichment && options.region == Region::interior &&
         !session.bounds_edges() && session.surface.topology().triangles.size() <= kMostTriangles;
}

std::optional<cdt::CdtResult> plain_without_points(Session& session) {
  if (!may_be_plain(session)) return std::nullopt;
  const std::size_t enriched_points = session.points.size();
  cdt::CdtResult plain = cdt::constrained_delaunay_tetrahedrization(
      enrich::plain_input(session.surface.topology(), session.points, session.predicates),
      session.points, session.predicates, session.control);
  session.points.truncate(enriched_points);
  if (!plain.steiner.empty()) return std::nullopt;
  return plain;
}

std::optional<cdt::CdtResult> plain_if_better(const cdt::CdtResult& enriched, Session& session) {
  std::optional<cdt::CdtResult> plain = plain_without_points(session);
  if (!plain) return std::nullopt;
  const MeshStatistics p = interior_statistics(*plain, session.points, session.control);
  if (p.min_face_angle < session.options.delta) return std::nullopt;
  const MeshStatistics e = interior_statistics(enriched, session.points, session.control);
  const bool better = p.min_face_angle >= e.min_face_angle && p.min_dihedral >= e.min_dihedral &&
                      p.tetrahedra <= e.tetrahedra;
  return better ? std::move(plain) : std::nullopt;
}

}  // namespace delmesher::policies
