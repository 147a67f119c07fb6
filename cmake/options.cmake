# Compile options of every target of ours. No -march here: kernels pick their instruction set at run time (Highway).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(velour_options INTERFACE)
target_compile_options(velour_options INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Werror
  $<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno>
  # One rounding a written operation, so that inlining cannot change results between builds of one instruction set.
  -ffp-contract=off)
if(VELOUR_SANITIZE)
  target_compile_options(velour_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                  -fno-omit-frame-pointer)
  target_link_options(velour_options INTERFACE -fsanitize=address,undefined)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # Relative to the sources, so that a clone elsewhere finds what was compiled here.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# velour_library(NAME FILES... LINK ...): one folder of native/src, one static library. What a folder may use is what it
# links; scripts/check_layers holds the includes to the same order.
function(velour_library name)
  cmake_parse_arguments(ARG "" "" "FILES;LINK" ${ARGN})
  add_library(velour_${name} STATIC ${ARG_FILES})
  target_link_libraries(velour_${name} PUBLIC ${ARG_LINK} PRIVATE velour_options)
  target_include_directories(velour_${name} PUBLIC ${PROJECT_SOURCE_DIR}/native/src)
  share_precompiled(velour_${name} velour_precompiled)
endfunction()

# velour_test(NAME FILES... LINK ... [LABEL unit|stat|capi]): one GoogleTest program, one ctest entry.
function(velour_test name)
  cmake_parse_arguments(ARG "" "LABEL" "FILES;LINK" ${ARGN})
  add_executable(test_${name} ${ARG_FILES})
  target_link_libraries(test_${name} PRIVATE ${ARG_LINK} velour_test_support GTest::gtest_main velour_options)
  share_precompiled(test_${name} velour_test_support)
  add_test(NAME ${name} COMMAND test_${name})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT 600)
endfunction()
