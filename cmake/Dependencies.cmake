# Everything Cleave takes from the system; nothing is downloaded. tools/packages.txt lists the Debian packages.

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED CONFIG)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)

set(HDF5_PREFER_PARALLEL FALSE)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT TARGET HDF5::HDF5) # CMake before 3.28 does not always name it so
    add_library(HDF5::HDF5 INTERFACE IMPORTED)
    target_include_directories(HDF5::HDF5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
    target_link_libraries(HDF5::HDF5 INTERFACE ${HDF5_C_LIBRARIES})
endif()

# OpenVDB's find module lies beside its library (multiarch on Debian), not where CMake looks. It needs Boost.Iostreams
# (not a dependency of Debian's libopenvdb-dev) and its headers need Imath, which it does not link. Both talk much:
# debugging leftovers, and a missing file of Imath's Python part that nobody here needs.
find_path(CLEAVE_OPENVDB_MODULE_DIR FindOpenVDB.cmake
    PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB
    PATHS ${CMAKE_PREFIX_PATH} /usr/local /usr REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
list(APPEND CMAKE_MODULE_PATH ${CLEAVE_OPENVDB_MODULE_DIR})
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
list(REMOVE_ITEM CMAKE_MODULE_PATH ${CLEAVE_OPENVDB_MODULE_DIR})
find_package(Imath REQUIRED CONFIG)
unset(CMAKE_MESSAGE_LOG_LEVEL)
target_link_libraries(OpenVDB::openvdb INTERFACE Imath::Imath)
