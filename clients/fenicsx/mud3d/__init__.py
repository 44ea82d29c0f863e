# SPDX-License-Identifier: MIT
"""MUD in three dimensions on FEniCSx, PETSc and MPI: scenes of mud_host, water and air at rest."""
