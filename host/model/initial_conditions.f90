! SPDX-License-Identifier: MIT
!> The state at the start of a scene: pressures, degree of saturation, effective stress.
!> docs/theory/host.md section 8.
module initial_conditions
   use acting_places, only: ground_of
   use exit_codes, only: EXIT_MATERIAL
   use kinds, only: wp
   use model_types, only: model_t, gravity_at, initial_t
   use given_pressures, only: pressures_at_start, water, suction
   use porous_domain, only: model_state_t, new_state_of, pressures_at, COUPLED, DRAINED, UNDRAINED, DRY
   use material_point, only: material_t, range_t
   use retention_curves, only: saturation_t
   use faults, only: fault_t, raise
   use start_findings, only: tension_t, use_t
   use texts, only: short, whole
   use triangle_mesh, only: nodes_of
   use unknown_fields, only: AT_U_Z, AT_P_W, AT_P_C
   use vertical_lines, only: strips_t, new_strips, pieces_above
   implicit none (type, external)
   private
   public :: initial_state

   integer, parameter :: OF_COLUMN = 400   !< Slices of a column, for its weight: relative error 1/(24 of the square).

   !> What the stress of a point is found from: which &initial every element has, and what lies above what.
   type :: ground_t
      type(initial_t), allocatable :: initials(:)   !< Those of the scene, after them one that gives nothing.
      integer, allocatable :: of(:)                 !< Place of that of every element in them.
      logical, allocatable :: present(:)            !< (elements) In the first stage.
      logical :: alike = .true.                     !< One region, one &initial: what lies above a point is as it is.
      type(strips_t) :: strips
   end type ground_t
