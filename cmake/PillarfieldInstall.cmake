# Installs the library for find_package(pillarfield), the program and the scenes.
include(CMakePackageConfigHelpers)

# pillarfield::pillarfield links all layers.
add_library(pillarfield_all INTERFACE)
add_library(pillarfield::pillarfield ALIAS pillarfield_all)
set_target_properties(pillarfield_all PROPERTIES EXPORT_NAME pillarfield)

foreach(layer kernels core device io streams pipeline)
  target_link_libraries(pillarfield_all INTERFACE pillarfield_${layer})
  install(TARGETS pillarfield_${layer} EXPORT pillarfield)
endforeach()
install(TARGETS pillarfield_all EXPORT pillarfield)
install(TARGETS pillarfield)

install(DIRECTORY host/include/pillarfield "${PROJECT_BINARY_DIR}/include/pillarfield"
  TYPE INCLUDE FILES_MATCHING PATTERN "*.h")
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/pillarfield
  FILES_MATCHING PATTERN "*.toml" PATTERN "*.png")
install(FILES LICENSE TYPE DOC)
install(DIRECTORY examples TYPE DOC)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pillarfield)
install(EXPORT pillarfield NAMESPACE pillarfield:: FILE pillarfieldTargets.cmake
  DESTINATION ${package_folder})
configure_package_config_file(cmake/pillarfieldConfig.cmake.in
  "${PROJECT_BINARY_DIR}/pillarfieldConfig.cmake" INSTALL_DESTINATION ${package_folder})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pillarfieldConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/pillarfieldConfig.cmake"
  "${PROJECT_BINARY_DIR}/pillarfieldConfigVersion.cmake" DESTINATION ${package_folder})
