! SPDX-License-Identifier: MIT
!> Pressures at the start, and where regions differ in what their fluids do: nodes of undrained elements, and groups of
!> supports, inflows and initial values that lie where nothing could have them.
!> docs/theory/host.md section 3.5.
module given_pressures
   use kinds, only: wp
   use exit_codes, only: EXIT_GROUP
   use faults, only: fault_t, raise
   use model_types, only: model_t, initial_t
   use porous_domain, only: domain_t, COUPLED, UNDRAINED, DRY
   use scene_parts, only: place_of, PRESCRIBED_WORDS
   use texts, only: whole
   use triangle_mesh, only: nodes_of
   use unknown_fields, only: DISPLACEMENTS
   implicit none (type, external)
   private
   public :: add_centers, pressures_at_start, check_places, nodes_with_flow, edges_with_flow
   public :: water, suction, set_middles
contains
   !> Adds a node in the middle of every undrained element: there its pressures are. docs/theory/host.md section 3.5.
   !> The regions must be known; coordinates: mean of the vertices.
   subroutine add_centers(domain)
      type(domain_t), intent(inout) :: domain
      logical :: closed(size(domain%region_of))   !< Whether the fluids of an element stay in it.
      integer :: e

      closed = domain%regions(domain%region_of)%drainage == UNDRAINED
      associate (x => domain%mesh%x, corners => domain%mesh%t6(:3, pack([(e, e=1, size(closed))], closed)))
         domain%center = unpack([(size(x, 2) + e, e=1, size(corners, 2))], closed, 0)
         domain%mesh%x = reshape([x, (sum(x(:, corners(:, e)), dim=2)/3, e=1, size(corners, 2))], &
                                 [2, size(x, 2) + size(corners, 2)])
      end associate
   end subroutine add_centers

   !> Sets p_w and p_c of every node as the &initial say, of several the last one [kPa]; 0 in plates. Nodes of the
   !> ground that is asked for have them from the &initial of that ground: an &initial of other ground that has them
   !> too, dry or not there yet, means its own pores. docs/theory/host.md section 8.
   function pressures_at_start(model, ground) result(p)
      type(model_t), intent(in) :: model
      logical, intent(in) :: ground(:)                 !< (elements)
      real(wp) :: p(2, size(model%domain%mesh%x, 2))   !< (2, nodes)
      logical :: asked(size(p, 2)), meant(size(p, 2)), chosen(size(ground))
      integer :: i, n

      p = 0.0_wp
      asked = nodes_of(model%domain%mesh, ground)
      do i = 1, size(model%initials)
         associate (one => model%initials(i), group => model%domain%mesh%groups(model%initials(i)%group))
            chosen = .false.
            chosen(group%elements) = ground(group%elements)
            meant = nodes_of(model%domain%mesh, chosen) .or. .not. asked
            do n = 1, size(group%nodes)
               if (any(model%domain%bodies == group%nodes(n))) cycle
               if (size(group%elements) > 0 .and. .not. meant(group%nodes(n))) cycle
               if (model%domain%with_w) p(1, group%nodes(n)) = water(one, model%domain%mesh%x(2, group%nodes(n)))
               if (model%domain%with_c) p(2, group%nodes(n)) = suction(one, model%domain%mesh%x(2, group%nodes(n)))
            end do
         end associate
      end do
   end function pressures_at_start

   !> Finds the pore water pressure at the start at a height [kPa]: linear in z, above a water table with a limit;
   !> docs/theory/host.md section 8.
   pure real(wp) function water(initial, z)
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z   !< [m]

      water = initial%p_w + initial%p_w_slope*(z - initial%datum)
      if (initial%with_table) water = max(initial%water_weight*(initial%water_table - z), -initial%largest_suction)
   end function water

   !> Finds the suction at the start at a height [kPa], as water; at and below a water table -p_w, which keeps the air
   !> at the pressure outside: docs/theory/host.md section 8.
   pure real(wp) function suction(initial, z)
      type(initial_t), intent(in) :: initial
      real(wp), intent(in) :: z   !< [m]

      suction = initial%p_c + initial%p_c_slope*(z - initial%datum)
      if (initial%with_table) suction = -water(initial, z)
   end function suction

   !> Where pressures are linear the middle of a side has the mean of its ends. docs/theory/host.md section 3.1.
   pure subroutine set_middles(domain, p)
      type(domain_t), intent(in) :: domain
      real(wp), intent(inout) :: p(:, :)   !< (2, nodes) [kPa]
      integer :: e

      if (domain%n_p == 6) return
      do e = 1, size(domain%region_of)
         associate (nodes => domain%mesh%t6(:, e))
            p(:, nodes(4:6)) = 0.5_wp*(p(:, nodes(1:3)) + p(:, nodes([2, 3, 1])))
         end associate
      end do
   end subroutine set_middles

   !> Marks nodes of elements whose fluids flow, middles of sides included.
   pure function nodes_with_flow(domain) result(flows)
      type(domain_t), intent(in) :: domain
      logical :: flows(size(domain%mesh%x, 2))

      flows = nodes_of(domain%mesh, domain%regions(domain%region_of)%drainage == COUPLED)
   end function nodes_with_flow

   !> Edges of a group through which fluids can flow in.
   pure function edges_with_flow(domain, group) result(flows)
      type(domain_t), intent(in) :: domain
      integer, intent(in) :: group   !< Its number in the mesh.
      logical :: flows(size(domain%mesh%groups(group)%edges, 2))
      logical :: at(size(domain%mesh%x, 2))
      integer :: e

      at = nodes_with_flow(domain)
      flows = [(all(at(domain%mesh%groups(group)%edges(:, e))), e=1, size(flows))]
   end function edges_with_flow

   !> Refuses values, supports and inflows where no node or element of their group could have them. Fault EXIT_GROUP: a
   !> pressure is prescribed on no node, or a fluid flows in through no edge, of a coupled region; or p_w, p_c are given
   !> for dry regions alone. docs/theory/host.md section 3.5.
   subroutine check_places(model, fault)
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      logical :: flows(size(model%domain%mesh%x, 2))
      integer :: i

      associate (domain => model%domain)
         if (all(domain%regions%drainage == COUPLED)) return
         flows = nodes_with_flow(domain)
         do i = 1, size(model%fixes)
            associate (fix => model%fixes(i))
               if (fix%field <= DISPLACEMENTS) cycle
               if (any(flows(domain%mesh%groups(fix%group)%nodes))) cycle
               call raise(fault, EXIT_GROUP, place_of(fix)//'no node of '''//trim(fix%group_name)//''' lies in a '// &
                          'region with drainage = ''coupled'', so that none has the unknown '// &
                          trim(PRESCRIBED_WORDS(fix%field))// &
                          '; leave this &fix out (drained regions keep their initial pressures), or couple '// &
                          'the region.')
               return
            end associate
         end do
         do i = 1, size(model%loads)
            associate (load => model%loads(i))
               if (.not. load%flows) cycle
               if (any(edges_with_flow(domain, load%group))) cycle
               call raise(fault, EXIT_GROUP, place_of(load)//'no edge of '''//trim(load%group_name)//''' belongs '// &
                          'to a region with drainage = ''coupled'': nothing can flow in; leave this &load out, or '// &
                          'couple the region.')
               return
            end associate
         end do
         do i = 1, size(model%initials)
            associate (one => model%initials(i), elements => &
                       domain%mesh%groups(model%initials(i)%group)%elements)
               if (size(elements) == 0 .or. .not. any(abs([one%p_w, one%p_w_slope, one%p_c, one%p_c_slope, &
                                                           one%water_weight]) > 0.0_wp)) cycle
               if (any(domain%regions(domain%region_of(elements))%drainage /= DRY)) cycle
               call raise(fault, EXIT_GROUP, place_of(one)//'all '//whole(size(elements))//' elements of '''// &
                          trim(one%group_name)//''' are of regions with drainage = ''dry'': p_w and p_c have no '// &
                          'meaning there; leave them out, or choose another drainage.')
               return
            end associate
         end do
      end associate
   end subroutine check_places
end module given_pressures
