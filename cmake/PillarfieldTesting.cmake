# Functions that define tests, and the environment of the tests.
#
# A test program is one entry of ctest and runs all of its tests; `PROGRAM --gtest_filter=...` runs some.
# Four keywords select when an entry runs:
#   (none)     in the optimised build, by `./dev test`
#   LONG       only by `./dev test --all`: it takes minutes, or tests tools of developers
#   SANITIZED  with sanitizers too, by `./dev test`: parsers, files, the ring, calibration planes.
#              `./dev test --all` runs all others with sanitizers.
#   FURTHER    tests whose suite or instantiation begins with Further are an entry of their own, which is
#              LONG: kernels that differ little from those of the others, and take long to compile
# The target `default_tests` builds the tests of `./dev test`, `all_tests` those of `./dev test --all`;
# `default_core_tests`, `all_lab_tests` and so on those of one house: core, viewer or lab.

# Compiled kernels are cached in the build tree, not in the user's home (where others can write the
# tree, each program compiles its own); graphics drivers need a folder of the user's session.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/session ${PROJECT_BINARY_DIR}/cache)
file(CHMOD ${PROJECT_BINARY_DIR}/session ${PROJECT_BINARY_DIR}/cache
  PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
set(PILLARFIELD_TEST_ENVIRONMENT "XDG_CACHE_HOME=${PROJECT_BINARY_DIR}/cache"
  "XDG_RUNTIME_DIR=${PROJECT_BINARY_DIR}/session")
set(PILLARFIELD_TEST_PREFIX "")
# At exit LeakSanitizer stops all threads, and sometimes crashes where PoCL has threads. So it runs only
# in programs without them (LEAKS in pillarfield_test); device_leaks counts leaks of devices.
set(PILLARFIELD_LEAKS_SOUGHT "")
if(PILLARFIELD_SANITIZE)
  # A small quarantine: forking copies its page tables.
  set(asan_options "detect_stack_use_after_return=1:strict_string_checks=1:quarantine_size_mb=16:exitcode=99")
  list(APPEND PILLARFIELD_TEST_ENVIRONMENT
    "ASAN_OPTIONS=${asan_options}:detect_leaks=0"
    "UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1:exitcode=99")
  set(PILLARFIELD_LEAKS_SOUGHT "ASAN_OPTIONS=${asan_options}:detect_leaks=1")
  set(PILLARFIELD_TEST_PREFIX "asan.")
else()
  # Freed memory is overwritten at once, so that its use shows, in libraries too.
  list(APPEND PILLARFIELD_TEST_ENVIRONMENT
    "MALLOC_PERTURB_=170" "GLIBC_TUNABLES=glibc.malloc.tcache_count=0")
endif()

# Seconds after which a test hangs. The slowest takes two minutes; a busy machine takes its time.
set(PILLARFIELD_TEST_TIMEOUT 3600)

add_custom_target(default_tests)
add_custom_target(all_tests)
foreach(house core viewer lab)
  add_custom_target(default_${house}_tests)
  add_custom_target(all_${house}_tests)
  add_dependencies(all_${house}_tests default_${house}_tests)
  add_dependencies(default_tests default_${house}_tests)
  add_dependencies(all_tests all_${house}_tests)
endforeach()

# pillarfield_test_entry(<name> [LONG] [SANITIZED] [TARGETS <targets...>]): sets when the test <name>
# runs and which targets it needs. Its label is the module that its name begins with, which is also the
# house of viewer and lab; the tests of all other modules are the core's.
function(pillarfield_test_entry name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG;SANITIZED" "" "TARGETS")
  string(REGEX REPLACE "[_.].*" "" labels ${name})
  set(house core)
  if(labels MATCHES "^(viewer|lab)$")
    set(house ${labels})
  endif()
  set(group default_${house}_tests)
  if(arg_LONG OR (PILLARFIELD_SANITIZE AND NOT arg_SANITIZED))
    list(APPEND labels long)
    set(group all_${house}_tests)
  endif()
  set_tests_properties(${PILLARFIELD_TEST_PREFIX}${name} PROPERTIES LABELS "${labels}"
    TIMEOUT ${PILLARFIELD_TEST_TIMEOUT} ENVIRONMENT "${PILLARFIELD_TEST_ENVIRONMENT}")
  if(arg_TARGETS)
    add_dependencies(${group} ${arg_TARGETS})
  endif()
endfunction()

# pillarfield_test_program(<name> LINK <modules...> SOURCES <files...>): a GoogleTest program.
function(pillarfield_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK;SOURCES")
  add_executable(${name} EXCLUDE_FROM_ALL ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/host)
  list(TRANSFORM arg_LINK PREPEND pillarfield_)
  target_link_libraries(${name} PRIVATE ${arg_LINK} GTest::gtest_main)
  pillarfield_compile_options(${name})
  pillarfield_test_options(${name})
endfunction()

# pillarfield_test_options(<target>): -O1, since tests are compiled more often than they run.
function(pillarfield_test_options target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# pillarfield_test(<module>_<subject> [LONG] [SANITIZED] [LEAKS] [FURTHER] LINK <modules...>
# SOURCES <files...>): a test program and its entry. LEAKS: with sanitizers, leaks are errors.
function(pillarfield_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG;SANITIZED;LEAKS;FURTHER" "" "")
  pillarfield_test_program(${name} ${arg_UNPARSED_ARGUMENTS})
  set(when "")
  foreach(keyword LONG SANITIZED)
    if(arg_${keyword})
      list(APPEND when ${keyword})
    endif()
  endforeach()
  if(arg_FURTHER)
    pillarfield_program_entry(${name}_further ${name} LONG --gtest_filter=Further*)
    set(arg_FURTHER --gtest_filter=-Further*)
  else()
    set(arg_FURTHER "")
  endif()
  pillarfield_program_entry(${name} ${name} "${when}" ${arg_FURTHER})
  if(arg_LEAKS)
    set_property(TEST ${PILLARFIELD_TEST_PREFIX}${name} APPEND PROPERTY ENVIRONMENT
      "${PILLARFIELD_LEAKS_SOUGHT}")
  endif()
endfunction()

# pillarfield_thread_test(<module>_<subject> SOURCES <files...>): a test with ThreadSanitizer, where the
# tool chain has it. It is compiled from these files alone: all that threads share must be instrumented.
include(CheckCXXSourceRuns)
set(CMAKE_REQUIRED_FLAGS "-fsanitize=thread")
check_cxx_source_runs("int main() {}" PILLARFIELD_HAS_THREAD_SANITIZER)
unset(CMAKE_REQUIRED_FLAGS)
function(pillarfield_thread_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES")
  if(PILLARFIELD_SANITIZE OR NOT PILLARFIELD_HAS_THREAD_SANITIZER)
    return()
  endif()
  pillarfield_test_program(${name} LINK kernels SOURCES ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/host/include)
  target_compile_options(${name} PRIVATE -fsanitize=thread
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  target_link_options(${name} PRIVATE -fsanitize=thread)
  target_link_libraries(${name} PRIVATE fmt::fmt Threads::Threads)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
  pillarfield_test_entry(${name} TARGETS ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT 300)
endfunction()

# An entry that runs a test program with arguments.
function(pillarfield_program_entry entry program when)
  add_test(NAME ${PILLARFIELD_TEST_PREFIX}${entry} COMMAND ${program} --gtest_brief=1 ${ARGN})
  pillarfield_test_entry(${entry} ${when} TARGETS ${program})
endfunction()

# pillarfield_oclgrind_test(<name> <program> <filter> [LONG]): runs the tests of a program that match the
# GoogleTest filter on Oclgrind's simulated device. It fails when they fail, when a kernel accesses
# memory out of bounds, or when two work-items race; it is skipped where Oclgrind is not installed.
# Oclgrind and AddressSanitizer exclude each other.
function(pillarfield_oclgrind_test name program filter)
  if(PILLARFIELD_SANITIZE)
    return()
  endif()
  add_test(NAME oclgrind.${name}
    COMMAND ${PROJECT_SOURCE_DIR}/tests/oclgrind/run_under_oclgrind
      ${CMAKE_CURRENT_BINARY_DIR}/${name}.log $<TARGET_FILE:${program}> ${filter})
  pillarfield_test_entry(oclgrind.${name} ${ARGN} TARGETS ${program})
  set_tests_properties(oclgrind.${name} PROPERTIES SKIP_RETURN_CODE 77)
endfunction()

# pillarfield_python_test(<module>_<subject> [LONG] SCRIPT <file> ARGUMENTS <words...> TARGETS <targets...>):
# a Python script that passes by exiting with 0. It needs h5py and NumPy, which may be installed only for
# the system's Python, which need not be the first on the path. Without them the test is skipped.
find_program(PILLARFIELD_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PILLARFIELD_PATH_PYTHON python3)
mark_as_advanced(PILLARFIELD_SYSTEM_PYTHON PILLARFIELD_PATH_PYTHON)
set(PILLARFIELD_TEST_PYTHON "")
foreach(python IN ITEMS ${PILLARFIELD_SYSTEM_PYTHON} ${PILLARFIELD_PATH_PYTHON})
  execute_process(COMMAND ${python} -c "import h5py, numpy" RESULT_VARIABLE failed
    OUTPUT_QUIET ERROR_QUIET)
  if(NOT failed AND NOT PILLARFIELD_TEST_PYTHON)
    set(PILLARFIELD_TEST_PYTHON ${python})
  endif()
endforeach()

function(pillarfield_python_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG" "SCRIPT" "ARGUMENTS;TARGETS")
  if(PILLARFIELD_TEST_PYTHON)
    set(command ${PILLARFIELD_TEST_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_SCRIPT} ${arg_ARGUMENTS})
  else()
    set(command ${CMAKE_COMMAND} -E echo "skipped: no Python with h5py and numpy was found")
  endif()
  add_test(NAME ${PILLARFIELD_TEST_PREFIX}${name} COMMAND ${command})
  set(when "")
  if(arg_LONG)
    set(when LONG)
  endif()
  pillarfield_test_entry(${name} ${when} TARGETS pillarfield ${arg_TARGETS})
  set_tests_properties(${PILLARFIELD_TEST_PREFIX}${name} PROPERTIES
    SKIP_REGULAR_EXPRESSION "^skipped:")
  set_property(TEST ${PILLARFIELD_TEST_PREFIX}${name} APPEND PROPERTY ENVIRONMENT
    "PILLARFIELD=$<TARGET_FILE:pillarfield>" "PILLARFIELD_SOURCE=${PROJECT_SOURCE_DIR}"
    "PYTHONDONTWRITEBYTECODE=1")
endfunction()
