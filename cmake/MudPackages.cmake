# SPDX-License-Identifier: MIT
# Debian packages by CPack: `cmake --build build/release --target package` writes them into the build folder.
# libmud2 (2 is the ABI version) for linked programs, libmud-dev to link, mud-programs for the command line.
# scripts/try_packages.sh installs and uses them in a root folder that has nothing else.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mud)
set(CPACK_PACKAGE_CONTACT "The MUD developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Bounding-surface model for unsaturated soil dynamics")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL library development programs)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)

# What the files need from the system, asked of dpkg-shlibdeps; ldconfig runs after the library is installed.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libmud${mud_abi_version})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "MUD soil model: shared library (C, UMAT, UDSM, MFront)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmud-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libmud${mud_abi_version} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "gfortran, cmake, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "MUD soil model: headers, archive, single source file, CMake, pkg-config")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME mud-programs)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "MUD soil model: laboratory tests, finite-element host, input of others")

# Every package names its licence in the form of Debian. These files are in no plain `cmake --install`.
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
string(REGEX REPLACE "^MIT License\n+Copyright [^\n]*\n+" "" licence "${licence}")
string(STRIP "${licence}" licence)
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n" "\n " licence "${licence}")
file(STRINGS ${PROJECT_SOURCE_DIR}/LICENSE copyright REGEX "^Copyright ")
string(REGEX REPLACE "^Copyright (\\([cC]\\) )?" "" copyright "${copyright}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/copyright CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: MUD

Files: *
Copyright: ${copyright}
License: Expat
 ${licence}
" @ONLY)
foreach(component library development programs)
   string(TOUPPER ${component} name)
   install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION share/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME}
      COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()
include(CPack)
