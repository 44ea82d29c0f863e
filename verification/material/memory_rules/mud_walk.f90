! SPDX-License-Identifier: MIT
!> One point of soil along the paths of standard input; a row of CSV on standard output where a path asks for one.
!>
!>    case NAME                       begins a path with the default material
!>    set PARAMETER VALUE             a material parameter (a number)
!>    start S11 S22 S33 S12 S13 S23 SUCTION E     effective stress, compression positive, suction [kPa], void ratio
!>    lead F F F T F F                T: the component is led by its stress, F: by its strain
!>    go N D1 D2 D3 D4 D5 D6 DSUCTION N equal increments; engineering shear
!>    turn R11 R21 R31 R12 ... R33    rigid rotation
!>    row LABEL                       writes the state
!>    show NAME N                     writes a comment with N entries of STATEV from a name on
!>
!> A path whose increments fail ends with a row of status 1; its other lines are passed over.
program mud_walk
   use, intrinsic :: iso_fortran_env, only: input_unit, output_unit, iostat_end
   use kinds, only: wp
   use walk_point, only: point_t, prepare, set_property, start, lead_components, go, turn, state_of, &
      states_of
   implicit none (type, external)
   type(point_t) :: point
   character(40) :: name, word, label
   character(400) :: line
   logical :: failed
   integer :: code

   name = ''
   failed = .false.
   write (output_unit, '(a)') 'case,label,status,s11,s22,s33,s12,s13,s23,e11,e22,e33,g12,g13,g23,e,suction,rates,' &
      //'substeps,resets,cuts,iterations'
   do
      read (input_unit, '(a)', iostat=code) line
      if (code == iostat_end) exit
      if (len_trim(line) == 0) cycle
      read (line, *) word
      if (word /= 'case' .and. failed) cycle
      call follow(code)
      if (code /= 0) then
         print '(a)', 'mud_walk: case '//trim(name)//', not understood: '//trim(line)
         error stop 1
      end if
      if (failed) call write_row('failed')
   end do
contains
   subroutine follow(code)
      integer, intent(out) :: code
      real(wp) :: values(8), rotation(3, 3)
      logical :: by_stress(6)
      integer :: n

      select case (word)
      case ('case')
         read (line, *, iostat=code) word, name
         failed = .false.
         call prepare(point)
      case ('set')
         read (line, *, iostat=code) word, label, values(1)
         if (code == 0) call set_property(point, label, values(1))
      case ('start')
         read (line, *, iostat=code) word, values(1:8)
         if (code == 0) call start(point, values(1:6), values(7), values(8))
      case ('lead')
         read (line, *, iostat=code) word, by_stress
         if (code == 0) call lead_components(point, by_stress)
      case ('go')
         read (line, *, iostat=code) word, n, values(1:7)
         if (code == 0) call go(point, n, values(1:6)/n, values(7)/n, failed)
      case ('turn')
         read (line, *, iostat=code) word, rotation
         if (code == 0) call turn(point, rotation, failed)
      case ('row')
         read (line, *, iostat=code) word, label
         if (code == 0) call write_row(label)
      case ('show')
         read (line, *, iostat=code) word, label, n
         if (code == 0) write (output_unit, '("# ", a, *(1x, es13.6))') trim(label), states_of(point, trim(label), n)
      case default
         code = 1
      end select
   end subroutine follow

   subroutine write_row(label)
      character(*), intent(in) :: label

      write (output_unit, '(a, ",", a, ",", i0, 14(",", es22.15), 5(",", i0))') trim(name), trim(label), &
         merge(1, 0, failed), point%stress, point%strain, state_of(point, 'void_ratio'), point%suction, &
         nint(state_of(point, 'n_rate')), nint(state_of(point, 'n_substep')), nint(state_of(point, 'n_reset')), &
         point%halvings, point%iterations
   end subroutine write_row
end program mud_walk
