#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes the Debian packages of a build and uses them in a root folder that has nothing else: programs first, then a C
# and a Fortran host against the development files. Needs root, debootstrap and a Debian mirror; takes some minutes and
# 1 GB of a temporary folder. Not part of ./check.
# usage: scripts/try_packages.sh [BUILD]      (default build/release, what the packages hold is built there;
#        MIRROR, by default that of apt, and SUITE from the environment)
set -eu
case ${1:-} in
   -*) sed -n '3,7s/^# //p' "$0"; exit 0 ;;
esac
source=$(cd "$(dirname "$0")/.." && pwd)
mirror=${MIRROR:-$(apt-get indextargets --format '$(SITE)' 2> /dev/null | head -n 1)}
suite=${SUITE:-bookworm}
say() { printf '%s\n' "$*"; }
refuse() { say "try_packages: $*" >&2; exit 2; }
[ "$(id -u)" = 0 ] || refuse "chroot needs root"
[ -n "$mirror" ] || refuse "apt knows no mirror; name one: MIRROR=..."
command -v debootstrap > /dev/null || refuse "there is no debootstrap (apt install debootstrap)"
command -v dpkg-shlibdeps > /dev/null || refuse "there is no dpkg-shlibdeps (apt install dpkg-dev)"
if [ $# -gt 0 ]; then
   [ -e "$1/CPackConfig.cmake" ] || refuse "$1 is no build folder of MUD: it has no CPackConfig.cmake"
else
   bash -c '. "$0/scripts/setup.sh" && configure_and_build release "$0/build/release" --target mud mud_shared mud_single_source \
      mud_triax mud_describe mud_host' "$source"
fi
build=$(cd "${1:-$source/build/release}" && pwd)
abi=$(sed -n 's/^#define MUD_ABI_VERSION //p' "$source/umat/include/mud.h")
work=$(mktemp -d)
root=$work/root
trap 'rm -rf "$work"' EXIT
failed=0
passed=0
check() { # SENTENCE COMMAND...: counts, and shows what went wrong
   sentence=$1
   shift
   if "$@" > "$work/log" 2>&1; then
      passed=$((passed + 1))
   else
      failed=$((failed + 1))
      say "FAILED $sentence"
      tail -n 20 "$work/log"
   fi
}
inside() {
   chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive HOME=/root "$@"
}
install() { inside apt-get install -q -y --no-install-recommends "$@"; }
says() { # PATTERN COMMAND...
   pattern=$1
   shift
   inside "$@" | tee "$work/said" && grep -q -e "$pattern" "$work/said"
}

# p' and q of tests/consumers/minimal_host within 1e-4 of what tests/umat/test_install.py holds to be right.
meets() {
   inside "$@" | tee "$work/said" && awk '{ p = $2/147.354 - 1; q = $5/219.587 - 1 }
      END { exit !(NR == 1 && p*p < 1e-8 && q*q < 1e-8) }' "$work/said"
}

check "packages are made" cpack --config "$build/CPackConfig.cmake" -B "$work/debs"
ls "$work"/debs/*.deb > /dev/null 2>&1 || refuse "no packages in $work/debs"
debootstrap --variant=minbase "$suite" "$root" "$mirror" > "$work/log" 2>&1 \
   || refuse "debootstrap: $(tail -n 3 "$work/log")"
cp "$work"/debs/*.deb "$root/tmp/"
# The way to the mirror is that of this machine.
cp /etc/resolv.conf "$root/etc/" 2> /dev/null || true
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/" 2> /dev/null || true
rm -f "$root"/etc/apt/apt.conf.d/docker-clean
cp "$source"/tests/consumers/minimal_host.c "$source"/tests/consumers/minimal_host.f90 "$root/tmp/"
case=$(ls "$source"/drivers/cases/*.nml | head -n 1)
cp -r "$source/drivers/cases" "$source/drivers/materials" "$root/tmp/"
inside apt-get update -q > "$work/log" 2>&1 || refuse "apt-get update: $(tail -n 3 "$work/log")"

check "there is no MUD before" sh -c "! ls $root/usr/lib/libmud* $root/usr/bin/mud_* 2> /dev/null"
debs() { (cd "$root" && echo tmp/$1_*.deb | sed "s,^,/,"); }
check "the programs install with what they need" install "$(debs mud-programs)"
check "mud_triax runs a case" inside sh -c "cd /tmp/cases && mud_triax $(basename "$case") --output /tmp/out.csv"
check "mud_describe reads the installed material" says '^150.0$' mud_describe plain /usr/share/mud/materials/toyoura.nml
check "mud_host says what it is" says mud_host mud_host --help
check "the library installs" install "$(debs libmud$abi)"
check "ldconfig knows it" says "libmud.so.$abi" ldconfig -p
check "the development files install" install "$(debs libmud-dev)" gcc gfortran libc6-dev pkg-config
check "a C host links and meets the known answer" meets \
   sh -c 'gcc /tmp/minimal_host.c $(pkg-config --cflags --libs mud) -o /tmp/host_c && /tmp/host_c'
check "a Fortran host links and meets the known answer" meets \
   sh -c 'cd /tmp && gfortran minimal_host.f90 $(pkg-config --cflags --libs mud) -o host_f && ./host_f'
check "a Fortran host links the archive" meets \
   sh -c 'cd /tmp && gfortran minimal_host.f90 $(pkg-config --cflags mud) $(pkg-config --variable=static_libs mud) -o host_a && ./host_a'
check "all three packages leave without a trace" inside sh -c \
   "dpkg --purge libmud-dev libmud$abi mud-programs && ! ls /usr/lib/libmud* /usr/bin/mud_* /usr/share/mud 2> /dev/null"
say "$passed passed, $failed failed"
[ "$failed" = 0 ]
