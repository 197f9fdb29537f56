# The three functions every folder uses. A module is a static library of the sources in its folder's rooms; its tests and
# benchmarks are the files in the folder of the same name under tests/ and bench/:
#   tests/NAME/*_test.cpp  the quick ones, label `unit`, or `scene` where whole scenes are compiled and run
#   tests/NAME/*_soak.cpp  the long ones, in parts (tests/soak.toml), run by `./test.sh soak PART`
#   bench/NAME/*_bench.cpp
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
# Optimised and debuggable, with assertions (CMake's own default would add -DNDEBUG).
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g")

find_program(TROCAR_CCACHE ccache)
if(TROCAR_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)  # the sloppiness is what lets it keep objects made with a PCH
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${TROCAR_CCACHE})
endif()

# Determinism law: no fused multiply-add unless written, no fast-math, errno and traps are nobody's business.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math
                    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
                    -fdiagnostics-color=auto)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # gcc 12 warns of members of temporaries in initializer lists (throw BadInput({{{path, 1, 1}, text}})) that are set.
  add_compile_options(-Wno-maybe-uninitialized)
endif()
if(TROCAR_MARCH)
  add_compile_options(-march=${TROCAR_MARCH})
endif()
if(TROCAR_SANITIZE)
  add_compile_options(-fsanitize=${TROCAR_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TROCAR_SANITIZE})
  add_compile_definitions(TROCAR_SANITIZED)
endif()

if(TROCAR_FUZZ)  # coverage for libFuzzer in every module; what is undefined in conversions counts, too
  # An input takes little longer with -O1, and the build half as long.
  add_compile_options(-O1 -gline-tables-only -fsanitize=fuzzer-no-link,float-cast-overflow -fno-sanitize-recover=all -D_GLIBCXX_ASSERTIONS)
endif()

# Text output. Debian compiles fmt and spdlog for libstdc++, so with libc++ only their headers are used.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
add_library(trocar_text INTERFACE)
if(TROCAR_LIBCXX)
  add_compile_options(-stdlib=libc++)
  add_link_options(-stdlib=libc++)
  target_compile_definitions(trocar_text INTERFACE FMT_HEADER_ONLY=1 SPDLOG_FMT_EXTERNAL)
else()
  target_link_libraries(trocar_text INTERFACE fmt::fmt spdlog::spdlog)
endif()

# What takes longest to read is read once a target: the JSON library, text, and with COMMAND_LINE its parser. Optimising
# what runs once a second or once an attempt, or a test's own lines, is not worth the minutes either.
function(trocar_quick_options target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()
function(trocar_quick_build target)
  cmake_parse_arguments(arg "COMMAND_LINE" "" "" ${ARGN})
  target_precompile_headers(${target} PRIVATE <nlohmann/json.hpp> <fmt/format.h> <algorithm> <array> <filesystem>
                            <functional> <map> <memory> <optional> <span> <string> <vector>
                            $<$<BOOL:${arg_COMMAND_LINE}>:<CLI/CLI.hpp$<ANGLE-R>>)
  trocar_quick_options(${target})
endfunction()

# Reading headers is most of a build from nothing, so that a preset may have source files compiled in groups. Then the names
# that a folder's files have for themselves must differ; files with options of their own are set apart. A neighbour's name
# that a member or a local hides is a warning to clang alone: whether a file hides its own is told where it stands alone.
function(trocar_group target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TROCAR_GROUPED} UNITY_BUILD_BATCH_SIZE 20)
  if(TROCAR_GROUPED)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
  endif()
endfunction()

# trocar_embed(TARGET HEADER NAMESPACE TYPE FUNCTION file...): the files' texts become a part of the library, in a source
# file made by the build that defines `std::span<const TYPE> FUNCTION()` of HEADER (a TYPE is {name, text}).
function(trocar_embed target header namespace type function)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  string(REPLACE ";" "," list "${ARGN}")
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DFILES=${list}" -DOUTPUT=${output} -DHEADER=${header} -DNAMESPACE=${namespace}
            -DTYPE=${type} -DFUNCTION=${function} -P ${PROJECT_SOURCE_DIR}/cmake/embed_texts.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed_texts.cmake
    COMMENT "Embedding texts: ${function}"
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()

# trocar_module(NAME [DEPENDS module...] [LIBS target...])
function(trocar_module name)
  cmake_parse_arguments(arg "" "" "DEPENDS;LIBS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  set(target trocar_${name})
  list(TRANSFORM arg_DEPENDS PREPEND trocar_)
  if(sources)
    add_library(${target} STATIC ${sources})
    target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target} PUBLIC ${arg_DEPENDS} ${arg_LIBS})
    trocar_group(${target})
    set_property(GLOBAL APPEND PROPERTY TROCAR_MODULES ${name})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target} INTERFACE ${arg_DEPENDS} ${arg_LIBS})
  endif()
