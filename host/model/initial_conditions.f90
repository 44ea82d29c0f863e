! SPDX-License-Identifier: MIT
!> The state at the start of a scene: pressures, degree of saturation, effective stress.
!> docs/theory/host.md section 8.
module initial_conditions
   use exit_codes, only: EXIT_MATERIAL
   use kinds, only: wp
   use model_types, only: model_t, gravity_at
   use given_pressures, only: pressures_at_start, water, suction
   use porous_domain, only: state_t, new_state_of, pressures_at, COUPLED, DRY, is_present
   use material_mud, only: mud_t
   use material_point, only: material_t
   use retention_curves, only: saturation_t
   use faults, only: fault_t, raise
   use texts, only: short, whole
   use unknown_fields, only: AT_U_Z, AT_P_W, AT_P_C
   use scene_types, only: initial_t
   use staged_ground, only: is_staged, ground_of
   implicit none (type, external)
   private
   public :: initial_state, tension_t

   integer, parameter :: SLICES = 400   !< Of a column, for its weight: relative error 1/(24 SLICES**2) of its bend.

   !> Points of MUD with a tensile component of the effective stress that the scene prescribes, or with no stress.
   type :: tension_t
      integer :: points = 0
      integer :: bare = 0            !< Points without effective stress: sand has no stiffness there.
      real(wp) :: largest = 0.0_wp   !< [kPa]
      real(wp) :: z = 0.0_wp         !< Where it is [m].
   end type tension_t
