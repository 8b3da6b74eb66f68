# Installs the library for find_package(pillarfield), the programs and the scenes.
include(CMakePackageConfigHelpers)

# pillarfield::pillarfield stands for all floors.
add_library(pillarfield_all INTERFACE)
add_library(pillarfield::pillarfield ALIAS pillarfield_all)
set_target_properties(pillarfield_all PROPERTIES EXPORT_NAME pillarfield)

set(libraries pillarfield_all)
foreach(floor kernels core device io)
  if(TARGET pillarfield_${floor})
    target_link_libraries(pillarfield_all INTERFACE pillarfield_${floor})
    list(APPEND libraries pillarfield_${floor})
  endif()
endforeach()
install(TARGETS ${libraries} EXPORT pillarfield)

foreach(folder host/cli viewer)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder}/CMakeLists.txt)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
      get_target_property(type ${target} TYPE)
      if(type STREQUAL "EXECUTABLE")
        install(TARGETS ${target})
      endif()
    endforeach()
  endif()
endforeach()

install(DIRECTORY host/include/pillarfield "${PROJECT_BINARY_DIR}/include/pillarfield"
  TYPE INCLUDE FILES_MATCHING PATTERN "*.h")
if(EXISTS ${PROJECT_SOURCE_DIR}/scenes)
  install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/pillarfield
    FILES_MATCHING PATTERN "*.toml")
endif()
install(FILES LICENSE TYPE DOC)

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
