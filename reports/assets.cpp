#include "reports/assets.h"

// The assembler copies a file as it is: quicker by far than an array in C++.
#define TETPROOF_ASSET(name, file)                                                            \
  __asm__(".section .rodata\n.global tetproof_asset_" #name "\n.global tetproof_asset_" #name \
          "_end\ntetproof_asset_" #name ":\n.incbin \"" file "\"\ntetproof_asset_" #name      \
          "_end:\n.byte 0\n.previous\n");                                                     \
  extern "C" const char tetproof_asset_##name[];                                              \
  extern "C" const char tetproof_asset_##name##_end[];                                        \
  std::string_view tetproof::assets::name() {                                                 \
    return {tetproof_asset_##name,                                                            \
            static_cast<std::size_t>(tetproof_asset_##name##_end - tetproof_asset_##name)};   \
  }

// A script that was not there when this program was built.
#define TETPROOF_NO_ASSET(name)               \
  std::string_view tetproof::assets::name() { \
    return {};                                \
  }

#ifdef TETPROOF_CHART_JS
TETPROOF_ASSET(chart_js, TETPROOF_CHART_JS)
#else
TETPROOF_NO_ASSET(chart_js)
#endif
#ifdef TETPROOF_THREE_JS
TETPROOF_ASSET(three_js, TETPROOF_THREE_JS)
TETPROOF_ASSET(orbit_controls_js, TETPROOF_ORBIT_CONTROLS_JS)
#else
TETPROOF_NO_ASSET(three_js)
TETPROOF_NO_ASSET(orbit_controls_js)
#endif
TETPROOF_ASSET(page_css, TETPROOF_PAGE_FOLDER "/page.css")
TETPROOF_ASSET(charts_js, TETPROOF_PAGE_FOLDER "/charts.js")
TETPROOF_ASSET(view_js, TETPROOF_PAGE_FOLDER "/view.js")
TETPROOF_ASSET(page_js, TETPROOF_PAGE_FOLDER "/page.js")
