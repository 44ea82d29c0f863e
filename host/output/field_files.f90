! SPDX-License-Identifier: MIT
!> Observer that writes fields in HDF5, one file for the mesh and one for every moment, and results.xdmf, which ParaView
!> opens. Every file is written as a whole: a run that is killed leaves whole files, and a restart writes the same ones
!> again.
module field_files
   use archive, only: archive_t
   use given_pressures, only: set_middles
   use kinds, only: wp
   use model_types, only: model_t
   use porous_domain, only: domain_t, model_state_t
   use run_observer, only: observer_t, BEGINS, TAKEN_OVER, STAGE_ENDS
   use run_state, only: run_t
   use unknown_fields, only: FIELDS, DISPLACEMENTS, AT_P_W, AT_P_C
   use files, only: write_whole, bytes_of
   use hdf5_file, only: h5_t, new_file, write_file, open_file, close_file, put, put_text, get_text
   use faults, only: fault_t, raise, EXIT_OUTPUT, EXIT_RESTART
   use texts, only: whole
   implicit none (type, external)
   private
   public :: field_observer_t, check_mesh

   type, extends(observer_t) :: field_observer_t
      real(wp), allocatable :: times(:)   !< Times of the fields written so far [s].
   contains
      procedure :: exchange
      procedure :: hear
   end type field_observer_t

   real(wp), parameter :: PICTURES = 50.0_wp   !< Fields of a stage with controlled steps, if no key says when.
   real(wp), parameter :: ON_TIME = 1.0e-6_wp   !< Distance from a time of output, share of output_dt, that is rounding.

   !> A field of a file, for results.xdmf.
   type :: field_t
      character(16) :: name
      character(8) :: unit
      logical :: of_nodes     !< Else it is the mean over the volume of every element.
      logical :: is_vector
   end type field_t
