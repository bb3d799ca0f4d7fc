# cmake -DBUILD=<build tree> -DWORK=<scratch folder> -P run.cmake: installs the build tree into the scratch
# folder, then configures, builds and runs the consumer against that installation only.
# cmake -DSOURCE=<source tree> -DWORK=<scratch folder> -P run.cmake: the same with the source tree as a subproject, without zlib.
function(step)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT RESULT_VARIABLE code WORKING_DIRECTORY ${WORK})
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed with ${code}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(compiler -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${CXXFLAGS}" -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
if(SOURCE)
  # In no build type at all code is slow to run and quick to build. Without what is optional, so that somebody builds that, too.
  step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -DDELMESHER_SOURCE=${SOURCE} ${compiler} -DCMAKE_DISABLE_FIND_PACKAGE_ZLIB=ON
       -DCMAKE_UNITY_BUILD=ON)
  step(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2 --target consumer)
else()
  step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
  step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix ${compiler}
       -DCMAKE_BUILD_TYPE=Release)
  step(${CMAKE_COMMAND} --build ${WORK}/build)
  step(${WORK}/build/c_consumer)
  # The same without CMake, as a Makefile would.
  find_program(PKG_CONFIG pkg-config REQUIRED)
  file(GLOB_RECURSE pc ${WORK}/prefix/delmesher.pc)
  get_filename_component(pc_folder "${pc}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${pc_folder})
  step(sh -c "cc ${CXXFLAGS} '${CMAKE_CURRENT_LIST_DIR}/c_consumer.c' -o from_pc $(pkg-config --cflags --libs delmesher)")
  step(${WORK}/from_pc)
endif()
step(${WORK}/build/consumer)
