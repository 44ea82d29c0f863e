# SPDX-License-Identifier: MIT
"""Recipe of Spack, from a local archive: put this folder into packages/mud of a repository of Spack, then

   git archive --prefix mud-0.2.0/ --output /tmp/mud-0.2.0.tar.gz HEAD
   spack install --no-checksum mud@0.2.0

An archive of a release has a checksum, which replaces --no-checksum.
"""

from spack.package import *
from spack_repo.builtin.build_systems.cmake import CMakePackage


class Mud(CMakePackage):
    """Bounding-surface model for unsaturated soil dynamics: library with a C interface and a UMAT, laboratory tests,
    finite-element host."""

    url = "file:///tmp/mud-0.2.0.tar.gz"

    license("MIT")

    version("0.2.0")

    variant("shared", default=True, description="Build libmud.so beside libmud.a")
    variant("host", default=False, description="Build the finite-element host")

    depends_on("c", type="build")
    depends_on("fortran", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("python@3.11:", type="build")
    depends_on("lapack")
    depends_on("suite-sparse", when="+host")
    depends_on("hdf5+fortran", when="+host")
    requires("%fortran=gcc@12:", msg="the programs are compiled by gfortran 12 or later")

    def cmake_args(self):
        return [
            self.define("MUD_BUILD_TESTS", False),
            self.define_from_variant("MUD_BUILD_SHARED", "shared"),
            self.define_from_variant("MUD_BUILD_HOST", "host"),
        ]