contains
   !> Exchanges the times of the fields that are written.
   subroutine exchange(self, archive)
      class(field_observer_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive

      call archive%exchange_allocatable('frames', self%times, 's', 'times of the fields written so far')
      if (.not. allocated(self%times)) call archive%refuse()
   end subroutine exchange

   !> Writes mesh and start of a new run, the fields after steps where they are due, and those at the end of a stage;
   !> after a failure too. Fault EXIT_OUTPUT: they cannot be written.
   subroutine hear(self, event, run, fault)
      class(field_observer_t), intent(inout) :: self
      integer, intent(in) :: event
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault

      select case (event)
      case (BEGINS)
         if (run%steps > 0) return
         allocate (self%times(0))
         call write_mesh(self%folder, run%model, fault)
         if (fault%code == 0) call write_frame(self, run, fault)
      case (TAKEN_OVER)
         if (is_due(run)) call write_frame(self, run, fault)
      case (STAGE_ENDS)
         call write_frame(self, run, fault)
      end select
   end subroutine hear

   !> Whether fields are due after a step within a stage.
   pure logical function is_due(run) result(due)
      type(run_t), intent(in) :: run
      real(wp) :: now, before

      due = .false.
      if (run%last) return
      now = run%state%time - run%at%t_start
      before = run%state%time - run%scheme%dt - run%at%t_start
      associate (stage => run%stage)
         if (stage%output_dt > 0.0_wp) then
            due = abs(now/stage%output_dt - anint(now/stage%output_dt)) < ON_TIME
         else if (stage%fields > 0) then
            due = mod(run%at%step, stage%fields) == 0
         else if (stage%controlled .and. stage%film) then
            due = picture_of(now/stage%duration) > picture_of(before/stage%duration)
         end if
      end associate
   contains
      !> Finds the number of the last picture up to a share of the stage.
      pure integer function picture_of(share)
         real(wp), intent(in) :: share   !< [-]

         picture_of = floor(PICTURES*share*(1 + ON_TIME))
      end function picture_of
   end function is_due

   !> Writes mesh.h5: nodes, elements, quadrature points, regions. Fault EXIT_OUTPUT: it cannot be written.
   subroutine write_mesh(folder, model, fault)
      character(*), intent(in) :: folder
      type(model_t), intent(in) :: model
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      integer :: e, g
      logical :: good

      call new_file(file, folder//'/mesh.h5')
      call put_text(file, 'kind', 'mesh of mud_host')
      call put_text(file, 'scene', trim(model%origin%name))
      call put_text(file, 'fingerprint', model%origin%fingerprint)
      associate (domain => model%domain, n => model%domain%rule, elements => size(model%domain%mesh%t6, 2))
         call put_text(file, 'axes', merge('r, z; axisymmetric', 'x, y; plane strain', domain%axisymmetric))
         call put(file, 'nodes', domain%mesh%x, 'm', 'coordinates r, z (x, y in plane strain) of every node')
         call put(file, 'elements', domain%mesh%t6 - 1, '-', 'nodes of every element from 0: vertices, then the '// &
                  'middles of the sides 1-2, 2-3, 3-1')
         call put(file, 'regions', domain%region_of, '-', 'number of the region of every element, as in the scene')
         call put(file, 'points/position', reshape([((domain%gauss(g, e)%x, g=1, n), e=1, elements)], &
                  [2, n*elements]), 'm', 'r, z (x, y in plane strain) of every quadrature point')
         call put(file, 'points/weight', [((domain%gauss(g, e)%weight, g=1, n), e=1, elements)], &
                  'm3', 'volume of every quadrature point (per m of thickness in plane strain)')
      end associate
      call write_file(file, good)
      if (.not. good) call raise_unwritten(folder//'/mesh.h5', fault)
   end subroutine write_mesh

   !> Refuses a folder whose mesh is not that of the scene's run. Fault EXIT_RESTART: mesh.h5 is missing, truncated, or
   !> of another scene.
   subroutine check_mesh(folder, fingerprint, fault)
      character(*), intent(in) :: folder, fingerprint
      type(fault_t), intent(inout) :: fault
      type(h5_t) :: file
      character(64) :: found

      call open_file(folder//'/mesh.h5', file)
      if (.not. file%good) then
         call raise(fault, EXIT_RESTART, folder//'/mesh.h5 is missing or truncated; --output must name the folder '// &
                    'of the interrupted run. Nothing was changed.')
         return
      end if
      found = get_text(file, 'fingerprint')
      if (found /= fingerprint) call raise(fault, EXIT_RESTART, folder//' holds another run (scene '// &
         trim(get_text(file, 'scene'))//', fingerprint '//trim(found)//', here '//fingerprint//'); --output must '// &
         'name the folder of the interrupted run. Nothing was changed.')
      call close_file(file)
   end subroutine check_mesh

   !> Writes fields_NUMBER.h5 of the present state, and results.xdmf up to it. Fault EXIT_OUTPUT: that cannot be done.
   subroutine write_frame(self, run, fault)
      class(field_observer_t), intent(inout) :: self
      type(run_t), intent(in) :: run
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: STRESS = 'effective stress, tension positive'
      type(h5_t) :: file
      type(field_t), allocatable :: list(:)
      real(wp) :: x(FIELDS, size(run%state%x, 2)), cells(8, size(run%domain%mesh%t6, 2))
      character(:), allocatable :: path
      logical :: good

      self%times = [self%times, run%state%time]
      path = self%folder//'/'//file_of(size(self%times))
      call new_file(file, path)
      call put_text(file, 'kind', 'fields of mud_host')
      call put(file, 'time', [run%state%time], 's', 'time')
      allocate (list(0))
      associate (domain => run%domain, state => run%state)
         x = state%x
         call set_middles(domain, x(AT_P_W:, :))
         call means(domain, state, cells)
         call add('nodes', 'displacement', 'm', 'u_r, u_z, 0', with_zero(state%x))
         call add('nodes', 'velocity', 'm/s', 'v_r, v_z, 0', with_zero(state%v))
         call add('nodes', 'acceleration', 'm/s2', 'a_r, a_z, 0', with_zero(state%a))
         if (domain%with_w) call add('nodes', 'p_w', 'kPa', 'pore water pressure, compression positive', &
                                     x(AT_P_W:AT_P_W, :))
         if (domain%with_c) then
            call add('nodes', 'p_c', 'kPa', 'suction p_a - p_w', x(AT_P_C:AT_P_C, :))
            call add('nodes', 'p_a', 'kPa', 'pore air pressure, compression positive', &
                     x(AT_P_W:AT_P_W, :) + x(AT_P_C:AT_P_C, :))
         end if
         call add('cells', 's_rr', 'kPa', STRESS, cells(1:1, :))
         call add('cells', 's_zz', 'kPa', STRESS, cells(2:2, :))
         call add('cells', 's_tt', 'kPa', STRESS, cells(3:3, :))
         call add('cells', 's_rz', 'kPa', 'effective stress', cells(4:4, :))
         call add('cells', 'p', 'kPa', 'mean effective stress, compression positive', cells(5:5, :))
         call add('cells', 'q', 'kPa', 'deviator stress: square root of 3 J_2', cells(6:6, :))
         call add('cells', 'e', '-', 'void ratio', cells(7:7, :))
         if (domain%with_c) call add('cells', 'S_w', '-', 'degree of saturation', cells(8:8, :))
         if (allocated(state%present)) call add('cells', 'ground', '-', '1: part of the ground at this time, 0: not', &
                                                reshape(merge(1.0_wp, 0.0_wp, state%present), [1, size(cells, 2)]))
         call put(file, 'points/stress', state%stress(1:4, :), 'kPa', 'effective stress rr, zz, tt, rz of every '// &
                  'quadrature point, tension positive')
         call put(file, 'points/e', state%e, '-', 'void ratio of every quadrature point')
         call put(file, 'points/S_w', state%s, '-', 'degree of saturation of every quadrature point')
      end associate
      call write_file(file, good)
      if (.not. good) call raise_unwritten(path, fault)
      if (good) call write_xdmf(self, run%domain, list, fault)
   contains
      subroutine add(center, name, unit, meaning, values)
         character(*), intent(in) :: center, name, unit, meaning
         real(wp), intent(in) :: values(:, :)   !< (1 or 3, nodes or elements)

         if (size(values, 1) == 1) call put(file, center//'/'//name, values(1, :), unit, meaning)
         if (size(values, 1) == 3) call put(file, center//'/'//name, values, unit, meaning)
         list = [list, field_t(name, unit, center == 'nodes', size(values, 1) == 3)]
      end subroutine add

      pure function with_zero(values) result(three)
         real(wp), intent(in) :: values(:, :)   !< (2 or more, nodes)
         real(wp) :: three(3, size(values, 2))

         three(:DISPLACEMENTS, :) = values(:DISPLACEMENTS, :)
         three(3, :) = 0.0_wp
      end function with_zero
   end subroutine write_frame

   pure function file_of(number) result(name)
      integer, intent(in) :: number
      character(16) :: name

      write (name, '(a,i6.6,a)') 'fields_', number, '.h5'
   end function file_of

   !> Means over the elements, in the order of the list.
   pure subroutine means(domain, state, cells)
      type(domain_t), intent(in) :: domain
      type(model_state_t), intent(in) :: state
      real(wp), intent(out) :: cells(:, :)
      real(wp) :: weight(domain%rule), s(4), p
      integer :: e, first, last, i

      do e = 1, size(cells, 2)
         first = (e - 1)*domain%rule + 1
         last = e*domain%rule
         weight = domain%gauss(:, e)%weight/sum(domain%gauss(:, e)%weight)
         s = matmul(state%stress(1:4, first:last), weight)
         p = -sum(s(1:3))/3
         cells(1:4, e) = s
         cells(5, e) = p
         cells(6, e) = sqrt(1.5_wp*sum([((s(i) + p)**2, i=1, 3)]) + 3*s(4)**2)
         cells(7, e) = dot_product(state%e(first:last), weight)
         cells(8, e) = dot_product(state%s(first:last), weight)
      end do
   end subroutine means

   subroutine write_xdmf(self, domain, list, fault)
      class(field_observer_t), intent(in) :: self
      type(domain_t), intent(in) :: domain
      type(field_t), intent(in) :: list(:)
      type(fault_t), intent(inout) :: fault
      character(*), parameter :: LF = new_line('a')
      character(:), allocatable :: text, mesh, attributes
      character(26) :: time
      integer :: i, k, nodes, elements
      logical :: good

      nodes = size(domain%mesh%x, 2)
      elements = size(domain%mesh%t6, 2)
      mesh = '    <Topology TopologyType="Triangle_6" NumberOfElements="'//whole(elements)//'">'// &
             item(whole(elements)//' 6', 'Int', 'mesh.h5', 'elements')//'</Topology>'//LF// &
             '    <Geometry GeometryType="XY">'//item(whole(nodes)//' 2', 'Float', 'mesh.h5', 'nodes')// &
             '</Geometry>'//LF
      text = '<?xml version="1.0"?>'//LF//'<Xdmf Version="3.0"><Domain>'//LF// &
             '<Grid Name="results" GridType="Collection" CollectionType="Temporal">'//LF
      do k = 1, size(self%times)
         attributes = ''
         do i = 1, size(list)
            associate (one => list(i))
               attributes = attributes//'    <Attribute Name="'//trim(one%name)//' ['//trim(one%unit)// &
                            ']" AttributeType="'//merge('Vector', 'Scalar', one%is_vector)// &
                            '" Center="'//merge('Node', 'Cell', one%of_nodes)//'">'// &
                            item(whole(merge(nodes, elements, one%of_nodes))//trim(merge(' 3', '  ', one%is_vector)), &
                                 'Float', trim(file_of(k)), merge('nodes', 'cells', one%of_nodes)//'/'// &
                                 trim(one%name))//'</Attribute>'//LF
            end associate
         end do
         write (time, '(es24.16e3)') self%times(k)
         text = text//'  <Grid Name="results" GridType="Uniform"><Time Value="'//trim(adjustl(time))//'"/>'//LF// &
                mesh//attributes//'  </Grid>'//LF
      end do
      text = text//'</Grid>'//LF//'</Domain></Xdmf>'//LF
      call write_whole(self%folder//'/results.xdmf', bytes_of(text), good)
      if (.not. good) call raise_unwritten(self%folder//'/results.xdmf', fault)
   end subroutine write_xdmf

   pure function item(dimensions, number, file, place) result(text)
      character(*), intent(in) :: dimensions, number, file, place
      character(:), allocatable :: text

      text = '<DataItem Dimensions="'//dimensions//'" NumberType="'//number//'" Precision="'// &
             merge('8', '4', number == 'Float')//'" Format="HDF">'//file//':/'//place//'</DataItem>'
   end function item

   subroutine raise_unwritten(path, fault)
      character(*), intent(in) :: path
      type(fault_t), intent(inout) :: fault

      call raise(fault, EXIT_OUTPUT, path//' cannot be written; is the disk full?')
   end subroutine raise_unwritten
end module field_files
