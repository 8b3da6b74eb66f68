# How tests are made, and what they run with.

# PoCL keeps compiled kernels in the build tree, not in the user's home; graphics drivers look for a
# folder of the user's session.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/session)
set(PILLARFIELD_TEST_ENVIRONMENT "POCL_CACHE_DIR=${PROJECT_BINARY_DIR}/pocl_cache"
  "XDG_RUNTIME_DIR=${PROJECT_BINARY_DIR}/session")
set(PILLARFIELD_TEST_PREFIX "")
if(PILLARFIELD_SANITIZE)
  list(APPEND PILLARFIELD_TEST_ENVIRONMENT
    "ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1"
    "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/sanitizer/lsan.supp:print_suppressions=0"
    "UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1")
  set(PILLARFIELD_TEST_PREFIX "asan.")
endif()

# pillarfield_test_program(<name> LINK <floors...> SOURCES <files...>): a GoogleTest program.
function(pillarfield_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK;SOURCES")
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/host)
  list(TRANSFORM arg_LINK PREPEND pillarfield_)
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest_main)
  pillarfield_compile_options(${name})
endfunction()

# pillarfield_test(<floor>_<subject> LINK <floors...> SOURCES <files...>): the same, and each of its
# tests is a test of the project.
function(pillarfield_test name)
  pillarfield_test_program(${name} ${ARGN})
  string(REGEX REPLACE "_.*" "" label ${name})
  gtest_discover_tests(${name} TEST_PREFIX "${PILLARFIELD_TEST_PREFIX}${name}." NO_PRETTY_VALUES
    TEST_LIST ${name}_tests DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${label} TIMEOUT 240)

  # gtest_discover_tests takes no property that is a list; ctest sets it once it has the tests.
  set(environment_file ${CMAKE_CURRENT_BINARY_DIR}/${name}_environment.cmake)
  file(CONFIGURE OUTPUT ${environment_file} @ONLY CONTENT [[
if(@name@_tests)
  set_tests_properties(${@name@_tests} PROPERTIES ENVIRONMENT "@PILLARFIELD_TEST_ENVIRONMENT@")
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${environment_file})
endfunction()

# pillarfield_labels(<variable> <name> [LONG]): the floor that a test's name begins with, and `long`,
# which `./dev test` leaves out and `./dev test --all` does not. LONG holds with sanitizers, which make
# many times slower what they do not watch either: kernels.
function(pillarfield_labels variable name)
  string(REGEX REPLACE "_.*" "" labels ${name})
  if("LONG" IN_LIST ARGN AND PILLARFIELD_SANITIZE)
    list(APPEND labels long)
  endif()
  set(${variable} "${labels}" PARENT_SCOPE)
endfunction()

# pillarfield_device_test(<name> [LONG] ...): the same, but the whole program is one test of the
# project: opening an OpenCL device and compiling kernels takes longer than a test of them.
function(pillarfield_device_test name)
  pillarfield_labels(labels ${name} ${ARGN})
  list(REMOVE_ITEM ARGN LONG)
  pillarfield_test_program(${name} ${ARGN})
  add_test(NAME ${PILLARFIELD_TEST_PREFIX}${name} COMMAND ${name} --gtest_brief=1)
  set_tests_properties(${PILLARFIELD_TEST_PREFIX}${name} PROPERTIES LABELS "${labels}" TIMEOUT 600
    ENVIRONMENT "${PILLARFIELD_TEST_ENVIRONMENT}")
endfunction()

# pillarfield_oclgrind_test(<name> <program> <filter> [LONG]): one more test, which runs those tests of a
# program that match the GoogleTest filter on Oclgrind's simulated device. It fails when they do, and
# when a kernel accesses memory out of bounds or two work-items race; it is skipped where Oclgrind is
# not installed. Oclgrind and AddressSanitizer exclude each other.
function(pillarfield_oclgrind_test name program filter)
  if(PILLARFIELD_SANITIZE)
    return()
  endif()
  add_test(NAME oclgrind.${name}
    COMMAND ${PROJECT_SOURCE_DIR}/tests/oclgrind/run_under_oclgrind
      ${CMAKE_CURRENT_BINARY_DIR}/${name}.log $<TARGET_FILE:${program}> ${filter})
  set(labels oclgrind)
  if("LONG" IN_LIST ARGN)
    list(APPEND labels long)
  endif()
  set_tests_properties(oclgrind.${name} PROPERTIES LABELS "${labels}" TIMEOUT 480 SKIP_RETURN_CODE 77
    ENVIRONMENT "${PILLARFIELD_TEST_ENVIRONMENT}")
endfunction()

# pillarfield_python_test(<floor>_<subject> [LONG] SCRIPT <file> ARGUMENTS <words...>): a Python script that
# passes by exiting with 0. It needs h5py and NumPy, which may be there for the system's Python only,
# and that need not be the first on the path. Without them the test is skipped.
find_program(PILLARFIELD_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PILLARFIELD_PATH_PYTHON python3)
mark_as_advanced(PILLARFIELD_SYSTEM_PYTHON PILLARFIELD_PATH_PYTHON)
set(PILLARFIELD_PYTHON "")
foreach(python IN ITEMS ${PILLARFIELD_SYSTEM_PYTHON} ${PILLARFIELD_PATH_PYTHON})
  execute_process(COMMAND ${python} -c "import h5py, numpy" RESULT_VARIABLE failed
    OUTPUT_QUIET ERROR_QUIET)
  if(NOT failed AND NOT PILLARFIELD_PYTHON)
    set(PILLARFIELD_PYTHON ${python})
  endif()
endforeach()

function(pillarfield_python_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG" "SCRIPT" "ARGUMENTS")
  pillarfield_labels(labels ${name} ${ARGN})
  if(PILLARFIELD_PYTHON)
    set(command ${PILLARFIELD_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_SCRIPT} ${arg_ARGUMENTS})
  else()
    set(command ${CMAKE_COMMAND} -E echo "skipped: no Python with h5py and numpy was found")
  endif()
  add_test(NAME ${PILLARFIELD_TEST_PREFIX}${name} COMMAND ${command})
  set_tests_properties(${PILLARFIELD_TEST_PREFIX}${name} PROPERTIES LABELS "${labels}" TIMEOUT 240
    SKIP_REGULAR_EXPRESSION "^skipped:"
    ENVIRONMENT "PILLARFIELD=$<TARGET_FILE:pillarfield>;PILLARFIELD_SOURCE=${PROJECT_SOURCE_DIR};PYTHONDONTWRITEBYTECODE=1;${PILLARFIELD_TEST_ENVIRONMENT}")
endfunction()
