"""Attacking the decoders: coverage-guided fuzzing with atheris, and mutation that keeps checksums right.

Compiled kernels are not instrumented, so coverage is that of the Python code around them; they run with the bounds of
every array index checked (NUMBA_BOUNDSCHECK), which turns a read or write outside an array into a finding.
"""
