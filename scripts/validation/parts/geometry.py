"""(a) The shape under vacuum against the converged profile, as in Fig. 6 of the paper."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from .. import style
from ..grip import Grip
from ..meridian import boundary_faces, hausdorff, meridian, read_vtu, section
from ..reference_data import profile
from ..report_items import Figure, Section, Table, check_small

NAME = 'geometry'
TOLERANCE = 0.3  # Hausdorff distance [mm]
PAPER = {'a20': 1.59, 'a30': 3.29}  # [mm], between simulation and a real cup
PRESSURES = {'a20': -6000.0, 'a30': -11000.0}
PRESSES = (0.001, 0.002)


def grips():
    return [Grip(cup=cup, pressure=pressure, press=press, speed=None)
            for cup, pressure in PRESSURES.items() for press in PRESSES]


def jobs(_quick):
    return grips()


def profile_name(grip):
    return f'{grip.cup}_profile_press{1e3 * grip.press:g}mm_{-1e-3 * grip.pressure:g}kPa.csv'


def describe(grip):
    return (f'{grip.cup.upper()}, {1e-3 * grip.pressure:g} kPa, pressed by '
            f'{1e3 * grip.press:g} mm')


class Shape:
    """The boundary of one run against its profile. [mm]"""

    def __init__(self, file, grip):
        points, tetrahedra, _ = read_vtu(file)
        faces = boundary_faces(tetrahedra)
        curve, self.rest = (1e3 * array for array in profile(profile_name(grip)))
        begins, ends = meridian(points, faces)
        distance, where, self.to_shape = hausdorff(1e-3 * curve, begins, ends)
        self.distance, self.where, self.curve = 1e3 * distance, 1e3 * where, curve
        self.to_shape *= 1e3
        self.section = 1e3 * section(points, faces)


def both_sides(curve):
    """A closed section from its right half."""
    return np.vstack([curve, curve[::-1] * [-1.0, 1.0]])


def draw(axis, shape, grip):
    axis.fill(*both_sides(shape.curve).T, color='0.80', linewidth=0)
    axis.plot(*both_sides(shape.rest).T, color=style.GREY, linewidth=0.6, linestyle=(0, (4, 3)))
    axis.add_collection(LineCollection(shape.section, colors=style.VERMILION, linewidths=1.2,
                                       capstyle='round'))
    axis.axhline(0.0, color=style.BLACK, linewidth=0.8)
    axis.plot(*shape.where, 'o', markerfacecolor='none', markeredgecolor=style.BLUE, markersize=9)
    axis.set_title(f'{describe(grip)}\nHausdorff distance {shape.distance:.2f} mm', loc='left')
    axis.set_aspect('equal')
    axis.set_ylim(-1.0, 21.0)


def overlay(shapes):
    figure, axes = plt.subplots(len(PRESSURES), len(PRESSES), sharex=True, sharey=True,
                                figsize=(style.WIDTH, 5.2), constrained_layout=True, squeeze=False)
    for axis, grip in zip(axes.flat, grips()):
        if grip in shapes:
            draw(axis, shapes[grip], grip)
    for axis in axes[-1]:
        axis.set_xlabel('distance from the axis [mm]')
    for axis in axes[:, 0]:
        axis.set_ylabel('height above the plate [mm]')
    handles = [plt.Rectangle((0, 0), 1, 1, color='0.80', label='CalculiX, converged'),
               plt.Line2D([], [], color=style.VERMILION, label='simulation, cut by a plane'),
               plt.Line2D([], [], color=style.GREY, linewidth=0.8, linestyle=(0, (4, 3)),
                          label='at rest'),
               plt.Line2D([], [], color=style.BLUE, marker='o', markersize=8, linestyle='',
                          markerfacecolor='none', label='where the distance is')]
    style.legend_below(figure, handles, [handle.get_label() for handle in handles], columns=4)
    style.save(figure, 'geometry')


def evaluate(results, _quick):
    shapes = {grip: Shape(results.folder(grip) / 'final.vtu', grip)
              for grip in grips() if results.ok(grip)}
    section_ = Section(NAME, 'Shape under vacuum', [
        'The cup is pressed and drawn on, the mount held (the geometry experiment of the paper, '
        'Sec. IV-B). The whole boundary, turned about the axis, is compared with the meridian of '
        'the converged axisymmetric solution: the distance holds every wrinkle of the lip. '
        f'The paper reports {PAPER["a20"]} mm (A20) and {PAPER["a30"]} mm (A30) between its '
        'simulation and a real cup, of another shape: a different comparison, named for scale.'])
    rows = []
    for grip, shape in shapes.items():
        check = check_small(NAME, f'{describe(grip)}: Hausdorff distance', shape.distance,
                            TOLERANCE, 'mm')
        section_.checks.append(check)
        rows.append((grip.cup.upper(), 1e-3 * grip.pressure, 1e3 * grip.press, shape.distance,
                     shape.to_shape, *shape.where, TOLERANCE, PAPER[grip.cup],
                     'pass' if check.passed else 'FAIL'))
    section_.tables.append(Table('geometry', 'Hausdorff distances', [
        ('cup', ''), ('pressure [kPa]', 'g'), ('pressed by [mm]', 'g'),
        ('Hausdorff distance [mm]', '.3f'), ('profile to shape alone [mm]', '.3f'),
        ('found at r [mm]', '.2f'), ('z [mm]', '.2f'), ('tolerance [mm]', 'g'),
        ('in the paper [mm]', '.2f'), ('verdict', '')], rows))
    if shapes:
        overlay(shapes)
        section_.figures.append(Figure('geometry', 'Sections under vacuum: the converged '
                                       'solution (grey) and the simulation (red).'))
    return section_
