# Installs the library so that find_package(quadseg) and pkg-config find it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS quadseg EXPORT quadsegTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/quadseg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/tools/result.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/quadseg)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/quadseg)
install(EXPORT quadsegTargets NAMESPACE quadseg:: DESTINATION ${config_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/cmake/quadsegConfig.cmake.in
    ${PROJECT_BINARY_DIR}/quadsegConfig.cmake INSTALL_DESTINATION ${config_folder})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/quadsegConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/quadsegConfig.cmake ${PROJECT_BINARY_DIR}/quadsegConfigVersion.cmake
    DESTINATION ${config_folder})

# A static library leaves its dependencies to its user.
if(NOT BUILD_SHARED_LIBS)
    set(QUADSEG_PC_LIBS "-ltbb")
endif()
# Relative to itself, so that an installation may be staged or moved.
file(RELATIVE_PATH QUADSEG_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/tools/cmake/quadseg.pc.in ${PROJECT_BINARY_DIR}/quadseg.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/quadseg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
