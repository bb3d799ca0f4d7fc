// The scripts and styles of the report, compiled into the program, so that it needs no files beside
// itself and the report no network.
#pragma once

#include <string_view>

namespace tetproof::assets {

// From packages: Chart.js, three.js and its OrbitControls, all under the MIT licence. Empty if they
// were not found when the program was built.
std::string_view chart_js();
std::string_view three_js();
std::string_view orbit_controls_js();
// The project's own, in page/.
std::string_view page_css();
std::string_view charts_js();
std::string_view view_js();
std::string_view page_js();

}  // namespace tetproof::assets
