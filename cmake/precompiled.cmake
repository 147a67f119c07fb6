# Precompiles the headers that most files include: parsing them takes two thirds of the compile time otherwise.
set(velour_common_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <mutex>
                          <numeric> <optional> <span> <string> <thread> <vector> <glm/glm.hpp> <Eigen/Cholesky>
                          <tbb/parallel_for.h> <tbb/task_arena.h>)

# Precompiled headers of the library. Takes the include folders of dependencies without linking them: their macros would
# otherwise be required of every target that reuses the headers.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
add_library(velour_precompiled OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
foreach(library glm::glm Eigen3::Eigen TBB::tbb)
  target_include_directories(velour_precompiled SYSTEM PRIVATE
                             $<TARGET_GENEX_EVAL:${library},$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>>)
endforeach()
target_link_libraries(velour_precompiled PRIVATE velour_options)
target_precompile_headers(velour_precompiled PRIVATE ${velour_common_headers})
# GCC 12 does not treat precompiled headers as system headers and reports false overruns in std::string.
target_compile_options(velour_options INTERFACE -Wno-array-bounds $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>)
# Each garbage collection of GCC marks all precompiled headers. Heap size before the first one, in KiB: 1 GiB.
target_compile_options(velour_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
if(CCACHE) # as its manual asks for
  target_compile_options(velour_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>
                         $<$<CXX_COMPILER_ID:Clang>:-Xclang$<SEMICOLON>-fno-pch-timestamp>)
endif()

# share_precompiled(TARGET WITH): reuses the precompiled headers of WITH.
function(share_precompiled target with)
  target_precompile_headers(${target} REUSE_FROM ${with})
endfunction()
