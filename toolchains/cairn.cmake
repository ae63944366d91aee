# SPDX-License-Identifier: Apache-2.0
# What every target of Cairn is built with, and the four functions that rooms use to declare themselves.
include(CheckCXXCompilerFlag)
include(CheckLinkerFlag)

add_library(cairn_flags INTERFACE)
target_include_directories(cairn_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_features(cairn_flags INTERFACE cxx_std_20)
# Contraction to fused multiply-add changes even OctoMap's own results; replays must match across machines.
target_compile_options(cairn_flags INTERFACE -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow $<$<BOOL:${CAIRN_WERROR}>:-Werror>
  # g++ 12 mistakes std::string's own copies for overlaps and overruns, depending on how long the strings happen to be: even
  # on the path of the source folder (GCC bugs 105651, 105329). clang and AddressSanitizer see the real ones.
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")
# Up to 1 GB, g++ collects no garbage: a tenth of a build's time for 100 MB more. It changes nothing that is compiled.
target_compile_options(cairn_flags INTERFACE
  "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-heapsize=1000000>")

# Hardening: taken where the compiler accepts it (clang 14 rejects the auto-var-init form for zero).
function(cairn_try_compile_flag flag)
  string(MAKE_C_IDENTIFIER "CAIRN_HAS_${flag}" have)
  check_cxx_compiler_flag("-Werror ${flag}" ${have})
  if(${have})
    target_compile_options(cairn_flags INTERFACE ${flag})
  endif()
endfunction()
foreach(flag IN ITEMS -fstack-protector-strong -fstack-clash-protection -ftrivial-auto-var-init=zero)
  cairn_try_compile_flag(${flag})
endforeach()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  cairn_try_compile_flag(-fcf-protection=full)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64")
  cairn_try_compile_flag(-mbranch-protection=standard)
endif()
target_compile_definitions(cairn_flags INTERFACE _GLIBCXX_ASSERTIONS)
if(NOT CAIRN_SANITIZE)
  # The sanitisers see more without the fortified wrappers. -U first: some distributions define it themselves.
  target_compile_options(cairn_flags INTERFACE $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE>
    $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=3>)
endif()
# mold links a program in a fifth of the time of GNU's linker; where it is missing, that one does.
foreach(flag IN ITEMS -fuse-ld=mold -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
  string(MAKE_C_IDENTIFIER "CAIRN_HAS_${flag}" have)
  check_linker_flag(CXX ${flag} ${have})
  if(${have})
    target_link_options(cairn_flags INTERFACE ${flag})
  endif()
endforeach()
if(CAIRN_SANITIZE)
  target_compile_options(cairn_flags INTERFACE -fsanitize=${CAIRN_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(cairn_flags INTERFACE -fsanitize=${CAIRN_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # A relative path, so that ccache knows it in every checkout.
    file(RELATIVE_PATH ignore ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_LIST_DIR}/sanitizer_ignore.txt)
    target_compile_options(cairn_flags INTERFACE -fsanitize-ignorelist=${ignore})
  endif()
endif()

# CAIRN_UNITY compiles up to 16 files of a library (or as many as it says), or 40 of a test program, as one. Their common headers are parsed once, and
# their common templates are instantiated once. The files that include them name paths from the project's root, so that ccache
# knows them in every checkout.
# cairn_compile_alone(FILE…) is for files whose private names (in the unnamed namespace) are those of a neighbour.
function(cairn_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# cairn_unite(TARGET SIZE): up to SIZE files as one, at the end of the folder, when all that compile alone are known.
function(cairn_unite target size)
  if(CAIRN_UNITY)
    cmake_language(EVAL CODE "cmake_language(DEFER CALL cairn_unite_now ${target} ${size})")
  endif()
endfunction()

function(cairn_unite_now target size)
  get_target_property(sources ${target} SOURCES)
  set(alone "")
  set(includes "")
  foreach(source IN LISTS sources)
    get_source_file_property(skip ${source} SKIP_UNITY_BUILD_INCLUSION)
    cmake_path(ABSOLUTE_PATH source NORMALIZE)
    if(skip OR NOT source MATCHES "\\.cpp$")
      list(APPEND alone ${source})
    else()
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      list(APPEND includes "#include \"${source}\"")
    endif()
  endforeach()
  list(LENGTH includes count)
  math(EXPR files "(${count} + ${size} - 1) / ${size}")
  if(count EQUAL 0)
    return()
  endif()
  foreach(file RANGE 1 ${files})
    math(EXPR first "${count} * (${file} - 1) / ${files}")
    math(EXPR length "${count} * ${file} / ${files} - ${first}")
    list(SUBLIST includes ${first} ${length} chunk)
    list(JOIN chunk "\n" text)
    set(united ${CMAKE_CURRENT_BINARY_DIR}/united/${target}_${file}.cpp)
    file(CONFIGURE OUTPUT ${united} CONTENT "${text}\n" @ONLY)
    list(APPEND alone ${united})
  endforeach()
  set_target_properties(${target} PROPERTIES SOURCES "${alone}")
endfunction()

# With CAIRN_UNITY, too: the headers that most files include are parsed once for all targets that are compiled alike. These
# are headers of the system alone. Their paths are the same in every checkout, so ccache finds what was compiled with them.
set(cairn_headers_of_library <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
  <numbers> <optional> <random> <ranges> <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector>
  <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry> <Eigen/LU>)
set(cairn_headers_of_program ${cairn_headers_of_library})
set(cairn_headers_of_test ${cairn_headers_of_library} <gmock/gmock.h> <gtest/gtest.h>)

# cairn_precompile(TARGET KIND): TARGET takes the headers of its kind: library, program or test.
function(cairn_precompile target kind)
  # clang's precompiled headers hold the checkout's path, so ccache would find nothing of another checkout. They save a
  # second of each file; finding it saves all of them.
  if(NOT CAIRN_UNITY OR CMAKE_CXX_COMPILER_ID MATCHES Clang)
    return()
  endif()
  set(headers cairn_${kind}_headers)
  if(NOT TARGET ${headers})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${headers}.cpp CONTENT "int main() {}\n")
    if(kind STREQUAL library)
      add_library(${headers} STATIC ${PROJECT_BINARY_DIR}/${headers}.cpp)
    else()
      add_executable(${headers} ${PROJECT_BINARY_DIR}/${headers}.cpp)
    endif()
    target_link_libraries(${headers} PRIVATE cairn_flags Eigen3::Eigen)
    target_precompile_headers(${headers} PRIVATE ${cairn_headers_of_${kind}})
    if(kind STREQUAL test)
      cairn_compile_as_test(${headers})
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

# What is tested is optimised; optimising (and, for the fuzzer, counting) the tests themselves would take half of the whole
# build's time. What tests spend their own time with is in libraries of tests/support. Without any optimisation the linker
# would take slow copies of what both have inline, unless the libraries come first: mold takes the first copy, and finds
# what it needs in any order. clang with the sanitisers then needs 40 % of the time; g++ gains nothing.
function(cairn_compile_as_test target)
  target_link_libraries(${target} PRIVATE GTest::gmock GTest::gtest_main)
  set(level -O1)
  if(CAIRN_FUZZ)
    target_link_libraries(${target} PRIVATE cairn_uncounted)
    if(CAIRN_HAS__fuse_ld_mold)
      set(level -O0)
    endif()
  endif()
  target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:${level}>)
endfunction()
if(CAIRN_FUZZ)
  # A library, so that its option comes after -fsanitize of cairn_flags.
  add_library(cairn_uncounted INTERFACE)
  target_compile_options(cairn_uncounted INTERFACE -fno-sanitize=fuzzer-no-link)
endif()

# What replaces operator new must not be inlined into its neighbours: g++ then takes new and free for a mismatch.
function(cairn_compile_allocators_alone)
  foreach(source IN LISTS ARGN)
    if(source MATCHES "allocation_count.cpp$")
      cairn_compile_alone(${source})
    endif()
  endforeach()
endfunction()

# cairn_library(NAME [UNITE n] SOURCES … [PUBLIC lib …] [PRIVATE lib …]): the static library cairn_NAME of one room. With
# CAIRN_UNITY up to n of its files are compiled as one.
function(cairn_library name)
  cmake_parse_arguments(A "" "UNITE" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(NOT A_UNITE)
    set(A_UNITE 16)
  endif()
  add_library(cairn_${name} STATIC ${A_SOURCES})
  # Programs of others get the headers and the language, and neither our warnings nor our hardening.
  target_link_libraries(cairn_${name} PUBLIC $<BUILD_INTERFACE:cairn_flags> ${A_PUBLIC} PRIVATE ${A_PRIVATE})
  target_compile_features(cairn_${name} PUBLIC cxx_std_20)
  target_include_directories(cairn_${name} SYSTEM INTERFACE $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/cairn>)
  cairn_unite(cairn_${name} ${A_UNITE})
  cairn_precompile(cairn_${name} library)
endfunction()

# cairn_dds_types(NAME [NO_TYPE_INFO] FILES …): the static library cairn_NAME of what idlc makes of IDL files: C, compiled
# without our warnings. CycloneDDS's own idlc_generate() writes the paths of the checkout into them, so ccache would find
# in no other checkout what includes them. NO_TYPE_INFO: without XTypes.
find_program(CAIRN_IDLC idlc NO_CMAKE_FIND_ROOT_PATH REQUIRED)
function(cairn_dds_types name)
  cmake_parse_arguments(A "NO_TYPE_INFO" "" "FILES" ${ARGN})
  add_library(cairn_${name} STATIC)
  foreach(file IN LISTS A_FILES)
    cmake_path(GET file STEM stem)
    cmake_path(ABSOLUTE_PATH file)
    add_custom_command(OUTPUT ${stem}.c ${stem}.h
      COMMAND ${CAIRN_IDLC} $<$<BOOL:${A_NO_TYPE_INFO}>:-t> -o . ${file}
      COMMAND sed -i "/^  Source: /d" ${stem}.c ${stem}.h
      DEPENDS ${file} WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} COMMAND_EXPAND_LISTS VERBATIM)
    target_sources(cairn_${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${stem}.c)
  endforeach()
  target_link_libraries(cairn_${name} PRIVATE cairn_flags PUBLIC CycloneDDS::ddsc)
  target_compile_options(cairn_${name} PRIVATE -w)
  target_include_directories(cairn_${name} SYSTEM PUBLIC ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# cairn_test(NAME SOURCES … [LINK lib …]): one GoogleTest program test_NAME; ctest lists its cases. Suites whose names
# begin with Full get the label slow: what takes too long for every change.
function(cairn_test name)
  cmake_parse_arguments(A "" "" "SOURCES;LINK" ${ARGN})
  cairn_compile_allocators_alone(${A_SOURCES})
  add_executable(test_${name} ${A_SOURCES})
  target_link_libraries(test_${name} PRIVATE cairn_flags cairn_places cairn_test_worlds ${A_LINK})
  cairn_compile_as_test(test_${name})
  cairn_unite(test_${name} 40)
  cairn_precompile(test_${name} test)
  # The time limits are for what hangs: no test may fail because a machine is slow.
  set(how TEST_PREFIX "${name}/" NO_PRETTY_VALUES DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 300)
  gtest_discover_tests(test_${name} ${how} TEST_FILTER -Full* PROPERTIES TIMEOUT 900)
  gtest_discover_tests(test_${name} ${how} TEST_FILTER Full* TEST_LIST test_${name}_SLOW PROPERTIES TIMEOUT 3600 LABELS slow)
endfunction()

# cairn_fuzz(NAME SOURCE [LARGE] [LINK lib …]): a libFuzzer target fuzz_NAME. Without CAIRN_FUZZ the same entry point runs
# over the corpus in tests/fuzz/corpus/NAME and over damaged copies of it, as an ordinary test with any compiler. The target
# fuzzers is those of the readers, for every change. LARGE ones need large libraries, which take minutes to compile with the
# sanitisers: all_fuzzers has them, too. tools/ci/fuzz.sh finds the names of both in build/fuzz.
add_custom_target(fuzzers)
add_custom_target(all_fuzzers)
add_dependencies(all_fuzzers fuzzers)
file(WRITE ${PROJECT_BINARY_DIR}/fuzzers.txt "")
file(WRITE ${PROJECT_BINARY_DIR}/all_fuzzers.txt "")
function(cairn_fuzz name source)
  cmake_parse_arguments(A "LARGE" "" "LINK" ${ARGN})
  set(corpus ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus/${name})
  if(CAIRN_FUZZ)
    add_executable(fuzz_${name} ${source})
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  else()
    add_executable(fuzz_${name} ${source})
    target_link_libraries(fuzz_${name} PRIVATE cairn_fuzz_replay)
    add_test(NAME fuzz_corpus/${name} COMMAND fuzz_${name} ${corpus})
    set_tests_properties(fuzz_corpus/${name} PROPERTIES TIMEOUT 900)
  endif()
  target_link_libraries(fuzz_${name} PRIVATE cairn_flags ${A_LINK})
  cairn_precompile(fuzz_${name} program)
  file(APPEND ${PROJECT_BINARY_DIR}/all_fuzzers.txt "${name}\n")
  if(A_LARGE)
    add_dependencies(all_fuzzers fuzz_${name})
  else()
    file(APPEND ${PROJECT_BINARY_DIR}/fuzzers.txt "${name}\n")
    add_dependencies(fuzzers fuzz_${name})
  endif()
endfunction()

# cairn_bench(NAME SOURCES … [LINK lib …]): a Google Benchmark program bench_NAME; the target benchmarks is all of them.
add_custom_target(benchmarks)
function(cairn_bench name)
  cmake_parse_arguments(A "" "" "SOURCES;LINK" ${ARGN})
  cairn_compile_allocators_alone(${A_SOURCES})
  add_executable(bench_${name} ${A_SOURCES})
  target_link_libraries(bench_${name} PRIVATE cairn_flags cairn_places cairn_test_worlds ${A_LINK} benchmark::benchmark)
  add_dependencies(benchmarks bench_${name})
endfunction()

# cairn_quality(NAME SOURCES … [LINK lib …]): a program that measures quality rather than time; the target quality is all of
# them.
add_custom_target(quality)
function(cairn_quality name)
  cmake_parse_arguments(A "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE cairn_flags cairn_places cairn_test_worlds ${A_LINK})
  add_dependencies(quality ${name})
endfunction()
