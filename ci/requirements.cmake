# Looks for every library that the chosen parts need, so that all that is missing is named at once, each with the package of
# Debian that brings it (from ci/packages). What is optional is named too, with what is left out.
# Any of them may lie elsewhere: CMAKE_PREFIX_PATH, or the variables that `cmake -L` shows.

file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/packages package_lines REGEX "^[^#]")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/packages)
set(missing "")
set(missing_packages "")
set(left_out "")

# The package of ci/packages that brings what CMake calls NAME.
function(package_of name result)
  foreach(line ${package_lines})
    if(line MATCHES "^([^ ]+) +[^ ]+ +([^ ]+)")
      set(package ${CMAKE_MATCH_1})
      string(REPLACE "," ";" names ${CMAKE_MATCH_2})
      if(name IN_LIST names)
        set(${result} ${package} PARENT_SCOPE)
        return()
      endif()
    endif()
  endforeach()
  message(FATAL_ERROR "ci/packages names no package for ${name}")
endfunction()

# need(NAME WHY VARIABLE...): all variables must be true. optional(NAME LOSS VARIABLE...): without them LOSS.
macro(need name why)
  foreach(variable ${ARGN})
    if(NOT ${variable})
      package_of(${name} package)
      list(APPEND missing "  ${name}, for ${why} (Debian: ${package})")
      list(APPEND missing_packages ${package})
      break()
    endif()
  endforeach()
endmacro()
macro(optional name loss)
  foreach(variable ${ARGN})
    if(NOT ${variable})
      package_of(${name} package)
      list(APPEND left_out "  ${name} (Debian: ${package}): ${loss}")
      break()
    endif()
  endforeach()
endmacro()

# CMake's own packages speak at length where they are found and where not.
macro(look_for)
  find_package(${ARGN} QUIET)
endmacro()

list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})  # FindGMP.cmake: Debian ships none
find_package(Threads REQUIRED)
if(DELMESHER_COMMAND OR TETPROOF_HARNESS)
  look_for(CLI11)
  look_for(nlohmann_json)
  need(CLI11 "command lines" CLI11_FOUND)
  need(nlohmann_json "statistics and records as JSON" nlohmann_json_FOUND)
endif()
if(TETPROOF_HARNESS OR TETPROOF_TESTS OR TETPROOF_FUZZ)
  look_for(GMP)
  need(GMP "the oracles and tests" GMP_FOUND)
  find_library(GMPXX_LIBRARY gmpxx)
  mark_as_advanced(GMPXX_LIBRARY)
  need(GMPXX "the oracles and tests" GMPXX_LIBRARY)
endif()
look_for(ZLIB)
if(TETPROOF_HARNESS)
  look_for(EXPAT)
  need(EXPAT "the oracles" EXPAT_FOUND)
  need(ZLIB "the oracles" ZLIB_FOUND)
else()
  optional(ZLIB "compressed files (gzip, .3mf, .vtu with zlib) are refused" ZLIB_FOUND)
endif()

