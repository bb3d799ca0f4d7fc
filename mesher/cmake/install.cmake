# `cmake --install`: libraries, headers, command line and a package for find_package(delmesher).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/delmesher)

install(TARGETS delmesher delmesher_io EXPORT delmesherTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES delmesher.h delmesher_c.h delmesher_files.h delmesher_plane.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY delmesher DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT delmesherTargets NAMESPACE delmesher:: DESTINATION ${package_dir})
# A static library is linked with what it needs by whoever links it.
set(find_zlib "")
set(pc_requires "")
if(ZLIB_FOUND)
  set(find_zlib "find_dependency(ZLIB)")
  set(pc_requires zlib)
endif()
configure_package_config_file(cmake/delmesherConfig.cmake.in delmesherConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(delmesherConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/delmesherConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/delmesherConfigVersion.cmake
        DESTINATION ${package_dir})
# The prefix of the file is where it lies, so that an installation can be moved, or be given with --prefix.
file(RELATIVE_PATH pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
configure_file(cmake/delmesher.pc.in delmesher.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/delmesher.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET delmesher_cli)
  install(TARGETS delmesher_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
