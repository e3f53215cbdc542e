# checking_copy NAME CMAKE_OPTIONS...: build the kernels with these options, for the Python in $python, into a copy of the
# sources under build/, and go there; a link in place of the folder of the build says where that was done before. The
# kernels of the checkout stay as they are. Python finds the copy from then on,
# also where the checkout is installed to be edited.
checking_copy() {
    local name=$1 copy="build/$1" level=
    shift
    # A product and a sum in one rounding take a hundred times as long where the processor's own are not used.
    grep -qsw fma /proc/cpuinfo && grep -qsw avx2 /proc/cpuinfo && level=3
    if [ ! -L "build/$name-kernels" ]; then
        cmake -S . -B "build/$name-kernels" -DPython_EXECUTABLE="$python" -DBSM_LEVEL="$level" "$@" > /dev/null
        cmake --build "build/$name-kernels" -j 2 > /dev/null
    fi
    mkdir -p "$copy"
    rm -rf "$copy"/{bitstream,codec,src,tests,tools,spec}
    cp -r bitstream codec src tests tools spec "$copy"
    cat > "$copy/sitecustomize.py" << 'END'
import sys

sys.meta_path[:] = [finder for finder in sys.meta_path if not type(finder).__module__.startswith("_editable_")]
END
    find "$copy" -name '_core.*.so' -delete
    cmake --install "build/$name-kernels" --prefix "$copy/src" > /dev/null
    cd "$copy"
    export PYTHONPATH="$PWD:$PWD/src"
}
