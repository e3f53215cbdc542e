#!/usr/bin/env bash
# Build the kernels into this checkout, and write their stubs; needs nanobind in the Python that is given (or found).
#     tools/build_kernels.sh [PYTHON] [CMAKE OPTIONS ...]
set -euo pipefail
cd "$(dirname "$0")/.."
python=${1:-python3}
[ $# -gt 0 ] && shift
python=$(command -v "$python")
# Absolute, but through no link: it is the link that makes a virtual environment.
python=$(cd "$(dirname "$python")" && pwd)/$(basename "$python")
cmake -S . -B build/kernels -DPython_EXECUTABLE="$python" "$@" > /dev/null
cmake --build build/kernels -j 2
cmake --install build/kernels --prefix src > /dev/null
PYTHONPATH=src tools/write_stubs.sh "$python"
