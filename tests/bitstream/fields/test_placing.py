"""Mending faces on a grid: the work grows with the faces, also where all of them share a vertex."""

import subprocess
from pathlib import Path

from tests.library.conftest import ROOT

# next_corner is called for every face that is looked at, so calls of it are the work.
PROGRAM = """#include "bitstream/fields/fields.h"
static int64_t looks;
#define next_corner(k) (looks++, (next_corner)(k))
#include "bitstream/fields/placing.c"
#include <stdio.h>
#include <stdlib.h>

/* A fan of faces around vertex 0, all of which have lost their area and cannot get it back: there is one cell. */
static int64_t looks_at_fan(int32_t faces) {
    int32_t vertices = faces + 2, most[3] = {0}, at = 0;
    int32_t *vertex = calloc(3 * faces, 4), *opposite = calloc(3 * faces, 4), *corner = calloc(3 * faces, 4);
    int32_t *starts = calloc(vertices + 1, 4), *places = calloc(3 * vertices, 4);
    double *wanted = calloc(4 * vertices, 8);
    uint8_t *tried = calloc(vertices, 1);
    for (int32_t k = 0; k < 3 * faces; k++) vertex[k] = k % 3 == 0 ? 0 : k / 3 + k % 3, opposite[k] = -1;
    for (int32_t v = 0; v < vertices; v++) {
        wanted[4 * v] = 0.1 * (v % 3), wanted[4 * v + 1] = 0.1 * (v % 2), wanted[4 * v + 3] = 9.0;
        int32_t first = v < 2 ? 0 : v - 2, last = v == 0 || v >= faces ? faces : v;
        for (int32_t f = first; f < last; f++)
            for (int32_t k = 3 * f; k < 3 * f + 3; k++)
                if (vertex[k] == v) corner[at++] = k;
        starts[v + 1] = at;
    }
    Corners corners = {{vertex, faces, 3}, {opposite, 3 * faces}, {starts, vertices + 1}, {corner, at}};
    looks = 0;
    mend_places(&corners, (Ints2){places, vertices, 3}, wanted, most, tried);
    return looks;
}

int main(void) { printf("%ld %ld\\n", (long)looks_at_fan(500), (long)looks_at_fan(2000)); }
"""


def test_faces_that_share_a_vertex_are_looked_at_a_bounded_number_of_times(tmp_path: Path) -> None:
    (tmp_path / "fan.c").write_text(PROGRAM, encoding="ascii")
    command = [
        "cc",
        "-std=gnu11",
        "-DKERNEL_ONE_TARGET",
        "-w",
        f"-I{ROOT}",
        "fan.c",
        "-lm",
        "-o",
        "fan",
    ]
    subprocess.run(command, cwd=tmp_path, check=True)
    few, many = map(
        int, subprocess.run([tmp_path / "fan"], capture_output=True, check=True).stdout.split()
    )
    assert 500 < few < 500 * 200
    assert many < 4.1 * few  # four times the faces
