!> The sample at a point: the only module that calls the library and the only one that knows its conventions.
!> Here compression is positive, components are 11, 22, 33, 12, 13, 23, shear strain is engineering shear;
!> the axis of the sample is component 33, the radial components are 11 and 22.
module triax_point
   use, intrinsic :: iso_fortran_env, only: wp => real64
   use, intrinsic :: iso_c_binding, only: c_int, c_null_char
   use mud_interface, only: mud_report, mud_version, mud_count, mud_index, mud_text, mud_bounds, mud_default_props, &
                            mud_validate_props, mud_init_state, mud_update, mud_save_increment, mud_message, &
                            MUD_PROPS, MUD_STATEV, &
                            MUD_NAME, MUD_UNIT, MUD_ORIGIN, MUD_MEANING, MUD_TANGENT_ELASTIC, MUD_TANGENT_CONSISTENT
   use faults, only: fault_t, raise, EXIT_INPUT, EXIT_OUTPUT
   use texts, only: from_c, whole
   implicit none (type, external)
   private
   public :: soil_t, point_t, tangent_t, mud_report
   public :: AXIAL, RADIAL
   public :: library_version, default_soil, check_soil, property_count, property_index, property_name, property_unit, &
             property_origin, property_meaning, property_range
   public :: start_point, update_point, save_update, update_sentence, slope_is_exact
   public :: mean_stress, deviator_stress, radial_stress, axial_strain, radial_strain, volumetric_strain, state_value

   integer, parameter :: AXIAL = 3            !< Component along the axis of the sample.
   integer, parameter :: RADIAL(2) = [1, 2]   !< Components across it.
   integer, parameter :: BUFFER = 600

   !> A material: the values of PROPS and where the state keeps what the driver shows.
   type :: soil_t
      real(wp), allocatable :: props(:)
      integer :: n_statev = 0
      integer :: i_void_ratio = 0, i_saturation = 0, i_state_parameter = 0   !< Places in STATEV, from 1.
      integer :: i_tangent = 0                                               !< Place in PROPS, from 1.
      integer :: i_n_substep = 0, i_n_reseat = 0, i_n_rate = 0, i_n_reject = 0, i_n_guard = 0
   end type soil_t

   !> A sample at one moment.
   type :: point_t
      real(wp) :: stress(6) = 0.0_wp   !< Effective stress [kPa].
      real(wp) :: strain(6) = 0.0_wp   !< Strain since the start [-].
      real(wp) :: suction = 0.0_wp     !< [kPa]
      real(wp), allocatable :: statev(:)
   end type point_t

   !> Slopes of an update, in the driver's conventions.
   type :: tangent_t
      real(wp) :: dsig_deps(6, 6) = 0.0_wp   !< Effective stress by strain [kPa].
      real(wp) :: dsig_dpc(6) = 0.0_wp       !< Effective stress by suction [-].
      real(wp) :: dsw_deps(6) = 0.0_wp       !< Degree of saturation by strain [-].
      real(wp) :: dsw_dpc = 0.0_wp           !< Degree of saturation by suction [1/kPa].
   end type tangent_t

