#!/usr/bin/env bash
# Build the kernels with AddressSanitizer and UndefinedBehaviorSanitizer (GCC), and run them over all vectors, mutations
# of them and bad meshes; then bsmenc over random meshes, and bsmdec over every 40th vector (STARVE=1: all of them)
# while its memory ends in each place (tools/attack/starve.c). The tests of the binding run with these sanitizers and with
# ThreadSanitizer. Any finding ends the run with a report and exit code 1. ONLY=binding skips everything but the binding.
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

# Tests that enter the binding, by the copy in which we are.
test_binding() { (cd "$root" && "$python" -m pytest -p no:cacheprovider -x "$@"); }

# ThreadSanitizer knows the interpreter lock, which is a mutex, but sees nothing that numpy and the interpreter do.
checking_copy races -DBSM_SANITIZE=thread
LD_PRELOAD=$(gcc -print-file-name=libtsan.so) test_binding tests/codec/test_threads.py -k share
cd "$root"
checking_copy sanitized -DBSM_SANITIZE=address,undefined
# libstdc++ as well: the sanitizer looks for its throw before Python has loaded it.
export LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libstdc++.so)"
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1 PYTHONMALLOC=malloc
# Not those that encode meshes only to count, and not what only numpy computes: they take ten minutes here.
test_binding tests/codec/test_threads.py tests/codec/static/test_{layers,congruence}.py tests/bitstream/{connectivity,fields} \
    tests/codec/static/test_work.py -k "not decoders_refuse and not would_be_refused and not limits_of_a_service and not is_not_work and not svd"
[ "${ONLY:-}" != binding ] || exit 0
"$python" -m tools.attack sweep "$@"
cd "$root"
unset PYTHONPATH PYTHONMALLOC
flags=$("$python" -c "from tools.attack.meshes import SANITIZED; print(*SANITIZED)")
# Without the sanitizer in the compiler itself, and once for all that follows.
made=$(env -u LD_PRELOAD "$python" -c "from tools.bsmenc import compiled_whole; print(compiled_whole(*'$flags'.split()))")
LD_PRELOAD="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libubsan.so)" \
    "$python" -m tools.attack meshes --seconds 15
unset LD_PRELOAD ASAN_OPTIONS
cc $flags -I"$made" -I. tools/attack/starve.c "$made/bsmdec.so" -pthread -Wl,-rpath,"$made" -o "$made/starve"
shopt -s extglob
# The large ones have hundreds of allocations, and decoding takes a second of each.
"$made/starve" "${STARVE:-40}" spec/vectors/*/!(good-large-*).bsm
