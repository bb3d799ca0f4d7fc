// Lies in the plane: promises in the record that are laxer than those of the options.
#include <cmath>

#include "property_tests/plane_lies/told.h"

namespace tetproof::plane_lies {
namespace {

using Index = std::uint32_t;

const Lie kRelaxed[] = {
    {"delta relaxed to nothing", "promise", [](Told& t) { t.record.delta = 0x1p-20; }},
    {"delta that is not a number", "promise", [](Told& t) { t.record.delta = NAN; }},
    {"delta that no triangle has", "promise", [](Told& t) { t.record.delta = 1000; }},
    {"delta between what triangles have and a right angle", "promise",
     [](Told& t) { t.record.delta = 61; }},
    {"threshold of corners stricter than asked for, where corners between are kept", "promise",
     [](Told& t) { t.record.acute = 90; }},
    {"delta stricter than asked for", "promise",
     [](Told& t) { t.record.delta = t.how.promised.delta * (1 + 1e-12); }},
    {"threshold of corners relaxed", "promise", [](Told& t) { t.record.acute = 1; }},
    {"threshold of corners that is not a number", "promise", [](Told& t) { t.record.acute = NAN; }},
    {"threshold of corners infinite", "promise", [](Told& t) { t.record.acute = HUGE_VAL; }},
    {"a distance infinite", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.front().distance = HUGE_VAL; }},
    {"a distance that is not a number", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.front().distance = NAN; }},
    {"a distance below nothing", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.front().distance *= -1; }},
    {"a distance a ten-thousandth larger", "refined-chamfer-cuts",
     [](Told& t) { t.record.corners.front().distance *= 1.0001; }},
    {"an old version", "promise", [](Told& t) { t.how.record_version = 0; }},
    {"a distance half as large again", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.front().distance *= 1.5; }},
    {"a distance half as large", "refined-chamfer-cuts",
     [](Told& t) { t.record.corners.front().distance /= 2; }},
    {"a distance of nothing", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.front().distance = 0; }},
    {"distances of 2^60", "refined-chamfer-distance",
     [](Told& t) {
       for (auto& corner : t.record.corners) corner.distance = 0x1p60;
     }},
    {"a corner fewer", "refined-chamfer-need", [](Told& t) { t.record.corners.pop_back(); }},
    {"a corner fewer, by its cuts", "refined-chamfer-cuts",
     [](Told& t) { t.record.corners.pop_back(); }},
    {"no corners", "refined-chamfer-need", [](Told& t) { t.record.corners.clear(); }},
    {"a corner twice", "refined-chamfer-distance",
     [](Told& t) { t.record.corners.push_back(t.record.corners.front()); }},
    {"a corner that is not acute", "refined-chamfer-need",
     [](Told& t) {
       t.record.corners.push_back({0, 0x1p-4});
     }},
    {"a corner that is not a vertex of the input", "refined-chamfer-distance",
     [](Told& t) {
       t.record.corners.push_back({static_cast<Index>(t.graph.vertices.size()), 0x1p-4});
     }},
    {"a dropped segment that is not called so", "refined-drops",
     [](Told& t) { t.record.dropped.clear(); }},
    {"a segment called dropped that is there", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(0); }},
    {"a segment dropped twice", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(t.record.dropped.front()); }},
    {"a dropped segment that is none", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(77); }},
};

}  // namespace

std::span<const Lie> relaxed() {
  return kRelaxed;
}

}  // namespace tetproof::plane_lies
