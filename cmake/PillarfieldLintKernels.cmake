# Compiles the kernels with clang's OpenCL C 1.2 front end, which warns where drivers do not: every
# sensel type and lane width, without stages and with all of them, and in integers.
find_program(PILLARFIELD_CLANG NAMES clang clang-14)
mark_as_advanced(PILLARFIELD_CLANG)
if(NOT PILLARFIELD_CLANG)
  message(STATUS "Kernels are not linted: clang was not found")
  return()
endif()

file(READ "${CMAKE_CURRENT_LIST_DIR}/../kernels/frame/stage_table.h" lint_table)
# The macros of the stages, those of a sensor's effects apart, and what the host defines beside them.
string(REGEX MATCHALL "X\\([a-z_]+, PF_[^X]*" lint_stages "${lint_table}")
list(FILTER lint_stages EXCLUDE REGEX "PF_PAPER|PF_SENSELS|PF_WIRES_AFTER_TARE")
set(lint_effects ${lint_stages})
list(FILTER lint_effects INCLUDE REGEX "effects\\.")
list(FILTER lint_stages EXCLUDE REGEX "effects\\.")
list(TRANSFORM lint_stages REPLACE ".*(PF_[A-Z_]+).*" "-D\\1" OUTPUT_VARIABLE lint_all_stages)
list(TRANSFORM lint_effects REPLACE ".*(PF_[A-Z_]+).*" "-D\\1")
list(APPEND lint_all_stages -DPF_NOISE -DPF_TARE_PLANE=0 -DPF_GAIN_PLANE=1 -DPF_DEAD_ZONE_PLANE=2
  -DPF_NOISE_PLANE=3 -DPF_MASK_PLANE=4 -DPF_BEND_X_PLANE=10 -DPF_BEND_Y_PLANE=11 -DPF_BEND_XY_PLANE=12
  -DPF_RELEASE_PLANE=8)
list(APPEND lint_effects -DPF_TILE_ROWS=64 -DPF_TILE_COLS=60 -DPF_MEMORY_PLANE=7 -DPF_PLAYS=4 -DPF_CREEPS=2)
set(lint_skipping -DPF_SKIP_IDLE)

set(lint_compile ${PILLARFIELD_CLANG} -x cl -cl-std=CL1.2 -target spir64
  -Xclang -finclude-default-header -fsyntax-only -Wall -Wextra -Wno-unused-parameter
  -Wno-unused-function -Werror)

set(lint_commands "")
foreach(sensel uchar ushort float)
  foreach(lanes 1 2 4 8 16)
    foreach(stages "" "-DPF_PAPER;-DPF_HALF" "-DPOCL_DEVICE_ADDRESS_BITS=64;-DPF_STREAM;${lint_skipping}" "${lint_all_stages};${lint_skipping};-DPF_ACTIVATION_PLANE=5"
        "${lint_effects};${lint_skipping}" "${lint_effects};-DPF_WIRES_AFTER_TARE;${lint_all_stages};${lint_skipping};-DPF_ACTIVATION_PLANE=5")
      list(APPEND lint_commands COMMAND ${lint_compile} -DPF_SENSEL=${sensel} -DPF_LANES=${lanes}
        ${stages} ${PROJECT_SOURCE_DIR}/kernels/all.h)
    endforeach()
  endforeach()
endforeach()
foreach(lanes 2 4 8 16)
  foreach(stages "" "${lint_skipping};-DPF_SATURATION;-DPF_PARITY_TEST")
    list(APPEND lint_commands COMMAND ${lint_compile} -DPF_SENSEL=uchar -DPF_LANES=${lanes}
      -DPF_WHOLE=4 ${stages} ${PROJECT_SOURCE_DIR}/kernels/all.h)
  endforeach()
endforeach()
set(lint_pack ${PROJECT_SOURCE_DIR}/kernels/frame/pack_results.cl)
list(APPEND lint_commands COMMAND ${lint_compile} ${lint_pack})
set(lint_stamp "${CMAKE_CURRENT_BINARY_DIR}/kernels.linted")
add_custom_command(OUTPUT ${lint_stamp} ${lint_commands}
  COMMAND ${CMAKE_COMMAND} -E touch ${lint_stamp}
  DEPENDS ${kernel_files} ${lint_pack} COMMENT "Linting the kernels" VERBATIM)
add_custom_target(lint-kernels ALL DEPENDS ${lint_stamp})
