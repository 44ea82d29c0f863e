# SPDX-License-Identifier: MIT
# Sourced by ./check and ./demo: makes sure that the tools are there. Quick when nothing is missing.
# Leaves $root (the repository) and $venv_python. A missing tool that cannot be installed ends with code 3.

# shellcheck source=scripts/python_environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/python_environment.sh"
venv=$root/build/venv
venv_python=$venv/bin/python3

# Any LAPACK that the linker finds, as CMake does.
has_lapack() {
   local library
   for library in lapack openblas mkl_rt; do
      [ -e "$("${FC:-gfortran}" -print-file-name="lib$library.so" 2>/dev/null)" ] && return
   done
   return 1
}

# Debian keeps the reference BLAS in a folder blas; an optimised one replaces the link to it.
has_optimised_blas() {
   local library
   library=$(readlink -f "$("${FC:-gfortran}" -print-file-name=libblas.so.3 2>/dev/null)" 2>/dev/null)
   case $library in
      */blas/libblas.so*) return 1 ;;
   esac
}

# What the programs run without, but slowly: installed where that is possible, told by mud_host where it is not.
wanted_packages() {
   has_optimised_blas || dpkg -s libopenblas0-serial >/dev/null 2>&1 || echo libopenblas0-serial
}

# The one list of what is needed: each line prints a Debian package if what it brings is missing.
missing_packages() {
   [ -n "${FC:-}" ] || command -v gfortran >/dev/null || echo gfortran
   [ -n "${CC:-}" ] || command -v cc >/dev/null || echo gcc libc6-dev
   command -v cmake >/dev/null || echo cmake
   command -v ninja >/dev/null || echo ninja-build
   command -v h5fc >/dev/null || echo libhdf5-dev
   # The sparse solver of the host.
   [ -e /usr/include/suitesparse/umfpack.h ] || [ -e /usr/include/umfpack.h ] || echo libsuitesparse-dev
   # Small dense systems of the programs; OpenBLAS brings its own.
   has_lapack || echo liblapack-dev
   local python
   python=$(find_python)
   if [ -z "$python" ]; then
      echo python3 python3-venv
   elif [ ! -e "$venv_python" ] && ! "$python" -c 'import venv, ensurepip' 2>/dev/null; then
      echo python3-venv
   fi
}

install_packages() {
   local packages as_root=()
   packages=$(missing_packages | xargs)
   [ -n "$packages" ] || return 0
   if [ "$(id -u)" != 0 ]; then
      sudo -n true 2>/dev/null && as_root=(sudo) ||
         setup_fail "missing: $packages; no right to install. Run:
   sudo apt-get update && sudo apt-get install -y --no-install-recommends $packages"
   fi
   command -v apt-get >/dev/null ||
      setup_fail "missing: $packages (Debian names); there is no apt-get here, so install them by hand."
   echo "setup: installing $packages"
   # shellcheck disable=SC2086  # one word per package
   { "${as_root[@]}" apt-get update -q -o DPkg::Lock::Timeout=300 &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install -q -y --no-install-recommends -o DPkg::Lock::Timeout=300 $packages; } >&2 ||
      setup_fail "apt-get could not install: $packages (its own message is above)"
   packages=$(missing_packages | xargs)
   [ -z "$packages" ] || setup_fail "still missing after the installation: $packages"
}

install_wanted_packages() {
   local packages as_root=()
   packages=$(wanted_packages | xargs)
   [ -n "$packages" ] && command -v apt-get >/dev/null || return 0
   if [ "$(id -u)" != 0 ]; then
      sudo -n true 2>/dev/null || return 0
      as_root=(sudo)
   fi
   echo "setup: installing $packages"
   # shellcheck disable=SC2086  # one word per package
   { "${as_root[@]}" apt-get update -q -o DPkg::Lock::Timeout=300 &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
         apt-get install -q -y --no-install-recommends -o DPkg::Lock::Timeout=300 $packages; } >&2 ||
      echo "setup: apt-get could not install $packages; everything works without them, but more slowly" >&2
}

check_versions() {
   local compiler=${FC:-gfortran} found
   found=$("$compiler" -dumpversion 2>/dev/null) ||
      setup_fail "the Fortran compiler '$compiler' is not found or does not run (FC chooses it)"
   "$compiler" --version | head -n 1 | grep -qi 'gnu fortran' ||
      setup_fail "the Fortran compiler '$compiler' is not gfortran; set FC to gfortran 12 or later"
   [ "${found%%.*}" -ge 12 ] ||
      setup_fail "gfortran 12 or later is needed, '$compiler' is $found; set FC to a later one"
   found=$(cmake --version | sed -n '1s/[^0-9]*\([0-9.]*\).*/\1/p')
   [ "$(printf '%s\n' 3.25 "$found" | sort -V | head -n 1)" = 3.25 ] ||
      setup_fail "cmake 3.25 or later is needed, found $found"
}

# configure_and_build PRESET BUILD_DIR [CMAKE_ARGUMENT...] [--target NAME...]: logs beside the build, shown only if it
# fails. Without --target everything is built.
configure_and_build() {
   local preset=$1 dir=$2 options=() targets=()
   shift 2
   while [ $# -gt 0 ] && [ "$1" != --target ]; do
      options+=("$1")
      shift
   done
   targets=("$@")
   set -- "${options[@]}"
   mkdir -p "$dir"
   # cmake reads its presets from the current folder.
   if ! (cd "$root" && cmake --preset "$preset" -B "$dir" -DMUD_PYTHON="$venv_python" "$@") \
      >"$dir/configure.log" 2>&1; then
      cat "$dir/configure.log" >&2
      echo "configuring the $preset build failed: see above" >&2
      return 1
   fi
   echo "setup: building the preset $preset, the first time for some minutes; log: ${dir#"$root"/}/build.log"
   if ! cmake --build "$dir" "${targets[@]}" -- -k 0 >"$dir/build.log" 2>&1; then
      grep -v '^\[[0-9]*/[0-9]*\] \(Building\|Linking\|Generating\|Reading\)' "$dir/build.log" | head -n 200 >&2
      echo "the $preset build failed: see above; the whole log is $dir/build.log" >&2
      return 1
   fi
}

install_packages
install_wanted_packages
check_versions
install_requirements "$root/requirements.txt" "$venv"
