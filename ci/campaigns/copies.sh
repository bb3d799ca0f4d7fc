# What ci/campaigns/varied and ci/campaigns/rotated have in common; to be sourced.

. "$(dirname "${BASH_SOURCE[0]}")/campaign.sh"

# PREFIX PATH...: checks the arguments and the settings (use_settings); sets `base` to PREFIX_OUT.
prepare() {
  local prefix=$1 name=${1,,} root variable
  shift
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
  for argument in "$@"; do
    case $argument in -*) echo "usage: ci/$name [PATH...]; its first lines tell more" >&2; exit 2 ;; esac
    [ -e "$argument" ] || { echo "ci/$name: $argument: no such file" >&2; exit 2; }
  done
  use_settings "$prefix"
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
    interruptible "$bin/tetproof" "$verb" "$@" -o "$out/models" >"$out/copies.part" || { cat "$out/copies.part" >&2; exit 1; }
    mv "$out/copies.part" "$out/copies.log"
  fi
  grep -v ': no valid surface$' "$out/copies.log"
}
