#!/bin/sh
# SPDX-License-Identifier: MIT
# usage: relative_names.sh FOLDER COMMAND...
# Runs the command; sources (*.f90) and folders of includes (-I) in FOLDER are named from the present folder.
folder=$1
shift
for word in "$@"; do
   shift
   case $word in
      "$folder"/*.f90) word=$(realpath -m --relative-to=. -- "$word") || exit 1 ;;
      -I"$folder"/*) word=-I$(realpath -m --relative-to=. -- "${word#-I}") || exit 1 ;;
   esac
   set -- "$@" "$word"
done
exec "$@"
