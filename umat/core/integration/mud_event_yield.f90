! SPDX-License-Identifier: MIT
!> Event: compression reaches what the isotropic mechanism remembers; docs/theory/material.md section 4.10.
module mud_event_yield
   use mud_event, only: event_t, NO_RATE, BEYOND, BY_MEMORY, ORDINARY, ELASTIC
   implicit none (type, external)
   private
   public :: YIELD

   !> The function is short_of_memory.
   type(event_t), parameter :: YIELD = event_t(ORDINARY .or. ELASTIC, NO_RATE, BEYOND, BY_MEMORY)
end module mud_event_yield
