# A build for any Linux with a glibc and a libstdc++ as old as its symbols; the preset portable sets this file as
# CMAKE_PROJECT_INCLUDE. The libraries of others are inside its own shared libraries and programs, but for the loaders
# of OpenCL and Vulkan, which are installed beside. PILLARFIELD_LIBRARIES is the folder that
# packaging/portable/libraries filled.
set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
list(PREPEND CMAKE_PREFIX_PATH "${PILLARFIELD_LIBRARIES}")
set(HDF5_ROOT "${PILLARFIELD_LIBRARIES}")
set(HDF5_USE_STATIC_LIBRARIES ON)
set(system /usr/lib/${CMAKE_SYSTEM_PROCESSOR}-linux-gnu)
set(OpenCL_LIBRARY ${system}/libOpenCL.so CACHE FILEPATH "")
set(Vulkan_LIBRARY ${system}/libvulkan.so CACHE FILEPATH "")

# Packages that name a shared library.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
set(fmt_DIR ${system}/cmake/fmt)
function(link_statically)
  set_target_properties(fmt::fmt PROPERTIES IMPORTED_LOCATION_NONE "${PILLARFIELD_LIBRARIES}/lib/libfmt.a")
  set_target_properties(tomlplusplus::tomlplusplus PROPERTIES
    IMPORTED_LOCATION "${PILLARFIELD_LIBRARIES}/lib/libtomlplusplus.a")
  set_target_properties(zstd::libzstd_shared PROPERTIES IMPORTED_LOCATION_NONE ${system}/libzstd.a)
endfunction()
cmake_language(DEFER CALL link_statically)

foreach(kind SHARED MODULE EXE)
  set(CMAKE_${kind}_LINKER_FLAGS "-Wl,--exclude-libs,ALL")
endforeach()
set(CMAKE_INSTALL_RPATH "$ORIGIN/../lib:$ORIGIN/../lib/pillarfield")

# The Python module once more for each Python whose headers are in the folder.
function(add_further_modules)
  set(modules pillarfield_python)
  get_target_property(folder pillarfield_python SOURCE_DIR)
  get_target_property(sources pillarfield_python SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(TRANSFORM sources PREPEND "${folder}/" REGEX "^[^/]")
  file(GLOB pythons "${PILLARFIELD_LIBRARIES}/python/usr/include/python3.*")
  foreach(headers IN LISTS pythons)
    string(REGEX REPLACE ".*python3\\." "3" version "${headers}")
    set(module pillarfield_python${version})
    add_library(${module} MODULE ${sources})
    pillarfield_compile_options(${module})
    target_compile_options(${module} PRIVATE -O1)
    target_include_directories(${module} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/host)
    target_include_directories(${module} SYSTEM PRIVATE ${headers} "${PILLARFIELD_LIBRARIES}/python/usr/include")
    target_link_libraries(${module} PRIVATE pillarfield_pipeline pillarfield_streams pillarfield_device fmt::fmt)
    set_target_properties(${module} PROPERTIES PREFIX "" OUTPUT_NAME _core
      SUFFIX ".cpython-${version}-${CMAKE_SYSTEM_PROCESSOR}-linux-gnu.so" CXX_VISIBILITY_PRESET hidden
      LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/python/pillarfield")
    list(APPEND modules ${module})
  endforeach()
  foreach(module IN LISTS modules)
    # The older kind of path lets the C++ library of a Python's own environment be found first.
    target_link_options(${module} PRIVATE LINKER:--disable-new-dtags)
    set_target_properties(${module} PROPERTIES BUILD_WITH_INSTALL_RPATH ON
      INSTALL_RPATH "$ORIGIN/lib:$ORIGIN/lib/pillarfield")
  endforeach()
endfunction()
cmake_language(DEFER CALL add_further_modules)
