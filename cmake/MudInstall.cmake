# SPDX-License-Identifier: MIT
# mud_install(TARGETS ... HEADERS ... MODULES ... RUNTIME ... DATA ...)
# What `cmake --install` puts where. RUNTIME: the libraries below libmud.a, without -l. Components: library (what a
# linked program needs), development, programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Commands that run before anything is installed: files that are not built are named, with the command that builds them.
# To be called before the folders that install, as commands run in the order of their places.
function(mud_install_only_what_is_built)
   install(CODE "include(\"${PROJECT_BINARY_DIR}/mud_built.cmake\")" ALL_COMPONENTS)
endfunction()

# mud_installs(COMPONENT FILE...): files that the component needs; generator expressions are allowed.
function(mud_installs component)
   foreach(file IN LISTS ARGN)
      set_property(GLOBAL APPEND_STRING PROPERTY MUD_INSTALLED_FILES "need(${component} \"${file}\")\n")
   endforeach()
endfunction()

# Writes what mud_install_only_what_is_built reads, once all files are known.
function(mud_write_installed_files)
   get_property(needs GLOBAL PROPERTY MUD_INSTALLED_FILES)
   file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/mud_built.cmake CONTENT
"set(missing \"\")
macro(need component file)
   if((NOT CMAKE_INSTALL_COMPONENT OR CMAKE_INSTALL_COMPONENT STREQUAL \"\${component}\") AND NOT EXISTS \"\${file}\")
      string(APPEND missing \"\\n   \${file}\")
   endif()
endmacro()
${needs}
if(missing)
   message(FATAL_ERROR \"MUD cannot be installed, because these files have not been built:\${missing}\\n\"
      \"Nothing was installed. Build them first: cmake --build ${PROJECT_BINARY_DIR}\")
endif()
")
endfunction()

function(mud_install)
   cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "TARGETS;HEADERS;MODULES;RUNTIME;DATA")
   set(package ${CMAKE_INSTALL_LIBDIR}/cmake/mud)
   # A program without any shared library needs what libgfortran.a itself needs.
   if("gfortran" IN_LIST arg_RUNTIME AND "quadmath" IN_LIST CMAKE_Fortran_IMPLICIT_LINK_LIBRARIES)
      list(FIND arg_RUNTIME gfortran place)
      math(EXPR place "${place} + 1")
      list(INSERT arg_RUNTIME ${place} quadmath)
   endif()
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
   foreach(target IN LISTS arg_TARGETS)
      mud_installs(development $<TARGET_FILE:${target}>)
      get_target_property(kind ${target} TYPE)
      if(kind STREQUAL "SHARED_LIBRARY")
         mud_installs(library $<TARGET_FILE:${target}>)
      endif()
   endforeach()
   mud_installs(development ${arg_MODULES} ${arg_DATA})
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
   list(TRANSFORM arg_RUNTIME PREPEND "-l" OUTPUT_VARIABLE runtime)
   list(JOIN runtime " " runtime)
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
         # Linked with libmud.so alone where there is no archive: it is looked for beside the program.
         if(NOT MUD_BUILD_STATIC)
            file(RELATIVE_PATH up /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
            set_property(TARGET ${program} PROPERTY INSTALL_RPATH $ORIGIN/${up})
         endif()
         install(TARGETS ${program} RUNTIME COMPONENT programs)
         mud_installs(programs $<TARGET_FILE:${program}>)
      endif()
   endforeach()
   install(FILES ${arg_MATERIALS} DESTINATION ${CMAKE_INSTALL_DATADIR}/mud/materials COMPONENT programs)
endfunction()
