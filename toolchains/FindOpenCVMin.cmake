# SPDX-License-Identifier: Apache-2.0
# Finds OpenCV module by module, as targets opencv::NAME. Debian has OpenCVConfig.cmake only in libopencv-dev, which depends
# on every module with VTK, HDF5 and MPI. This file needs only the packages of the modules that are asked for.
#   find_package(OpenCVMin REQUIRED COMPONENTS core imgproc [OPTIONAL_COMPONENTS videoio])
find_path(OpenCVMin_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
foreach(component IN LISTS OpenCVMin_FIND_COMPONENTS)
  find_library(OpenCVMin_${component}_LIBRARY opencv_${component})
  if(OpenCVMin_${component}_LIBRARY AND OpenCVMin_INCLUDE_DIR)
    set(OpenCVMin_${component}_FOUND TRUE)
    if(NOT TARGET opencv::${component})
      add_library(opencv::${component} UNKNOWN IMPORTED)
      set_target_properties(opencv::${component} PROPERTIES IMPORTED_LOCATION "${OpenCVMin_${component}_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${OpenCVMin_INCLUDE_DIR}")
    endif()
  endif()
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVMin REQUIRED_VARS OpenCVMin_INCLUDE_DIR HANDLE_COMPONENTS)
