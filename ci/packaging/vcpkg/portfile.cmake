# A port for vcpkg, as it lies here an overlay: vcpkg install delmesher --overlay-ports=ci/packaging/vcpkg
# Tried: vcpkg.json against vcpkg's schema; this file with functions that stand in for vcpkg's, and ci/machines/consumer against what the same
# commands by hand install. Not tried: vcpkg itself.
# A release replaces the first command by vcpkg_from_github or vcpkg_download_distfile.
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../.." ABSOLUTE)

vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES tools DELMESHER_COMMAND)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${options} -DTETPROOF_HARNESS=OFF -DTETPROOF_TESTS=OFF -DDELMESHER_INSTALL=ON)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/delmesher)
vcpkg_fixup_pkgconfig()
if("tools" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES delmesher AUTO_CLEAN)
endif()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share" "${CURRENT_PACKAGES_DIR}/share/doc")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
