! SPDX-License-Identifier: MIT
!> Points of a mesh for the tests of mud_init_points, mud_update_points and mud_saturation_points.
module meshes
   use, intrinsic :: iso_c_binding, only: c_int, c_loc
   use abi_host, only: random_strain, prepared_of, default_props
   use mud_interface, only: mud_report, mud_points, mud_init_points, mud_update_points, MUD_TANGENT_NONE
   use mud_kinds, only: wp
   use mud_registry, only: NPROPS, NSTATV => NSTATV_BASE, P_SCHEME, P_TOLERANCE
   use random_states, only: random_t
   implicit none (type, external)
   private
   public :: mesh_t, fine_props, new_mesh, walked_mesh, points_of, update, N, UNWRITTEN

   integer, parameter :: N = 40
   real(wp), parameter :: UNWRITTEN = 7.25_wp

   !> All points of a mesh.
   type :: mesh_t
      real(wp) :: stress(6, N) = 0.0_wp, statev(NSTATV, N) = 0.0_wp, strain(6, N) = 0.0_wp, suction(N) = 0.0_wp
      real(wp) :: c(6, 6, N) = UNWRITTEN, c_pc(6, N) = UNWRITTEN, sw_e(6, N) = UNWRITTEN, sw_pc(N) = UNWRITTEN
      real(wp) :: s_w(N) = UNWRITTEN
      integer(c_int) :: status(N) = 77
      type(mud_report) :: reports(N)
   end type mesh_t
contains
   !> Converged answers.
   function fine_props() result(props)
      real(wp) :: props(NPROPS)

      props = default_props()
      props(P_SCHEME) = 3.0_wp
      props(P_TOLERANCE) = 1.0e-11_wp
   end function fine_props

   !> Points that have begun at different stresses and suctions, with different strains ahead.
   type(mesh_t) function new_mesh() result(mesh)
      type(random_t) :: random
      type(mesh_t), target :: begun
      integer :: i

      do i = 1, N
         begun%stress(1:3, i) = -50.0_wp - i
         begun%strain(:, i) = random_strain(random, 1.0e-4_wp)
         begun%suction(i) = real(i, wp)
      end do
      if (mud_init_points(prepared_of(default_props(), NPROPS), 1, points_of(begun, 0, 1)) /= 0) then
         error stop 'meshes: a start is refused'
      end if
      mesh = begun
      mesh%status = 77
   end function new_mesh

   !> The same after ten increments, beyond their elastic domains.
   type(mesh_t) function walked_mesh() result(mesh)
      integer :: i

      mesh = new_mesh()
      do i = 1, 10
         if (update(mesh, fine_props(), MUD_TANGENT_NONE, 2) /= 0) error stop 'meshes: an update fails'
      end do
      mesh%status = 77
      mesh%c = UNWRITTEN
   end function walked_mesh

   !> What mud.h wants of a mesh; stress and state are updated in place.
   type(mud_points) function points_of(mesh, tangent, threads) result(points)
      type(mesh_t), intent(in), target :: mesh
      integer, intent(in) :: tangent, threads

      points = mud_points(n=N, nstatev=NSTATV, tangent=tangent, threads=threads, stress0=c_loc(mesh%stress), &
         statev0=c_loc(mesh%statev), dstrain=c_loc(mesh%strain), suction=c_loc(mesh%suction), &
         stress1=c_loc(mesh%stress), statev1=c_loc(mesh%statev), dsig_deps=c_loc(mesh%c), dsig_dpc=c_loc(mesh%c_pc), &
         dsw_deps=c_loc(mesh%sw_e), dsw_dpc=c_loc(mesh%sw_pc), s_w=c_loc(mesh%s_w), status=c_loc(mesh%status), &
         reports=c_loc(mesh%reports))
   end function points_of

   integer function update(mesh, props, tangent, threads)
      type(mesh_t), intent(inout), target :: mesh
      real(wp), intent(in) :: props(NPROPS)
      integer, intent(in) :: tangent, threads

      update = mud_update_points(prepared_of(props, NPROPS), 1, points_of(mesh, tangent, threads))
   end function update
end module meshes
