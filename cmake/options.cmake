# Compile options of all our targets. No -march here: kernels pick their instruction set at run time (Highway).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(velour_options INTERFACE)
target_compile_options(velour_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Werror
  # Clang's -Wshadow also reports names of other sources that are compiled as one with a source (join_sources).
  $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>
  $<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno>
  # Symbols are hidden by version scripts, not here: native/tests links a library that exports all of them.
  -fno-semantic-interposition
  # Round after every written operation, so that inlining cannot change results between builds for one instruction set.
  -ffp-contract=off)
if(VELOUR_FUZZ)
  target_compile_options(velour_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(velour_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(VELOUR_SANITIZE)
  target_compile_options(velour_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                  -fno-omit-frame-pointer)
  target_link_options(velour_options INTERFACE -fsanitize=address,undefined)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # Cache paths relative to the sources, so that clones in other folders share the results. ccache's manual asks for the
  # sloppiness and -fpch-preprocess where headers are precompiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# join_sources(TARGET BATCH FILES...): compiles up to BATCH sources as one translation unit (a CMake unity build), which
# halves compile time: headers are parsed and templates instantiated once. Names in anonymous namespaces and static
# names must therefore be unique within a folder, and a type in an anonymous namespace cannot be a member of a type that
# a header declares. Sources that define macros, as Highway's kernels do, stay separate.
function(join_sources target batch)
  list(FILTER ARGN INCLUDE REGEX "\\.cpp$")
  foreach(source ${ARGN})
    file(STRINGS ${source} macros REGEX "^#(define|include <hwy/foreach_target)" LIMIT_COUNT 1)
    if(macros)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
endfunction()

# velour_layer(FOLDER LAYERS ...): builds a folder of native/src as a static library, velour_FOLDER with _ for /; the other
# arguments are described in native/src/layers.cmake. Folders with a CMakeLists.txt inside it build themselves. The C
# interface is built from objects.
function(velour_layer folder layers)
  cmake_parse_arguments(ARG "" "BATCH" "BELOW;LIBRARIES" ${ARGN})
  if(NOT ARG_BATCH)
    set(ARG_BATCH 8)
  endif()
  set(source ${PROJECT_SOURCE_DIR}/native/src)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${source}/${folder}/*.cpp)
  file(GLOB_RECURSE lists RELATIVE ${source} ${source}/${folder}/*/CMakeLists.txt)
  list(TRANSFORM lists REPLACE "/CMakeLists.txt$" "")
  foreach(other ${layers} ${lists})
    if(other MATCHES "^${folder}/")
      list(FILTER files EXCLUDE REGEX "/native/src/${other}/")
    endif()
  endforeach()
  string(REPLACE "/" "_" name ${folder})
  if(folder STREQUAL capi)
    add_library(velour_${name} OBJECT ${files})
  else()
    add_library(velour_${name} STATIC ${files})
  endif()
  join_sources(velour_${name} ${ARG_BATCH} ${files})
  list(TRANSFORM ARG_BELOW REPLACE "/" "_")
  list(TRANSFORM ARG_BELOW PREPEND velour_)
  target_link_libraries(velour_${name} PUBLIC ${ARG_BELOW} ${ARG_LIBRARIES} PRIVATE velour_options)
  target_include_directories(velour_${name} PUBLIC ${source})
  share_precompiled(velour_${name} velour_precompiled)
endfunction()

# velour_test(NAME FILES... [LINK ...] [LABEL unit|stat|capi] [OPTIMIZE]): one GoogleTest program and its ctest entry,
# for all tests of a folder, since most of the time is that of headers and templates. Each file has a namespace of its
# own, named after the file. Test programs are compiled without optimization, which halves their compile time: a test
# should spend its time in the library. OPTIMIZE: for test programs that do much computation themselves.
function(velour_test name)
  cmake_parse_arguments(ARG "OPTIMIZE" "LABEL" "FILES;LINK" ${ARGN})
  add_executable(test_${name} ${ARG_FILES})
  join_sources(test_${name} 16 ${ARG_FILES})
  target_link_libraries(test_${name} PRIVATE ${ARG_LINK} velour_test_support GTest::gtest_main velour_options)
  if(ARG_OPTIMIZE)
    target_link_libraries(test_${name} PRIVATE velour_optimized)
    share_precompiled(test_${name} velour_test_support)
  else()
    target_link_libraries(test_${name} PRIVATE velour_unoptimized)
    share_precompiled(test_${name} velour_test_precompiled)
  endif()
  add_test(NAME ${name} COMMAND test_${name})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 600)
endfunction()
