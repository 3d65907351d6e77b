# find_package(pathwarp) gives the targets pathwarp::pathwarp, the shared library, and pathwarp::static, by pkg-config.
include(CMakeFindDependencyMacro)
find_dependency(PkgConfig)
set(_pathwarp_path "$ENV{PKG_CONFIG_PATH}")
set(ENV{PKG_CONFIG_PATH} "${CMAKE_CURRENT_LIST_DIR}/../../pkgconfig:${_pathwarp_path}")
pkg_check_modules(pathwarp_pc REQUIRED QUIET IMPORTED_TARGET GLOBAL pathwarp)
set(ENV{PKG_CONFIG_PATH} "${_pathwarp_path}")
if(NOT TARGET pathwarp::pathwarp)
  add_library(pathwarp::pathwarp ALIAS PkgConfig::pathwarp_pc)
  add_library(pathwarp::static STATIC IMPORTED)
  get_filename_component(_pathwarp_lib "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
  set_target_properties(pathwarp::static PROPERTIES
    IMPORTED_LOCATION "${_pathwarp_lib}/libpathwarp_c.a"
    INTERFACE_INCLUDE_DIRECTORIES "${pathwarp_pc_INCLUDE_DIRS}"
    INTERFACE_LINK_LIBRARIES "m;pthread;dl")
endif()
