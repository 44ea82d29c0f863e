# SPDX-License-Identifier: MIT
"""scikit-fem: drained compression, unloading and reloading against mud_triax; ground under K_0 stress."""
import clients

clients.triaxial("scikit-fem")
clients.start("scikit-fem")
clients.finish()
