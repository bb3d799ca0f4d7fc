#include "mesher/results/improvement.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace delmesher::results {

improve::ImproveMesh improvable(cdt::CdtResult& cdt) {
  return {
      std::move(cdt.tetrahedra), {cdt.inside.begin(), cdt.inside.end()}, std::move(cdt.boundary)};
}

void put_in(improve::ImproveMesh mesh, cdt::CdtResult& cdt) {
  cdt.tetrahedra = std::move(mesh.tetrahedra);
  cdt.inside.assign(mesh.region.begin(), mesh.region.end());
  cdt.boundary = std::move(mesh.boundary);
  cdt.repeated_faces.clear();
}

void follow(std::span<const VertexId> became, cdt::CdtResult& cdt) {
  const auto replace = [&](std::vector<VertexId>& vertices) {
    for (VertexId& v : vertices) v = became[v];
    std::erase(vertices, kNone);
  };
  for (std::vector<VertexId>& chain : cdt.chain) replace(chain);
  replace(cdt.steiner);
}

void keep_inside(cdt::CdtResult& cdt) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < cdt.tetrahedra.size(); ++n) {
    if (cdt.inside[n] != 0) cdt.tetrahedra[kept++] = cdt.tetrahedra[n];
  }
  cdt.tetrahedra.resize(kept);
  cdt.inside.assign(kept, 1);
  cdt.repeated_faces.clear();
}

}  // namespace delmesher::results
