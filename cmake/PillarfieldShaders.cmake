# pillarfield_shaders(<target> <files...>): compiles GLSL of shaders/ to SPIR-V, optimised where the
# compiler can, and lets the target include each as "shaders/<file with _ for .>.h", which defines an
# array of that name.
function(pillarfield_shaders target)
  set(folder ${PROJECT_BINARY_DIR}/generated/shaders)
  file(MAKE_DIRECTORY ${folder})
  foreach(file IN LISTS ARGN)
    string(REPLACE "." "_" name ${file})
    add_custom_command(
      OUTPUT ${folder}/${name}.h
      DEPENDS ${PROJECT_SOURCE_DIR}/shaders/${file}
      DEPFILE ${folder}/${name}.d
      COMMAND ${PILLARFIELD_GLSLANG} --quiet -V --target-env vulkan1.2
        -I${PROJECT_SOURCE_DIR}/shaders --depfile ${folder}/${name}.d --vn ${name}
        -o ${folder}/${name}.h ${PROJECT_SOURCE_DIR}/shaders/${file}
      COMMENT "Compiling shader ${file}"
      VERBATIM)
    target_sources(${target} PRIVATE ${folder}/${name}.h)
    list(APPEND compiled ${folder}/${name}.h)
  endforeach()
  add_custom_target(${target}_shaders DEPENDS ${compiled})
  add_dependencies(generated_sources ${target}_shaders)
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()
