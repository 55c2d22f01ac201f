"""A real gripper's record beside the simulated one, and where on a ball a cup still seals."""

import csv
import dataclasses
import math
from typing import Tuple

import matplotlib.pyplot as plt
import numpy as np

from .. import style
from ..paths import EXPERIMENT, REFERENCE_DATA, REPOSITORY
from ..report_items import Check, Figure, Section, Table

NAME = 'measured'
RECORD = REFERENCE_DATA / 'measured'
EXPERIMENTS = REPOSITORY / 'config' / 'experiments'
SCENARIO = EXPERIMENTS / 'measured_grip.yaml'
AMBIENT = 1017.0       # of the record [hPa]
RECORD_SEAL = 2.9147   # first reading after the fall [s]
RECORD_AIR = 2.8       # until here the cup is in the air [s]
SHOWN = (-0.4, 2.6)    # after the seal [s]
NEAR = 15.0            # of the deepest reading [hPa]
OPEN = 940.0           # the line reads more with the cup in the air [hPa]

DIAMETERS = (0.040, 0.075, 0.120)  # [m]
TILTS = (0, 10, 20)                # [degrees]
OFFSETS = tuple(0.002 * i for i in range(13))  # [m]
LIP, LENGTH = 0.0094, 0.016        # of the cup: radius, mount to lip [m]
APPROACH, PRESS, HOLD = 0.05, 0.004, 0.3  # [m/s], below the first touch [m], [s]


@dataclasses.dataclass(frozen=True)
class Run:
    """The scenario, with some keys set."""
    id: str
    settings: Tuple = ()
    cost: float = 25.0
    alone: bool = False

    def command(self, folder):
        words = [EXPERIMENT.relative_to(REPOSITORY), SCENARIO.relative_to(REPOSITORY)]
        for key, value in self.settings:
            words += ['--set', f'{key}={value}']
        return [*words, '--out', folder.relative_to(REPOSITORY), '--quiet']

    def inputs(self):
        return [EXPERIMENT, SCENARIO, REPOSITORY / 'config' / 'cups' / 'bellows_20.yaml',
                REPOSITORY / 'meshes' / 'bellows_20_quadratic_1300.msh']

    def allowed(self):
        """3: steps were undone, at the rim of what can be gripped; the map says where."""
        return (0, 3) if self.id.startswith('sphere') else (0,)


GRIP = Run('measured_grip')
# The ball is put where the cup does not meet it.
NEVER = Run('measured_never_sealed', (('surfaces.0.position', '[0.06, 0.0, -0.0375]'),))


def first_touch(radius, offset, tilt):
    """Height of the lip's middle above the ball's top where the lip touches; NaN: it never does."""
    around = np.linspace(0.0, 2.0 * math.pi, 721)
    x = offset + LIP * np.cos(around) * math.cos(tilt)
    down = -LIP * np.cos(around) * math.sin(tilt)  # of the lip's points below its middle
    square = radius**2 - x**2 - (LIP * np.sin(around))**2
    if square.max() <= 0.0:
        return math.nan
    return np.nanmax(np.where(square > 0.0, np.sqrt(np.maximum(square, 0.0)) - radius + down,
                              np.nan))


def offset_run(diameter, degrees, offset):
    """The cup comes down beside the ball's top, its axis leaning away from the ball's middle."""
    radius, tilt = 0.5 * diameter, math.radians(degrees)
    touch = first_touch(radius, offset, tilt)
    x = offset - LENGTH * math.sin(tilt)
    rows = []
    for time, lip in ((0.0, touch + 0.005), (0.1, touch), (0.1 + PRESS / APPROACH, touch - PRESS),
                      (0.1 + PRESS / APPROACH + HOLD, touch - PRESS)):
        rows.append(f'{{time: {time:.4f}, position: [{x:.6f}, 0.0, '
                    f'{lip + LENGTH * math.cos(tilt):.6f}], rotation: [{math.pi:.15f}, '
                    f'{-tilt:.15f}, 0.0], pressure_setpoint: -85000.0}}')
    return Run(f'sphere{1e3 * diameter:g}mm_tilt{degrees}_offset{1e3 * offset:g}mm', (
        ('time_step', '0.01'), ('surfaces.0.radius', f'{radius:.4f}'),
        ('surfaces.0.position', f'[0.0, 0.0, {-radius:.4f}]'), ('timeline', f'[{", ".join(rows)}]')),
        3.0)


