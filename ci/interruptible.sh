# Long work in a script that can be stopped; to be sourced. The script ends with 5 at a signal.

trap 'exit 5' INT TERM HUP

# COMMAND...: a signal for the script alone would leave its child at work. The first wait ends with the signal, the second one with the child.
interruptible() {
  local child code=0
  "$@" &
  child=$!
  trap 'kill -TERM $child 2>/dev/null || true' INT TERM HUP
  wait $child || code=$?
  while kill -0 $child 2>/dev/null; do code=0; wait $child || code=$?; done
  trap 'exit 5' INT TERM HUP
  [ $code -lt 128 ] || exit 5
  return $code
}
