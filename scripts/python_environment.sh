# SPDX-License-Identifier: MIT
# Sourced by scripts that need Python packages: makes virtual environments of requirements. Leaves $root (the repository).

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

setup_fail() {
   echo "setup: $*" >&2
   exit 3
}

# numpy as pinned needs 3.11; a shim earlier on the PATH may be older than the system's own.
find_python() {
   local candidate
   for candidate in python3 /usr/bin/python3; do
      if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
         echo "$candidate"
         return
      fi
   done
}

# install_requirements FILE FOLDER: the stamp is a copy of the requirements, written last, so that an interrupted
# installation is redone. Quick when nothing is missing.
install_requirements() {
   local requirements=$1 folder=$2
   if cmp -s "$requirements" "$folder/requirements.stamp" && "$folder/bin/python3" -c '' 2>/dev/null; then
      return 0
   fi
   [ -n "$(find_python)" ] || setup_fail "Python 3.11 or later is needed (Debian: python3 python3-venv)"
   echo "setup: installing the Python packages of ${requirements#"$root"/} in ${folder#"$root"/}"
   mkdir -p "$(dirname "$folder")"
   "$(find_python)" -m venv --clear "$folder" ||
      setup_fail "could not make the Python environment ${folder#"$root"/}"
   "$folder/bin/python3" -m pip install --quiet --disable-pip-version-check -r "$requirements" ||
      setup_fail "pip could not install ${requirements#"$root"/} (its own message is above)"
   cp "$requirements" "$folder/requirements.stamp"
}
