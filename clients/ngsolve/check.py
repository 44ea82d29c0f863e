# SPDX-License-Identifier: MIT
"""ngsolve: drained compression, unloading and reloading against mud_triax; ground under K_0 stress."""
import clients

clients.triaxial("ngsolve")
clients.start("ngsolve")
clients.finish()
