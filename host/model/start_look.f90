! SPDX-License-Identifier: MIT
!> Warnings about the start of a scene and of its stages: balance, air, water outside or held, velocities, motions,
!> displacements that are zeroed, plates, pulses that are over. What they tell is allowed, but usually a mistake.
module start_look
   use kinds, only: wp, PI
   use acting_places, only: ground_of, nodes_of_ground, given_in
   use given_pressures, only: water, suction
   use history_shapes, only: slope_beside
   use warnings, only: print_warning
   use start_findings, only: balance_t
   use model_types, only: model_t, factor_at, factors_of, value_at, fix_t, plate_t, SPACINGS
   use porous_domain, only: COUPLED, DRAINED
   use scene_parts, only: place_of, LOAD_AIR, PRESCRIBED_P_A
   use texts, only: place_text, short, whole
   use unknown_fields, only: AT_U_Z, AT_P_W, DISPLACEMENTS
   implicit none (type, external)
   private
   public :: warn_of_start

   real(wp), parameter :: ROUNDING = 1.0e-6_wp   !< Of a pressure.
   real(wp), parameter :: AT_ONCE = 0.05_wp      !< Share of the largest velocity of a motion: no start from rest.
   real(wp), parameter :: HARD = 1.0e4_wp        !< [kPa] Of a plate; above it a force in N is likely.
