! SPDX-License-Identifier: MIT
!> Warnings about supports, loads and histories of a scene that are allowed but usually mistakes.
module boundary_warnings
   use acting_places, only: given_in, acting_stages, are_on_axis, facing_edges
   use kinds, only: wp
   use given_pressures, only: nodes_with_flow, edges_with_flow
   use warnings, only: print_warning
   use model_types, only: model_t, acting_t, fix_t
   use scene_parts, only: amplitude_at, place_of, LOAD_AIR, LOAD_FORCE_R, LOAD_FORCE_Z, PRESCRIBED_P_A, &
                          PRESCRIBED_WORDS
   use texts, only: place_text, short, whole
   use unknown_fields, only: DISPLACEMENTS, AT_U_R, AT_P_W, AT_P_C
   implicit none (type, external)
   private
   public :: warn_of_boundaries

   real(wp), parameter :: ROUNDING = 1.0e-9_wp   !< Of a prescribed value.
   real(wp), parameter :: AT_ONCE = 1.0e-3_wp    !< Share of the range of a history that is no sudden load.
   real(wp), parameter :: BRIEF = 0.1_wp         !< Share of the time before a stage that a pulse lasts.
contains
   !> Prints all of them.
   subroutine warn_of_boundaries(model)
      type(model_t), intent(in) :: model

      call look_at_fixes(model)
      call look_at_slopes(model)
      call look_at_inflows(model)
      call look_at_histories(model)
      call look_at_places(model)
   end subroutine warn_of_boundaries

   !> Warns of two &fix that prescribe an unknown of a stage differently: the later one applies; and p_w, p_c and p_a
   !> all at once.
   subroutine look_at_fixes(model)
      type(model_t), intent(in) :: model
      integer, allocatable :: by(:, :)
      integer :: i, j, s, n, node

      allocate (by(PRESCRIBED_P_A, size(model%domain%mesh%x, 2)))
      do i = 2, size(model%fixes)
         associate (one => model%fixes(i))
            do j = 1, i - 1
               associate (before => model%fixes(j), nodes => model%domain%mesh%groups(model%fixes(j)%group)%nodes)
                  s = findloc(one%in_stage .and. before%in_stage, .true., dim=1)
                  ! Beside a limit what is given counts, as at a water level, and of two limits the smaller one.
                  if (s == 0 .or. before%field /= one%field .or. before%limits .or. one%limits) cycle
                  if (before%from >= one%until .or. one%from >= before%until) cycle
                  n = findloc([(differ(before, one, model%domain%mesh%x(2, nodes(node))) .and. &
                                any(model%domain%mesh%groups(one%group)%nodes == nodes(node)), &
                                node=1, size(nodes))], .true., dim=1)
                  if (n > 0) call print_warning(place_of(one)//PRESCRIBED_WORDS(one%field)//' of the node at '// &
                     place_text(model%domain%mesh%x(:, nodes(n)))//' has two &fix in stage '// &
                     trim(model%stages(s)%name)//', of the groups '''//trim(before%group_name)//''' and '''// &
                     trim(one%group_name)//''', with different values; the later one counts.')
               end associate
            end do
         end associate
      end do
      do s = 1, size(model%stages)
         by = 0
         do i = 1, size(model%fixes)
            if (model%fixes(i)%field > DISPLACEMENTS .and. model%fixes(i)%in_stage(s)) &
               by(model%fixes(i)%field, model%domain%mesh%groups(model%fixes(i)%group)%nodes) = i
         end do
         node = findloc(all(by(AT_P_W:, :) > 0, dim=1), .true., dim=1)
         if (node > 0) call print_warning(place_of(model%fixes(maxval(by(:, node))))//'p_w, p_c and p_a of a node '// &
            'are all prescribed in stage '//trim(model%stages(s)%name)//'; p_a = p_w + p_c, so give two of them.')
      end do
   contains
      pure logical function differ(a, b, z)
         type(fix_t), intent(in) :: a, b
         real(wp), intent(in) :: z   !< [m]
         real(wp) :: parts(2, 2), values(2), least

         differ = .false.
         if (a%hold .and. b%hold) return
         parts = reshape([a%value, a%value_slope*(z - a%datum), b%value, b%value_slope*(z - b%datum)], [2, 2])
         values = sum(parts, dim=1)
         least = ROUNDING*maxval(abs(parts))
         ! Histories of nothing are one.
         differ = (a%hold .neqv. b%hold) .or. (a%acceleration .neqv. b%acceleration) .or. &
                  abs(values(2) - values(1)) > least .or. (a%amplitude /= b%amplitude .and. any(abs(values) > least))
      end function differ
   end subroutine look_at_fixes

   !> Pressures of water that grow upwards, where weight makes them grow downwards.
   subroutine look_at_slopes(model)
      type(model_t), intent(in) :: model
      character(*), parameter :: REMEDY = ' kPa/m grows upwards; in water at rest p_w grows downwards, by -rho_w g '// &
                                          '(-9.81 kPa/m).'
      integer :: i

      if (.not. (model%domain%with_w .and. model%domain%gravity > 0.0_wp)) return
      do i = 1, size(model%initials)
         associate (one => model%initials(i))
            if (one%p_w_slope > 0.0_wp) call print_warning(place_of(one)//'p_w_slope = '//short(one%p_w_slope)//REMEDY)
         end associate
      end do
      do i = 1, size(model%fixes)
         associate (one => model%fixes(i))
            if (one%field == AT_P_W .and. one%value_slope > 0.0_wp) call print_warning(place_of(one)// &
               'value_slope = '//short(one%value_slope)//' of p_w'//REMEDY)
         end associate
      end do
   end subroutine look_at_slopes

   !> Inflows through edges with a prescribed pressure, which takes them up: they do nothing.
   subroutine look_at_inflows(model)
      type(model_t), intent(in) :: model
      logical, allocatable :: given(:, :), taken(:)
      integer :: e, i, s, lost
      integer :: own   !< The pressure of the fluid: given itself, or by the other one and p_c.

      do i = 1, size(model%loads)
         associate (one => model%loads(i), edges => model%domain%mesh%groups(model%loads(i)%group)%edges)
            if (.not. one%flows) cycle
            own = merge(PRESCRIBED_P_A, AT_P_W, one%kind == LOAD_AIR)
            do s = 1, size(model%stages)
               if (.not. one%in_stage(s)) cycle
               given = given_in(model, s, throughout=.true.)
               taken = given(own, :) .or. (given(AT_P_C, :) .and. given(AT_P_W + PRESCRIBED_P_A - own, :))
               lost = count([(all(taken(edges(:2, e))), e=1, size(edges, 2))])
               if (lost == 0) cycle
               call print_warning(place_of(one)//'the inflow has no effect on '//whole(lost)//' of the '// &
                  whole(size(edges, 2))//' edges of '''//trim(one%group_name)//''' in stage '// &
                  trim(model%stages(s)%name)//': a &fix prescribes the pressure of '// &
                  trim(merge('air  ', 'water', one%kind == LOAD_AIR))//' there.')
               exit
            end do
         end associate
      end do
   end subroutine look_at_inflows

   !> Histories of which a part lies before what they act on, and short pulses that are over before the first dynamic
   !> stage, though what follows them acts there: times are those of the run, not of the stage.
   subroutine look_at_histories(model)
      type(model_t), intent(in) :: model
      character(*), parameter :: OF_RUN = ' times of a &history are those of the run, not of a stage: its key '// &
                                          'stages counts them from stages.'
      real(wp) :: start, factor
      integer :: i, n, dynamic

      dynamic = findloc(model%stages%has_inertia, .true., dim=1)
      do i = 1, size(model%actions)
         if (model%actions(i)%amplitude == 0) cycle
         associate (one => model%actions(i), h => model%amplitudes(model%actions(i)%amplitude))
            if (size(h%stages) > 0) cycle
            start = max(one%from, model%stages(findloc(one%in_stage, .true., dim=1))%start)
            factor = amplitude_at(h, start)
            n = size(h%times)
            if (any(h%times < start .and. &
                    abs(h%values - factor) > AT_ONCE*(maxval(h%values) - minval(h%values)))) call print_warning( &
               place_of(one)//'history '''//trim(h%name)//''' begins at '//short(h%times(1))//' s, and this acts '// &
               'from '//short(start)//' s on, at once with the factor '//short(factor)// &
               trim(merge(', which then stays; ', ';                   ', h%times(n) <= start))//OF_RUN)
            if (dynamic < 2) cycle
            ! What acts from that stage on alone is told by its first factor.
            if (.not. (one%in_stage(dynamic) .and. any(one%in_stage(:dynamic - 1)))) cycle
            start = model%stages(dynamic)%start
            if (h%times(n) <= start .and. h%times(n) - h%times(1) <= BRIEF*start .and. &
                .not. abs(h%values(n) - h%values(1)) > 0.0_wp .and. any(abs(h%values - h%values(1)) > 0.0_wp)) &
               call print_warning(place_of(one)//'history '''//trim(h%name)//''' is over at '//short(h%times(n))// &
                                  ' s, before stage '//trim(model%stages(dynamic)%name)//' begins at '// &
                                  short(start)//' s;'//OF_RUN)
         end associate
      end do
   end subroutine look_at_histories

   !> Supports of pressures and inflows that act on a part of their group alone, or in static stages alone; dashpots and
   !> accelerations without a dynamic stage; supports that take nodes off the axis, or whose time no stage has; loads on
   !> the axis, forces along r on a plate that moves vertically, and rain on what faces sideways or down.
   subroutine look_at_places(model)
      type(model_t), intent(in) :: model
      logical, dimension(size(model%domain%mesh%x, 2)) :: flows, on_axis, vertical
      integer :: i

      on_axis = are_on_axis(model)
      vertical = .false.
      vertical(model%domain%bodies) = .true.
      vertical(model%domain%bodies_along_r) = .false.
      flows = nodes_with_flow(model%domain)
      do i = 1, size(model%fixes)
         associate (one => model%fixes(i), nodes => model%domain%mesh%groups(model%fixes(i)%group)%nodes)
            if (one%acceleration .and. .not. any(one%in_stage .and. model%stages%has_inertia)) call print_warning( &
               place_of(one)//'the acceleration has no effect: no stage in which it acts is dynamic, and elsewhere '// &
               'the nodes stay.')
            if (one%field == AT_U_R .and. .not. one%hold .and. any(on_axis(nodes)) .and. &
                max(abs(one%value), abs(one%value_slope)) > 0.0_wp) call print_warning( &
               place_of(one)//'u_r of nodes at r = 0 is prescribed: in axial symmetry they stay '// &
               'on the axis, and beside nodes that leave it the hoop strain has no bound.')
            associate (start => model%stages%start)
               if (.not. any(one%in_stage .and. start < one%until .and. one%from < start + model%stages%duration)) &
                  call print_warning(place_of(one)//'this &fix has no effect: its stages begin at '// &
                     short(minval(start, mask=one%in_stage))//' s and end at '// &
                     short(maxval(start + model%stages%duration, mask=one%in_stage))//' s, none of them between '// &
                     'from and until, which are times of the run.')
            end associate
            if (one%field <= DISPLACEMENTS) cycle
            call look_at_stages(one, PRESCRIBED_WORDS(one%field))
            if (.not. all(flows(nodes))) call print_warning(place_of(one)// &
               trim(PRESCRIBED_WORDS(one%field))//' is prescribed on '//whole(count(flows(nodes)))//' of the '// &
               whole(size(nodes))//' nodes of '''//trim(one%group_name)//''': the others lie in no region with '// &
               'drainage = ''coupled''.')
         end associate
      end do
      do i = 1, size(model%loads)
         associate (one => model%loads(i), nodes => model%domain%mesh%groups(model%loads(i)%group)%nodes)
            if (one%kind == LOAD_FORCE_R .and. all(vertical(nodes))) then
               call print_warning(place_of(one)//'the force has no effect: the plate '''//trim(one%group_name)// &
                                  ''' moves vertically alone; see motion of &plate.')
            else if (one%kind /= LOAD_FORCE_Z .and. .not. one%falls .and. all(on_axis(nodes))) then
               ! Rain, beside this, limits the pressures there.
               call print_warning(place_of(one)//'the load has no effect: all nodes of '''//trim(one%group_name)// &
                                  ''' lie at r = 0, where nothing moves along r and a boundary has no area.')
            end if
            if (.not. one%flows) cycle
            call look_at_stages(one, 'the inflow')
            if (one%falls) then
               associate (edges => facing_edges(model, one%group, one%in_stage), r => model%domain%mesh%x(1, :))
                  ! The ground is on the left: what looks upwards runs against r.
                  if (.not. any(r(edges(2, :)) < r(edges(1, :)))) call print_warning(place_of(one)// &
                     'no rain falls on '''//trim(one%group_name)//''': none of its edges faces upwards, and it is '// &
                     'a seepage face there.')
               end associate
            end if
            associate (edges => edges_with_flow(model%domain, one%group))
               if (.not. all(edges)) call print_warning(place_of(one)//'fluid flows in through '// &
                  whole(count(edges))//' of the '//whole(size(edges))//' edges of '''//trim(one%group_name)// &
                  ''': the others belong to no region with drainage = ''coupled''.')
            end associate
         end associate
      end do
      do i = 1, size(model%actions)
         associate (one => model%actions(i))
            if (one%damps .and. .not. any(acting_stages(model, one))) call print_warning(place_of(one)// &
               trim(one%what)//' has no effect: no stage in which it acts is dynamic.')
         end associate
      end do
   contains
      subroutine look_at_stages(one, what)
         class(acting_t), intent(in) :: one
         character(*), intent(in) :: what

         if (any(one%in_stage .and. model%stages%has_rates)) return
         call print_warning(place_of(one)//trim(what)//' has no effect: the stages in which it acts are static, '// &
                            'where pressures stay.')
      end subroutine look_at_stages
   end subroutine look_at_places
end module boundary_warnings
