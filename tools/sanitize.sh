#!/usr/bin/env bash
# Build the kernels with AddressSanitizer and UndefinedBehaviorSanitizer (GCC), and run them over all vectors, mutations
# of them and bad meshes; then bsmdec, over mutations, and over every 40th vector (STARVE=1: all of them) while its memory
# ends in each place (tools/attack/starve.c). Whatever they find ends the run with a report and exit code 1.
#     [STARVE=N] tools/sanitize.sh [PYTHON] [OPTIONS of python -m tools.attack sweep ...]
set -euo pipefail
cd "$(dirname "$0")/.."
python=${1:-python3}
[ $# -gt 0 ] && shift
python=$(command -v "$python")
# Absolute, but through no link: it is the link that makes a virtual environment.
python=$(cd "$(dirname "$python")" && pwd)/$(basename "$python")
. tools/checking_copy.sh
root=$PWD
checking_copy sanitized -DBSM_SANITIZE=ON
# libstdc++ as well: the sanitizer looks for its throw before Python has loaded it.
export LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libstdc++.so)"
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 PYTHONMALLOC=malloc
"$python" -m tools.attack.sweep "$@"
cd "$root"
unset PYTHONPATH PYTHONMALLOC
flags="-O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all -DKERNEL_ONE_TARGET"
LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libubsan.so)" \
    "$python" -m tests.engine.mutants 5000 ci --exact --tolerant --seconds 15 --flags="$flags"
unset LD_PRELOAD ASAN_OPTIONS
made=$("$python" -c "from tests.engine.decoding import compiled; print(compiled(*'$flags'.split()))")
cc $flags -I"$made" -I. tools/attack/starve.c "$made/bsmdec.so" -pthread -Wl,-rpath,"$made" -o "$made/starve"
"$made/starve" "${STARVE:-40}" spec/vectors/*/*.bsm
