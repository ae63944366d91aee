# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` leaves for programs of others: headers below include/cairn, static libraries, CairnConfig.cmake
# and pkg-config files. A component is a few libraries of rooms; find_package(Cairn COMPONENTS client) gives Cairn::client.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(cairn_headers ${CMAKE_INSTALL_INCLUDEDIR}/cairn)
set(cairn_config ${CMAKE_INSTALL_LIBDIR}/cmake/Cairn)
set(cairn_components "")
# From the folder of the .pc files to the prefix: installed files may be moved.
file(RELATIVE_PATH CAIRN_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)

# cairn_component(NAME [NEEDS component…] LIBRARIES cairn_x… HEADERS folder|file… [PACKAGES pkg-config modules…]
#   [IN_HEADERS modules that the headers include…])
function(cairn_component name)
  cmake_parse_arguments(A "" "" "NEEDS;LIBRARIES;HEADERS;PACKAGES;IN_HEADERS" ${ARGN})
  install(TARGETS ${A_LIBRARIES} EXPORT CairnTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  foreach(header IN LISTS A_HEADERS)
    if(header MATCHES "\\.hpp$")
      cmake_path(GET header PARENT_PATH folder)
      install(FILES ${header} DESTINATION ${cairn_headers}/${folder} COMPONENT dev)
    else()
      install(DIRECTORY ${header}/ DESTINATION ${cairn_headers}/${header} COMPONENT dev FILES_MATCHING PATTERN "*.hpp")
    endif()
  endforeach()
  list(TRANSFORM A_LIBRARIES PREPEND "-l" OUTPUT_VARIABLE flags)
  list(JOIN flags " " CAIRN_LIBS)
  list(TRANSFORM A_NEEDS PREPEND "cairn-" OUTPUT_VARIABLE needs)
  list(JOIN needs ", " CAIRN_NEEDS)
  list(JOIN A_IN_HEADERS ", " CAIRN_IN_HEADERS)
  list(JOIN A_PACKAGES ", " CAIRN_PACKAGES)
  set(CAIRN_COMPONENT ${name})
  configure_file(toolchains/cairn.pc.in ${PROJECT_BINARY_DIR}/sdk/cairn-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/sdk/cairn-${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
  set(cairn_components ${cairn_components} ${name} PARENT_SCOPE)
  string(APPEND cairn_parts "set(cairn_needs_${name} ${A_NEEDS})\nset(cairn_libraries_${name} ${A_LIBRARIES})\n")
  set(cairn_parts "${cairn_parts}" PARENT_SCOPE)
endfunction()

cairn_component(hal LIBRARIES cairn_hal HEADERS hal PACKAGES yaml-cpp libcrypto IN_HEADERS eigen3)
cairn_component(client NEEDS hal LIBRARIES cairn_client cairn_clients HEADERS drivers/clients onboard/client PACKAGES libxxhash)
cairn_component(drivers NEEDS client
  LIBRARIES cairn_recording cairn_velodyne cairn_camera cairn_thermal cairn_depth cairn_drive cairn_gpio cairn_peer_link
  HEADERS drivers/velodyne drivers/recording drivers/camera drivers/thermal drivers/depth drivers/drive drivers/gpio
    drivers/peers
  PACKAGES libpcap libgpiod libxxhash)
cairn_component(odometry NEEDS hal LIBRARIES cairn_odometry HEADERS onboard/odometry)
cairn_component(mapping NEEDS hal LIBRARIES cairn_mapping HEADERS onboard/mapping PACKAGES libzstd libxxhash IN_HEADERS octomap)
cairn_component(cameras NEEDS hal LIBRARIES cairn_labelling cairn_people cairn_cameras
  HEADERS onboard/perception/cameras onboard/perception/labelling onboard/perception/people)
cairn_component(networks NEEDS hal LIBRARIES cairn_networks HEADERS onboard/perception/networks)
cairn_component(visual_odometry NEEDS odometry cameras LIBRARIES cairn_visual_odometry cairn_stereo
  HEADERS onboard/visual_odometry onboard/perception/stereo/stereo_geometry.hpp onboard/perception/stereo/stereo_pair.hpp
    onboard/perception/stereo/rectifier.hpp onboard/perception/stereo/dense_stereo.hpp)
cairn_component(robot NEEDS visual_odometry mapping LIBRARIES cairn_robot HEADERS onboard/earlier_maps.hpp onboard/robot.hpp)
cairn_component(fusion NEEDS mapping LIBRARIES cairn_team cairn_matching cairn_merging cairn_peers
  HEADERS fusion/matching fusion/merging fusion/peers fusion/team)

cairn_component(mirror NEEDS client fusion LIBRARIES cairn_client_map)

install(EXPORT CairnTargets NAMESPACE Cairn:: DESTINATION ${cairn_config} COMPONENT dev)
configure_package_config_file(toolchains/CairnConfig.cmake.in ${PROJECT_BINARY_DIR}/sdk/CairnConfig.cmake
  INSTALL_DESTINATION ${cairn_config})
# Before 1.0 any version may change anything.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sdk/CairnConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(toolchains/version.hpp.in ${PROJECT_BINARY_DIR}/sdk/version.hpp @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/sdk/CairnConfig.cmake ${PROJECT_BINARY_DIR}/sdk/CairnConfigVersion.cmake
  toolchains/FindOpenCVMin.cmake DESTINATION ${cairn_config} COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/sdk/version.hpp DESTINATION ${cairn_headers} COMPONENT dev)

# What the programs need beside them, and what a reader wants.
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/cairn/config COMPONENT core
  PATTERN systemd EXCLUDE PATTERN udev EXCLUDE)
# Programs that are not installed find it in the same place beside their own folder.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share/cairn)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/config ${PROJECT_BINARY_DIR}/share/cairn/config SYMBOLIC)
install(DIRECTORY config/systemd/ DESTINATION lib/systemd/system COMPONENT core FILES_MATCHING PATTERN "*.service")
install(DIRECTORY config/udev/ DESTINATION lib/udev/rules.d COMPONENT core FILES_MATCHING PATTERN "*.rules")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev FILES_MATCHING PATTERN "*.md")
