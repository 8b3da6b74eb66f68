# What every target of the project has in common.

# Language, warnings and the floating-point rules that make host and device agree bit for bit.
function(pillarfield_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wnull-dereference
    -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ 12 reports null dereferences inside the standard library at -O3.
    target_compile_options(${target} PRIVATE -Wno-null-dereference)
  endif()
  if(PILLARFIELD_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(PILLARFIELD_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined
      -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endif()
endfunction()

# A floor of the library: pillarfield_<name>, exported as pillarfield::<name>.
function(pillarfield_library name)
  add_library(pillarfield_${name} STATIC ${ARGN})
  add_library(pillarfield::${name} ALIAS pillarfield_${name})
  set_target_properties(pillarfield_${name} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(pillarfield_${name}
    PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/host/include>
      $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/host)
  pillarfield_compile_options(pillarfield_${name})
endfunction()
