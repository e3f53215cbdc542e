"""Attacking the decoders: coverage-guided fuzzing with atheris, and mutation that keeps checksums right.

Compiled kernels are instrumented, too: libFuzzer follows their coverage, and AddressSanitizer and traps turn a read or
write outside an array, and undefined behaviour, into a finding.
"""
