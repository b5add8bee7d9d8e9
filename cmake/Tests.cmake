# One GoogleTest binary per folder of tests/: test_<folder> from tests/<folder>/*_test.cpp.
#
# A folder named like a module links that module and has the label `unit`; any other (verification,
# regression) links everything and has its own name as label. Tests with `Slow` in their name are labelled `slow`
# instead. Tests of a module with kernels run once per instruction set, each time hiding the better ones from the
# dynamic loader. Test programs know the source tree as CLEAVE_SOURCE_DIR.
find_package(GTest REQUIRED)
include(GoogleTest)

file(GLOB support_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.cpp)
if(support_sources)
    # Links core only: an object that needs more is pulled only by tests that link more.
    add_library(cleave_test_support STATIC ${support_sources})
    target_link_libraries(cleave_test_support PUBLIC cleave_core GTest::gtest)
else()
    add_library(cleave_test_support INTERFACE)
    target_link_libraries(cleave_test_support INTERFACE cleave_core GTest::gtest)
endif()

function(add_cleave_tests folder)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${folder}/*_test.cpp)
    if(NOT sources)
        return()
    endif()
    set(label ${folder})
    set(module app)
    if(folder IN_LIST CLEAVE_MODULES)
        set(label unit)
        set(module ${folder})
    endif()
    add_executable(test_${folder} ${sources})
    target_link_libraries(test_${folder} PRIVATE cleave_test_support cleave_${module} ${CLEAVE_HIDES_${module}}
        GTest::gtest_main)
    target_compile_definitions(test_${folder} PRIVATE CLEAVE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    if(folder STREQUAL regression) # runs the program itself
        target_compile_definitions(test_${folder} PRIVATE CLEAVE_PROGRAM="$<TARGET_FILE:cleave>")
        add_dependencies(test_${folder} cleave)
    endif()
    set_target_properties(test_${folder} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
    set(discover DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120)
    gtest_discover_tests(test_${folder} ${discover} TEST_FILTER "-*Slow*" PROPERTIES LABELS ${label} TIMEOUT 900)
    gtest_discover_tests(test_${folder} ${discover} TEST_FILTER "*Slow*" PROPERTIES LABELS slow TIMEOUT 3600)
    if(folder IN_LIST CLEAVE_KERNEL_MODULES AND CLEAVE_KERNEL_LEVELS)
        gtest_discover_tests(test_${folder} ${discover} TEST_FILTER "-*Slow*" TEST_SUFFIX " (at most x86-64-v3)"
            PROPERTIES LABELS ${label} TIMEOUT 900 ENVIRONMENT GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F)
        gtest_discover_tests(test_${folder} ${discover} TEST_FILTER "-*Slow*" TEST_SUFFIX " (baseline)"
            PROPERTIES LABELS ${label} TIMEOUT 900 ENVIRONMENT GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2)
    endif()
endfunction()

file(GLOB test_folders CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/tests LIST_DIRECTORIES true
    ${PROJECT_SOURCE_DIR}/tests/*)
list(REMOVE_ITEM test_folders support)
foreach(folder IN LISTS test_folders)
    if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/tests/${folder})
        add_cleave_tests(${folder})
    endif()
endforeach()
