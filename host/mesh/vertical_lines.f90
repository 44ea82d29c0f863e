! SPDX-License-Identifier: MIT
!> The triangles that a vertical line passes, for the weight of what lies above a point. Sides are taken as straight.
module vertical_lines
   use kinds, only: wp
   use triangle_mesh, only: mesh_t
   implicit none (type, external)
   private
   public :: strips_t, new_strips, pieces_above

   real(wp), parameter :: ROUNDED = 1.0e-12_wp   !< Share of the length of a line that is rounding.

   !> Triangles of a mesh by vertical strips of one width, so that a line looks at few of them.
   type :: strips_t
      real(wp) :: left = 0.0_wp, width = 1.0_wp   !< [m]
      integer, allocatable :: first(:)   !< First entry of a strip in `elements`; one more than there are strips.
      integer, allocatable :: elements(:)
   end type strips_t
contains
   !> Strips of all triangles, as many as make few triangles each.
   pure function new_strips(mesh) result(strips)
      type(mesh_t), intent(in) :: mesh
      type(strips_t) :: strips
      real(wp) :: r(2, size(mesh%t6, 2))
      integer :: e, k, n, pass
      integer, allocatable :: at(:)

      do e = 1, size(r, 2)
         r(:, e) = [minval(mesh%x(1, mesh%t6(:3, e))), maxval(mesh%x(1, mesh%t6(:3, e)))]
      end do
      n = max(1, int(sqrt(real(size(r, 2), wp))))
      strips%left = minval(r(1, :))
      strips%width = (maxval(r(2, :)) - strips%left)/n
      allocate (at(n + 1), source=0)
      do pass = 1, 2
         do e = 1, size(r, 2)
            do k = strip_at(strips, n, r(1, e)), strip_at(strips, n, r(2, e))
               if (pass == 2) strips%elements(at(k)) = e
               at(k) = at(k) + 1
            end do
         end do
         if (pass == 2) exit
         strips%first = [1, (1 + sum(at(:k)), k=1, n)]
         allocate (strips%elements(strips%first(n + 1) - 1))
         at = strips%first
      end do
   end function new_strips

   pure integer function strip_at(strips, number, r)
      type(strips_t), intent(in) :: strips
      integer, intent(in) :: number
      real(wp), intent(in) :: r   !< [m]

      strip_at = min(number, max(1, 1 + int((r - strips%left)/strips%width)))
   end function strip_at

   !> Pieces of the line from a point upwards to a height, or, where that is none, to the top of what it passes: ends
   !> [m], and the triangle of every piece, 0 where there is none.
   subroutine pieces_above(mesh, strips, x, height, ends, element)
      type(mesh_t), intent(in) :: mesh
      type(strips_t), intent(in) :: strips
      real(wp), intent(in) :: x(2)   !< [m]
      real(wp), intent(in), optional :: height   !< [m]
      real(wp), allocatable, intent(out) :: ends(:)   !< (pieces + 1) From the point on.
      integer, allocatable, intent(out) :: element(:)   !< (pieces)
      real(wp) :: z(2), top, at, rounding
      real(wp), allocatable :: span(:, :)
      integer, allocatable :: passed(:)
      integer :: i, j, n, pieces

      associate (k => strip_at(strips, size(strips%first) - 1, x(1)))
         allocate (span(2, strips%first(k + 1) - strips%first(k)), passed(strips%first(k + 1) - strips%first(k)))
         n = 0
         do i = strips%first(k), strips%first(k + 1) - 1
            associate (corners => mesh%x(:, mesh%t6(:3, strips%elements(i))))
               if (minval(corners(1, :)) > x(1) .or. maxval(corners(1, :)) < x(1)) cycle
               z = heights_at(corners, x(1))
            end associate
            if (z(2) <= x(2)) cycle
            ! By their lower ends; triangles mostly come in that order.
            j = n
            do while (j > 0)
               if (span(1, j) <= z(1)) exit
               span(:, j + 1) = span(:, j)
               passed(j + 1) = passed(j)
               j = j - 1
            end do
            span(:, j + 1) = z
            passed(j + 1) = strips%elements(i)
            n = n + 1
         end do
      end associate
      top = x(2)
      if (n > 0) top = max(top, maxval(span(2, :n)))
      if (present(height)) top = height
      rounding = ROUNDED*abs(top - x(2))
      allocate (ends(2*n + 2), element(2*n + 1))
      at = x(2)
      ends(1) = at
      pieces = 0
      do i = 1, n
         if (at >= top - rounding) exit
         if (min(span(2, i), top) <= at + rounding) cycle
         if (span(1, i) > at + rounding) call add(min(span(1, i), top), 0)
         if (span(1, i) < top) call add(min(span(2, i), top), passed(i))
      end do
      ! To the very top: what is left is without triangle, but for rounding.
      if (pieces == 0 .or. abs(top - at) > rounding) then
         call add(top, 0)
      else
         ends(pieces + 1) = top
      end if
      ends = ends(:pieces + 1)
      element = element(:pieces)
   contains
      subroutine add(until, triangle)
         real(wp), intent(in) :: until
         integer, intent(in) :: triangle

         pieces = pieces + 1
         ends(pieces + 1) = until
         element(pieces) = triangle
         at = until
      end subroutine add
   end subroutine pieces_above

   !> Finds the lowest and highest point of a triangle on a vertical line that meets it [m].
   pure function heights_at(corners, r) result(z)
      real(wp), intent(in) :: corners(2, 3), r   !< [m]
      real(wp) :: z(2), at
      integer :: k

      z = [huge(1.0_wp), -huge(1.0_wp)]
      do k = 1, 3
         associate (a => corners(:, k), b => corners(:, mod(k, 3) + 1))
            if (min(a(1), b(1)) > r .or. max(a(1), b(1)) < r) cycle
            if (abs(b(1) - a(1)) > 0.0_wp) then
               at = a(2) + (b(2) - a(2))*(r - a(1))/(b(1) - a(1))
               z = [min(z(1), at), max(z(2), at)]
            else
               z = [min(z(1), a(2), b(2)), max(z(2), a(2), b(2))]
            end if
         end associate
      end do
   end function heights_at
end module vertical_lines
