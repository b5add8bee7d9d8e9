# What every target of Cleave is compiled with: target cleave_options.
#
# Never -ffast-math: NaN must stay visible, and equal input must give equal bits. The two relaxations below change no
# value; they only forget errno and floating-point exception flags, which nobody reads.

set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON) # a moved build directory still finds its libraries
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(cleave_options INTERFACE)
target_compile_features(cleave_options INTERFACE cxx_std_20)
set(CMAKE_CXX_EXTENSIONS OFF)
target_include_directories(cleave_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(cleave_options INTERFACE -fno-math-errno -fno-trapping-math
    -ffp-contract=fast # ISO mode would switch fused multiply-adds off: a third of the kernels' speed
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    -Wno-psabi # vector types never cross a library, so their calling convention is ours
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # g++ 12 warns about its own std::string (GCC bug 105329)
    $<$<BOOL:${CLEAVE_WERROR}>:-Werror>
    $<$<BOOL:${CLEAVE_NATIVE}>:-march=native>)
target_compile_definitions(cleave_options INTERFACE
    CLEAVE_VERSION="${PROJECT_VERSION}"
    CLEAVE_BUILD_TYPE="${CMAKE_BUILD_TYPE}"
    $<$<BOOL:${CLEAVE_CHECKED}>:CLEAVE_CHECKED>
    EIGEN_MAX_ALIGN_BYTES=16) # else Eigen's allocator and layouts would differ between the kernel libraries

# Inside a shared library a call binds to the library's own copy of a function. It makes calls inlinable again, and it
# keeps a kernel library for AVX-512 from calling, or being called for, another library's copy of an inline function.
target_compile_options(cleave_options INTERFACE -fno-semantic-interposition)
target_link_options(cleave_options INTERFACE -Wl,-Bsymbolic-functions)

if(CLEAVE_SANITIZE)
    target_compile_options(cleave_options INTERFACE -fsanitize=${CLEAVE_SANITIZE} -fno-omit-frame-pointer
        -fno-sanitize-recover=all)
    target_link_options(cleave_options INTERFACE -fsanitize=${CLEAVE_SANITIZE})
endif()
