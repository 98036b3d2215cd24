# Installs the host to a temporary folder, builds the example plugin against it, lists it and renders with it.
#   cmake -DHOST_BUILD=... -DEXAMPLE=... -DSCENE=... -DWORK=... -P out_of_tree_plugin.cmake

include(${CMAKE_CURRENT_LIST_DIR}/../support/run.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${HOST_BUILD} --prefix ${WORK}/host)
expect_no_options(${WORK}/host/lib/cmake/tungsten)
expect_no_options(${WORK}/host/lib/cmake/darts)
# No optimisation: that the plugin builds and works is what counts.
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${WORK}/plugin -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-DNDEBUG" "-DCMAKE_CXX_FLAGS=-Wall -Wextra" -DCMAKE_PREFIX_PATH=${WORK}/host)
run(${CMAKE_COMMAND} --build ${WORK}/plugin)

set(ENV{TUNGSTEN_PLUGIN_PATH} ${WORK}/plugin)
set(tungsten ${WORK}/host/bin/tungsten)
run(${tungsten} --list)
if(NOT output MATCHES "ambient_occlusion" OR NOT output MATCHES "${WORK}/plugin/libtungsten-example.so")
  message(FATAL_ERROR "--list does not show the plugin and its file:\n${output}")
endif()
if(NOT output MATCHES "path_tracer")
  message(FATAL_ERROR "--list lost the installed integrators:\n${output}")
endif()
run(${tungsten} --describe ambient_occlusion)
if(NOT output MATCHES "distance \\[length\\], default 1\n *how far rays must travel freely")
  message(FATAL_ERROR "--describe does not show the plugin's field:\n${output}")
endif()

run(${tungsten} ${SCENE} --set integrator.type=ambient_occlusion --set integrator.distance=0.5 --resolution 32x32
  --spp 4 -d ${WORK}/out -o ao.png -e ao.pfm --stats ${WORK}/out/ao.json)
file(READ ${WORK}/out/ao.json stats)
string(JSON rays GET "${stats}" counters "occlusion rays")
if(NOT rays EQUAL 4096 OR NOT EXISTS ${WORK}/out/ao.png OR NOT EXISTS ${WORK}/out/ao.pfm)
  message(FATAL_ERROR "the example did not render: ${rays} rays\n${output}")
endif()
if(PYTHON) # finds the integrators beside the installed library
  set(ENV{PYTHONPATH} ${WORK}/host/lib/python3/dist-packages)
  run(${PYTHON} -c "print([type['name'] for type in __import__('darts_tungsten').describe('integrators')])")
  if(NOT output MATCHES "'ambient_occlusion'.*'path_tracer'")
    message(FATAL_ERROR "the installed Python module does not find integrators:\n${output}")
  endif()
endif()
file(REMOVE_RECURSE ${WORK})
