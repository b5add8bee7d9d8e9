# add_cleave_module(name [DEPENDS folder...] [USES library...] [HIDES library...] [KERNELS])
#
# Declare the folder `name` as target cleave_<name>, made of <name>/*.cpp (none yet: headers only).
#   DEPENDS  folders to the left of this one; everything they depend on comes along
#   USES     third-party libraries whose headers may appear in this folder's headers
#   HIDES    third-party libraries that only this folder's .cpp files (and its tests) may include
#   KERNELS  build it once per instruction set: lib/libcleave_<name>.so for any machine and
#            lib/glibc-hwcaps/<level>/libcleave_<name>.so; the dynamic loader takes the best one the processor runs
#
# A module with kernels and all it depends on are shared libraries, so that each piece of code and state exists once;
# the folders above it are static. What must not happen: a type whose layout depends on the instruction set (such as
# core::native_lanes) in an interface between two folders.

set(CLEAVE_SHARED_MODULES core geometry grid particles material transfer)
set(CLEAVE_MODULES "" CACHE INTERNAL "")
set(CLEAVE_KERNEL_MODULES "" CACHE INTERNAL "")

function(add_cleave_module name)
    cmake_parse_arguments(module "KERNELS" "" "DEPENDS;USES;HIDES" ${ARGN})
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
    list(REMOVE_ITEM sources ${PROJECT_SOURCE_DIR}/app/main.cpp)
    list(TRANSFORM module_DEPENDS PREPEND cleave_ OUTPUT_VARIABLE depends)
    set(CLEAVE_MODULES ${CLEAVE_MODULES} ${name} CACHE INTERNAL "")
    set(CLEAVE_HIDES_${name} "${module_HIDES}" CACHE INTERNAL "")

    if(NOT sources)
        add_library(cleave_${name} INTERFACE)
        target_link_libraries(cleave_${name} INTERFACE cleave_options ${depends} ${module_USES})
        return()
    endif()

    set(kind STATIC)
    if(name IN_LIST CLEAVE_SHARED_MODULES)
        set(kind SHARED)
    endif()
    set(targets cleave_${name})
    add_library(cleave_${name} ${kind} ${sources})
    if(module_KERNELS AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND NOT CLEAVE_NATIVE)
        foreach(level IN LISTS CLEAVE_KERNEL_LEVELS)
            set(variant cleave_${name}_${level})
            list(APPEND targets ${variant})
            add_library(${variant} SHARED ${sources})
            target_compile_options(${variant} PRIVATE -march=${level} -mtune=generic)
            set(bits 256)
            if(level STREQUAL "x86-64-v4")
                set(bits 512)
                # g++ 12 warns about its own AVX-512 header (GCC bug 105593); the other levels keep the warning.
                target_compile_options(${variant} PRIVATE -mprefer-vector-width=512
                    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>
                    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
            endif()
            # g++ copies vectors by 16 bytes or in a string instruction else, and what is read whole again has to wait.
            set(has_move_max $<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,12>>)
            target_compile_options(${variant} PRIVATE
                $<${has_move_max}:-mmove-max=${bits}> $<${has_move_max}:-mstore-max=${bits}>)
            set_target_properties(${variant} PROPERTIES OUTPUT_NAME cleave_${name} BUILD_RPATH "$ORIGIN/../.."
                LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/glibc-hwcaps/${level})
            add_dependencies(cleave_${name} ${variant}) # whoever builds one builds all: no stale kernels
        endforeach()
        set(CLEAVE_KERNEL_MODULES ${CLEAVE_KERNEL_MODULES} ${name} CACHE INTERNAL "")
    endif()
    foreach(target IN LISTS targets)
        target_link_libraries(${target} PUBLIC cleave_options ${depends} ${module_USES} PRIVATE ${module_HIDES})
    endforeach()
    set_target_properties(cleave_${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
        ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
endfunction()
