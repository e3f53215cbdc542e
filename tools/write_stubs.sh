#!/usr/bin/env bash
# Write the stubs of the built kernels into this checkout, which mypy reads: tools/write_stubs.sh [PYTHON]
set -euo pipefail
cd "$(dirname "$0")/.."
for module in bsm._engine bsm._kernels bsm.bitstream._kernels bsm.codec._kernels; do
    "${1:-python3}" -m nanobind.stubgen -q -m "$module" -o "src/${module//./\/}.pyi"
done
