#!/usr/bin/env bash
# Write the stubs of the built kernels, of public names and typed keywords into this checkout, for mypy: tools/write_stubs.sh [PYTHON]
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p src/bsm/_core
for module in "" bitstream codec; do
    "${1:-python3}" -m nanobind.stubgen -q -m "bsm._core${module:+.$module}" -o "src/bsm/_core/${module:-__init__}.pyi"
done
"${1:-python3}" tools/keywords.py
