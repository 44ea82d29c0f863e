# SPDX-License-Identifier: MIT
# Test suites, written once as pFUnit .pf files and built with pFUnit where it is installed,
# otherwise with the runner in tests/support.

set(mud_pfunit OFF)
if(NOT MUD_USE_PFUNIT STREQUAL "OFF")
   if(MUD_USE_PFUNIT STREQUAL "ON")
      find_package(PFUNIT REQUIRED)
   else()
      find_package(PFUNIT QUIET)
   endif()
   if(PFUNIT_FOUND)
      set(mud_pfunit ON)
   endif()
endif()

# The demo's environment has numpy; any Python 3 will do for the .pf files.
if(NOT MUD_PYTHON)
   find_program(MUD_PYTHON python3 PATHS ${PROJECT_SOURCE_DIR}/build/venv/bin NO_DEFAULT_PATH)
   find_program(MUD_PYTHON python3 REQUIRED)
endif()

if(mud_pfunit)
   message(STATUS "Test framework: pFUnit ${PFUNIT_VERSION}")
else()
   message(STATUS "Test framework: own runner for .pf files (no pFUnit in use)")
   add_library(mud_funit STATIC ${PROJECT_SOURCE_DIR}/tests/support/funit.f90)
   set_target_properties(mud_funit PROPERTIES Fortran_MODULE_DIRECTORY ${PROJECT_BINARY_DIR}/modules/funit)
   target_include_directories(mud_funit PUBLIC ${PROJECT_BINARY_DIR}/modules/funit)
   mud_set_warnings(mud_funit)
endif()

# What every test may know about the build it belongs to.
function(mud_set_test_environment name)
   set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT
      MUD_PRESET=${MUD_PRESET} MUD_BUILD_DIR=${PROJECT_BINARY_DIR} MUD_SOURCE_DIR=${PROJECT_SOURCE_DIR})
endfunction()

# mud_add_pfunit_suite(NAME FILE.pf... [LINK_LIBRARIES ...])
# One executable and one ctest entry of that name. With the own runner a suite is one file.
function(mud_add_pfunit_suite name)
   cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK_LIBRARIES")
   set(files ${arg_UNPARSED_ARGUMENTS})
   if(mud_pfunit)
      # pFUnit takes absolute paths for generated files and would write beside the source.
      list(TRANSFORM files REPLACE "^${CMAKE_CURRENT_SOURCE_DIR}/" "")
      add_pfunit_ctest(${name} TEST_SOURCES ${files} LINK_LIBRARIES ${arg_LINK_LIBRARIES})
      # Its generated code is not ours to hold to our warnings.
      target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:Fortran>:-ffree-line-length-none>)
      # Its argument parser leaks a few bytes, which is not a finding about us.
      set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
   else()
      list(LENGTH files count)
      if(NOT count EQUAL 1)
         message(FATAL_ERROR "mud_add_pfunit_suite(${name}): give exactly one .pf file, got ${count}.")
      endif()
      set(processor ${PROJECT_SOURCE_DIR}/tests/support/pf_to_f90.py)
      get_filename_component(source ${files} ABSOLUTE)
      set(generated ${CMAKE_CURRENT_BINARY_DIR}/${name}.F90)
      add_custom_command(OUTPUT ${generated}
         COMMAND ${MUD_PYTHON} ${processor} ${source} ${generated}
         DEPENDS ${source} ${processor} COMMENT "Reading ${name}.pf" VERBATIM)
      add_executable(${name} ${generated})
      set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY ${PROJECT_BINARY_DIR}/modules/${name})
      target_link_libraries(${name} PRIVATE mud_funit ${arg_LINK_LIBRARIES})
      # A suite calls compiled code once or twice; to optimise its own costs more than it saves.
      target_compile_options(${name} PRIVATE "$<$<COMPILE_LANGUAGE:Fortran>:-ffree-line-length-none;-O0>")
      mud_set_warnings(${name} TESTS)
      add_test(NAME ${name} COMMAND ${name})
      # A `stop` in a test ends with code 0, but without this line.
      set_property(TEST ${name} PROPERTY PASS_REGULAR_EXPRESSION "[0-9]+ passed, 0 failed")
   endif()
   mud_set_test_environment(${name})
endfunction()

# mud_add_script_suite(NAME FILE.py): tests of pytest; tests/conftest.py closes with `N passed, M failed`.
function(mud_add_script_suite name file)
   add_test(NAME ${name} COMMAND ${MUD_PYTHON} -m pytest ${file})
   mud_set_test_environment(${name})
endfunction()
