!> What a table of results is made of, for every format.
module triax_table
   implicit none (type, external)
   private
   public :: column_t, attribute_t, TEXT_LENGTH

   integer, parameter :: TEXT_LENGTH = 1000

   !> A column of the results.
   type :: column_t
      character(16) :: name
      character(8) :: unit
      character(120) :: meaning
      logical :: whole = .false.   !< Counts.
   end type column_t

   !> A fact about the run.
   type :: attribute_t
      character(64) :: name = ''
      character(TEXT_LENGTH) :: text = ''
   end type attribute_t
end module triax_table
