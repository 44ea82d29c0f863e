!> The state at the start of a scene: pressures, degree of saturation, effective stress.
module host_initial
   use host_kinds, only: EXIT_MATERIAL
   use kinds, only: wp
   use host_scene, only: scene_t, initial_t
   use fe_model, only: state_t, new_state_of
   use fe_retention, only: saturation_t
   use faults, only: fault_t, raise
   use texts, only: short, whole
   implicit none (type, external)
   private
   public :: initial_state

   integer, parameter :: SLICES = 400   !< Of a column, for its weight: relative error 1/(24 SLICES**2) of its bend.
contains
   subroutine initial_state(scene, state, fault)
      type(scene_t), intent(in) :: scene
      type(state_t), intent(out) :: state
      type(fault_t), intent(inout) :: fault
      type(initial_t), allocatable :: of_point(:)
      type(saturation_t) :: sat
      character(600) :: text
      real(wp) :: p_c
      integer :: e, g, p, i, n

      state = new_state_of(scene%model)
      allocate (of_point(size(state%s)))
      do i = 1, size(scene%initials)
         associate (one => scene%initials(i), group => scene%model%mesh%groups(scene%initials(i)%group))
            do n = 1, size(group%nodes)
               state%v(2, group%nodes(n)) = one%v_z + one%wave*sin(one%wave_number &
                                               *(scene%model%mesh%x(2, group%nodes(n)) - one%datum))
               if (any(scene%model%bodies == group%nodes(n))) cycle
               if (scene%model%with_w) state%x(3, group%nodes(n)) = water(one, scene%model%mesh%x(2, group%nodes(n)))
               if (scene%model%with_c) state%x(4, group%nodes(n)) = suction(one, scene%model%mesh%x(2, group%nodes(n)))
            end do
            do n = 1, size(group%elements)
               of_point((group%elements(n) - 1)*scene%model%rule + 1:group%elements(n)*scene%model%rule) = one
            end do
         end associate
      end do
      ! Pressures live on the vertices alone where they are linear.
      if (scene%model%n_p == 3) then
         do e = 1, size(scene%model%mesh%t6, 2)
            state%x(3:4, scene%model%mesh%t6(4:6, e)) = 0.0_wp
         end do
      end if
      do e = 1, size(scene%model%mesh%t6, 2)
         associate (region => scene%model%regions(scene%model%region_of(e)))
            do g = 1, scene%model%rule
               p = (e - 1)*scene%model%rule + g
               associate (gp => scene%model%gauss(g, e), n_p => scene%model%n_p)
                  p_c = dot_product(gp%m(:n_p), state%x(4, scene%model%mesh%t6(:n_p, e)))
                  if (scene%model%with_c) then
                     sat = scene%model%retentions(region%retention)%law%at(p_c, state%e(p))
                     state%s(p) = sat%s
                  end if
                  call set_stress(scene, e, of_point(p), gp%x(2), state%s(p), state%stress(:, p))
               end associate
               associate (law => scene%model%materials(region%material)%law)
                  call law%start(state%stress(:, p), p_c, state%e(p), state%state(:law%n_state, p), text)
               end associate
               if (text == '') cycle
               call raise(fault, EXIT_MATERIAL, 'Element '//whole(e)//', point '//whole(g)//' at z = '// &
                          short(scene%model%gauss(g, e)%x(2))//' m: '//trim(text))
               return
            end do
         end associate
      end do
   end subroutine initial_state

   pure real(wp) function water(initial, z)
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z

      water = initial%p_w + initial%p_w_slope*(z - initial%datum)
   end function water

   pure real(wp) function suction(initial, z)
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z

      suction = initial%p_c + initial%p_c_slope*(z - initial%datum)
   end function suction

   !> Effective stress, tension positive.
   subroutine set_stress(scene, element, initial, z, s, stress)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: element
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z, s
      real(wp), intent(inout) :: stress(6)
      real(wp) :: vertical, p_w, p_c, chi, shift

      if (initial%uniform) stress(1:3) = initial%sigma
      if (.not. initial%geostatic) return
      p_w = merge(water(initial, z), 0.0_wp, scene%model%with_w)
      p_c = merge(suction(initial, z), 0.0_wp, scene%model%with_c)
      vertical = initial%surcharge + weight_above(scene, element, initial, z)
      chi = s*max(p_c, 0.0_wp)
      vertical = vertical - (p_w + (1 - s)*p_c)   ! effective, compression positive
      shift = merge(chi, 0.0_wp, initial%net)
      stress(2) = -vertical
      stress([1, 3]) = -(initial%k_0*(vertical - shift) + shift)
   end subroutine set_stress

   !> Weight of a column of this region from z to the surface [kPa].
   real(wp) function weight_above(scene, element, initial, z) result(weight)
      type(scene_t), intent(in) :: scene
      integer, intent(in) :: element
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z
      type(saturation_t) :: sat
      real(wp) :: at, step, n, p_a, rho_a
      integer :: i

      weight = 0.0_wp
      step = (initial%surface - z)/SLICES
      associate (m => scene%model, region => scene%model%regions(scene%model%region_of(element)))
         n = region%void_ratio/(1 + region%void_ratio)
         do i = 1, SLICES
            at = z + (i - 0.5_wp)*step
            weight = weight + (1 - n)*region%rho_s
            if (m%with_c) sat = m%retentions(region%retention)%law%at(suction(initial, at), region%void_ratio)
            rho_a = m%fluids%rho_a
            p_a = water(initial, at) + suction(initial, at)
            if (m%fluids%ideal_gas) rho_a = rho_a*(1 + p_a/m%fluids%p_ref)
            if (m%with_w) weight = weight + n*(sat%s*m%fluids%rho_w + (1 - sat%s)*rho_a)
         end do
      end associate
      weight = weight*step*scene%model%gravity
   end function weight_above
end module host_initial
