# Installs the sampling library to temporary folders, once from a copy of its folder alone and once as a component of this build,
# and builds and runs the example against each.
#   cmake -DHOST_BUILD=... -DLIBRARY=<src/darts> -DWORK=... -DGENERATOR=... -DCOMPILER=... [-DLAUNCHER=...] -P package.cmake

include(${CMAKE_CURRENT_LIST_DIR}/../support/run.cmake)

# That it builds and links is what counts: no optimisation. Files that lack an include are found by builds with TUNGSTEN_UNITY off.
function(configure_and_build source build)
  run(${CMAKE_COMMAND} -S ${source} -B ${build} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
    -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-DNDEBUG" "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror" ${ARGN})
  run(${CMAKE_COMMAND} --build ${build})
endfunction()

function(run_example prefix)
  # Found here and nowhere else.
  configure_and_build(${WORK}/example ${prefix}-example -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
    "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG") # it draws a million samples
  run(${prefix}-example/darts-example)
  if(NOT output MATCHES "best: 0\\.[0-9]+   published: 0\\.[0-9]+")
    message(FATAL_ERROR "the example printed:\n${output}")
  endif()
  file(GLOB_RECURSE installed RELATIVE ${prefix} ${prefix}/*)
  foreach(file ${installed})
    if(NOT file MATCHES "^(include/darts/[A-Za-z0-9]+\\.h|lib/libdarts\\.a|lib/cmake/darts/[-A-Za-z]+\\.cmake)$")
      message(FATAL_ERROR "installed what is not the library's: ${file}")
    endif()
  endforeach()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(COPY ${LIBRARY}/ DESTINATION ${WORK}/darts) # out of the tree, where nothing else must be found
file(RENAME ${WORK}/darts/example ${WORK}/example)
configure_and_build(${WORK}/darts ${WORK}/library -DCMAKE_UNITY_BUILD=ON)
run(${CMAKE_COMMAND} --install ${WORK}/library --prefix ${WORK}/alone)
run_example(${WORK}/alone)
run(${CMAKE_COMMAND} --install ${HOST_BUILD} --component darts --prefix ${WORK}/component)
run_example(${WORK}/component)
# One version, whichever way it is built.
set(version_file lib/cmake/darts/dartsConfigVersion.cmake)
run(${CMAKE_COMMAND} -E compare_files ${WORK}/alone/${version_file} ${WORK}/component/${version_file})
file(REMOVE_RECURSE ${WORK})
