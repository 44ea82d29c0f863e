# SPDX-License-Identifier: MIT
"""Light falling weight deflectometer tests on unsaturated soil, computed by mud_host (needs f90nml and matplotlib)."""
