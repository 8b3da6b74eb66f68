# Options of all targets.

# The compilers of `./dev test`. Newer ones have more warnings, which must not break a user's build.
if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^12\\.")
   OR (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION MATCHES "^14\\."))
  set(PILLARFIELD_KNOWN_COMPILER ON)
endif()

# Programs are position-independent, and the loader searches only the system's directories. (A build
# directory's RUNPATH would end in an empty entry, which means the current directory.) Programs that link
# shared libraries of the build tree need its path until they are installed.
include(CheckPIESupported)
check_pie_supported(LANGUAGES CXX)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT BUILD_SHARED_LIBS)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
endif()

# Language, warnings and the floating-point rules that make host and device agree bit for bit.
function(pillarfield_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wnull-dereference
    -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ 12 reports false null dereferences and overlaps inside the standard library at -O3.
    target_compile_options(${target} PRIVATE -Wno-null-dereference -Wno-restrict)
  endif()
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ mistakes an included source file for a header, whose types would differ from file to file.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  if(PILLARFIELD_WERROR AND PILLARFIELD_KNOWN_COMPILER)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(PILLARFIELD_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined
      -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  else()
    # Hardening; tests/package/hardening_test.py reads it from the programs. FORTIFY needs an optimiser.
    target_compile_options(${target} PRIVATE -fstack-protector-strong
      $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE$<SEMICOLON>-D_FORTIFY_SOURCE=2>)
    target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now)
  endif()
endfunction()

# A module of the library: pillarfield_<name>, exported as pillarfield::<name>; shared with BUILD_SHARED_LIBS.
# PRIVATE_MODULE: only programs of this project link it, so it is static and not installed.
function(pillarfield_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PRIVATE_MODULE" "" "")
  set(type "")
  if(arg_PRIVATE_MODULE)
    set(type STATIC)
  endif()
  add_library(pillarfield_${name} ${type} ${arg_UNPARSED_ARGUMENTS})
  add_library(pillarfield::${name} ALIAS pillarfield_${name})
  # Before 1.0 a minor version may change the interface. Without DEFINE_SYMBOL, static and shared builds
  # compile the same objects.
  set_target_properties(pillarfield_${name} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL ""
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(pillarfield_${name}
    PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/host/include>
      $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/host)
  pillarfield_compile_options(pillarfield_${name})
endfunction()

# pillarfield_embed(<variable> <file> <function> [files...]): sets the variable to a source file whose function
# pillarfield::<function>() returns the bytes of the file, which includes the further files. It is the last of its
# target: in a unity build the definition follows the declaration.
function(pillarfield_embed variable file function)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/Embed.cmake")
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFILE=${file} -DFUNCTION=${function} -DOUTPUT=${output} -P ${script}
    DEPENDS ${file} ${ARGN} ${script} COMMENT "Embedding ${function}" VERBATIM)
  add_custom_target(embed_${function} DEPENDS ${output})
  add_dependencies(generated_sources embed_${function})
  set(${variable} ${output} PARENT_SCOPE)
endfunction()

# pillarfield_precompile(<target> <headers...>): precompiles slow headers in builds without unity (the
# preset dev). A unity build reads them once per batch.
function(pillarfield_precompile target)
  if(NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()
