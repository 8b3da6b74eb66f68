# Debian packages, one for each component that is installed; `./dev package` builds them.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_CONTACT "Pillarfield authors <authors@pillarfield.invalid>" CACHE STRING
  "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# Each package has a summary of its own.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# Lets dpkg-shlibdeps find the libraries of this build; packages name their own package below.
foreach(layer core device io streams pipeline)
  get_target_property(folder pillarfield_${layer} BINARY_DIR)
  list(APPEND CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${folder})
endforeach()

file(WRITE "${PROJECT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/triggers")

set(abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(changelog "${PROJECT_BINARY_DIR}/changelog.Debian")
configure_file(packaging/changelog.in ${changelog} @ONLY)
execute_process(COMMAND gzip -9nf ${changelog})

# pillarfield_package(<component> <package> SECTION <section> SUMMARY <words> DESCRIPTION <text>
#   [DEPENDS <packages>] [RECOMMENDS <packages>] [SUGGESTS <packages>] [CONTAINS <packages...>] [ALL])
# CONTAINS: Debian packages of headers whose code is compiled in; their licences are installed. ALL: it holds
# nothing of one architecture.
function(pillarfield_package component package)
  cmake_parse_arguments(PARSE_ARGV 2 arg "ALL" "SECTION;SUMMARY;DESCRIPTION;DEPENDS;RECOMMENDS;SUGGESTS" "CONTAINS")
  get_cmake_property(installed COMPONENTS)
  if(NOT component IN_LIST installed)
    return()
  endif()
  string(TOUPPER ${component} name)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${name}_PACKAGE_SECTION ${arg_SECTION} PARENT_SCOPE)
  set(CPACK_COMPONENT_${name}_DESCRIPTION "${arg_SUMMARY}\n${arg_DESCRIPTION}" PARENT_SCOPE)
  foreach(relation DEPENDS RECOMMENDS SUGGESTS)
    set(CPACK_DEBIAN_${name}_PACKAGE_${relation} "${arg_${relation}}" PARENT_SCOPE)
  endforeach()
  if(arg_ALL)
    set(CPACK_DEBIAN_${name}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
  endif()
  if(BUILD_SHARED_LIBS)
    install(FILES packaging/copyright ${changelog}.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
      COMPONENT ${component})
    foreach(headers IN LISTS arg_CONTAINS)
      install(FILES /usr/share/doc/${headers}/copyright COMPONENT ${component} OPTIONAL
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}/contains RENAME ${headers})
    endforeach()
  endif()
endfunction()

pillarfield_package(program pillarfield SECTION science
  SUMMARY "forces on a tactile skin from its frames - command"
  DESCRIPTION "Turns frames of a high-density tactile skin into fields of three-axis
force: shear and normal force in newtons on every pillar, and each
contact's force, torque, friction and slip. It simulates, calibrates,
solves, streams and compares."
  DEPENDS "libpillarfield${abi} ${same}"
  RECOMMENDS "pocl-opencl-icd | opencl-icd, pillarfield-viewer, pillarfield-doc"
  CONTAINS libcli11-dev nlohmann-json3-dev)
pillarfield_package(viewer pillarfield-viewer SECTION science
  SUMMARY "forces on a tactile skin from its frames - viewer"
  DESCRIPTION "Draws fields of three-axis force as heat maps and arrows by Vulkan: in a
window while they are solved, or without a display as pictures and
videos."
  DEPENDS "libpillarfield${abi} ${same}, mesa-vulkan-drivers | vulkan-icd, fonts-dejavu-core"
  RECOMMENDS "pocl-opencl-icd | opencl-icd" SUGGESTS "ffmpeg" CONTAINS libcli11-dev libimgui-dev)
pillarfield_package(library libpillarfield${abi} SECTION libs
  SUMMARY "forces on a tactile skin from its frames - shared libraries"
  DESCRIPTION "Solves frames of a tactile skin on an OpenCL device or on the host,
tracks contacts, calibrates, simulates, reads and writes files, and
streams live."
  RECOMMENDS "pocl-opencl-icd | opencl-icd" CONTAINS libkissfft-dev nlohmann-json3-dev)
pillarfield_package(development libpillarfield-dev SECTION libdevel
  SUMMARY "forces on a tactile skin from its frames - headers"
  DESCRIPTION "Headers, files for CMake and pkg-config, and examples, for C++20
programs that use Pillarfield."
  DEPENDS "libpillarfield${abi} ${same}" SUGGESTS "pillarfield-doc")
pillarfield_package(python python3-pillarfield SECTION python
  SUMMARY "forces on a tactile skin from its frames - Python module"
  DESCRIPTION "Solves NumPy arrays, recordings and live frames of a tactile skin from
Python."
  DEPENDS "libpillarfield${abi} ${same}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy"
  RECOMMENDS "pocl-opencl-icd | opencl-icd, python3-h5py" SUGGESTS "python3-matplotlib, pillarfield-doc"
  CONTAINS pybind11-dev)
pillarfield_package(documentation pillarfield-doc SECTION doc ALL
  SUMMARY "forces on a tactile skin from its frames - manual and scenes"
  DESCRIPTION "The manual with tutorial, gallery and reference of the library as HTML,
and ready-made scenes to simulate."
  RECOMMENDS libjs-mathjax)

# Its module is installed with the folder that holds the package, which CPack neither strips nor relinks.
if(BUILD_SHARED_LIBS AND TARGET pillarfield_python)
  set_target_properties(pillarfield_python PROPERTIES BUILD_WITH_INSTALL_RPATH ON)
  target_link_options(pillarfield_python PRIVATE -s)
endif()

include(CPack)
