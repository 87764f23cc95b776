# The CUDA backend of opal-render: built where there is a CUDA compiler, missed by nobody where there is none.

set(OPAL_CUDA AUTO CACHE STRING "CUDA backend of opal-render: ON, OFF, or AUTO: where a CUDA compiler is found")
set_property(CACHE OPAL_CUDA PROPERTY STRINGS AUTO ON OFF)

set(OPAL_HAS_CUDA OFF)
if(OPAL_CUDA STREQUAL "ON" OR (OPAL_CUDA STREQUAL "AUTO" AND NOT OPAL_SANITIZE AND NOT OPAL_FUZZ))
  # Turing, Ampere (whose code Ada runs as well), Hopper, and code that later devices translate for themselves. The environment's
  # CUDAARCHS goes before.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
    set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90)
  endif()
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    # CMake 3.25 does not know how newer compilers are told the standard.
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    endif()
    find_package(CUDAToolkit REQUIRED)
    if(OPAL_CCACHE AND NOT CMAKE_CUDA_COMPILER_LAUNCHER)
      set(CMAKE_CUDA_COMPILER_LAUNCHER ${OPAL_CCACHE})
    endif()
    set(OPAL_HAS_CUDA ON)
  elseif(OPAL_CUDA STREQUAL "ON")
    message(FATAL_ERROR "OPAL_CUDA=ON, but no CUDA compiler was found (nvcc on PATH, or CUDACXX)")
  endif()
endif()
message(STATUS "CUDA backend: ${OPAL_HAS_CUDA}")