contains
   !> Sets the state of a model at the start; a fault where a material refuses it. `tension`: points with a tensile
   !> stress. docs/theory/host.md section 8. Stresses: tension positive, pore pressures: compression positive [kPa].
   !> Fault EXIT_MATERIAL.
   subroutine initial_state(model, state, fault, tension)
      type(model_t), intent(in) :: model
      type(model_state_t), intent(out) :: state
      type(fault_t), intent(inout) :: fault
      type(tension_t), intent(out) :: tension
      type(ground_t) :: ground
      type(saturation_t) :: sat
      character(600) :: text
      real(wp) :: p_c, pressures(2)
      integer :: e, g, p

      allocate (tension%uses(size(model%domain%regions)))
      state = new_state_of(model%domain)
      state%gravity = gravity_at(model, state%time)
      ground = ground_at_start(model)
      call set_nodes(model, ground%present, state)
      do e = 1, size(model%domain%mesh%t6, 2)
         associate (region => model%domain%regions(model%domain%region_of(e)), one => ground%initials(ground%of(e)))
            do g = 1, model%domain%rule
               p = (e - 1)*model%domain%rule + g
               associate (gp => model%domain%gauss(g, e))
                  pressures = pressures_at(model%domain, e, g, state%x(AT_P_W:, &
                     model%domain%carriers(:model%domain%n_carriers(e), e)))
                  p_c = pressures(2)
                  ! New ground brings the water of its own suction, whatever its first nodes have.
                  if (.not. ground%present(e)) p_c = suction(one, gp%x(2))
                  if (region%with_c) then
                     sat = region%law%retention(p_c, state%e(p))
                     state%s(p) = sat%s
                     if (one%saturation > 0.0_wp) state%s(p) = one%saturation
                  end if
                  call set_stress(model, ground, e, gp%x, state%s(p), state%stress(:, p))
                  ! Ground that joins later comes without stress, and no &initial can give it one.
                  if (ground%present(e)) call note_tension(region%law, state%stress(:, p), gp%x(2), tension)
               end associate
               associate (own => state%state(model%domain%before_state(e) + (g - 1)*region%law%n_state + 1: &
                                             model%domain%before_state(e) + g*region%law%n_state))
                  text = ''
                  if (region%with_c .and. one%saturation > 0.0_wp) &
                     call region%law%preset_saturation(one%saturation, own, text)
                  if (text == '') call region%law%initial_state(state%stress(:, p), p_c, state%e(p), own, text)
                  if (text == '') then
                     state%e(p) = region%law%void_ratio(own)
                     if (region%with_c) state%s(p) = region%law%saturation(own)
                     call note_use(region%law, state%e(p), -sum(state%stress(1:3, p))/3, &
                                                         tension%uses(model%domain%region_of(e)))
                     cycle
                  end if
               end associate
               call raise(fault, EXIT_MATERIAL, 'Element '//whole(e)//', point '//whole(g)//' at z = '// &
                          short(model%domain%gauss(g, e)%x(2))//' m: '//trim(text))
               return
            end do
         end associate
      end do
   end subroutine initial_state

   !> Sets velocities and pressures of the nodes.
   subroutine set_nodes(model, present, state)
      type(model_t), intent(in) :: model
      logical, intent(in) :: present(:)   !< (elements) In the first stage.
      type(model_state_t), intent(inout) :: state
      integer :: i

      associate (mesh => model%domain%mesh)
         do i = 1, size(model%initials)
            associate (one => model%initials(i), nodes => mesh%groups(model%initials(i)%group)%nodes)
               state%v(AT_U_Z, nodes) = one%v_z + one%wave*sin(one%wave_number*(mesh%x(2, nodes) - one%datum))
            end associate
         end do
         ! Tied nodes move as one from the start, as the first of them.
         do i = 1, size(mesh%x, 2)
            associate (at => model%dofs%of(AT_U_Z, i))
               if (at > 0) state%v(AT_U_Z, i) = state%v(AT_U_Z, model%dofs%node(at))
            end associate
         end do
         associate (flows => present .and. model%domain%regions(model%domain%region_of)%drainage == COUPLED)
            state%x(AT_P_W:AT_P_C, :) = pressures_at_start(model, flows)
            call share_pressures(model, nodes_of(mesh, flows), state%x)
         end associate
         call set_given_nodes(model, present, state%x)
         ! Pressures live on the vertices alone where they are linear.
         if (model%domain%n_p == 3) state%x(AT_P_W:AT_P_C, [mesh%t6(4:6, :)]) = 0.0_wp
      end associate
   end subroutine set_nodes

   !> Tied nodes whose pressures are one begin alike, as the first of them whose fluids flow.
   pure subroutine share_pressures(model, flows, x)
      type(model_t), intent(in) :: model
      logical, intent(in) :: flows(:)      !< (nodes)
      real(wp), intent(inout) :: x(:, :)   !< (FIELDS, nodes)
      integer :: first(model%dofs%n), i, f

      first = model%dofs%node
      do i = size(flows), 1, -1
         do f = AT_P_W, AT_P_C
            if (flows(i) .and. model%dofs%of(f, i) > 0) first(model%dofs%of(f, i)) = i
         end do
      end do
      do i = 1, size(flows)
         do f = AT_P_W, AT_P_C
            if (model%dofs%of(f, i) > 0) x(f, i) = x(f, first(model%dofs%of(f, i)))
         end do
      end do
   end subroutine share_pressures

   pure subroutine note_use(law, e, p, use_of_law)
      class(material_t), intent(in) :: law
      real(wp), intent(in) :: e, p   !< [-], [kPa]
      type(use_t), intent(inout) :: use_of_law

      use_of_law%points = use_of_law%points + 1
      if (e < law%tested_e%least .or. e > law%tested_e%most) use_of_law%outside_e = use_of_law%outside_e + 1
      if (p < law%tested_p%least .or. p > law%tested_p%most) use_of_law%outside_p = use_of_law%outside_p + 1
      use_of_law%e = range_t(min(use_of_law%e%least, e), max(use_of_law%e%most, e))
      use_of_law%p = range_t(min(use_of_law%p%least, p), max(use_of_law%p%most, p))
   end subroutine note_use

   pure subroutine note_tension(law, stress, z, tension)
      class(material_t), intent(in) :: law
      real(wp), intent(in) :: stress(6), z
      type(tension_t), intent(inout) :: tension

      if (.not. law%cohesionless) return
      if (.not. any(abs(stress(1:3)) > 0.0_wp)) tension%bare = tension%bare + 1
      if (.not. any(stress(1:3) > 0.0_wp)) return
      tension%points = tension%points + 1
      if (maxval(stress(1:3)) <= tension%largest) return
      tension%largest = maxval(stress(1:3))
      tension%z = z
   end subroutine note_tension

   !> Where no region has fluids there are no pressures; drained ground that is there has its own, and undrained
   !> elements begin with the means of theirs.
   pure subroutine set_given_nodes(model, present, x)
      type(model_t), intent(in) :: model
      logical, intent(in) :: present(:)    !< (elements) In the first stage.
      real(wp), intent(inout) :: x(:, :)   !< (FIELDS, nodes)
      logical, dimension(size(x, 2)) :: own, without   !< Nodes with pressures of drained ground; of no fluids.

      associate (domain => model%domain)
         if (all(domain%regions%drainage == COUPLED)) return
         associate (centers => pack(domain%center, domain%center > 0), of => domain%regions(domain%region_of)%drainage)
            without = .not. nodes_of(domain%mesh, of /= DRY)
            without(centers) = .false.
            own = nodes_of(domain%mesh, of == DRAINED .and. present)
            if (any(own)) where (spread(own, 1, 2)) x(AT_P_W:AT_P_C, :) = domain%given(:, :, DRAINED)
            if (size(centers) > 0) x(AT_P_W:AT_P_C, centers) = domain%given(:, centers, UNDRAINED)
            where (spread(without, 1, 2)) x(AT_P_W:AT_P_C, :) = 0.0_wp
         end associate
      end associate
   end subroutine set_given_nodes

   !> Finds which &initial every element has, of several the last one, and the ground that weighs.
   function ground_at_start(model) result(ground)
      type(model_t), intent(in) :: model
      type(ground_t) :: ground
      integer :: i

      allocate (ground%initials(size(model%initials) + 1))
      ground%initials(:size(model%initials)) = model%initials
      ground%present = ground_of(model, 1)
      allocate (ground%of(size(ground%present)), source=size(ground%initials))
      do i = 1, size(model%initials)
         associate (elements => model%domain%mesh%groups(model%initials(i)%group)%elements)
            ground%of(elements) = i
         end associate
         ground%alike = ground%alike .and. .not. model%initials(i)%follows
      end do
      ground%alike = ground%alike .and. all(ground%present) .and. size(model%domain%regions) == 1 .and. &
                     all(ground%of == ground%of(1))
      if (.not. ground%alike) ground%strips = new_strips(model%domain%mesh)
   end function ground_at_start

   !> Sets the effective stress of a point, tension positive.
   subroutine set_stress(model, ground, element, x, s, stress)
      type(model_t), intent(in) :: model
      type(ground_t), intent(in) :: ground
      integer, intent(in) :: element
      real(wp), intent(in) :: x(2), s
      real(wp), intent(inout) :: stress(6)
      real(wp) :: vertical, p_w, p_c, chi, shift

      associate (initial => ground%initials(ground%of(element)))
         if (initial%uniform) stress(1:3) = initial%sigma
         if (.not. initial%geostatic) return
         associate (region => model%domain%regions(model%domain%region_of(element)))
            p_w = merge(water(initial, x(2)), 0.0_wp, region%with_w)
            p_c = merge(suction(initial, x(2)), 0.0_wp, region%with_c)
         end associate
         vertical = initial%surcharge + weight_above(model, ground, element, x)
         chi = s*max(p_c, 0.0_wp)
         vertical = vertical - (p_w + (1 - s)*p_c)   ! effective, compression positive
         shift = merge(chi, 0.0_wp, initial%net)
         stress(2) = -vertical
         stress([1, 3]) = -(initial%k_0*(vertical - shift) + shift)
      end associate
   end subroutine set_stress

   !> Weighs what lies between a point and the surface, layer by layer [kPa]; where no element does, it is as the
   !> point's own. docs/theory/host.md section 8.
   real(wp) function weight_above(model, ground, element, x) result(weight)
      type(model_t), intent(in) :: model
      type(ground_t), intent(in) :: ground
      integer, intent(in) :: element
      real(wp), intent(in) :: x(2)   !< [m]
      real(wp), allocatable :: ends(:)
      integer, allocatable :: of(:)
      integer :: i, last

      associate (initial => ground%initials(ground%of(element)))
         if (ground%alike) then
            ends = [x(2), initial%surface]
            of = [element]
         else if (initial%follows) then
            call pieces_above(model%domain%mesh, ground%strips, x, ends=ends, element=of)
         else
            call pieces_above(model%domain%mesh, ground%strips, x, initial%surface, ends, of)
         end if
      end associate
      where (of == 0) of = element
      weight = 0.0_wp
      if (.not. abs(ends(size(ends)) - x(2)) > 0.0_wp) return
      last = 1
      do i = 1, size(of)
         ! Triangles of one layer are one piece of it.
         if (i < size(of)) then
            if (model%domain%region_of(of(i)) == model%domain%region_of(of(i + 1)) .and. &
                ground%of(of(i)) == ground%of(of(i + 1))) cycle
         end if
         if (ground%present(of(i))) weight = weight + &
            weight_of_piece(model, ground%initials(ground%of(of(i))), of(i), ends([last, i + 1]), &
                            (ends(i + 1) - ends(last))/(ends(size(ends)) - ends(1)))
         last = i + 1
      end do
   end function weight_above

   !> Weighs a piece of a column in the region of an element [kPa].
   real(wp) function weight_of_piece(model, initial, element, ends, share) result(weight)
      type(model_t), intent(in) :: model
      type(initial_t), intent(in) :: initial
      integer, intent(in) :: element
      real(wp), intent(in) :: ends(2), share   !< [m]; of the column [-].
      type(saturation_t) :: sat
      real(wp) :: at, step, n, p_c, p_c_before, rho_a
      integer :: i, slices

      weight = 0.0_wp
      p_c_before = huge(p_c_before)
      slices = max(1, nint(OF_COLUMN*share))
      step = (ends(2) - ends(1))/slices
      associate (m => model%domain, region => model%domain%regions(model%domain%region_of(element)))
         n = region%void_ratio/(1 + region%void_ratio)
         do i = 1, slices
            at = ends(1) + (i - 0.5_wp)*step
            weight = weight + (1 - n)*region%rho_s
            p_c = suction(initial, at)
            ! a suction that is the same all over has one degree of saturation
            if (region%with_c .and. abs(p_c - p_c_before) > 0.0_wp) sat = region%law%retention(p_c, region%void_ratio)
            p_c_before = p_c
            if (region%with_c .and. initial%saturation > 0.0_wp) sat%s = initial%saturation
            rho_a = m%fluids%air_density(water(initial, at) + p_c)
            if (region%with_w) weight = weight + n*(sat%s*m%fluids%rho_w + (1 - sat%s)*rho_a)
         end do
      end associate
      weight = weight*step*gravity_at(model, 0.0_wp)
   end function weight_of_piece
end module initial_conditions
