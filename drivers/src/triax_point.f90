! SPDX-License-Identifier: MIT
!> The sample at a point, and the only module of the driver that knows the conventions of laws.
!> Here compression is positive, components are 11, 22, 33, 12, 13, 23, shear strain is engineering shear;
!> the axis of the sample is component 33, the radial components are 11 and 22.
module triax_point
   use faults, only: fault_t, raise, EXIT_INPUT, EXIT_OUTPUT
   use kinds, only: wp
   use material_point, only: material_t, response_t, batch_report_t, state_index, WITH_TANGENT
   use texts, only: whole
   use triax_air, only: air_t
   implicit none (type, external)
   private
   public :: soil_t, point_t, tangent_t
   public :: AXIAL, RADIAL
   public :: start_point, restore_point, update_point, save_update, update_sentence
   public :: mean_stress, deviator_stress, radial_stress, volumetric_strain, void_ratio, &
             saturation, state_value

   integer, parameter :: AXIAL = 3            !< Component along the axis of the sample.
   integer, parameter :: RADIAL(2) = [1, 2]   !< Components across it.
   integer, parameter :: BUFFER = 1000

   type :: soil_t
      class(material_t), allocatable :: law
      type(air_t) :: air
   end type soil_t

   !> A sample at one moment.
   type :: point_t
      real(wp) :: stress(6) = 0.0_wp   !< Effective stress [unit of stress of the law].
      real(wp) :: strain(6) = 0.0_wp   !< Natural strain since the start [-].
      real(wp) :: suction = 0.0_wp     !< [unit of stress of the law]
      real(wp) :: p_a = 0.0_wp         !< Air pressure, above the atmosphere [unit of stress of the law].
      real(wp), allocatable :: state(:, :)   !< One column.
   end type point_t

   !> Slopes of an update, in the driver's conventions.
   type :: tangent_t
      real(wp) :: dsig_deps(6, 6) = 0.0_wp   !< Effective stress by strain [unit of stress of the law].
      real(wp) :: dsig_dpc(6) = 0.0_wp       !< Effective stress by suction [-].
      real(wp) :: dsw_deps(6) = 0.0_wp       !< Degree of saturation by strain [-].
      real(wp) :: dsw_dpc = 0.0_wp           !< Degree of saturation by suction [1/unit of stress of the law].
   end type tangent_t

