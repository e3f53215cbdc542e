#!/usr/bin/env bash
# The same bits on arm64: compile the kernels for it, run all vectors there, and compare what is decoded and encoded with
# what this processor makes of it. Without such a machine, QEMU runs one; everything is fetched into the folder that is given.
#     tools/arm64.sh [FOLDER [PYTEST OPTIONS ...]]
# Needs an x86-64 Debian with: apt install qemu-user-static gcc-aarch64-linux-gnu g++-aarch64-linux-gnu cmake; and the
# development environment of CONTRIBUTING.md in .venv (or the Python that PYTHON names), with the kernels built.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-$PWD/.venv/bin/python}
mkdir -p "${1:-.cache/arm64}"
folder=$(cd "${1:-.cache/arm64}" && pwd)
[ $# -gt 0 ] && shift
root=$folder/root
version=$(. /etc/os-release && echo "$VERSION_CODENAME")

if [ ! -x "$root/usr/bin/python3" ]; then # A Python for arm64, from Debian; apt keeps its lists in the folder, too.
    mkdir -p "$folder"/apt/{lists/partial,cache/archives/partial} "$folder/packages"
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $version main" > "$folder/apt/sources"
    : > "$folder/apt/status"
    options=(-qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o "Dir::State=$folder/apt" -o "Dir::State::status=$folder/apt/status"
        -o "Dir::Cache=$folder/apt/cache" -o "Dir::Etc::sourcelist=$folder/apt/sources" -o Dir::Etc::sourceparts=- -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update
    apt-cache "${options[@]}" depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks --no-replaces --no-enhances \
        python3 libpython3-dev libstdc++6 | grep '^[a-z]' | grep -v '<' | sort -u > "$folder/names"
    (cd "$folder/packages" && xargs apt-get "${options[@]}" download < "$folder/names")
    for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$root"; done
fi
emulated() { qemu-aarch64-static -L "$root" -E "PYTHONPATH=$folder/source:$folder/source/src:$folder/site" -E OPENBLAS_NUM_THREADS=1 "$root/usr/bin/python3" "$@"; }
number=$(emulated -c 'import sys; print("%d.%d" % sys.version_info[:2])')

if [ ! -d "$folder/site" ]; then
    "$python" -m pip download -q --no-deps --only-binary=:all: --python-version "$number" -d "$folder/wheels" \
        --platform manylinux2014_aarch64 --platform manylinux_2_27_aarch64 --platform manylinux_2_28_aarch64 \
        numpy msgpack tqdm zstandard pytest pluggy iniconfig packaging pygments hypothesis sortedcontainers
    for wheel in "$folder"/wheels/*.whl; do "$python" -m zipfile -e "$wheel" "$folder/site"; done
fi

rm -rf "$folder/source" "$folder/build"
mkdir "$folder/source"
git ls-files -z | tar --null -T - -c | tar -x -C "$folder/source"
cat > "$folder/arm64.cmake" << END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CXX_FLAGS_INIT "-I$root/usr/include")
END
cmake -S . -B "$folder/build" -DCMAKE_TOOLCHAIN_FILE="$folder/arm64.cmake" -DPython_EXECUTABLE="$python" \
    -DPython_INCLUDE_DIR="$root/usr/include/python$number" > "$folder/build.log" 2>&1
cmake --build "$folder/build" -j "$(nproc)" >> "$folder/build.log" 2>&1
cp "$folder"/build/bsm/_kernels.*.so "$folder/source/src/bsm/_kernels.so"
for package in bitstream codec; do cp "$folder/build/$package"/_kernels.*.so "$folder/source/$package/_kernels.so"; done

PYTHONPATH=.:src "$python" -c 'import sys, numpy; from bsm.evaluation.sample import knot; mesh = knot(20_000)
numpy.savez(sys.argv[1], positions=mesh.positions, faces=mesh.faces)' "$folder/sample.npz"
round='import hashlib, platform, sys, numpy, bsm
sample = numpy.load(sys.argv[1])
mesh = bsm.TriangleMesh(sample["positions"], sample["faces"])
parts = [bsm.encode(mesh, **options) for options in ({}, {"grid": 12}, {"preset": "fine"})]
parts += [numpy.ascontiguousarray(bsm.decode(part).positions).tobytes() for part in list(parts)]
print(platform.machine(), [len(part) for part in parts], file=sys.stderr)
print(hashlib.sha256(b"".join(parts)).hexdigest())'
here=$(PYTHONPATH=.:src "$python" -c "$round" "$folder/sample.npz")
there=$(emulated -P -c "$round" "$folder/sample.npz")
[ "$here" = "$there" ] || { echo "the sample comes out differently on arm64" >&2; exit 1; }
echo "three streams of the sample, and what they decode to: the same bits, sha256 $here"
# But those that start processes: the emulator runs this one alone.
cd "$folder/source" && emulated -m pytest -q -p no:cacheprovider tests/spec/test_vectors.py -k "not command_lines and not wrong_decoder" "$@"
