#!/usr/bin/env bash
# Install this checkout into .venv with all that its tests need; after a change of C, build what changed, and link.
#     tools/develop.sh
# The tools that build stand in .venv, too: in pip's own environment they have a new path each time, so that CMake
# compiles everything again.
set -euo pipefail
cd "$(dirname "$0")/.."
installed=.venv/installed  # when all that pyproject.toml asks for was installed
if [ pyproject.toml -nt "$installed" ]; then
    .venv/bin/pip install -q cmake ninja nanobind scikit-build-core
    .venv/bin/pip install -q --no-build-isolation -e '.[eval,formats,paper,test]'
    touch "$installed"
else
    .venv/bin/pip install -q --no-deps --no-build-isolation -e .
fi