if(TETPROOF_HARNESS)
  look_for(fmt)
  look_for(SQLiteCpp)
  need(fmt "tetproof" fmt_FOUND)
  need(SQLiteCpp "the database of campaigns" SQLiteCpp_FOUND)

  set(TETPROOF_TETGEN_ROOT "" CACHE PATH
    "Another TetGen: a folder with tetgen.h and a library (libtet or libtetgen), also in include/ and lib/")
  set(tetgen_hints "")
  if(TETPROOF_TETGEN_ROOT)
    set(tetgen_hints HINTS "${TETPROOF_TETGEN_ROOT}" PATH_SUFFIXES include lib build . NO_DEFAULT_PATH)
  endif()
  find_path(TETPROOF_TETGEN_INCLUDE_DIR tetgen.h ${tetgen_hints})
  find_library(TETPROOF_TETGEN_LIBRARY NAMES tet tetgen ${tetgen_hints})
  mark_as_advanced(TETPROOF_TETGEN_INCLUDE_DIR TETPROOF_TETGEN_LIBRARY)
  if(TETPROOF_TETGEN_ROOT)
    need(TetGen "tetproof-tetgen: not in TETPROOF_TETGEN_ROOT" TETPROOF_TETGEN_INCLUDE_DIR TETPROOF_TETGEN_LIBRARY)
  else()
    optional(TetGen "no mesher `tetgen`" TETPROOF_TETGEN_INCLUDE_DIR TETPROOF_TETGEN_LIBRARY)
  endif()

  # Peers of the league; only their own programs link them.
  find_path(TETPROOF_NGLIB_INCLUDE_DIR netgen/nglib.h)
  find_library(TETPROOF_NGLIB_LIBRARY nglib PATH_SUFFIXES netgen)
  mark_as_advanced(TETPROOF_NGLIB_INCLUDE_DIR TETPROOF_NGLIB_LIBRARY)
  optional(Netgen "no mesher `netgen`" TETPROOF_NGLIB_INCLUDE_DIR TETPROOF_NGLIB_LIBRARY)

  # Scripts that are compiled into the report; builds that define globals, not modules.
  set(script_folders PATHS /usr/share /usr/local/share PATH_SUFFIXES javascript javascript/chart.js javascript/chartjs
    javascript/three javascript/three/build javascript/three/examples/js/controls nodejs/three/build
    nodejs/three/examples/js/controls nodejs/chart.js/dist)
  find_file(TETPROOF_CHART_JS NAMES chart.min.js chart.umd.js chart.umd.min.js ${script_folders}
    DOC "Chart.js 3 or 4, minified")
  find_file(TETPROOF_THREE_JS NAMES three.min.js ${script_folders} DOC "three.js up to release 147, minified")
  find_file(TETPROOF_ORBIT_CONTROLS_JS OrbitControls.js ${script_folders}
    DOC "OrbitControls.js of the same release, from examples/js/controls")
  optional(Chart.js "reports have no charts" TETPROOF_CHART_JS)
  optional(three.js "reports have no 3D view" TETPROOF_THREE_JS TETPROOF_ORBIT_CONTROLS_JS)

  if(TETPROOF_SECOND_OPINIONS)
    look_for(CGAL)
    find_path(CGAL_INCLUDE_DIR CGAL/Polygon_mesh_processing/self_intersections.h)
    find_library(MPFR_LIBRARY mpfr)
    find_path(OPENMESH_INCLUDE_DIR OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh)
    find_library(OPENMESH_CORE_LIBRARY OpenMeshCore)
    mark_as_advanced(CGAL_INCLUDE_DIR MPFR_LIBRARY OPENMESH_INCLUDE_DIR OPENMESH_CORE_LIBRARY)
    set(why "second opinions and generated models")
    need(CGAL "${why}" CGAL_FOUND CGAL_INCLUDE_DIR)
    need(MPFR "${why}" MPFR_LIBRARY)
    need(OpenMesh "${why}" OPENMESH_INCLUDE_DIR OPENMESH_CORE_LIBRARY)
    look_for(benchmark)
    optional(benchmark "the benchmark `tetproof-kernels` is not there" benchmark_FOUND)
  elseif(TETPROOF_TESTS OR TETPROOF_FUZZ)
    message(FATAL_ERROR "tests and fuzz targets of the harness need second opinions: "
                        "set TETPROOF_SECOND_OPINIONS=ON, or TETPROOF_TESTS=OFF and TETPROOF_FUZZ=OFF")
  endif()
endif()

if(TETPROOF_TESTS)
  look_for(GTest)
  need(GTest "the tests" GTest_FOUND)
  if(TETPROOF_HARNESS)
    look_for(Python3 COMPONENTS Interpreter)
    need(Python3 "the tests" Python3_Interpreter_FOUND)
    find_file(TETPROOF_CGAL_DATA data.tar.gz PATHS /usr/share/doc/libcgal-dev /usr/share/doc/libcgal-demo
      DOC "CGAL's archive of models (data/meshes), which comes with its demos")
    optional(CGAL-models "no property tests on real models" TETPROOF_CGAL_DATA)
  endif()
endif()

if(left_out)
  list(JOIN left_out "\n" text)
  message(STATUS "Not found, and done without:\n${text}")
endif()
if(missing)
  list(REMOVE_DUPLICATES missing_packages)
  list(JOIN missing "\n" text)
  list(JOIN missing_packages " " packages)
  message(FATAL_ERROR "These libraries are missing:\n${text}\nOn Debian and Ubuntu: apt-get install ${packages}\n"
                      "Elsewhere: CMAKE_PREFIX_PATH names further folders to look in.\n"
                      "Without tests: -DTETPROOF_TESTS=OFF, without second opinions too: -DTETPROOF_SECOND_OPINIONS=OFF, "
                      "the mesher alone: cmake --preset mesher.\n")
endif()
