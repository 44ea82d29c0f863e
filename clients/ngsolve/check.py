# SPDX-License-Identifier: MIT
"""ngsolve: drained compression, unloading and reloading in three dimensions against mud_triax."""
import clients

clients.triaxial("ngsolve")
clients.finish()
