# Sourced by the scripts of this folder: strict mode, the project's root, messages, and progress of programs.
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)

# The Open Image Denoise that scripts/setup --denoise installed; libvelour opens it.
for oidn in "$root"/build/tools/lib/python3*/site-packages/pyoidn/oidn/lib/libOpenImageDenoise.so.2; do
  if [[ -e $oidn ]]; then export VELOUR_OIDN=${VELOUR_OIDN:-$oidn}; fi
done

say() { printf '%s\n' "$*"; }

die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# usage_if_asked "$@": prints the header comment of the script for -h or --help.
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

# with_progress STAGE COUNTER LOG PROGRAM...: runs a program with its output in LOG and prints its progress: on a
# terminal one line that is updated, elsewhere a line every ten seconds. `COUNTER LOG` prints "DONE TOTAL", or nothing
# while that is unknown. If the program fails, shows the errors in LOG and dies. Ctrl-C and SIGTERM end the program too.
with_progress() {
  if ! try_with_progress "$@"; then
    show_failure "$3"
    die "$1 failed; the whole log: $3"
  fi
}

# quietly LOG STAGE PROGRAM...: with_progress for a program whose progress cannot be counted.
quietly() { with_progress "$2" count_nothing "$1" "${@:3}"; }

# configure FOLDER OPTION...: runs CMake, whose files are in FOLDER. It refuses the cache of a project that was moved or
# copied here.
configure() {
  local fresh=()
  grep -qsxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$1/CMakeCache.txt" || fresh=(--fresh)
  quietly "$1/configure.log" "configuring" cmake "${fresh[@]}" "${@:2}"
}

# try_with_progress STAGE COUNTER LOG PROGRAM...: with_progress that returns the exit status and shows no errors.
try_with_progress() {
  local stage=$1 counter=$2 log=$3 begin=$SECONDS status=0 stopped=0 reporting reporter program traps
  shift 3
  mkdir -p "$(dirname "$log")"
  : >"$log"
  # The reporter ends when this file is closed, even if this shell is killed.
  exec {reporting}> >(report_progress "$stage" "$counter" "$log")
  reporter=$!
  # Runs in the background, because only `wait` lets a trap run at once. Background programs of a shell ignore Ctrl-C; env
  # restores the default.
  env --default-signal=INT,QUIT "$@" >"$log" 2>&1 {reporting}>&- &
  program=$!
  traps=$(trap -p INT TERM HUP)
  trap 'stop_program INT 130' INT
  trap 'stop_program TERM 143' TERM
  trap 'stop_program HUP 129' HUP
  wait "$program" || status=$?
  # A trap ends `wait` before the program ends. Bash may wait forever for a program that it has already reaped.
  while ((stopped)) && [[ -e /proc/$program ]]; do wait "$program" || true; done
  trap - INT TERM HUP
  eval "$traps"
  exec {reporting}>&-
  wait "$reporter" || true
  if ((stopped)); then
    printf '%s: stopped while %s\n' "$(basename "$0")" "$stage" >&2
    exit "$stopped"
  fi
  if ((status == 0 && SECONDS - begin >= progress_interval)); then
    say "$stage: done after $(duration $((SECONDS - begin)))"
  fi
  return "$status"
}

# Used by the traps of try_with_progress. Ctrl-C reaches the program by itself, but a signal to this shell does not.
stop_program() {
  stopped=$2
  kill -s "$1" "$program" 2>/dev/null || true
}

show_failure() {
  { grep -aE -A 5 '(error|Error|FAILED|^E:)' "$1" || tail -n 40 "$1"; } | sed -n 1,40p >&2
}

# Seconds between two lines of progress. On a terminal the line changes every second.
progress_interval=10

# report_progress STAGE COUNTER LOG: prints the progress until its input is closed.
report_progress() {
  local interval=$progress_interval begin=$SECONDS before='' after='\n'
  trap '' INT # it must clear its line first
  if [[ -t 1 ]]; then interval=1 before='\r\e[K' after=''; fi
  while read -rt "$interval" || (($? > 128)); do
    printf "$before%s$after" "$(progress_line "$1" $((SECONDS - begin)) $("$2" "$3"))"
  done
  if [[ -t 1 ]]; then printf '\r\e[K'; fi
}

# progress_line STAGE SECONDS [DONE TOTAL]
progress_line() {
  local stage=$1 seconds=$2 finished=${3:-0} total=${4:-0} left=''
  if ((finished)); then left=", about $(duration $((seconds * (total - finished) / finished))) left"; fi
  if ((total)); then printf '[%3d/%d] ' "$finished" "$total"; fi
  printf '%s: %d s%s' "$stage" "$seconds" "$left"
}

# duration SECONDS: formatted as in scripts/lib/bench/progress.py.
duration() { if (($1 < 600)); then printf '%d s' "$1"; else printf '%d min' $((($1 + 30) / 60)); fi; }

# Counters for with_progress.
count_nothing() { :; }
count_ninja() { grep -aoE '^\[[0-9]+/[0-9]+\]' "$1" | tail -n 1 | tr '[/]' ' '; }
count_apt() { # each package is fetched (unless it is cached), unpacked and set up
  awk '/^Get:/ { fetched++ }
    /^(Unpacking|Setting up) / { installed++ }
    / newly installed, / { packages = $1 + $3 }
    END { if (packages) print fetched + installed, (installed ? fetched : packages) + 2 * packages }' "$1"
}
