# SPDX-License-Identifier: MIT
# mud_set_warnings(TARGET [TESTS])
# The language standard and the warnings every target of ours is held to, and relative names of sources in messages.
# TESTS leaves out -Wuse-without-only, because .pf files say `use funit`.
function(mud_set_warnings target)
   cmake_parse_arguments(PARSE_ARGV 1 arg "TESTS" "" "")
   set(fortran -std=f2018 -Wall -Wextra -Wcharacter-truncation)
   set(c -std=c11 -Wall -Wextra)
   if(NOT arg_TESTS)
      list(APPEND fortran -Wuse-without-only)
      # gfortran keeps the name of a source as it stands in the command, for its messages of run time (-ffile-prefix-map
      # changes other languages alone). By relative names libraries and programs do not hold where they were built.
      if(UNIX)
         set_property(TARGET ${target} PROPERTY
            RULE_LAUNCH_COMPILE "sh \"${PROJECT_SOURCE_DIR}/cmake/relative_names.sh\" \"${PROJECT_SOURCE_DIR}\"")
      endif()
   endif()
   # Without much optimisation gfortran 12 takes allocations for a use of undefined bounds.
   if(arg_TESTS OR CMAKE_BUILD_TYPE MATCHES "^(Debug|Sanitize)$")
      list(APPEND fortran -Wno-maybe-uninitialized)
   endif()
   if(MUD_WERROR)
      list(APPEND fortran -Werror)
      list(APPEND c -Werror)
   endif()
   target_compile_options(${target} PRIVATE
      "$<$<COMPILE_LANG_AND_ID:Fortran,GNU>:${fortran}>"
      "$<$<COMPILE_LANG_AND_ID:C,GNU,Clang>:${c}>")
endfunction()