def map_runs():
    """By ball, tilt and offset; the lip's middle stays above the ball."""
    return {(d, t, o): offset_run(d, t, o) for d in DIAMETERS for t in TILTS for o in OFFSETS
            if o < 0.5 * d and math.isfinite(first_touch(0.5 * d, o, math.radians(t)))}


def jobs(quick):
    return [GRIP, NEVER] + ([] if quick else list(map_runs().values()))


def read_columns(path):
    with open(path, newline='', encoding='utf-8') as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def sequence(time, pressure, force_time, force):
    """The grip as the sensor shows it: a dictionary of its figures; see measured_record_test.cpp."""
    inside = pressure[:-1] < 1000.0
    seal = 1 + int(np.argmax(np.where(inside, pressure[:-1] - pressure[1:], -np.inf)))
    loss = seal + int(np.argmax(pressure[seal:] > OPEN))
    held = pressure[seal:loss]
    near = seal + np.flatnonzero(held <= held.min() + NEAR)
    force_at = force[np.maximum(np.searchsorted(force_time, time + 1e-6) - 1, 0)]
    return {'before the seal [hPa]': pressure[seal - 1], 'sealed [hPa]': pressure[seal],
            'deepest [hPa]': held.min(), 'falls for [s]': time[near[0]] - time[seal],
            'before the loss [hPa]': pressure[loss - 1],
            'rise [hPa]': pressure[loss - 1] - held.min(),
            'rises for [s]': time[loss - 1] - time[near[-1]], 'lost [hPa]': pressure[loss],
            'force held [N]': force_at[near[0]:near[-1] + 1].mean(),
            'force before the loss [N]': force_at[loss - 1], 'seal': time[seal]}


def record():
    """(time of pressure, pressure, time of force, force)"""
    sensor, wrench = (read_columns(RECORD / f'grip_0_{name}.csv') for name in ('pressure', 'wrench'))
    return (sensor['t'], sensor['p_hPa'], wrench['t'],
            wrench['fz'] - wrench['fz'][wrench['t'] < RECORD_AIR].mean())


def simulated(folder):
    sensor, series = (read_columns(folder / f'{name}.csv') for name in ('sensor', 'timeseries'))
    return (sensor['time'], 0.01 * sensor['absolute_pressure'], series['time'],
            -series['force_z'])


def draw_overlay(real, model):
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(style.WIDTH, 5.6), sharex=True,
                                          constrained_layout=True)
    for (time, pressure, force_time, force), color, name in (
            (real, style.BLACK, 'measured'), (model, style.VERMILION, 'simulated')):
        zero = sequence(time, pressure, force_time, force)['seal']
        upper.plot(time - zero, pressure, color=color, marker='.', markersize=3.0, linewidth=0.9,
                   label=name)
        lower.plot(force_time - zero, force, color=color, linewidth=0.9)
    upper.axhspan(600.0, 700.0, color='0.94', zorder=0)
    upper.set_ylabel('absolute pressure in the line [hPa]')
    lower.set_ylabel('pull on the wrist [N]')
    lower.set_xlabel('time after the seal [s]')
    lower.set_xlim(*SHOWN)
    upper.legend(loc='center right')
    style.save(figure, 'measured')


def draw_map(vacuums):
    figure, axes = plt.subplots(1, len(DIAMETERS), figsize=(style.WIDTH, 3.2), sharey=True,
                                constrained_layout=True)
    for axis, diameter in zip(axes, DIAMETERS):
        for tilt, color in zip(TILTS, (style.BLUE, style.ORANGE, style.VERMILION)):
            points = sorted((o, p) for (d, t, o), p in vacuums.items() if (d, t) == (diameter, tilt))
            axis.plot([1e3 * o for o, _ in points], [p for _, p in points], color=color, marker='o',
                      label=f'tilted by {tilt} degrees')
        axis.set_title(f'ball of {1e3 * diameter:g} mm')
        axis.set_xlabel('offset [mm]')
        axis.set_xlim(-0.5, 1e3 * OFFSETS[-1] + 0.5)
    axes[0].set_ylabel('pressure reached [hPa]')
    style.legend_below(figure, *axes[0].get_legend_handles_labels(), columns=3)
    style.save(figure, 'offset_map')


def reached(folder):
    """What the line reads at last. [hPa]"""
    return AMBIENT + 0.01 * read_columns(folder / 'timeseries.csv')['manifold_pressure'][-1]


