# find_package(tungsten): the target tungsten::tungsten, for plugins.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(TBB)
find_dependency(embree 3)
find_dependency(Imath 3)
find_dependency(Boost 1.74)
include(${CMAKE_CURRENT_LIST_DIR}/tungsten-targets.cmake)
