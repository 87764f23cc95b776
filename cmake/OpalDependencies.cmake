# Everything comes from Debian packages: scripts/install_dependencies.sh lists them.

list(APPEND CMAKE_MODULE_PATH ${CMAKE_LIBRARY_PATH} /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)

find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenVDB REQUIRED)
# OpenImageIO's CMake files on Debian insist on its command line tools and Python module; pkg-config does not.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(PLplot REQUIRED IMPORTED_TARGET plplot-c++)
find_package(embree 3 REQUIRED)
find_package(assimp REQUIRED)
find_package(PNG REQUIRED)
find_package(Freetype REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)
add_library(opal_nanovdb INTERFACE)
target_include_directories(opal_nanovdb SYSTEM INTERFACE ${NANOVDB_INCLUDE_DIR})
