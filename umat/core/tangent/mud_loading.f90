! SPDX-License-Identifier: MIT
!> Changes of the part of a strain rate that loads along the directions of a derivative: a sum of the changes of the
!> strain, of those of the elastic domain at the start, and of two fixed tensors.
module mud_loading
   use mud_kinds, only: wp
   use mud_tensor, only: DIRECTIONS, tensors_t, contracted, traces, ddot, trace, UNIT_STRAINS, ANY_TENSORS
   implicit none (type, external)
   private
   public :: loading_t, whole_strain, loading_contracted, loading_traces, add_loading

   !> The rates themselves and the parts of their changes, [-] per unit of pseudo-time.
   type :: loading_t
      real(wp) :: basis(6, 2)             !< the fixed tensors: what loads is the sum of part times them
      logical :: turns                    !< the domain turns; otherwise the second tensor is zero
      logical :: aside                    !< a part of the strain rate does not load
      logical :: beside                   !< a part of its changes does not
      real(wp) :: part(2), whole(2)       !< factors of what loads, of the whole strain rate
      real(wp) :: of_strain, of_centre    !< factors of the changes of strain rate and centre
      real(wp) :: along(DIRECTIONS, 2)         !< changes along the fixed tensors
      real(wp) :: from_centre             !< volumetric strain from the centre of the elastic domain, if beside
      real(wp) :: of_volume(DIRECTIONS)        !< changes of that, if aside
   end type loading_t
contains
   !> All of a strain rate loads. d_strain [-].
   pure subroutine whole_strain(d_strain, loading)
      real(wp), intent(in) :: d_strain(6)
      type(loading_t), intent(inout) :: loading

      loading%basis(:, 1) = d_strain
      loading%basis(:, 2) = 0.0_wp
      loading%turns = .false.
      loading%aside = .false.
      loading%beside = .false.
      loading%whole = [1.0_wp, 0.0_wp]
      loading%part = loading%whole
      loading%of_strain = 1.0_wp
      loading%of_centre = 0.0_wp
      loading%along = 0.0_wp
   end subroutine whole_strain

   !> Contractions of the changes with a, in its unit. strain and centre are the changes [-] that loading refers to.
   !> Derivative of docs/theory/memory-rules.md section 4.2.
   pure function loading_contracted(loading, strain, centre, a) result(c)
      type(loading_t), intent(in) :: loading
      type(tensors_t), intent(in) :: strain, centre
      real(wp), intent(in) :: a(6)
      real(wp) :: c(DIRECTIONS)

      c = ddot(loading%basis(:, 1), a)*loading%along(:, 1)
      if (loading%turns) c = c + ddot(loading%basis(:, 2), a)*loading%along(:, 2)
      if (strain%kind == UNIT_STRAINS) then
         c(1:6) = c(1:6) + loading%of_strain*a
      else
         c = c + loading%of_strain*contracted(strain, a)
      end if
      if (centre%kind == ANY_TENSORS) c = c + loading%of_centre*contracted(centre, a)
   end function loading_contracted

   !> Traces of the changes [-]. Arguments as in loading_contracted, and its source.
   pure function loading_traces(loading, strain, centre) result(c)
      type(loading_t), intent(in) :: loading
      type(tensors_t), intent(in) :: strain, centre
      real(wp) :: c(DIRECTIONS)

      c = loading%of_strain*traces(strain) + trace(loading%basis(:, 1))*loading%along(:, 1) &
          + trace(loading%basis(:, 2))*loading%along(:, 2)
      if (centre%kind == ANY_TENSORS) c = c + loading%of_centre*traces(centre)
   end function loading_traces

   !> Adds what is not along the fixed tensors to sums, strain by of_strain and centre by of_centre, in their unit.
   pure subroutine add_loading(strain, centre, of_strain, of_centre, sums)
      type(tensors_t), intent(in) :: strain, centre
      real(wp), intent(in) :: of_strain, of_centre
      real(wp), intent(inout) :: sums(DIRECTIONS, 6)
      integer :: i

      if (strain%kind == UNIT_STRAINS) then
         do i = 1, 3
            sums(i, i) = sums(i, i) + of_strain
            sums(i + 3, i + 3) = sums(i + 3, i + 3) + 0.5_wp*of_strain
         end do
      else if (strain%kind == ANY_TENSORS) then
         sums = sums + of_strain*strain%of
      end if
      if (centre%kind == ANY_TENSORS) sums = sums + of_centre*centre%of
   end subroutine add_loading
end module mud_loading
