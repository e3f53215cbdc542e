#!/usr/bin/env bash
# Fuzz bsmdec, guided by coverage, with AddressSanitizer and UndefinedBehaviorSanitizer; clang must be there (apt install
# clang libclang-rt-dev). Inputs are kept in .cache/fuzz, and findings beside it; any ends the run with exit code 1.
#     tools/fuzz.sh PYTHON [OPTIONS of libFuzzer, such as -max_total_time=3600]
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p .cache/fuzz
"$1" -m tools.amalgamate build/fuzzed
# That nothing has no bytes is no fault: NULL + 0 is NULL.
clang -std=gnu11 -ffp-contract=off -DKERNEL_ONE_TARGET -O1 -g1 -w -fsanitize=fuzzer,address,undefined \
    -fno-sanitize=pointer-overflow -fsanitize-trap=undefined -Ibuild/fuzzed -I. tools/attack/fuzz.c -o build/fuzzed/fuzz -lm
cp spec/vectors/*/*.bsm .cache/fuzz
exec build/fuzzed/fuzz .cache/fuzz -max_len=6000 -timeout=100 -artifact_prefix=.cache/fuzz- "${@:2}"
