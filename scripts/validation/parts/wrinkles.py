"""How the lip looks shortly before the cup lets go: is it still axisymmetric?"""

import dataclasses
import math

import matplotlib.pyplot as plt
import numpy as np

from .. import style
from ..grip import Grip
from ..meridian import boundary_faces, face_grid, read_vtu, sub_triangles
from ..report_items import Figure, Section, Table

NAME = 'wrinkles'
PRESSURES = (-4e3, -6e3, -8e3, -10e3)
BEFORE = 0.0002   # the picture is taken this lift before the loss [m]
DIVISIONS = 4     # of a face's edge
TOP = 1.0         # of the colours: height above the plate [mm]
LIP_RADIUS = 0.01875  # of the circle on which the cup stands at rest [m]


def jobs(_quick):
    return [Grip(pressure=pressure) for pressure in PRESSURES]


def before_loss(grip, series):
    """The same pull, ended shortly before the loss that it found."""
    lift = math.floor(1e5 * (series.lift_at_loss - BEFORE)) / 1e5
    return dataclasses.replace(grip, lift=lift)


def followups(results, quick):
    """Runs that can be told only from the results of jobs()."""
    return [before_loss(grip, results.series(grip)) for grip in jobs(quick)
            if results.series(grip) is not None
            and math.isfinite(results.series(grip).lift_at_loss)]


def lip_ring(points, displacement):
    """Radius and height [mm] over the angle [rad] of the nodes on which the cup stands at rest."""
    rest = points - displacement
    radius = np.hypot(rest[:, 0], rest[:, 1])
    ring = (rest[:, 2] < rest[:, 2].min() + 1e-6) & (np.abs(radius - LIP_RADIUS) < 1e-5)
    angle = np.arctan2(rest[ring, 1], rest[ring, 0])
    order = np.argsort(angle)
    moved = 1e3 * points[ring][order]
    return angle[order], np.hypot(moved[:, 0], moved[:, 1]), moved[:, 2]


def waves(values):
    """Amplitude of each number of waves around the axis, of evenly spaced values."""
    return 2.0 * np.abs(np.fft.rfft(values)) / len(values)


def draw_from_below(axis, points, tetrahedra):
    faces = boundary_faces(tetrahedra)
    corners = 1e3 * sub_triangles(face_grid(points, faces, DIVISIONS), DIVISIONS)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners = corners[normals[:, 2] < 0.0]
    # The highest first: what is nearer to the plate covers it.
    corners = corners[np.argsort(-corners[:, :, 2].mean(axis=1))].reshape(-1, 3)
    picture = axis.tripcolor(corners[:, 0], corners[:, 1],
                             np.arange(len(corners)).reshape(-1, 3),
                             np.clip(corners[:, 2], 0.0, TOP), shading='gouraud', cmap='cividis',
                             vmin=0.0, vmax=TOP, rasterized=True)
    axis.set_aspect('equal')
    axis.set_xlim(-21.0, 21.0)
    axis.set_ylim(-21.0, 21.0)
    axis.grid(False)
    return picture


def evaluate(results, quick):
    section = Section(NAME, 'The lip before the loss', [
        f'A20, pulled at 5 mm/s, {1e3 * BEFORE:g} mm before the cup lets go, seen from below. The '
        'references are axisymmetric: where the lip is not, they say nothing. The waves are those '
        'of the circle on which the cup stands at rest; 8 and its multiples are in the mesh, whose '
        'stem and sectors repeat 8 times.'])
    rows = []
    figure, axes = plt.subplots(1, len(PRESSURES), sharex=True, sharey=True,
                                figsize=(style.WIDTH, 2.7), constrained_layout=True)
    picture = None
    for axis, grip in zip(axes, jobs(quick)):
        series = results.series(grip)
        if series is None or not math.isfinite(series.lift_at_loss):
            continue
        run = before_loss(grip, series)
        if not results.ok(run):
            continue
        points, tetrahedra, displacement = read_vtu(results.folder(run) / 'final.vtu')
        picture = draw_from_below(axis, points, tetrahedra)
        axis.set_title(f'{1e-3 * grip.pressure:g} kPa, {1e3 * run.lift:.2f} mm', loc='left')
        axis.set_xlabel('x [mm]')
        _, radius, height = lip_ring(points, displacement)
        number = 1 + int(np.argmax(waves(radius)[1:]))
        rows.append((1e-3 * grip.pressure, 1e3 * run.lift, radius.mean(),
                     0.5 * (radius.max() - radius.min()), number, waves(radius)[number],
                     0.5 * (height.max() - height.min())))
    axes[0].set_ylabel('y [mm]')
    if picture is not None:
        figure.colorbar(picture, ax=axes, label='height above\nthe plate [mm]', shrink=0.8)
    style.save(figure, 'wrinkles')
    section.figures.append(Figure('wrinkles', 'Height of the underside above the plate, shortly '
                                  'before the loss.'))
    section.tables.append(Table('wrinkles', 'Waves of the lip', [
        ('pressure [kPa]', 'g'), ('lift [mm]', '.2f'), ('mean radius [mm]', '.2f'),
        ('amplitude of the radius [mm]', '.3f'), ('strongest number of waves', 'd'),
        ('its amplitude [mm]', '.3f'), ('amplitude of the height [mm]', '.3f')], rows))
    return section
