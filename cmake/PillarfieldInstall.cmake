# Installs programs, the library for find_package(pillarfield) and pkg-config, pages and scenes. Each file
# belongs to a component, which PillarfieldPackage.cmake makes a Debian package of.
include(CMakePackageConfigHelpers)

# pillarfield::pillarfield links all layers.
add_library(pillarfield_all INTERFACE)
add_library(pillarfield::pillarfield ALIAS pillarfield_all)
set_target_properties(pillarfield_all PROPERTIES EXPORT_NAME pillarfield)

foreach(layer kernels core device io streams pipeline)
  target_link_libraries(pillarfield_all INTERFACE pillarfield_${layer})
  install(TARGETS pillarfield_${layer} EXPORT pillarfield
    ARCHIVE COMPONENT development
    LIBRARY COMPONENT library NAMELINK_COMPONENT development)
endforeach()
install(TARGETS pillarfield_all EXPORT pillarfield)

# --- development ----------------------------------------------------------------------------------

install(DIRECTORY host/include/pillarfield "${PROJECT_BINARY_DIR}/include/pillarfield"
  TYPE INCLUDE COMPONENT development FILES_MATCHING PATTERN "*.h")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pillarfield)
install(EXPORT pillarfield NAMESPACE pillarfield:: FILE pillarfieldTargets.cmake
  DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/pillarfieldConfig.cmake.in
  "${PROJECT_BINARY_DIR}/pillarfieldConfig.cmake" INSTALL_DESTINATION ${package_folder})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pillarfieldConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/pillarfieldConfig.cmake"
  "${PROJECT_BINARY_DIR}/pillarfieldConfigVersion.cmake"
  DESTINATION ${package_folder} COMPONENT development)

# Programs that link static libraries need what these link. The prefix is relative: `cmake --install` may
# be given another.
set(pc_requires "")
if(NOT BUILD_SHARED_LIBS)
  set(pc_requires "Requires: OpenCL, hdf5, libzstd, zlib, minizip, libpng, fmt")
  if(tomlplusplus_DIR)
    string(APPEND pc_requires ", tomlplusplus")
  endif()
endif()
file(RELATIVE_PATH pc_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
configure_file(packaging/pillarfield.pc.in "${PROJECT_BINARY_DIR}/pillarfield.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/pillarfield.pc"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# --- programs -------------------------------------------------------------------------------------

install(TARGETS pillarfield RUNTIME COMPONENT program)
# Completion of the shells.
set(completion "${PROJECT_BINARY_DIR}/completion")
file(MAKE_DIRECTORY ${completion})
add_custom_command(
  OUTPUT ${completion}/pillarfield ${completion}/_pillarfield ${completion}/pillarfield.fish
  COMMAND pillarfield completion bash > ${completion}/pillarfield
  COMMAND pillarfield completion zsh > ${completion}/_pillarfield
  COMMAND pillarfield completion fish > ${completion}/pillarfield.fish VERBATIM)
add_custom_target(completion ALL DEPENDS ${completion}/pillarfield)
install(FILES ${completion}/pillarfield COMPONENT program OPTIONAL
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${completion}/_pillarfield COMPONENT program OPTIONAL
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${completion}/pillarfield.fish COMPONENT program OPTIONAL
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

if(PILLARFIELD_VIEWER)
  install(TARGETS pillarfield-viewer RUNTIME COMPONENT viewer)
  install(FILES packaging/pillarfield-viewer.desktop
    DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT viewer)
  install(FILES packaging/pillarfield-viewer.svg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT viewer)
endif()

# --- pages ----------------------------------------------------------------------------------------

# Man pages, from --help; a build of all targets makes them where help2man is found.
find_program(PILLARFIELD_HELP2MAN help2man)
mark_as_advanced(PILLARFIELD_HELP2MAN)
if(PILLARFIELD_HELP2MAN)
  set(programs pillarfield)
  if(PILLARFIELD_VIEWER)
    list(APPEND programs pillarfield-viewer)
  endif()
  list(TRANSFORM programs REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
  set(man "${PROJECT_BINARY_DIR}/man")
  add_custom_command(OUTPUT ${man}/pillarfield.1.gz
    COMMAND ${PROJECT_SOURCE_DIR}/packaging/make_man_pages ${man} ${files}
    DEPENDS ${programs} packaging/make_man_pages packaging/man.h2m COMMENT "Writing man pages" VERBATIM)
  add_custom_target(man_pages ALL DEPENDS ${man}/pillarfield.1.gz)
  install(DIRECTORY ${man}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program OPTIONAL
    FILES_MATCHING PATTERN "*.1.gz" PATTERN "pillarfield-viewer.1.gz" EXCLUDE)
  install(FILES ${man}/pillarfield-viewer.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT viewer
    OPTIONAL)
endif()

install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/pillarfield COMPONENT documentation)
install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)

set(PILLARFIELD_SITE "" CACHE PATH "Documentation that ./dev docs built, to install")
mark_as_advanced(PILLARFIELD_SITE)
if(PILLARFIELD_SITE)
  install(DIRECTORY ${PILLARFIELD_SITE}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/pillarfield-doc/html
    COMPONENT documentation)
endif()
