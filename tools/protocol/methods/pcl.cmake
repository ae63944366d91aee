# SPDX-License-Identifier: Apache-2.0
# PCL 1.13 as Debian 12 has it: headers as tools/protocol.sh unpacked them, or installed; libraries by the names that need
# no -dev package.
set(unpacked ${PROJECT_BINARY_DIR}/pcl/usr/include)
find_path(PCL_HEADERS pcl/pcl_macros.h PATHS ${unpacked}/pcl-1.13 /usr/include/pcl-1.13 NO_DEFAULT_PATH REQUIRED)
find_path(FLANN_HEADERS flann/flann.hpp PATHS ${unpacked} /usr/include NO_DEFAULT_PATH REQUIRED)
add_executable(pcl_baselines methods/pcl_baselines.cpp)
target_include_directories(pcl_baselines SYSTEM PRIVATE ${PCL_HEADERS} ${FLANN_HEADERS})
foreach(part IN ITEMS registration features filters search kdtree octree sample_consensus common)
  find_library(PCL_${part} NAMES libpcl_${part}.so.1.13 REQUIRED)
  target_link_libraries(pcl_baselines PRIVATE ${PCL_${part}})
endforeach()
find_library(FLANN NAMES libflann_cpp.so.1.9 REQUIRED)
target_compile_options(pcl_baselines PRIVATE -Wno-maybe-uninitialized)  # inside of Eigen, by way of PCL
target_link_libraries(pcl_baselines PRIVATE cairn_protocol ${FLANN})
