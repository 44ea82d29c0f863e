!> Materials, retention curves and permeabilities from their groups.
module law_builder
   use, intrinsic :: iso_c_binding, only: c_null_char
   use mud_interface, only: mud_index, MUD_PROPS
   use kinds, only: wp
   use scene_types, only: scene_law_t
   use scene_keys, only: number_of, numbers_of, text_of, word_is
   use fe_elastic, only: elastic_t
   use fe_material, only: slot_t
   use fe_mud, only: mud_t, make_mud
   use permeability_laws, only: permeability_t, LAW_CONSTANT, LAW_COREY, LAW_MUALEM, LAW_POWER
   use retention_curves, only: retention_slot_t, bilogarithmic_t, power_t, table_t, saturated_t
   use faults, only: fault_t, raise, at_line, EXIT_INPUT
   use library_tables, only: state_count
   use parameter_groups, only: read_parameters
   use namelists, only: group_t, LENGTH
   use texts, only: lower_case
   implicit none (type, external)
   private
   public :: build_material, build_retention, build_permeability, retention_of_mud
contains
   subroutine build_material(given, slot, fault)
      type(scene_law_t), intent(in) :: given
      type(slot_t), intent(out) :: slot
      type(fault_t), intent(inout) :: fault

      if (given%group%name == 'mud') then
         call read_mud(given%group, slot, fault)
      else
         call read_elastic(given%group, slot)
      end if
   end subroutine build_material

   subroutine read_elastic(group, slot)
      type(group_t), intent(in) :: group
      type(slot_t), intent(out) :: slot
      type(elastic_t) :: law

      law%young = number_of(group, 'young')
      law%poisson = number_of(group, 'poisson')
      law%stored = .true.
      slot%name = text_of(group, 'name')
      allocate (slot%law, source=law)
   end subroutine read_elastic

   !> The library's own reader takes all but `call`.
   subroutine read_mud(group, slot, fault)
      type(group_t), intent(in) :: group
      type(slot_t), intent(out) :: slot
      type(fault_t), intent(inout) :: fault
      type(group_t) :: rest
      real(wp), allocatable :: props(:)
      type(mud_t) :: law
      character(LENGTH) :: title
      integer :: i

      rest = group
      rest%entries = pack(group%entries(:group%count), &
                          [(lower_case(group%entries(i)%key) /= 'material_call', i=1, group%count)])
      rest%count = size(rest%entries)
      call read_parameters(rest, props, title, fault)
      if (fault%code /= 0) return
      call make_mud(props, state_count(), word_is(group, 'material_call', 'umat'), law)
      slot%name = text_of(group, 'name')
      allocate (slot%law, source=law)
      if (law%tangent == 0) call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                                       'tangent = 0 gives no slopes; Newton needs 1, 2 or 3 (3: consistent).')
   end subroutine read_mud

   subroutine build_retention(given, slot, fault)
      type(scene_law_t), intent(in) :: given
      type(retention_slot_t), intent(out) :: slot
      type(fault_t), intent(inout) :: fault
      type(table_t) :: table

      slot%name = given%name
      associate (group => given%group)
         select case (lower_case(text_of(group, 'law')))
         case ('bilogarithmic')
            allocate (slot%law, source=bilogarithmic_t(number_of(group, 'p_a'), number_of(group, 'n'), &
                                                       number_of(group, 'm'), number_of(group, 'omega'), &
                                                       number_of(group, 's_max'), number_of(group, 's_min')))
         case ('power')
            allocate (slot%law, source=power_t(number_of(group, 'a'), number_of(group, 'b'), number_of(group, 's_min')))
         case ('table')
            table%p_c = numbers_of(group, 'suction')
            table%s = numbers_of(group, 'saturation')
            if (size(table%p_c) < 2 .or. size(table%p_c) /= size(table%s)) then
               call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'a table needs as many saturations '// &
                          'as suctions, at least two.')
            else if (any(table%p_c(2:) <= table%p_c(:size(table%p_c) - 1))) then
               call raise(fault, EXIT_INPUT, at_line(group%file, group%line)//'the suctions of a table must ascend.')
            end if
            allocate (slot%law, source=table)
         case default
            allocate (slot%law, source=saturated_t())
         end select
      end associate
   end subroutine build_retention

   !> The curve that a MUD material uses itself.
   subroutine retention_of_mud(law, slot)
      type(mud_t), intent(in) :: law
      type(retention_slot_t), intent(out) :: slot

      slot%name = 'mud'
      allocate (slot%law, source=bilogarithmic_t(prop('P_a'), prop('n_x'), prop('m_x'), prop('Omega'), prop('S_max'), &
                                                 prop('S_min')))
   contains
      real(wp) function prop(name)
         character(*), intent(in) :: name

         prop = law%props(mud_index(MUD_PROPS, name//c_null_char) + 1)
      end function prop
   end subroutine retention_of_mud

   subroutine build_permeability(given, law, fault)
      type(scene_law_t), intent(in) :: given
      type(permeability_t), intent(out) :: law
      type(fault_t), intent(inout) :: fault

      law%name = given%name
      associate (group => given%group)
         law%intrinsic = number_of(group, 'intrinsic')
         law%s_min = number_of(group, 's_min')
         law%s_max = number_of(group, 's_max')
         law%a = number_of(group, 'a')
         law%b = number_of(group, 'b')
         law%c = number_of(group, 'c')
         law%m = number_of(group, 'm')
         law%k_rw = number_of(group, 'k_rw')
         law%k_ra = number_of(group, 'k_ra')
         law%floor = number_of(group, 'floor')
         select case (lower_case(text_of(group, 'law')))
         case ('constant')
            law%law = LAW_CONSTANT
         case ('mualem')
            law%law = LAW_MUALEM
         case ('power')
            law%law = LAW_POWER
         case default
            law%law = LAW_COREY
         end select
         if (law%s_max <= law%s_min) call raise(fault, EXIT_INPUT, at_line(group%file, group%line)// &
                                                's_max must be larger than s_min.')
      end associate
   end subroutine build_permeability
end module law_builder
