# What long work over models has in common; to be sourced. The script ends with 5 at a signal.

trap 'exit 5' INT TERM HUP

# COMMAND...: a signal for the script alone would leave its child at work. The first wait ends with the signal, the second one with the child.
interruptible() {
  local child code=0 stopped=0
  "$@" &
  child=$!
  trap 'stopped=1; kill -TERM $child 2>/dev/null || true' INT TERM HUP
  wait $child || code=$?
  while kill -0 $child 2>/dev/null; do code=0; wait $child || code=$?; done
  trap 'exit 5' INT TERM HUP
  [ $stopped = 0 ] || exit 5
  return $code
}

# PREFIX: PREFIX_CPU, PREFIX_MEMORY and PREFIX_JOBS are numbers above 0 or not set, and `bin` is where PREFIX_BUILD has its programs.
use_settings() {
  local name=$0 root variable
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
  for variable in "$1_CPU" "$1_MEMORY" "$1_JOBS"; do
    [[ "${!variable:-1}" =~ ^[1-9][0-9]*$ ]] || { echo "$name: $variable: ${!variable} is not a number above 0" >&2; exit 2; }
  done
  variable=$1_BUILD
  bin=$(realpath -m "${!variable:-$root/build/release}")/bin
  [ -x "$bin/tetproof" ] || { echo "$name: $bin/tetproof is missing; cmake --preset release && cmake --build --preset release" >&2; exit 2; }
}
