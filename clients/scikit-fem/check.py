# SPDX-License-Identifier: MIT
"""scikit-fem: drained compression, unloading and reloading in three dimensions against mud_triax."""
import clients

clients.triaxial("scikit-fem")
clients.finish()
