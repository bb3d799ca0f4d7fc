# What ci/varied and ci/rotated have in common; to be sourced.

# NAME PREFIX PATH...: checks the arguments and PREFIX_CPU, PREFIX_MEMORY, PREFIX_JOBS; sets `bin`, and `base` to PREFIX_OUT.
prepare() {
  local name=$1 prefix=$2 root variable
  shift 2
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
  for argument in "$@"; do
    case $argument in -*) echo "usage: ci/$name [PATH...]; its first lines tell more" >&2; exit 2 ;; esac
    [ -e "$argument" ] || { echo "ci/$name: $argument: no such file" >&2; exit 2; }
  done
  for variable in "${prefix}_CPU" "${prefix}_MEMORY" "${prefix}_JOBS"; do
    [[ "${!variable:-1}" =~ ^[1-9][0-9]*$ ]] || { echo "ci/$name: $variable: ${!variable} is no number above 0" >&2; exit 2; }
  done
  variable=${prefix}_BUILD
  bin=$(realpath -m "${!variable:-$root/build/release}")/bin
  [ -x "$bin/tetproof" ] || { echo "ci/$name: $bin/tetproof is missing; cmake --preset release && cmake --build --preset release" >&2; exit 2; }
  variable=${prefix}_OUT
  base=$(realpath -m "${!variable:-$root/build/$name}")
  mkdir -p "$base" || exit 1
}

# VERB PATH...: copies by `tetproof VERB`, once for the same files, in $out/models; sets `out` to their folder in `base`.
make_copies() {
  local verb=$1
  shift
  out=$base/$(find -L "$@" -type f -printf '%p %s %T@\n' | sort | sha256sum | head -c 8)
  mkdir -p "$out" || exit 1
  if [ ! -f "$out/copies.log" ]; then
    "$bin/tetproof" "$verb" "$@" -o "$out/models" >"$out/copies.part" || { cat "$out/copies.part" >&2; exit 1; }
    mv "$out/copies.part" "$out/copies.log"
  fi
  grep -v ': no valid surface$' "$out/copies.log"
}
