# find_package(Cattaneo) for users: targets Cattaneo::core and, where MFEM is found, Cattaneo::cattaneo.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Cattaneo)
set(export_cattaneo_core CattaneoCoreTargets)
set(export_cattaneo CattaneoTargets)
foreach(library IN LISTS libraries)
   install(TARGETS ${library} EXPORT ${export_${library}}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
   install(EXPORT ${export_${library}} NAMESPACE Cattaneo:: DESTINATION ${config_dir})
endforeach()
install(DIRECTORY plugin/cattaneo DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
set(exported_mfem_dir ${MFEM_DIR})
if(bundled_mfem)
   file(RELATIVE_PATH from_config /${config_dir} /${mfem_dir}/lib/cmake/mfem)
   set(exported_mfem_dir "\${CMAKE_CURRENT_LIST_DIR}/${from_config}")
endif()
configure_package_config_file(cmake/CattaneoConfig.cmake.in
   "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfig.cmake" INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfigVersion.cmake"
   COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfig.cmake"
   "${CMAKE_CURRENT_BINARY_DIR}/CattaneoConfigVersion.cmake"
   cmake/FindCHOLMOD.cmake cmake/FindIpopt.cmake cmake/MFEMTarget.cmake DESTINATION ${config_dir})
