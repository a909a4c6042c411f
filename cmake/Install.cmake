# find_package(Cattaneo) for users: targets Cattaneo::cattaneo and, without MFEM, Cattaneo::core.
include(CMakePackageConfigHelpers)
install(TARGETS ${libraries} EXPORT CattaneoTargets
   ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY plugin/cattaneo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Cattaneo)
install(EXPORT CattaneoTargets NAMESPACE Cattaneo:: DESTINATION ${config_dir})
configure_package_config_file(cmake/CattaneoConfig.cmake.in
   "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfig.cmake" INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfigVersion.cmake"
   COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfig.cmake"
   "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfigVersion.cmake"
   cmake/FindCHOLMOD.cmake cmake/FindIpopt.cmake cmake/MFEMTarget.cmake DESTINATION ${config_dir})
