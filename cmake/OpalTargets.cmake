# Compiler settings that every target of ours shares, and the include rule between the rooms.

find_program(OPAL_CCACHE ccache)
if(OPAL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers are cached only where ccache may ignore their time stamps.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${OPAL_CCACHE})
endif()

add_library(opal_compile_options INTERFACE)
# The host's compiler alone: a device's takes others.
target_compile_options(opal_compile_options INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Werror>"
  # Mathematics without errno and trap semantics vectorizes; values are unchanged.
  "$<$<COMPILE_LANGUAGE:CXX>:-fno-math-errno;-fno-trapping-math;-fopenmp-simd>"
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fpch-preprocess>)

if(OPAL_AVX2 AND EXISTS /proc/cpuinfo)
  file(READ /proc/cpuinfo opal_cpuinfo)
  if(opal_cpuinfo MATCHES "avx2" AND opal_cpuinfo MATCHES "fma")
    target_compile_options(opal_compile_options INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-mavx2;-mfma;-mf16c;-mbmi2>")
  endif()
endif()

if(OPAL_FUZZ)
  # Clang warns of other things than the compiler that the project is written for.
  target_compile_options(opal_compile_options INTERFACE -fsanitize=fuzzer-no-link,address -g1 -Wno-error)
  target_link_options(opal_compile_options INTERFACE -fsanitize=address)
endif()

if(OPAL_SANITIZE)
  # Instrumented, CGAL's optional pairs look uninitialized to GCC 12; the builds without sanitizers keep the warning.
  target_compile_options(opal_compile_options INTERFACE -fsanitize=${OPAL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -Wno-maybe-uninitialized)
  target_link_options(opal_compile_options INTERFACE -fsanitize=${OPAL_SANITIZE})
  if(OPAL_SANITIZE MATCHES "undefined")
    # These cost a third of the time to compile OpenVDB's templates; what they catch ends in a crash that is told all the same.
    target_compile_options(opal_compile_options INTERFACE -fno-sanitize=vptr,null,alignment,object-size)
  endif()
endif()

# opal_expose_headers(TARGET ROOM): makes "ROOM/file.h" includable for TARGET and for whoever links it, and for nobody else. The
# sources stay at the top of the tree; a folder of links, one per room, is what goes on the include path.
function(opal_expose_headers target room)
  set(link_dir ${CMAKE_BINARY_DIR}/include_${room})
  file(MAKE_DIRECTORY ${link_dir})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${room} ${link_dir}/${room} SYMBOLIC)
  target_include_directories(${target} PUBLIC ${link_dir})
endfunction()
