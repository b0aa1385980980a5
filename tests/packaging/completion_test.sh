#!/bin/bash
# Completes words as bash would, and holds every option against the program's own help.
# completion_test.sh FOLDER PROGRAM
set -euo pipefail
folder=$1 program=$2
source "$folder/stiffscope"
compopt() { :; }  # known only while bash completes

offered() {  # what is offered for the last of these words
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _stiffscope || true
  echo "${COMPREPLY[*]}"
}
hold() { [ "$1" = "$2" ] || { echo "offered '$1', expected '$2'" >&2; exit 1; }; }

hold "$(offered stiffscope ide)" "identify"
hold "$(offered stiffscope identify --sp)" "--springs-only"
hold "$(offered stiffscope import te)" "template"
hold "$(offered stiffscope import template --ma)" "--maker"
hold "$(offered stiffscope view --screen)" "--screenshot"
hold "$(cd "$(dirname "$0")" && offered stiffscope identify completion_)" "completion_test.sh"
for command in init audit fit frames identify calibrate compensate compare plan diagnose fleet blind simulate report; do
  known=$("$program" "$command" --help | grep -oE '^ +(-[a-z],)?--[a-z-]+' | sed 's/.*--/--/' | sort)
  got=$(offered stiffscope "$command" -- | tr ' ' '\n' | sort)
  hold "$got" "$known"
done
echo "completion: as the program's help has it"
