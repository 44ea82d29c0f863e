! SPDX-License-Identifier: MIT
!> Texts on request: how to call the driver, and a case file that runs unchanged.
module triax_help
   use, intrinsic :: iso_fortran_env, only: wp => real64, output_unit
   use texts, only: short
   use faults, only: fault_t
   use key_schema, only: key_t, described
   use key_table, only: key_table_t, listing
   use material_registry, only: law_names, law_keys
   use retention_curves, only: retention_t
   use retention_groups, only: new_retention
   use stress_units, only: KILOPASCAL
   use triax_case, only: case_keys
   use triax_stage, only: CONTROL_NAMES, lead_keys
   use library_tables, only: property_count, property_name, property_unit, property_origin, property_meaning, &
      property_range
   implicit none (type, external)
   private
   public :: print_help, print_template

contains
   !> Prints the usage, every key of a case and every control.
   subroutine print_help()
      character(12), allocatable :: laws(:)
      type(key_table_t) :: table
      class(retention_t), allocatable :: unused
      type(fault_t) :: none
      integer :: i

      write (output_unit, '(a)') &
         'usage: mud_triax CASE.nml [--output FILE.csv] [--material NAME] [--quiet] [--residuals]', &
         '                 [--accuracy A] [--verify] [--save-failed FILE]', &
         '       mud_triax --template > my_case.nml', &
         '       mud_triax --help | --version', &
         '', &
         'Runs a laboratory test on a soil model at a point, MUD or another law, and writes a CSV file.', &
         'Compression is positive, stresses are effective, q = sigma_a - sigma_r is negative in extension.', &
         '', &
         '   --output FILE   where to write; default: NAME.csv in the current folder; "-" is the screen', &
         '   --material NAME   replaces &material of the case by a set of the library of materials (toyoura,', &
         '                   karlsruhe ...), or by a file whose name ends in .nml', &
         '   --accuracy A    relative error wanted in the histories, in place of accuracy of &case: increments and', &
         '                   the tolerance of the stress integration follow where they are not given', &
         '   --verify        runs once more with a quarter of the increments and a sixteenth of the tolerance; the', &
         '                   difference takes the place of the estimated errors', &
         '   --quiet         no summary, no progress', &
         '   --residuals     prints the error of every iteration for prescribed stresses', &
         '   --save-failed FILE   writes the first update that the library refuses to a new case file', &
         '   --template      prints a case that runs unchanged, with every parameter and its range', &
         '', &
         'Exit codes: 0 done; 2 input refused, nothing written; 3 the run stopped, rows so far are kept;', &
         '4 the output cannot be written.', &
         '', &
         'A case file is made of groups, "&name", "key = value" lines, "/"; "!" begins a comment:', &
         '   &material', &
         '      file             path of a material file, relative to the case file', &
         '      name, reference  texts', &
         '      (parameters)     by name, see --template; they replace those of the file'
      allocate (laws, source=law_names())
      do i = 2, size(laws)
         call print_keys(law_keys(laws(i), 'material'), ' with law = '''//trim(laws(i))// &
                         ''', besides name and reference')
      end do
      table = listing('retention')
      call new_retention(table, unused, none)
      call print_keys(table%keys, ' of a law that has none of its own')
      call print_keys(case_keys(KILOPASCAL), '')
      write (output_unit, '(a)') '   Controls, and the keys of which one ends the stage:'
      do i = 1, size(CONTROL_NAMES)
         write (output_unit, '(4a)') '      ', CONTROL_NAMES(i), ' ', lead_keys(i)
      end do
   end subroutine print_help

   !> A list of keys, under the heads of their groups.
   subroutine print_keys(keys, remark)
      type(key_t), intent(in) :: keys(:)   !< (keys to print)
      character(*), intent(in) :: remark   !< Behind the head.
      integer :: k

      do k = 1, size(keys)
         if (.not. any(keys(:k - 1)%group == keys(k)%group)) write (output_unit, '(3a)') '   &', &
            trim(keys(k)%group), remark
         write (output_unit, '(4a)') '      ', keys(k)%name, ' ', described(keys(k))
      end do
   end subroutine print_keys

   !> Prints a case that runs unchanged, with every parameter, its range and its origin.
   subroutine print_template()
      real(wp) :: lower, upper, preset
      integer :: i

      write (output_unit, '(a)') &
         '! A case for mud_triax: undrained compression, drained extension, cycles. All keys: mud_triax --help', &
         '&case', &
         '   name = ''my_case''', &
         '   title = ''undrained compression, drained extension, undrained cycles''', &
         '/', &
         '&material   ! or file = ''path'', with the values to change after it; a parameter left out has its default', &
         '   name = ''my sand'''
      do i = 1, property_count()
         call property_range(i, lower, upper, preset)
         write (output_unit, '(a)') '   '//padded(property_name(i)//' = '//short(preset), 26)//' ! '// &
            property_meaning(i)// &
            '; '//short(lower)//' to '//short(upper)//units(property_unit(i))//' ['//property_origin(i)//']'
      end do
      write (output_unit, '(a)') &
         '/', &
         '&initial', &
         '   p_eff = 100.0             ! mean effective stress [kPa]; or sigma_a and sigma_r', &
         '   void_ratio = 0.8', &
         '   suction = 0.0             ! [kPa], 0: saturated', &
         '/', &
         '&stage', &
         '   control = ''undrained''', &
         '   eps_a_end = 0.01          ! strains count from the start of the test', &
         '   increment = 1e-4', &
         '   output_interval = 1e-3', &
         '/', &
         '&stage', &
         '   control = ''drained''', &
         '   eps_a_end = -0.02', &
         '/', &
         '&stage                      ! ten cycles of deviator stress, or fewer', &
         '   control = ''undrained''', &
         '   cycle_by = ''q''            ! or eps_a; gamma and tau in simple shear', &
         '   amplitude = 5.0           ! [kPa]', &
         '   cycles = 10', &
         '   stop_r_u = 0.95           ! pore pressure ratio', &
         '/'
   end subroutine print_template

   pure function padded(text, width) result(filled)
      character(*), intent(in) :: text
      integer, intent(in) :: width
      character(max(width, len(text))) :: filled

      filled = text
   end function padded

   pure function units(unit) result(text)
      character(*), intent(in) :: unit
      character(:), allocatable :: text

      text = ''
      if (unit /= '1') text = ' '//unit
   end function units
end module triax_help