def collapse(vacuums, diameter, tilt):
    """First offset at which half of the vacuum reached in the middle is missing; None: no such."""
    rows = sorted((o, p) for (d, t, o), p in vacuums.items() if (d, t) == (diameter, tilt))
    best = AMBIENT - min(p for _, p in rows)
    return next((o for o, p in rows if AMBIENT - p < 0.5 * best and
                 all(AMBIENT - q < 0.5 * best for r, q in rows if r >= o)), None)


def check(name, value, reference, passed, unit=''):
    return Check(NAME, name, value, reference, 0.0, 0.0, bool(passed), unit, unit)


def checks_of(figures, who):
    """What the record shows."""
    f = figures
    return [
        check(f'{who}: pressure before the seal', f['before the seal [hPa]'], '> 940',
              f['before the seal [hPa]'] > OPEN, 'hPa'),
        check(f'{who}: one reading later', f['sealed [hPa]'], '600 to 700',
              600.0 < f['sealed [hPa]'] < 700.0, 'hPa'),
        check(f'{who}: rise before the loss', f['rise [hPa]'], '> 200', f['rise [hPa]'] > 200.0,
              'hPa'),
        check(f'{who}: it takes', f['rises for [s]'], '.3 to 1.2',
              0.3 < f['rises for [s]'] < 1.2, 's'),
        check(f'{who}: force left before the loss',
              f['force before the loss [N]'] / f['force held [N]'], '> .5',
              f['force before the loss [N]'] > 0.5 * f['force held [N]']),
        check(f'{who}: pressure one reading later', f['lost [hPa]'], '> 955', f['lost [hPa]'] > 955,
              'hPa')]


def evaluate(results, quick):
    section = Section(NAME, 'A real gripper', [
        'A bellows of a robot grips a ball and is pulled off: pressure in the ejector\'s line and '
        'force at the wrist, measured (Velasquez 2022) and simulated with a bellows of that size.'])
    if results.ok(GRIP):
        real, model = record(), simulated(results.folder(GRIP))
        columns = {'measured': sequence(*real), 'simulated': sequence(*model)}
        section.checks += [c for who, f in columns.items() for c in checks_of(f, who)]
        section.tables.append(Table('measured', 'The grip as the sensor shows it', [
            ('', ''), ('measured', '.2f'), ('simulated', '.2f')],
            [(name, *(f[name] for f in columns.values()))
             for name in columns['measured'] if name != 'seal']))
        draw_overlay(real, model)
        section.figures.append(Figure('measured', 'Pressure and force over time, from the first '
                                      'reading after the seal. Grey: 600 to 700 hPa.'))
    if results.ok(NEVER):
        lowest = simulated(results.folder(NEVER))[1].min()
        section.checks.append(check('never sealed: lowest pressure', lowest, '> 955',
                                    lowest > 955.0, 'hPa'))
    if quick:
        return section
    vacuums = {key: reached(results.folder(run)) for key, run in map_runs().items()
               if results.ok(run)}
    if not vacuums:
        return section
    draw_map(vacuums)
    section.figures.append(Figure('offset_map', 'Pressure reached over the lateral offset of the '
                                  'lip\'s middle from the ball\'s, pressed 4 mm beyond the first '
                                  'touch.'))
    rows = [(1e3 * d, t, *(vacuums.get((d, t, o)) for o in OFFSETS)) for d in DIAMETERS
            for t in TILTS]
    section.tables.append(Table('offset_map', 'Pressure reached [hPa]', [
        ('ball [mm]', 'g'), ('tilt [degrees]', 'd'),
        *((f'{1e3 * o:g} mm', '.0f') for o in OFFSETS)], rows))
    ends = {(d, t): collapse(vacuums, d, t) or math.inf for d in DIAMETERS for t in TILTS}
    section.checks += [
        check(f'collapse at {t} degrees: offset on {1e3 * small:g} mm', 1e3 * ends[small, t],
              f'<= {1e3 * ends[large, t]:g} on {1e3 * large:g} mm', ends[small, t] <= ends[large, t],
              'mm') for t in TILTS for small, large in zip(DIAMETERS, DIAMETERS[1:])]
    section.checks += [
        check(f'collapse on {1e3 * d:g} mm: offset at {more} degrees', 1e3 * ends[d, more],
              f'<= {1e3 * ends[d, less]:g} at {less} degrees', ends[d, more] <= ends[d, less], 'mm')
        for d in DIAMETERS for less, more in zip(TILTS, TILTS[1:])]
    return section