contains
   !> Makes a sample at rest under an effective stress. Compression positive. Fault EXIT_INPUT: the law refuses it, as
   !> its sentence says. Where s_w > 0 the law starts from that degree of saturation.
   subroutine start_point(soil, stress, suction, ratio, s_w, point, fault)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: stress(6)   !< [unit of stress of the law]
      real(wp), intent(in) :: suction     !< [unit of stress of the law]
      real(wp), intent(in) :: ratio       !< Void ratio [-].
      real(wp), intent(in) :: s_w         !< Degree of saturation [-]; 0: that of the law.
      type(point_t), intent(out) :: point
      type(fault_t), intent(inout) :: fault
      real(wp) :: tension(6)
      character(BUFFER) :: text

      allocate (point%state(soil%law%n_state, 1), source=0.0_wp)
      tension = -stress
      text = ''
      if (s_w > 0.0_wp) call soil%law%preset_saturation(s_w, point%state(:, 1), text)
      if (text == '') call soil%law%initial_state(tension, suction, ratio, point%state(:, 1), text)
      if (text /= '') then
         call raise(fault, EXIT_INPUT, trim(text))
         return
      end if
      point%stress = -tension
      point%suction = suction
   end subroutine start_point

   !> Makes a sample with the state variables of an earlier one, unchanged and unchecked. Compression positive. Fault
   !> EXIT_INPUT: the law has another number of them.
   subroutine restore_point(soil, stress, suction, state, point, fault)
      type(soil_t), intent(in) :: soil
      real(wp), intent(in) :: stress(6), suction   !< [unit of stress of the law]
      real(wp), intent(in) :: state(:)   !< (state variables of the law)
      type(point_t), intent(out) :: point
      type(fault_t), intent(inout) :: fault

      if (size(state) /= soil%law%n_state) then
         call raise(fault, EXIT_INPUT, 'state_variables has '//whole(size(state))//' values; the law of this &
                    &material has '//whole(soil%law%n_state)//'.')
         return
      end if
      allocate (point%state(soil%law%n_state, 1))
      point%state(:, 1) = state
      point%stress = stress
      point%suction = suction
   end subroutine restore_point

   !> Integrates a strain and a change of suction. Where the report's code is not 0, only the report is of use. Strain
   !> compression positive.
   subroutine update_point(soil, before, strain, suction, after, tangent, report)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: before
      real(wp), intent(in) :: strain(6)      !< Increment [-].
      real(wp), intent(in) :: suction        !< Increment [unit of stress of the law].
      type(point_t), intent(inout) :: after
      type(tangent_t), intent(out) :: tangent
      type(batch_report_t), intent(out) :: report
      type(response_t) :: response
      real(wp) :: tension(6, 1), strain_(6, 1)

      if (.not. allocated(after%state)) allocate (after%state(soil%law%n_state, 1), source=0.0_wp)
      tension(:, 1) = -before%stress
      strain_(:, 1) = -strain
      call soil%law%update(1, tension, before%state, strain_, [before%suction], [suction], WITH_TANGENT, response, &
                           after%state, report)
      if (report%code /= 0) return
      tangent%dsig_deps = response%dsig_deps(:, :, 1)
      tangent%dsig_dpc = -response%dsig_dpc(:, 1)
      tangent%dsw_deps(1:3) = -response%dsw_dev(1)
      tangent%dsw_dpc = response%dsw_dpc(1)
      after%stress = -response%stress(:, 1)
      after%strain = before%strain + strain
      after%suction = before%suction + suction
      after%p_a = before%p_a
   end subroutine update_point

   !> Writes an update to a case file. Fault EXIT_OUTPUT: there is such a file, it cannot be written, or
   !> the law saves none.
   subroutine save_update(file, origin, soil, before, strain, suction, fault)
      character(*), intent(in) :: file, origin
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: before
      real(wp), intent(in) :: strain(6), suction   !< Increments as of update_point.
      type(fault_t), intent(inout) :: fault
      character(BUFFER) :: text

      call soil%law%save_update(file, origin, -before%stress, before%state(:, 1), -strain, before%suction, suction, &
                                text)
      if (text /= '') call raise(fault, EXIT_OUTPUT, '--save-failed '//trim(file)//': '//trim(text)//'.')
   end subroutine save_update

   !> The law's sentence for a report.
   function update_sentence(soil, report) result(sentence)
      type(soil_t), intent(in) :: soil
      type(batch_report_t), intent(in) :: report
      character(:), allocatable :: sentence
      character(BUFFER) :: text

      call soil%law%message(report, text)
      sentence = trim(text)
   end function update_sentence

   !> Mean effective stress, compression positive [unit of stress of the law].
   pure real(wp) function mean_stress(point)
      type(point_t), intent(in) :: point

      mean_stress = sum(point%stress(1:3))/3.0_wp
   end function mean_stress

   !> Mean of the two radial effective stresses, compression positive [unit of stress of the law].
   pure real(wp) function radial_stress(point)
      type(point_t), intent(in) :: point

      radial_stress = 0.5_wp*sum(point%stress(RADIAL))
   end function radial_stress

   !> q = sigma_a - sigma_r, negative in extension. [unit of stress of the law]
   pure real(wp) function deviator_stress(point)
      type(point_t), intent(in) :: point

      deviator_stress = point%stress(AXIAL) - radial_stress(point)
   end function deviator_stress

   !> Natural volumetric strain since the start of the test, compression positive [-].
   pure real(wp) function volumetric_strain(point)
      type(point_t), intent(in) :: point

      volumetric_strain = sum(point%strain(1:3))
   end function volumetric_strain

   !> Void ratio of the law's state [-].
   pure real(wp) function void_ratio(soil, point)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point

      void_ratio = soil%law%void_ratio(point%state(:, 1))
   end function void_ratio

   !> Degree of saturation [-].
   pure real(wp) function saturation(soil, point)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point

      saturation = soil%law%saturation(point%state(:, 1))
   end function saturation

   !> One state variable, by its name; 0 where the law has none of that name. In its own unit.
   pure real(wp) function state_value(soil, point, name)
      type(soil_t), intent(in) :: soil
      type(point_t), intent(in) :: point
      character(*), intent(in) :: name
      integer :: place

      place = state_index(soil%law, name)
      state_value = 0.0_wp
      if (place > 0) state_value = point%state(place, 1)
   end function state_value
end module triax_point
