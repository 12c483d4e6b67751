# Compiles a source for an instruction set; see engine/core/instruction_set.hpp. Kernels are optimised in every build, for
# their inline functions must not come out of line. They are straight-line arithmetic, which the sanitizers take many
# minutes to instrument, so only what calls them is. Orders and lanes are ints there. GCC 12 takes the undefined operand
# inside some AVX-512 intrinsics for a mistake of ours, and orders the series' long straight lines better before it hands
# out registers, minding how many there are, than after: a twentieth more trials a second. Its vectoriser of straight
# lines may drop a rounding to single precision and back, which the portable pack has (tests/core sees it).
#
#   steerstat_kernels(STEM SOURCES_VARIABLE)   appends STEM_avx512.cpp and so on, those this processor family may have
function(steerstat_kernels stem sources)
  set(flags -O3 -Wno-sign-conversion -Wno-uninitialized -Wno-maybe-uninitialized)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND flags -fschedule-insns -fsched-pressure)
  endif()
  if(STEERSTAT_SANITIZE)
    list(APPEND flags -fno-sanitize=all)
  endif()
  set(portable_flags ${flags} -fno-tree-slp-vectorize)
  set(kernels ${stem}_portable.cpp)
  set_source_files_properties(${stem}_portable.cpp PROPERTIES COMPILE_OPTIONS "${portable_flags}")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND flags -mavx2 -mfma -mbmi2)
    list(APPEND kernels ${stem}_avx2.cpp)
    set_source_files_properties(${stem}_avx2.cpp PROPERTIES COMPILE_OPTIONS "${flags}")
    list(APPEND flags -mavx512f -mavx512dq -mavx512vl -mavx512bw)
    list(APPEND kernels ${stem}_avx512.cpp)
    set_source_files_properties(${stem}_avx512.cpp PROPERTIES COMPILE_OPTIONS "${flags}")
  endif()
  set(${sources} ${${sources}} ${kernels} PARENT_SCOPE)
endfunction()