endfunction()

# Entries of ctest for an executable of GoogleTest cases: one for all of them, so that what they share (a compiled scene)
# is made once; or, where that takes long, SHARDS that run beside each other. Results go to test-results/ENTRY.json.
# SECONDS is about how long it takes: the longest begin first, so that none is left to run alone at the end.
function(trocar_test_entries target name label shards seconds_about)
  set(seconds 1800)
  foreach(shard RANGE 1 ${shards})
    set(entry ${name})
    if(shards GREATER 1)
      set(entry ${name}.${shard})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${entry} COMMAND ${target})
    set(environment GTEST_BRIEF=1 GTEST_OUTPUT=json:${PROJECT_BINARY_DIR}/test-results/${entry}.json
                    GTEST_TOTAL_SHARDS=${shards} GTEST_SHARD_INDEX=${index} TROCAR_TEST_SECONDS=${seconds})
    math(EXPR killed "${seconds} + 60")
    set_tests_properties(${entry} PROPERTIES LABELS ${label} TIMEOUT ${killed} COST ${seconds_about}
                                               ENVIRONMENT "${environment}")
  endforeach()
  set_property(GLOBAL APPEND PROPERTY TROCAR_TEST_TARGETS ${target})
endfunction()

# One executable of GoogleTest cases.
function(trocar_test_executable target sources depends libs)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE ${depends} ${libs} trocar_test_main)
  target_precompile_headers(${target} REUSE_FROM trocar_test_main)
  trocar_quick_options(${target})
  file(RELATIVE_PATH built ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR})  # tests/main.cpp goes to the source folder
  target_compile_definitions(${target} PRIVATE TROCAR_SOURCE_DIR="." TROCAR_BINARY_DIR="${built}")
endfunction()

# trocar_test(NAME [GROUPED] DEPENDS module... [LIBS target...] [LABEL unit|scene] [SHARDS n] [SECONDS n]):
#   tests/NAME/*_test.cpp -> NAME_test, entry NAME (NAME.1, NAME.2, ... of several shards) under LABEL
#   tests/NAME/*_soak.cpp -> NAME_soak, whose cases are in parts of tests/soak.toml (tools/soak.py)
function(trocar_test name)
  cmake_parse_arguments(arg "GROUPED" "LABEL;SHARDS;SECONDS" "DEPENDS;LIBS" ${ARGN})
  list(TRANSFORM arg_DEPENDS PREPEND trocar_)
  file(GLOB quick CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  file(GLOB soak CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_soak.cpp)
  foreach(given LABEL=unit SHARDS=1 SECONDS=1)
    string(REPLACE "=" ";" given ${given})
    list(GET given 0 key)
    if(NOT arg_${key})
      list(GET given 1 arg_${key})
    endif()
  endforeach()
  if(quick)
    trocar_test_executable(${name}_test "${quick}" "${arg_DEPENDS}" "${arg_LIBS}")
    if(arg_GROUPED)
      trocar_group(${name}_test)
      if(TROCAR_GROUPED)  # a neighbour's names are hidden, a fixture's file is not where it ends: each file alone is told
        target_compile_options(${name}_test PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
      endif()
    endif()
    trocar_test_entries(${name}_test ${name} ${arg_LABEL} ${arg_SHARDS} ${arg_SECONDS})
  endif()
  if(soak)
    trocar_test_executable(${name}_soak "${soak}" "${arg_DEPENDS}" "${arg_LIBS}")
    set_target_properties(${name}_soak PROPERTIES EXCLUDE_FROM_ALL TRUE)  # minutes; `./test.sh soak` builds them
    if(NOT TARGET soak_programs)
      add_custom_target(soak_programs)
    endif()
    add_dependencies(soak_programs ${name}_soak)
  endif()
endfunction()

# trocar_bench(NAME DEPENDS module... [LIBS ...]): bench/NAME/*_bench.cpp -> NAME_bench
function(trocar_bench name)
  cmake_parse_arguments(arg "" "" "DEPENDS;LIBS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_bench.cpp)
  if(NOT sources)
    return()
  endif()
  list(TRANSFORM arg_DEPENDS PREPEND trocar_)
  add_executable(${name}_bench ${sources})
  target_link_libraries(${name}_bench PRIVATE ${arg_DEPENDS} ${arg_LIBS} benchmark::benchmark_main)
endfunction()
