! SPDX-License-Identifier: MIT
!> Event: compression ceases, and the isotropic mechanism remembers how far it came; docs/theory/material.md
!> section 4.10.
module mud_event_unload
   use mud_event, only: event_t, RATE_THERE, BEYOND, NOTHING, ORDINARY, ELASTIC
   implicit none (type, external)
   private
   public :: UNLOAD

   !> The function is drive_to_memory; rates are smooth there.
   type(event_t), parameter :: UNLOAD = event_t(ORDINARY .or. ELASTIC, RATE_THERE, BEYOND, NOTHING)
end module mud_event_unload
