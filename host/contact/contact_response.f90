! SPDX-License-Identifier: MIT
!> Forces and stiffness of one pair of edges. The pressure at a point is
!>   nodal gaps      p = sum_A M_A p_A, p_A held: what follows from its change is added in contact_penalty;
!>   pointwise gaps  p = eps <-g>.
!> docs/theory/contact.md section 3.
module contact_response
   use contact_mortar, only: mortar_point_t, hats, hat_slopes, forces_on_nodes
   use kinds, only: wp
   implicit none (type, external)
   private
   public :: pair_response_t, nodal_forces_t, nodal_response, pointwise_response, new_forces, make_room, add_column

   integer, parameter :: FIRST_ROOM = 1024   !< Triplets to begin with.

   !> Forces and stiffness of a pair, in local coordinates.
   type :: pair_response_t
      real(wp) :: force(12) = 0.0_wp           !< To be added to the internal forces [kN]
      real(wp) :: stiffness(12, 12) = 0.0_wp   !< d force/d coordinates [kN/m]
      real(wp) :: energy = 0.0_wp              !< Pointwise form only [kN m]
      real(wp) :: load(3) = 0.0_wp             !< Pointwise form only: int M_A p 2 pi r dGamma [kN]
   end type pair_response_t

   !> Forces over numbered unknowns, and their slopes as entries of a matrix.
   type :: nodal_forces_t
      real(wp), allocatable :: force(:)         !< Slope of the energy: minus what contact exerts on the nodes [kN]
      real(wp), allocatable :: size(:)          !< Sum of the magnitudes that a force is made of [kN].
      integer :: triplets = 0                   !< Number of triplets that are filled.
      integer, allocatable :: row(:), column(:)
      real(wp), allocatable :: value(:)         !< d force/d displacement; equal places are to be added [kN/m]
   end type nodal_forces_t
contains
   !> Makes room for forces, of which there are none yet.
   pure function new_forces(unknowns) result(forces)
      integer, intent(in) :: unknowns
      type(nodal_forces_t) :: forces

      allocate (forces%force(unknowns), forces%size(unknowns), source=0.0_wp)
      allocate (forces%row(FIRST_ROOM), forces%column(FIRST_ROOM), source=0)
      allocate (forces%value(FIRST_ROOM), source=0.0_wp)
   end function new_forces

   !> Makes room for more triplets: it doubles, so that it soon stays as it is.
   pure subroutine make_room(forces, more)
      class(nodal_forces_t), intent(inout) :: forces
      integer, intent(in) :: more   !< Triplets.
      integer :: n

      if (forces%triplets + more <= size(forces%row)) return
      n = max(size(forces%row), more)
      forces%row = [forces%row, spread(0, 1, n)]
      forces%column = [forces%column, spread(0, 1, n)]
      forces%value = [forces%value, spread(0.0_wp, 1, n)]
   end subroutine make_room

   !> Entries of one column of the tangent; exact zeros are left out. There must be room for them.
   pure subroutine add_column(forces, rows, column, values)
      class(nodal_forces_t), intent(inout) :: forces
      integer, intent(in) :: rows(:), column   !< Numbers of unknowns. (entries)
      real(wp), intent(in) :: values(:)        !< (entries) [kN/m]
      integer :: i

      do i = 1, size(rows)
         if (.not. abs(values(i)) > 0.0_wp) cycle
         forces%triplets = forces%triplets + 1
         forces%row(forces%triplets) = rows(i)
         forces%column(forces%triplets) = column
         forces%value(forces%triplets) = values(i)
      end do
   end subroutine add_column

   !> Adds the forces of a pair and, if wanted, their stiffness, of pressures or, where it slides, tractions of its
   !> slave nodes, which are held. docs/theory/contact.md sections 3 and 9.
   pure subroutine nodal_response(points, slides, values, with_stiffness, response)
      type(mortar_point_t), intent(in) :: points(:)
      logical, intent(in) :: slides
      real(wp), intent(in) :: values(3)   !< [kPa]
      logical, intent(in) :: with_stiffness
      type(pair_response_t), intent(out) :: response
      integer :: k

      do k = 1, size(points)
         associate (p => points(k))
            call add_work(p, slides, dot_product(hats(p%s), values), dot_product(hat_slopes(p%s), values)*p%d_s, &
                          with_stiffness, response)
         end associate
      end do
   end subroutine nodal_response

   !> Adds the forces of a pair and, if wanted, their stiffness, of a penalty on the gap at its points.
   !> docs/theory/contact.md section 3.
   pure subroutine pointwise_response(points, penalty, with_stiffness, response)
      type(mortar_point_t), intent(in) :: points(:)
      real(wp), intent(in) :: penalty       !< [kN/m3]
      logical, intent(in) :: with_stiffness
      type(pair_response_t), intent(out) :: response
      real(wp) :: pressure, gap
      integer :: k

      do k = 1, size(points)
         associate (p => points(k))
            if (p%phi >= 0.0_wp) cycle
            gap = p%phi/p%length
            pressure = -penalty*gap
            response%energy = response%energy + 0.5_wp*penalty*gap**2*p%length*p%area
            response%load = response%load + p%area*p%length*hats(p%s)*pressure
            call add_work(p, .false., pressure, -penalty/p%length*(p%d_phi - gap*p%d_length), with_stiffness, response)
         end associate
      end do
   end subroutine pointwise_response

   !> A pressure acts along the slave's normal at both points: the forces of a pair of points cancel and lie on one
   !> line, so that momentum and its moment are kept exactly. A traction acts along the slave's tangent.
   !> docs/theory/contact.md sections 3 and 9.
   pure subroutine add_work(p, slides, pressure, d_pressure, with_stiffness, response)
      type(mortar_point_t), intent(in) :: p
      logical, intent(in) :: slides   !< It acts along the tangent.
      real(wp), intent(in) :: pressure, d_pressure(12)   !< At the point [kPa], by the local coordinates [kPa/m].
      logical, intent(in) :: with_stiffness
      type(pair_response_t), intent(inout) :: response
      real(wp) :: nu(2), d_nu(2, 12)   !< Direction, as long as the slave's tangent [m], and its slopes [-].
      real(wp) :: push(12), d_load(12), load
      integer :: i, j, c

      if (slides) then
         nu = p%t
         d_nu = p%d_t
      else
         nu = [p%t(2), -p%t(1)]
         d_nu(1, :) = p%d_t(2, :)
         d_nu(2, :) = -p%d_t(1, :)
      end if
      load = p%area*pressure
      push = forces_on_nodes(p, nu)
      response%force = response%force + load*push
      if (.not. with_stiffness) return
      d_load = pressure*p%d_area + p%area*d_pressure
      do j = 1, 12
         response%stiffness(:, j) = response%stiffness(:, j) + d_load(j)*push
      end do
      do c = 1, 2
         do i = 1, 3
            response%stiffness(2*i - 2 + c, :) = response%stiffness(2*i - 2 + c, :) &
                                                 + load*(p%ns(i)*d_nu(c, :) + nu(c)*p%dns(i)*p%d_s)
            response%stiffness(2*i + 4 + c, :) = response%stiffness(2*i + 4 + c, :) &
                                                 - load*(p%nm(i)*d_nu(c, :) + nu(c)*p%dnm(i)*p%d_m)
         end do
      end do
   end subroutine add_work
end module contact_response