contains
   !> Prints all of them.
   subroutine warn_of_start(model, balance)
      type(model_t), intent(in) :: model
      type(balance_t), intent(in) :: balance
      integer :: i

      call look_at_balance(model, balance)
      call look_at_air(model)
      call look_at_water_outside(model)
      call look_at_dashpots(model)
      call look_at_held_water(model)
      do i = 1, size(model%fixes)
         call look_at_motion(model, model%fixes(i))
         call look_at_return(model, model%fixes(i))
         call look_at_zero(model, model%fixes(i))
      end do
      do i = 1, size(model%plates)
         call look_at_plate(model, model%plates(i))
      end do
   end subroutine warn_of_start

   !> Warns of a start that is not in balance. Where no &initial gives a stress, a static stage finds the balance.
   subroutine look_at_balance(model, balance)
      type(model_t), intent(in) :: model
      type(balance_t), intent(in) :: balance
      character(:), allocatable :: share, why
      integer :: i

      if (.not. balance%matters) return
      if (.not. model%stages(1)%has_rates .and. &
          .not. any(model%initials%geostatic .or. model%initials%uniform)) return
      share = ', where there is no stress'
      if (balance%there > 0.0_wp) share = ', '//short(100*balance%stress/balance%there)//' % of the stress there'
      why = ''
      i = findloc(model%actions%damps, .true., dim=1)
      if (model%stages(1)%has_inertia .and. i > 0) why = ' The dashpots of '//trim(model%actions(i)%what)// &
         ' hold no weight: find the balance in a static stage with a &fix that is limited to it.'
      call print_warning('The start is not in balance: the forces at '//place_text(balance%x)//' are '// &
                       short(balance%stress)//' kPa away from it'//share//'. Stage '//trim(model%stages(1)%name)// &
                       ' begins with what they set free; compare rho_s, surface, surcharge, k_0 and p_w with the '// &
                       'loads of the start.'//why)
   end subroutine look_at_balance

   !> Warns of air that is not at atmospheric pressure where pores hold some, though nothing in the scene asks so.
   subroutine look_at_air(model)
      type(model_t), intent(in) :: model
      character(:), allocatable :: meant
      real(wp) :: worst, p_w, p_c, z
      integer :: i, k

      if (.not. model%domain%with_c) return
      if (any(model%loads%kind == LOAD_AIR)) return
      if (any(model%fixes%field == PRESCRIBED_P_A .and. (abs(model%fixes%value) > 0.0_wp .or. &
                                                        abs(model%fixes%value_slope) > 0.0_wp))) return
      do i = 1, size(model%initials)
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            if (size(group%elements) == 0) cycle
            worst = 0.0_wp
            z = 0.0_wp
            do k = 1, size(group%nodes)
               p_w = water(one, model%domain%mesh%x(2, group%nodes(k)))
               p_c = suction(one, model%domain%mesh%x(2, group%nodes(k)))
               if (.not. (p_c > 0.0_wp .or. p_w < 0.0_wp)) cycle
               ! Water and air both under pressure are meant, unless one sign is wrong.
               if (p_w > 0.0_wp .and. abs(p_c - p_w) > ROUNDING*p_w) cycle
               if (abs(p_w + p_c) <= max(abs(worst), ROUNDING*max(1.0_wp, abs(p_w), abs(p_c)))) cycle
               worst = p_w + p_c
               z = model%domain%mesh%x(2, group%nodes(k))
            end do
            if (.not. abs(worst) > 0.0_wp) cycle
            meant = meant_by('p_c', -one%p_w, -one%p_w_slope)
            if (.not. (abs(one%p_w) > 0.0_wp .or. abs(one%p_w_slope) > 0.0_wp)) &
               meant = meant_by('p_w', -one%p_c, -one%p_c_slope)
            call print_warning(place_of(one)//'the air begins with p_a = p_w + p_c = '//short(worst)//' kPa at z = '// &
               short(z)//' m, and nothing asks for it (0: as outside). Did you mean '//meant//'?')
         end associate
      end do
   contains
      function meant_by(key, value, slope) result(text)
         character(*), intent(in) :: key
         real(wp), intent(in) :: value, slope   !< [kPa, kPa/m]
         character(:), allocatable :: text

         text = key//' = '//short(value)
         if (abs(slope) > 0.0_wp) text = text//', '//key//'_slope = '//short(slope)
      end function meant_by
   end subroutine look_at_air

   !> Warns of ground that joins or leaves in a dynamic stage where dashpots alone hold the rest upright.
   subroutine look_at_dashpots(model)
      type(model_t), intent(in) :: model
      integer :: s, i

      i = findloc(model%actions%damps, .true., dim=1)
      if (i == 0) return
      do s = 2, size(model%stages)
         if (.not. model%stages(s)%has_inertia) cycle
         if (all(ground_of(model, s) .eqv. ground_of(model, s - 1))) cycle
         associate (held => given_in(model, s))
            if (any(held(AT_U_Z, :) .and. nodes_of_ground(model, s))) cycle
         end associate
         call print_warning('Regions join or leave with the dynamic stage '//trim(model%stages(s)%name)//', where '// &
            'no &fix of u_z holds the ground: the dashpots of '//trim(model%actions(i)%what)//' do not carry the '// &
            'change of weight, and the ground drifts for ever. Let them join or leave in a static stage, with a '// &
            '&fix that is limited to it.')
         return
      end do
   end subroutine look_at_dashpots

   !> Warns of water whose weight follows gravity while its pressure is held: the skeleton bears the change.
   subroutine look_at_held_water(model)
      type(model_t), intent(in) :: model
      integer, parameter :: TIMES = 32   !< At which the history is asked in a stage.
      real(wp) :: factors(0:TIMES)
      logical :: held(size(model%domain%regions))
      character(60) :: why
      integer :: s, k

      if (.not. model%domain%fluids%rho_w*model%domain%gravity > 0.0_wp) return
      do s = 1, size(model%stages)
         associate (stage => model%stages(s))
            factors = [(factor_at(model, model%gravity_amplitude, stage%start + k*stage%duration/TIMES), k=0, TIMES)]
         end associate
         held = model%domain%regions%with_w .and. model%domain%regions%drainage == DRAINED
         why = 'drained regions keep the pressures of the start'
         if (.not. model%stages(s)%has_rates) then
            held = held .or. (model%domain%regions%with_w .and. model%domain%regions%drainage == COUPLED)
            why = 'a static stage keeps the pressures with which it begins'
         end if
         if (.not. (any(held) .and. maxval(factors) - minval(factors) > ROUNDING)) cycle
         call print_warning('stage '//trim(model%stages(s)%name)//': gravity_history takes the weight of the pore '// &
            'water from '//short(minval(factors))//' to '//short(maxval(factors))//' of its value, and its '// &
            'pressure stays, since '//trim(why)//': the skeleton bears the change. Let it follow in a '// &
            'quasi_static stage, in which the region is coupled.')
         return
      end do
   end subroutine look_at_held_water

   !> Warns of water that stands on a free surface, by the p_w of a &fix there, without the load of its pressure.
   subroutine look_at_water_outside(model)
      type(model_t), intent(in) :: model
      logical, allocatable :: held(:, :), pressed(:)
      real(wp) :: pressure, most
      integer :: i, s, k, bare

      do i = 1, size(model%fixes)
         associate (fix => model%fixes(i), edges => model%domain%mesh%groups(model%fixes(i)%group)%edges)
            if (fix%field /= AT_P_W .or. fix%hold) cycle
            do s = 1, size(model%stages)
               if (.not. (fix%in_stage(s) .and. model%stages(s)%has_rates)) cycle
               held = given_in(model, s)
               pressed = nodes_under_pressure(model, s)
               bare = 0
               most = 0.0_wp
               do k = 1, size(edges, 2)
                  associate (x => model%domain%mesh%x, middle => edges(3, k))
                     if (pressed(middle)) cycle
                     ! What is held along the normal needs no load.
                     if (held(merge(1, 2, abs(x(2, edges(2, k)) - x(2, edges(1, k))) > &
                                          abs(x(1, edges(2, k)) - x(1, edges(1, k)))), middle)) cycle
                     pressure = maxval(value_at(fix, x(2, middle))*factors_of(model, fix%amplitude))
                  end associate
                  if (.not. pressure > 0.0_wp) cycle
                  bare = bare + 1
                  most = max(most, pressure)
               end do
               if (bare == 0) cycle
               call print_warning(place_of(fix)//'water of up to '//short(most)//' kPa stands on '//whole(bare)// &
                  ' of the '//whole(size(edges, 2))//' edges of '''//trim(fix%group_name)//''' in stage '// &
                  trim(model%stages(s)%name)//', and nothing bears on them: its weight is missing. Add a &load of '// &
                  'kind = ''pressure'' with the same values, unless water is pressed in there.')
               exit
            end do
         end associate
      end do
   end subroutine look_at_water_outside

   !> Marks the nodes on which something presses in a stage.
   pure function nodes_under_pressure(model, number) result(pressed)
      type(model_t), intent(in) :: model
      integer, intent(in) :: number   !< Of the stage.
      logical :: pressed(size(model%domain%mesh%x, 2))
      integer :: i

      pressed = .false.
      do i = 1, size(model%actions)
         associate (one => model%actions(i))
            if (one%bears .and. one%group > 0 .and. one%in_stage(number)) &
               pressed(model%domain%mesh%groups(one%group)%nodes) = .true.
         end associate
      end do
   end function nodes_under_pressure

   !> Warns of a displacement that does not begin from rest in a dynamic stage: what moves at once is struck.
   subroutine look_at_motion(model, fix)
      type(model_t), intent(in) :: model
      type(fix_t), intent(in) :: fix
      real(wp) :: start, before, after, at_rest
      integer :: s, i

      if (fix%field > DISPLACEMENTS .or. fix%acceleration .or. fix%hold .or. fix%amplitude == 0) return
      if (size(model%amplitudes(fix%amplitude)%times) < 2) return
      associate (h => model%amplitudes(fix%amplitude))
         do s = 1, size(model%stages)
            start = model%stages(s)%start
            if (.not. (fix%in_stage(s) .and. model%stages(s)%has_inertia)) cycle
            after = 0.0_wp
            i = count(h%times <= max(start, fix%from))
            if (i > 0) after = fix%value*slope_beside(h%times, h%values, h%arcs, i, 1)
            before = 0.0_wp
            if (s > 1 .and. fix%from <= start) then
               if (model%stages(s - 1)%has_inertia .and. fix%in_stage(s - 1)) cycle
            end if
            if (s == 1 .and. fix%field == AT_U_Z) then
               do i = 1, size(model%initials)
                  if (any(model%domain%mesh%groups(model%initials(i)%group)%nodes == &
                          model%domain%mesh%groups(fix%group)%nodes(1))) before = model%initials(i)%v_z
               end do
            end if
            at_rest = AT_ONCE*abs(fix%value)*maxval(abs((h%values(2:) - h%values(:size(h%values) - 1)) &
                                                        /(h%times(2:) - h%times(:size(h%times) - 1))))
            if (abs(after - before) <= at_rest .or. .not. abs(after - before) > 0.0_wp) cycle
            call print_warning(place_of(fix)//'the motion of '''//trim(fix%group_name)//''' begins in stage '// &
               trim(model%stages(s)%name)//' with a velocity of '//short(after)//' m/s, and the ground with '// &
               short(before)//': it is struck. Let history '''//trim(h%name)//''' begin without slope, or '// &
               'prescribe motion = ''acceleration''.')
            return
         end do
      end associate
   end subroutine look_at_motion

   !> Warns of a support that begins within a stage and holds what was there where the stage began: it takes it back.
   subroutine look_at_return(model, fix)
      type(model_t), intent(in) :: model
      type(fix_t), intent(in) :: fix
      integer :: s

      if (.not. fix%hold) return
      do s = 1, size(model%stages)
         associate (stage => model%stages(s))
            if (.not. fix%in_stage(s) .or. fix%from <= stage%start + SPACINGS*spacing(stage%start) .or. &
                fix%from >= stage%start + stage%duration) cycle
            call print_warning(place_of(fix)//'hold = ''yes'' takes '''//trim(fix%group_name)//''' back at '// &
               short(fix%from)//' s, at once, to what it was where stage '//trim(stage%name)//' began. To hold it '// &
               'as it is then, let a stage begin at that time and limit this &fix to it.')
            return
         end associate
      end do
   end subroutine look_at_return

   !> Warns of a prescribed displacement that goes on after a stage that sets displacements to zero.
   subroutine look_at_zero(model, fix)
      type(model_t), intent(in) :: model
      type(fix_t), intent(in) :: fix
      real(wp) :: zeroed   !< When [s].
      integer :: s

      if (fix%field > DISPLACEMENTS .or. fix%acceleration .or. fix%hold .or. fix%of_body) return
      do s = 1, size(model%stages) - 1
         if (.not. (model%stages(s)%zero_displacements .and. all(fix%in_stage(s:s + 1)))) cycle
         zeroed = model%stages(s + 1)%start
         if (fix%from >= zeroed - SPACINGS*spacing(zeroed) .or. fix%until <= zeroed + SPACINGS*spacing(zeroed)) cycle
         if (.not. abs(factor_at(model, fix%amplitude, zeroed))*max(abs(fix%value), abs(fix%value_slope)) > 0.0_wp) &
            cycle
         call print_warning(place_of(fix)//'stage '//trim(model%stages(s)%name)//' sets displacements to zero, and '// &
            'in stage '//trim(model%stages(s + 1)%name)//' the value of '''//trim(fix%group_name)//''' counts from '// &
            'there, beyond what it has moved. Limit this &fix to its stages, and hold = ''yes'' in one for the others.')
         return
      end do
   end subroutine look_at_zero

   !> Warns of a force that seems to be in N, and a plate on the ground that nothing presses down.
   subroutine look_at_plate(model, plate)
      type(model_t), intent(in) :: model
      type(plate_t), intent(in) :: plate
      real(wp) :: r(2), area, forces(2)
      integer :: i

      if (size(plate%coordinates) > 1) return
      if (plate%group > 0) then
         associate (x => model%domain%mesh%x(1, model%domain%mesh%groups(plate%group)%nodes))
            r = [minval(x), maxval(x)]
         end associate
      else
         r = [minval(plate%corners(1, :)), maxval(plate%corners(1, :))]
      end if
      area = r(2) - r(1)
      if (model%domain%axisymmetric) area = PI*(r(2)**2 - r(1)**2)
      forces = plate%force*factors_of(model, plate%amplitude)
      ! A boundary along z has no area that a vertical force could press on.
      if (area > 0.0_wp .and. maxval(abs(forces)) > HARD*area) call print_warning(place_of(plate)// &
         'the force of the plate '''// &
         trim(plate%name)//''' is '//short(maxval(abs(forces))/area)//' kPa on its '//short(area)//' m2; forces '// &
         'are in kN.')
      if (plate%on_buffer .or. minval(forces) < 0.0_wp .or. (plate%heavy .and. model%domain%gravity > 0.0_wp)) return
      if (plate%group == 0) then
         if (plate%corners(1, 2) < plate%corners(1, 1)) return
      end if
      if (any([(moves(model%fixes(i)%group_name) .and. model%fixes(i)%field <= DISPLACEMENTS, &
                i=1, size(model%fixes)), (moves(model%loads(i)%group_name), i=1, size(model%loads)), &
               (moves(model%initials(i)%group_name) .and. abs(model%initials(i)%v_z) > 0.0_wp, &
                i=1, size(model%initials))])) return
      call print_warning(place_of(plate)//'nothing presses the plate '''//trim(plate%name)//''' down: it has no '// &
         'weight (weight = ''yes'' and gravity), no negative force (force acts upwards), no &fix and no &load.')
   contains
      pure logical function moves(group)
         character(*), intent(in) :: group

         moves = group == plate%name
         if (plate%group > 0) moves = moves .or. group == model%domain%mesh%groups(plate%group)%name
      end function moves
   end subroutine look_at_plate

end module start_look
