! SPDX-License-Identifier: MIT
! The module that every Fortran host compiles for itself.
include 'mud_interface.f90'
