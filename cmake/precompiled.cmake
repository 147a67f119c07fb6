# What most files include is parsed once: without it that is two thirds of the time that compiling takes. Not beside a compiler
# cache, which does better and cannot know such a file again in another folder; it also is what notices a header that a file forgot.
set(velour_common_headers <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <mutex>
                          <numeric> <optional> <span> <string> <thread> <vector> <glm/glm.hpp> <Eigen/Cholesky>
                          <tbb/parallel_for.h> <tbb/task_arena.h>)

# Of the library. By folders, not linked: what defines macros would bind all who share it to them.
if(NOT CCACHE)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
  add_library(velour_precompiled OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  foreach(library glm::glm Eigen3::Eigen TBB::tbb)
    target_include_directories(velour_precompiled SYSTEM PRIVATE
                               $<TARGET_GENEX_EVAL:${library},$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>>)
  endforeach()
  target_link_libraries(velour_precompiled PRIVATE velour_options)
  target_precompile_headers(velour_precompiled PRIVATE ${velour_common_headers})
  # GCC 12 forgets that such headers are the system's, and finds overruns in std::string where there are none.
  target_compile_options(velour_options INTERFACE -Wno-array-bounds $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>)
  # GCC would mark the whole of the precompiled headers at each garbage collection. In KiB: none below a gigabyte.
  target_compile_options(velour_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1048576>)
endif()

# share_precompiled(TARGET WITH): uses the headers that WITH has precompiled.
function(share_precompiled target with)
  if(NOT CCACHE)
    target_precompile_headers(${target} REUSE_FROM ${with})
  endif()
endfunction()
