#include <stdexcept>

#include "corpus/plane/bench.h"
#include "mesher/io/read_plane.h"
#include "oracles/plane/shapes.h"

namespace tetproof::plane_bench {

Input family(const std::string& what) {
  const std::size_t colon = what.find(':');
  const std::string name = what.substr(0, colon);
  const int n = colon == std::string::npos ? 1 : std::stoi(what.substr(colon + 1));
  if (name == "koch") return {what, shapes::koch(n)};
  if (name == "star") return {what, shapes::star(n, 0.3)};
  if (name == "comb") return {what, shapes::comb(n, 0.5 / n)};
  if (name == "fan") return {what, shapes::fan(n, 1.0 / n)};
  if (name == "rough") return {what, shapes::rough_circle(n, 0.2, 1)};
  if (name == "nested") return {what, shapes::nested_squares(n)};
  if (name == "archipelago") return {what, shapes::archipelago(n / 2, n / 18, 1)};
  if (name == "figure") return {what, shapes::figure()};
  throw std::invalid_argument("no family " + name);
}

Input file(const std::string& path) {
  delmesher::io::PlaneReadResult input = delmesher::io::read_plane(path);
  if (!input.ok()) throw std::runtime_error(input.error);
  const std::size_t slash = path.rfind('/');
  return {slash == std::string::npos ? path : path.substr(slash + 1), std::move(input.graph)};
}

}  // namespace tetproof::plane_bench
