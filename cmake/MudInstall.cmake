# SPDX-License-Identifier: MIT
# mud_install(TARGETS ... HEADERS ... MODULES ... RUNTIME ... DATA ...)
# What `cmake --install` puts where. RUNTIME: the libraries below libmud.a, without -l. Components: library (what a
# linked program needs), development, programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

function(mud_install)
   cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "TARGETS;HEADERS;MODULES;RUNTIME;DATA")
   set(package ${CMAKE_INSTALL_LIBDIR}/cmake/mud)
   set(modules ${CMAKE_INSTALL_INCLUDEDIR}/mud/modules)

   # The module files are gfortran's own: no other compiler is sent there.
   foreach(target IN LISTS arg_TARGETS)
      target_include_directories(${target} INTERFACE
         $<INSTALL_INTERFACE:$<$<COMPILE_LANG_AND_ID:Fortran,GNU>:$<INSTALL_PREFIX>/${modules}>>)
   endforeach()
   install(TARGETS ${arg_TARGETS} EXPORT mudTargets
      LIBRARY COMPONENT library NAMELINK_COMPONENT development
      ARCHIVE COMPONENT development
      INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
   install(FILES ${arg_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
   install(FILES ${arg_MODULES} DESTINATION ${modules} COMPONENT development)
   install(EXPORT mudTargets NAMESPACE mud:: DESTINATION ${package} COMPONENT development)

   configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/mudConfig.cmake.in mudConfig.cmake
      INSTALL_DESTINATION ${package} PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_DATADIR
      NO_CHECK_REQUIRED_COMPONENTS_MACRO)
   # Before 1.0 a minor version may change what a host sees.
   write_basic_package_version_file(mudConfigVersion.cmake COMPATIBILITY SameMinorVersion)
   install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mudConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/mudConfigVersion.cmake
      DESTINATION ${package} COMPONENT development)

   # pkg-config. The prefix follows the file, so that the tree can be moved.
   set(prefix ${CMAKE_INSTALL_PREFIX})
   if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
      file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
      string(REGEX REPLACE "/$" "" up "${up}")
      set(prefix "\${pcfiledir}/${up}")
   endif()
   foreach(dir LIBDIR INCLUDEDIR DATADIR)
      cmake_path(APPEND pc_${dir} "\${prefix}" "${CMAKE_INSTALL_${dir}}")
   endforeach()
   list(TRANSFORM arg_RUNTIME PREPEND "-l")
   list(JOIN arg_RUNTIME " " runtime)
   # A program without any shared library needs what libgfortran.a itself needs.
   set(private "${runtime}")
   if("quadmath" IN_LIST CMAKE_Fortran_IMPLICIT_LINK_LIBRARIES)
      string(REPLACE "-lgfortran" "-lgfortran -lquadmath" private "${runtime}")
   endif()
   # Where there is no shared library, -lmud is the archive and always needs what is below it.
   set(libs "")
   if(NOT MUD_BUILD_SHARED)
      set(libs " ${runtime}")
   endif()
   configure_file(${PROJECT_SOURCE_DIR}/cmake/mud.pc.in mud.pc @ONLY)
   install(FILES ${CMAKE_CURRENT_BINARY_DIR}/mud.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
      COMPONENT development)
   install(FILES ${arg_DATA} DESTINATION ${CMAKE_INSTALL_DATADIR}/mud COMPONENT development)
endfunction()

# mud_install_programs(MATERIALS ... PROGRAMS ...)
# Those programs that this build has, and named materials for them.
function(mud_install_programs)
   cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "MATERIALS;PROGRAMS")
   foreach(program IN LISTS arg_PROGRAMS)
      if(TARGET ${program})
         install(TARGETS ${program} RUNTIME COMPONENT programs)
      endif()
   endforeach()
   install(FILES ${arg_MATERIALS} DESTINATION ${CMAKE_INSTALL_DATADIR}/mud/materials COMPONENT programs)
endfunction()