contains
   function library_version() result(version)
      character(:), allocatable :: version
      character(BUFFER) :: text
      integer(c_int) :: code

      text = c_null_char
      code = mud_version(text, BUFFER)
      version = from_c(text)
      if (code < 0) version = 'unknown'
   end function library_version

   !> The library's default material, and the places of state variables by their names.
   subroutine default_soil(soil, fault)
      type(soil_t), intent(out) :: soil
      type(fault_t), intent(inout) :: fault

      allocate (soil%props(mud_count(MUD_PROPS)))
      soil%n_statev = mud_count(MUD_STATEV)
      if (mud_default_props(soil%props, size(soil%props)) /= 0) then
         call raise(fault, EXIT_INPUT, 'The library refuses to fill its own defaults; driver and library do not match.')
      end if
      soil%i_tangent = property_index('tangent')
      call locate('void_ratio', soil%i_void_ratio)
      call locate('saturation', soil%i_saturation)
      call locate('state_parameter', soil%i_state_parameter)
      call locate('n_substep', soil%i_n_substep)
      call locate('n_reseat', soil%i_n_reseat)
      call locate('n_rate', soil%i_n_rate)
      call locate('n_reject', soil%i_n_reject)
      call locate('n_guard', soil%i_n_guard)
   contains
      subroutine locate(name, place)
         character(*), intent(in) :: name
         integer, intent(out) :: place

         place = mud_index(MUD_STATEV, name//c_null_char) + 1
         if (place < 1) then
            call raise(fault, EXIT_INPUT, 'The library keeps no state variable '//name// &
                       '; driver and library do not match.')
         end if
      end subroutine locate
   end subroutine default_soil

   integer function property_count()
      property_count = mud_count(MUD_PROPS)
   end function property_count

   !> Place of a parameter in PROPS, from 1; 0 if there is none of that name.
   integer function property_index(name)
      character(*), intent(in) :: name

      property_index = mud_index(MUD_PROPS, trim(name)//c_null_char) + 1
   end function property_index

   function property_name(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = property_text(place, MUD_NAME)
   end function property_name

   function property_unit(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = property_text(place, MUD_UNIT)
   end function property_unit

   function property_origin(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = property_text(place, MUD_ORIGIN)
   end function property_origin

   function property_meaning(place) result(text)
      integer, intent(in) :: place
      character(:), allocatable :: text

      text = property_text(place, MUD_MEANING)
   end function property_meaning

   function property_text(place, field) result(text)
      integer, intent(in) :: place
      integer(c_int), intent(in) :: field
      character(:), allocatable :: text
      character(BUFFER) :: raw

      raw = c_null_char
      if (mud_text(MUD_PROPS, place - 1, field, raw, BUFFER) < 0) raw = c_null_char
      text = from_c(raw)
   end function property_text

   subroutine property_range(place, lower, upper, preset)
      integer, intent(in) :: place
      real(wp), intent(out) :: lower, upper, preset

      if (mud_bounds(MUD_PROPS, place - 1, lower, upper, preset) < 0) then
         lower = 0.0_wp
         upper = 0.0_wp
         preset = 0.0_wp
      end if
   end subroutine property_range

   !> The library's verdict on a set of parameters: an empty sentence, or its first fault.
   function check_soil(soil) result(sentence)
      type(soil_t), intent(in) :: soil
      character(:), allocatable :: sentence
      character(BUFFER) :: text

      text = c_null_char
      if (mud_validate_props(soil%props, size(soil%props), text, BUFFER) == 0) text = c_null_char
      sentence = from_c(text)
   end function check_soil

   !> A sample at rest under an effective stress.
   subroutine start_point(soil, stress, suction, ratio, point, fault)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: stress(6)   !< [kPa]
      real(wp), intent(in) :: suction     !< [kPa]
      real(wp), intent(in) :: ratio       !< Void ratio [-].
      type(point_t), intent(out) :: point
      type(fault_t), intent(inout) :: fault
      real(wp) :: tension(6)
      character(BUFFER) :: text
      integer(c_int) :: code

      allocate (point%statev(soil%n_statev), source=0.0_wp)
      tension = -stress
      text = c_null_char
      code = mud_init_state(soil%props, size(soil%props), tension, suction, ratio, point%statev, soil%n_statev, text, &
                            BUFFER)
      if (code /= 0) then
         call raise(fault, EXIT_INPUT, from_c(text))
         return
      end if
      point%stress = -tension
      point%suction = suction
   end subroutine start_point

   !> Integrates a strain and a change of suction. Where the report's status is not 0, only the report is of use.
   subroutine update_point(soil, before, strain, suction, after, tangent, report)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: before
      real(wp), intent(in) :: strain(6)      !< Increment [-].
      real(wp), intent(in) :: suction        !< Increment [kPa].
      type(point_t), intent(inout) :: after
      type(tangent_t), intent(out) :: tangent
      type(mud_report), intent(out) :: report
      real(wp) :: tension0(6), tension1(6)
      integer(c_int) :: code

      if (.not. allocated(after%statev)) allocate (after%statev(soil%n_statev), source=0.0_wp)
      tension0 = -before%stress
      tension1 = tension0
      code = mud_update(soil%props, size(soil%props), tension0, before%statev, soil%n_statev, -strain, before%suction, &
                        suction, tangent_kind(soil), tension1, after%statev, tangent%dsig_deps, tangent%dsig_dpc, &
                        tangent%dsw_deps, tangent%dsw_dpc, report)
      report%status = code
      if (code /= 0) return
      tangent%dsig_dpc = -tangent%dsig_dpc
      tangent%dsw_deps = -tangent%dsw_deps
      after%stress = -tension1
      after%strain = before%strain + strain
      after%suction = before%suction + suction
   end subroutine update_point

   !> Writes an update to a file that mud_replay runs.
   subroutine save_update(file, origin, soil, before, strain, suction, fault)
      character(*), intent(in) :: file, origin
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: before
      real(wp), intent(in) :: strain(6), suction   !< Increments as of update_point.
      type(fault_t), intent(inout) :: fault
      character(BUFFER) :: text

      text = c_null_char
      if (mud_save_increment(trim(file)//c_null_char, origin//c_null_char, soil%props, size(soil%props), &
                             -before%stress, before%statev, soil%n_statev, -strain, before%suction, suction, &
                             tangent_kind(soil), text, BUFFER) /= 0) then
         call raise(fault, EXIT_OUTPUT, '--save-failed '//trim(file)//': '//from_c(text)//'.')
      end if
   end subroutine save_update

   !> Kind of tangent asked for: that of the material, but a held stress needs a slope of some kind.
   pure integer(c_int) function tangent_kind(soil)
      type(soil_t), intent(in) :: soil

      tangent_kind = max(nint(soil%props(soil%i_tangent), c_int), MUD_TANGENT_ELASTIC)
   end function tangent_kind

   !> True if the slope is the derivative of the update itself, so that Newton's method is quadratic with it.
   pure logical function slope_is_exact(soil)
      type(soil_t), intent(in) :: soil

      slope_is_exact = tangent_kind(soil) == MUD_TANGENT_CONSISTENT
   end function slope_is_exact

   !> The library's sentence for a report.
   function update_sentence(report) result(sentence)
      type(mud_report), intent(in) :: report
      character(:), allocatable :: sentence
      character(BUFFER) :: text

      text = c_null_char
      if (mud_message(report, text, BUFFER) < 0) text = 'Status '//whole(int(report%status))//'.'//c_null_char
      sentence = from_c(text)
   end function update_sentence

   pure real(wp) function mean_stress(point)
      type(point_t), intent(in) :: point

      mean_stress = sum(point%stress(1:3))/3.0_wp
   end function mean_stress

   pure real(wp) function radial_stress(point)
      type(point_t), intent(in) :: point

      radial_stress = 0.5_wp*sum(point%stress(RADIAL))
   end function radial_stress

   !> q = sigma_a - sigma_r, negative in extension.
   pure real(wp) function deviator_stress(point)
      type(point_t), intent(in) :: point

      deviator_stress = point%stress(AXIAL) - radial_stress(point)
   end function deviator_stress

   pure real(wp) function axial_strain(point)
      type(point_t), intent(in) :: point

      axial_strain = point%strain(AXIAL)
   end function axial_strain

   pure real(wp) function radial_strain(point)
      type(point_t), intent(in) :: point

      radial_strain = 0.5_wp*sum(point%strain(RADIAL))
   end function radial_strain

   pure real(wp) function volumetric_strain(point)
      type(point_t), intent(in) :: point

      volumetric_strain = sum(point%strain(1:3))
   end function volumetric_strain

   !> One state variable, by its place in STATEV.
   pure real(wp) function state_value(point, place)
      type(point_t), intent(in) :: point
      integer, intent(in) :: place

      state_value = point%statev(place)
   end function state_value
end module triax_point
