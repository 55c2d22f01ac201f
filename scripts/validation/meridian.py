"""The boundary of a deformed cup, turned about its axis or cut by a plane through it."""

import xml.etree.ElementTree as ElementTree

import numpy as np

# Corners and mid-edge nodes of a tetrahedron's faces, outwards; VTK's order.
FACES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
DIVISIONS = 4  # of a face's edge, as in test/validation/meridian.h


def read_vtu(file):
    """(points #by 3 [m], tetrahedra # by 4 or 10, displacement # by 3 [m]) of final.vtu."""
    arrays = {array.get('Name'): np.array((array.text or '').split(), dtype=float)
              for array in ElementTree.parse(file).iter('DataArray')}
    nodes = int(arrays['offsets'][0])
    return (arrays['Points'].reshape(-1, 3),
            arrays['connectivity'].astype(int).reshape(-1, nodes),
            arrays['displacement'].reshape(-1, 3))


def boundary_faces(tetrahedra):
    """Faces of one tetrahedron only, # by 3 or 6 nodes."""
    width = 6 if tetrahedra.shape[1] == 10 else 3
    faces = tetrahedra[:, FACES[:, :width]].reshape(-1, width)
    _, first, count = np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_index=True,
                                return_counts=True)
    return faces[first[count == 1]]


def shape_functions(a, b, order):
    """Of a triangle at the barycentric coordinates a, b of its first two corners."""
    c = 1.0 - a - b
    if order == 1:
        return np.array([a, b, c])
    return np.array([a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1),
                     4 * a * b, 4 * b * c, 4 * c * a])


def face_grid(points, faces, divisions):
    """Points on each face, {(i, j): # by 3}, at the barycentric coordinates i, j / divisions."""
    order = 2 if faces.shape[1] == 6 else 1
    return {(i, j): np.einsum('k,fkd->fd',
                              shape_functions(i / divisions, j / divisions, order), points[faces])
            for i in range(divisions + 1) for j in range(divisions + 1 - i)}


def sub_triangles(grid, divisions):
    """The small triangles of a face_grid(), as seen from the side of their faces; # by 3 by 3."""
    triangles = []
    for i in range(divisions):
        for j in range(divisions - i):
            triangles.append((grid[i, j], grid[i + 1, j], grid[i, j + 1]))
            if i + j + 2 <= divisions:
                triangles.append((grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]))
    return np.stack([np.vstack(corners) for corners in zip(*triangles)], axis=1)


def meridian(points, faces, divisions=DIVISIONS):
    """The whole boundary as a grid of lines, turned about the axis x = y = 0 into one half plane.

    Returns (begins, ends), # by (distance from the axis, height). [m]
    """
    grid = {key: np.column_stack([np.hypot(p[:, 0], p[:, 1]), p[:, 2]])
            for key, p in face_grid(points, faces, divisions).items()}
    begins, ends = [], []
    for i in range(divisions):
        for j in range(divisions - i):
            for a, b in (((i, j), (i + 1, j)), ((i, j), (i, j + 1)), ((i + 1, j), (i, j + 1))):
                begins.append(grid[a])
                ends.append(grid[b])
    return np.vstack(begins), np.vstack(ends)


def section(points, faces, divisions=8):
    """Where the plane y = 0 cuts the boundary: segments, # by 2 by (x, z). [m]"""
    corners = sub_triangles(face_grid(points, faces, divisions), divisions)
    # A node on the plane counts as on one side of it: a triangle is cut in two edges or in none.
    side = corners[:, :, 1] >= 0.0
    cut = corners[side.any(axis=1) & ~side.all(axis=1)]
    side = cut[:, :, 1] >= 0.0
    segments = np.empty((len(cut), 2, 2))
    filled = np.zeros(len(cut), dtype=int)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        rows = np.flatnonzero(side[:, a] != side[:, b])
        p, q = cut[rows, a], cut[rows, b]
        t = (p[:, 1] / (p[:, 1] - q[:, 1]))[:, None]
        segments[rows, filled[rows]] = ((1.0 - t) * p + t * q)[:, [0, 2]]
        filled[rows] += 1
    return segments


def distances(points, begins, ends, chunk=200):
    """Distance of each point to the nearest of the segments. [m]"""
    edges = ends - begins
    squares = np.maximum(np.einsum('sd,sd->s', edges, edges), 1e-30)
    result = []
    for some in np.array_split(points, max(1, len(points) // chunk)):
        offsets = some[:, None] - begins
        t = np.clip(np.einsum('psd,sd->ps', offsets, edges) / squares, 0.0, 1.0)
        gaps = offsets - t[:, :, None] * edges
        result.append(np.sqrt(np.einsum('psd,psd->ps', gaps, gaps).min(axis=1)))
    return np.concatenate(result)


def hausdorff(curve, begins, ends):
    """Between a polygonal curve and a meridian's segments.

    Returns (distance [m], the point from where it is, the farthest point of the curve alone [m]).
    """
    to_shape = distances(curve, begins, ends)
    points = np.unique(begins, axis=0)
    to_curve = distances(points, curve[:-1], curve[1:], chunk=2000)
    if to_shape.max() >= to_curve.max():
        return to_shape.max(), curve[to_shape.argmax()], to_shape.max()
    return to_curve.max(), points[to_curve.argmax()], to_shape.max()
