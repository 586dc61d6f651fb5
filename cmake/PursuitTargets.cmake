# How every target of our own is made: one set of warnings, all of them errors, and the same
# floating-point rules everywhere, because the same events must give the same poses bit for bit.

# -g1: stack traces with lines at a third of the size, and quicker to build.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -g1 -DNDEBUG")
set(CMAKE_C_FLAGS_RELEASE "-O3 -g1 -DNDEBUG")
# Assertions on; optimised as far as sanitizer reports stay readable.
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1")
set(CMAKE_C_FLAGS_SANITIZE "-O1 -g1")

add_library(pursuit_options INTERFACE)
# Nobody asks for errno or traps of arithmetic; without them results are the same, and sooner.
target_compile_options(pursuit_options INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
if("${CMAKE_CXX_FLAGS}" MATCHES "-march=")
    # A build for one processor: what Eigen makes of these two by itself rounds otherwise.
    target_compile_options(pursuit_options INTERFACE -mno-fma -mno-avx512f)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    # Any processor since 2009.
    target_compile_options(pursuit_options INTERFACE -march=x86-64-v2)
endif()
target_include_directories(pursuit_options INTERFACE ${CMAKE_SOURCE_DIR})
if(PURSUIT_SANITIZE)
    target_compile_options(pursuit_options INTERFACE -fsanitize=${PURSUIT_SANITIZE}
                           -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(pursuit_options INTERFACE -fsanitize=${PURSUIT_SANITIZE})
endif()

add_library(pursuit_warnings INTERFACE)
target_compile_options(pursuit_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Werror
                       $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
                       # gcc 12 reports const char* + std::string&& wrongly (its bug 105651).
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

find_program(MOLD_PATH NAMES mold)
if(MOLD_PATH)
    add_link_options(-fuse-ld=mold)
endif()

find_program(CCACHE_PATH NAMES ccache)
if(CCACHE_PATH)
    # Without this, what uses a precompiled header is never found in the cache.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PATH})
endif()

# Most of the time of a clean build goes into the same headers and templates, once for each source
# file; so the files of a target are compiled some at a time, as one. What is local to a file needs
# a name of its own within its target then. A file that cannot join the others is named SEPARATE.
option(PURSUIT_UNITY "Compile several files of a target as one: quicker from clean, slower to repeat" ON)
function(pursuit_unity name sources separate)
    list(FILTER sources EXCLUDE REGEX TARGET_OBJECTS)
    list(LENGTH sources count)
    if(count LESS 2)
        return()
    endif()
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${PURSUIT_UNITY} UNITY_BUILD_BATCH_SIZE 8)
    if(separate)
        set_source_files_properties(${separate} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
endfunction()

# pursuit_library(NAME SOURCES a.cpp … [LIBRARIES x …] [SEPARATE b.cpp …]): a static library of our
# own code.
function(pursuit_library name)
    cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;SEPARATE" ${ARGN})
    add_library(${name} STATIC ${arg_SOURCES} ${arg_SEPARATE})
    pursuit_unity(${name} "${arg_SOURCES}" "${arg_SEPARATE}")
    target_link_libraries(${name} PUBLIC pursuit_options ${arg_LIBRARIES} PRIVATE pursuit_warnings)
endfunction()

# pursuit_executable(NAME SOURCES … [LIBRARIES …] [SEPARATE …]): a program; lands in
# build/<preset>/bin.
function(pursuit_executable name)
    cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;SEPARATE" ${ARGN})
    add_executable(${name} ${arg_SOURCES} ${arg_SEPARATE})
    pursuit_unity(${name} "${arg_SOURCES}" "${arg_SEPARATE}")
    target_link_libraries(${name} PRIVATE pursuit_options pursuit_warnings ${arg_LIBRARIES})
endfunction()

# pursuit_headers(NAME HEADERS <a> … [LIBRARIES …] [OPTIONS …]): headers that cost more to read than
# the files that include them, read once. Targets of the same flags take them by REUSE_FROM.
function(pursuit_headers name)
    cmake_parse_arguments(arg "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
    set(source ${CMAKE_BINARY_DIR}/${name}.cpp)
    if(NOT EXISTS ${source})
        file(WRITE ${source} "")
    endif()
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${source})
    target_link_libraries(${name} PRIVATE pursuit_options pursuit_warnings ${arg_LIBRARIES})
    target_compile_options(${name} PRIVATE ${arg_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
endfunction()

# pursuit_shell(NAME …): targets that talk DDS or read command lines. Their headers cost more than
# they do, and nothing in them loops over events: that is the libraries' work. (At -O1 gcc 12 takes
# an empty std::optional for an uninitialised one, its bug 80635.)
function(pursuit_shell)
    foreach(name ${ARGN})
        target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>
                               $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
        target_precompile_headers(${name} REUSE_FROM pursuit_dds_headers)
    endforeach()
endfunction()

# pursuit_test(NAME SOURCES … [LIBRARIES …] [LABELS …] [SEPARATE …]): a GoogleTest program, one
# ctest entry.
function(pursuit_test name)
    cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;LABELS;SEPARATE" ${ARGN})
    pursuit_executable(${name} SOURCES ${arg_SOURCES} SEPARATE ${arg_SEPARATE}
                       LIBRARIES ${arg_LIBRARIES} GTest::gmock GTest::gtest_main)
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    # What is tested keeps its optimisation; the tests themselves are to be built soon.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    target_precompile_headers(${name} REUSE_FROM pursuit_test_headers)
    if(NOT arg_LABELS)
        set(arg_LABELS unit)
    endif()
    add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT 300)
    if("unit" IN_LIST arg_LABELS)
        add_dependencies(unit_tests ${name})
    endif()
endfunction()