contains
   !> State of a model at the start; a fault where a material refuses it. `tension`: points with a tensile stress.
   !> docs/theory/host.md section 8. Stresses: tension positive, pore pressures: compression positive [kPa]. Fault
   !> EXIT_MATERIAL.
   subroutine initial_state(model, state, fault, tension)
      type(model_t), intent(in) :: model
      type(state_t), intent(out) :: state
      type(fault_t), intent(inout) :: fault
      type(tension_t), intent(out), optional :: tension
      type(initial_t), allocatable :: of_point(:)
      type(saturation_t) :: sat
      character(600) :: text
      real(wp) :: p_c, pressures(2)
      integer :: e, g, p, i, n

      state = new_state_of(model%domain)
      state%gravity = gravity_at(model, state%time)
      if (is_staged(model)) then
         state%present = ground_of(model, 1)
         state%joins = spread(.false., 1, size(state%present))
      end if
      allocate (of_point(size(state%s)))
      do i = 1, size(model%initials)
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            do n = 1, size(group%nodes)
               state%v(AT_U_Z, group%nodes(n)) = one%v_z + one%wave*sin(one%wave_number &
                                               *(model%domain%mesh%x(2, group%nodes(n)) - one%datum))
            end do
            do n = 1, size(group%elements)
               of_point((group%elements(n) - 1)*model%domain%rule + 1:group%elements(n)*model%domain%rule) = one
            end do
         end associate
      end do
      state%x(AT_P_W:AT_P_C, :) = pressures_at_start(model)
      call clear_dry_nodes(model, state%x)
      ! Pressures live on the vertices alone where they are linear.
      if (model%domain%n_p == 3) then
         do e = 1, size(model%domain%mesh%t6, 2)
            state%x(AT_P_W:AT_P_C, model%domain%mesh%t6(4:6, e)) = 0.0_wp
         end do
      end if
      do e = 1, size(model%domain%mesh%t6, 2)
         associate (region => model%domain%regions(model%domain%region_of(e)))
            do g = 1, model%domain%rule
               p = (e - 1)*model%domain%rule + g
               associate (gp => model%domain%gauss(g, e))
                  pressures = pressures_at(model%domain, e, g, state%x(AT_P_W:, &
                     model%domain%carriers(:model%domain%n_carriers(e), e)))
                  p_c = pressures(2)
                  ! New ground brings the water of its own suction, whatever its first nodes have.
                  if (.not. is_present(state, e)) p_c = suction(of_point(p), gp%x(2))
                  if (region%with_c) then
                     sat = region%law%retention(p_c, state%e(p))
                     state%s(p) = sat%s
                     if (of_point(p)%saturation > 0.0_wp) state%s(p) = of_point(p)%saturation
                  end if
                  call set_stress(model, e, of_point(p), gp%x(2), state%s(p), state%stress(:, p))
                  if (present(tension)) call note_tension(region%law, state%stress(:, p), gp%x(2), tension)
               end associate
               associate (own => state%state(model%domain%before_state(e) + (g - 1)*region%law%n_state + 1: &
                                             model%domain%before_state(e) + g*region%law%n_state))
                  text = ''
                  if (region%with_c .and. of_point(p)%saturation > 0.0_wp) &
                     call region%law%preset_saturation(of_point(p)%saturation, own, text)
                  if (text == '') call region%law%initial_state(state%stress(:, p), p_c, state%e(p), own, text)
                  if (text == '') then
                     state%e(p) = region%law%void_ratio(own)
                     if (region%with_c) state%s(p) = region%law%saturation(own)
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

   pure subroutine note_tension(law, stress, z, tension)
      class(material_t), intent(in) :: law
      real(wp), intent(in) :: stress(6), z
      type(tension_t), intent(inout) :: tension

      select type (law)
      type is (mud_t)
         if (.not. any(abs(stress(1:3)) > 0.0_wp)) tension%bare = tension%bare + 1
         if (.not. any(stress(1:3) > 0.0_wp)) return
         tension%points = tension%points + 1
         if (maxval(stress(1:3)) <= tension%largest) return
         tension%largest = maxval(stress(1:3))
         tension%z = z
      end select
   end subroutine note_tension

   !> Where no region has fluids there are no pressures; undrained elements begin with the means of theirs.
   pure subroutine clear_dry_nodes(model, x)
      type(model_t), intent(in) :: model
      real(wp), intent(inout) :: x(:, :)   !< (FIELDS, nodes)
      logical :: wet(size(x, 2))
      integer :: e

      associate (domain => model%domain)
         if (all(domain%regions%drainage == COUPLED)) return
         wet = .false.
         do e = 1, size(domain%region_of)
            if (domain%regions(domain%region_of(e))%drainage /= DRY) wet(domain%mesh%t6(:, e)) = .true.
            if (domain%center(e) == 0) cycle
            wet(domain%center(e)) = .true.
            x(AT_P_W:AT_P_C, domain%center(e)) = domain%given(:, domain%center(e))
         end do
         do e = 1, size(x, 2)
            if (.not. wet(e)) x(AT_P_W:AT_P_C, e) = 0.0_wp
         end do
      end associate
   end subroutine clear_dry_nodes

   !> Effective stress, tension positive.
   subroutine set_stress(model, element, initial, z, s, stress)
      type(model_t), intent(in) :: model
      integer, intent(in) :: element
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z, s
      real(wp), intent(inout) :: stress(6)
      real(wp) :: vertical, p_w, p_c, chi, shift

      if (initial%uniform) stress(1:3) = initial%sigma
      if (.not. initial%geostatic) return
      associate (region => model%domain%regions(model%domain%region_of(element)))
         p_w = merge(water(initial, z), 0.0_wp, region%with_w)
         p_c = merge(suction(initial, z), 0.0_wp, region%with_c)
      end associate
      vertical = initial%surcharge + weight_above(model, element, initial, z)
      chi = s*max(p_c, 0.0_wp)
      vertical = vertical - (p_w + (1 - s)*p_c)   ! effective, compression positive
      shift = merge(chi, 0.0_wp, initial%net)
      stress(2) = -vertical
      stress([1, 3]) = -(initial%k_0*(vertical - shift) + shift)
   end subroutine set_stress

   !> Weight of a column of this region from z to the surface [kPa].
   real(wp) function weight_above(model, element, initial, z) result(weight)
      type(model_t), intent(in) :: model
      integer, intent(in) :: element
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z
      type(saturation_t) :: sat
      real(wp) :: at, step, n, p_a, p_c, p_c_before, rho_a
      integer :: i

      weight = 0.0_wp
      p_c_before = huge(p_c_before)
      step = (initial%surface - z)/SLICES
      associate (m => model%domain, region => model%domain%regions(model%domain%region_of(element)))
         n = region%void_ratio/(1 + region%void_ratio)
         do i = 1, SLICES
            at = z + (i - 0.5_wp)*step
            weight = weight + (1 - n)*region%rho_s
            p_c = suction(initial, at)
            ! a suction that is the same all over has one degree of saturation
            if (region%with_c .and. abs(p_c - p_c_before) > 0.0_wp) sat = region%law%retention(p_c, region%void_ratio)
            p_c_before = p_c
            if (region%with_c .and. initial%saturation > 0.0_wp) sat%s = initial%saturation
            rho_a = m%fluids%rho_a
            p_a = water(initial, at) + p_c
            if (m%fluids%ideal_gas) rho_a = rho_a*(1 + p_a/m%fluids%p_ref)
            if (region%with_w) weight = weight + n*(sat%s*m%fluids%rho_w + (1 - sat%s)*rho_a)
         end do
      end associate
      weight = weight*step*gravity_at(model, 0.0_wp)
   end function weight_above
end module initial_conditions
