# SPDX-License-Identifier: MIT
"""Studies of scenes of mud_host: what accuracy costs, and which effects a scene calls for (needs f90nml)."""
