"""The extension `base` for reference_decoder.py: cells, their graph and their faces, and places spread to vertices.

The rules stand beside what follows them (extension-base.md).
"""

import numpy as np
from reference_decoder import require

LARGEST = {"reach": 8, "rounds": 64, "halvings": 40}


def check_base(header, stored):  # M 18.1
    require(len(header["base"]) == 4, "a base is not four numbers")
    cells, *others = header["base"]
    require(
        all(value <= most for value, most in zip(others, LARGEST.values())), "a base out of range"
    )
    require(cells <= header["vertices"], "more cells than vertices")
    require(header["refinement"], "a base without refinement")
    require(not {"paper", "onorm"} & stored, "a base in the paper's mode")


class Cells:
    def __init__(self, graph, faces, base):
        count, reach, self.rounds, self.halvings = base
        self.mesh, self.own = graph, cells_of(graph, reach)
        require(max(self.own) + 1 == count, "another number of cells")
        around = [set() for _ in range(count)]  # M 18.3
        for v, row in enumerate(graph):
            around[self.own[v]].update(self.own[w] for w in row)
        self.graph = [sorted(row - {cell}) for cell, row in enumerate(around)]
        corners = [tuple(self.own[v] for v in face) for face in faces]  # M 18.4
        first = {frozenset(cells): cells for cells in reversed(corners) if len({*cells}) == 3}
        self.faces = list(dict.fromkeys(first[frozenset(c)] for c in corners if len({*c}) == 3))

    def prolonged(self, places):  # M 18.7
        with np.errstate(over="ignore"):
            current = places.astype(np.float32)[self.own]
        half = np.float32(0.5)
        for _ in range(self.rounds):
            following = half * current
            for v, row in enumerate(self.mesh):
                total = np.zeros(3, np.float32)
                for w in row:
                    total = total + current[w]
                if row:
                    following[v] = following[v] + half / np.float32(len(row)) * total
            current = following
        return current.astype(float)


def cells_of(graph, reach):  # M 18.2: the cell of each vertex
    centers, distance = [], [reach + 1] * len(graph)
    for v in range(len(graph)):
        if distance[v] <= reach:
            continue
        centers.append(v)
        distance[v], found = 0, [v]
        for u in found:  # `found` grows meanwhile
            for w in graph[u]:
                if distance[w] > distance[u] + 1:
                    distance[w] = distance[u] + 1
                    found.append(w)
    own, found = {center: cell for cell, center in enumerate(centers)}, centers
    for u in found:
        for w in graph[u]:
            if w not in own:
                own[w] = own[u]
                found.append(w)
    return [own[v] for v in range(len(graph))]
