# SPDX-License-Identifier: MIT
# mud_add_lanes(SOURCES CORE)
# Sources of increments side by side (MUD_LANES of mud.h), for x86-64 and GNU compilers; none elsewhere, nor on Windows,
# where GCC aligns the stack to 16 bytes and vectors on it need 32 or 64, nor by make: for makefiles CMake looks for
# modules before the preprocessor has renamed them. CORE: the files of the core in their order.
#
# For each of two kinds of processor they are the core once more, and what a rate needs of it again, compiled so that
# loops over points become vectors. The preprocessor gives the modules of each copy names of their own, so that nothing
# of a copy stands in for what is compiled for any processor. mud_lane_choice.c asks the processor.
function(mud_add_lanes sources core)
   set(${sources} "" PARENT_SCOPE)
   if(NOT (CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64" AND CMAKE_SIZEOF_VOID_P EQUAL 8 AND NOT WIN32 AND
           CMAKE_Fortran_COMPILER_ID STREQUAL "GNU" AND CMAKE_C_COMPILER_ID STREQUAL "GNU" AND
           CMAKE_C_COMPILER_VERSION VERSION_GREATER_EQUAL 12))
      return()
   endif()
   if(CMAKE_GENERATOR MATCHES "Makefiles")
      message(STATUS "${CMAKE_GENERATOR}: without increments side by side (MUD_LANES); Ninja builds them")
      return()
   endif()
   set(levels v3 v4)
   set(vectors 256 512)
   list(FIND core core/integration/mud_increment.f90 last)
   math(EXPR last "${last} + 1")
   list(SUBLIST core 0 ${last} below)
   # No value of a sound point is infinite or not a number; a lane that has one is asked again where it is seen.
   set(loops -fno-math-errno -fno-trapping-math -ffinite-math-only -fno-signed-zeros -fopenmp-simd
      -finline-limit=20000 --param=max-inline-insns-auto=2000 --param=max-inline-insns-single=4000
      --param=early-inlining-insns=400 --param=large-function-growth=10000 --param=large-function-insns=100000
      --param=inline-unit-growth=1000 --param=max-early-inliner-iterations=10 --param=large-stack-frame-growth=100000)
   set(copies lanes/mud_lane_choice.c)
   set_source_files_properties(${copies} PROPERTIES COMPILE_DEFINITIONS MUD_LANES_COMPILED)
   foreach(level bits IN ZIP_LISTS levels vectors)
      mud_copy_of_core(wide ${level} ${bits} "${below};lanes/mud_lane_rates.f90;lanes/mud_lane_loops.f90" "${loops}")
      # Rounding of what is scalar stays that of the other build; inlined farther it takes 0.96 of the time.
      mud_copy_of_core(lane ${level} ${bits}
         "${core};lanes/mud_lane_rates.f90;lanes/mud_lanes.f90;abi/mud_kernel.f90;lanes/mud_lane_kernel.f90"
         "-ffp-contract=off;-finline-limit=1000;--param=inline-unit-growth=80")
      list(APPEND copies ${CMAKE_CURRENT_BINARY_DIR}/mud_wide_${level}.F90
         ${CMAKE_CURRENT_BINARY_DIR}/mud_lane_${level}.F90)
   endforeach()
   set(${sources} ${copies} PARENT_SCOPE)
endfunction()

# mud_copy_of_core(NAME LEVEL BITS PARTS OPTIONS)
# Writes mud_NAME_LEVEL.F90, compiled for x86-64-LEVEL with vectors of so many bits, which includes the parts and calls
# a module mud_x of theirs mud_of_NAME_LEVEL_x; the entries between the copies have the level behind their names.
function(mud_copy_of_core name level bits parts options)
   list(TRANSFORM parts REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
   list(JOIN includes "" includes)
   set(unit ${CMAKE_CURRENT_BINARY_DIR}/mud_${name}_${level}.F90)
   file(CONFIGURE OUTPUT ${unit} CONTENT "${includes}" @ONLY)
   list(TRANSFORM parts REPLACE ".*/(mud_([a-z_]+))[.]f90" "\\1=mud_of_${name}_${level}_\\2" OUTPUT_VARIABLE names)
   list(APPEND names mud_points_of_level=mud_lane_points_${level} mud_find_rates=mud_find_rates_${level}
      mud_find_ends=mud_find_ends_${level})
   list(TRANSFORM parts PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
   set_source_files_properties(${unit} PROPERTIES OBJECT_DEPENDS "${parts}" COMPILE_DEFINITIONS "${names}"
      COMPILE_OPTIONS "-march=x86-64-${level};-mprefer-vector-width=${bits};${options}")
endfunction()
