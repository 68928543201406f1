include(CMakePackageConfigHelpers)
set(SCALEFCN_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/scalefcn)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/scalefcnConfig.cmake.in
    ${PROJECT_BINARY_DIR}/scalefcnConfig.cmake INSTALL_DESTINATION ${SCALEFCN_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/scalefcnConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(EXPORT scalefcnTargets NAMESPACE scalefcn:: DESTINATION ${SCALEFCN_CONFIG_DIR})
install(FILES ${PROJECT_BINARY_DIR}/scalefcnConfig.cmake
              ${PROJECT_BINARY_DIR}/scalefcnConfigVersion.cmake
        DESTINATION ${SCALEFCN_CONFIG_DIR})
