#!/bin/bash -eu
# What OSS-Fuzz and ClusterFuzzLite call: compilers and flags come from the environment ($CC $CXX $CFLAGS $CXXFLAGS
# $LIB_FUZZING_ENGINE), programs, seeds and dictionaries go to $OUT.
root=${SRC:+$SRC/tetproof}
root=${root:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
work=${WORK:-$(mktemp -d)}/build
cmake -S "$root" -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTETPROOF_FUZZ=ON -DTETPROOF_TESTS=OFF \
  -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_CXX_FLAGS="${CXXFLAGS:-}" \
  -DTETPROOF_FUZZING_ENGINE="$LIB_FUZZING_ENGINE"
cmake --build "$work" --target fuzz_targets
while read -r target seeds; do
  [ -n "$target" ] || continue
  cp "$work/fuzz/${target}_fuzzer" "$OUT/"
  folders=()
  for folder in ${seeds//;/ }; do folders+=("$root/fuzz/seeds/$folder"); done
  [ -d "$root/fuzz/regressions/$target" ] && folders+=("$root/fuzz/regressions/$target")
  zip -q -j "$OUT/${target}_fuzzer_seed_corpus.zip" $(find "${folders[@]}" -type f)
  case $target in
    reader_* | plane_reader) cp "$root/fuzz/dictionaries/surface.dict" "$OUT/${target}_fuzzer.dict" ;;
    command_line) cp "$root/fuzz/dictionaries/command_line.dict" "$OUT/${target}_fuzzer.dict" ;;
  esac
done <"$work/fuzz/targets.txt"
