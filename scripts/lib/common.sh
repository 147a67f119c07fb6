# What every script of this folder starts with: strict mode, the project's root, two ways to speak. Sourced, not run.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)

say() { printf '%s\n' "$*"; }

die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# usage_if_asked "$@": prints the comment at the head of the script for -h or --help.
usage_if_asked() {
  local argument
  for argument in "$@"; do
    case $argument in
      -h | --help)
        sed -n '2,/^[^#]/{/^#/s/^# \{0,1\}//p}' "$0"
        exit 0
        ;;
    esac
  done
}

# quietly LOG WHAT COMMAND...: runs with the output in LOG; shows its end, and dies, when the command fails.
quietly() {
  local log=$1 what=$2
  shift 2
  mkdir -p "$(dirname "$log")"
  if ! "$@" >"$log" 2>&1; then
    { grep -E -A 5 '(error|Error|FAILED|^E:)' "$log" || tail -n 40 "$log"; } | sed -n 1,40p >&2
    die "$what failed; everything it said is in $log"
  fi
}
