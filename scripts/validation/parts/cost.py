"""(d) What accuracy costs: the error of a mesh beside the time of its step."""

import matplotlib.pyplot as plt

from .. import style
from ..grip import Grip
from ..meshes import CATALOGUE
from ..report_items import Figure, Section, Table
from .convergence import mesh_grips, references

NAME = 'cost'
TARGETS = (5.0, 2.0, 1.0)  # [%]
FLOOR = 0.05               # errors that are zero are drawn here [%]
LIFT = -0.0005             # the timed run is short: sealed, at rest and a little of the pull [m]
MATERIAL = 'corotational'
FINEST = 'quadratic_12000'  # too slow for whole pulls


def timed(mesh):
    """A short run of a mesh, alone on the machine."""
    return Grip(mesh=mesh, lift=LIFT, alone=True)


def runs(quick):
    """(run that tells the forces, run that tells the step time) of every mesh."""
    pairs = [(grip, timed(grip.mesh)) for grip in mesh_grips(MATERIAL, quick)]
    return pairs if quick else pairs + [(timed(FINEST), timed(FINEST))]


def jobs(quick):
    return [grip for pair in runs(quick) for grip in pair]


def distance(value, spread):
    """Signed, from the spread, in percent of its nearer end."""
    nearest = min(max(value, spread[0]), spread[1])
    return 100.0 * (value - nearest) / abs(nearest)


def measure(results, quick):
    """Rows of a mesh: name, elements, press, its error, hold, its error, its change to the
    finest quadratic mesh, the worse of the first two errors, step [ms]."""
    rows = []
    finest = results.series(runs(quick)[-1][0])
    for grip, clock_grip in runs(quick):
        series, clock = results.series(grip), results.series(clock_grip)
        if series is None or clock is None:
            continue
        press = distance(-series.press_force, references()['press'])
        hold = distance(series.hold_force, references()['hold'])
        mesh = 100.0 * (series.hold_force / finest.hold_force - 1.0) if finest else None
        rows.append((grip.mesh, results.num_elements(grip), -series.press_force, press,
                     series.hold_force, hold, mesh, max(abs(press), abs(hold)),
                     clock.sealed_step_ms))
    return rows


def answers(rows):
    """For each target the mesh whose step is shortest among those that reach it."""
    result = []
    for target in TARGETS:
        good = [row for row in rows if row[7] <= target]
        if good:
            best = min(good, key=lambda row: row[8])
            result.append((target, best[0], best[1], best[7], best[8]))
        else:
            result.append((target, 'none of these', None, None, None))
    return result


def draw(rows):
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH, 4.0), sharex=True, sharey=True,
                                constrained_layout=True)
    for axis, column, text in ((axes[0], 3, 'force pressed by 1 mm'),
                               (axes[1], 5, 'force held at -6 kPa')):
        for order, color, marker in ((1, style.VERMILION, '^'), (2, style.BLUE, 'o')):
            mine = [row for row in rows if CATALOGUE[row[0]].order == order]
            x, y = [row[8] for row in mine], [max(abs(row[column]), FLOOR) for row in mine]
            axis.plot(x, y, color=color, label='quadratic' if order == 2 else 'linear')
            for row, a, b in zip(mine, x, y):
                axis.plot(a, b, marker, color=color,
                          markerfacecolor='white' if b == FLOOR else color)
                style.label(axis, a, b, row[0].split('_')[1], color, dx=6, dy=5)
        style.log_ticks(axis.xaxis, (1, 10, 100, 1000))
        style.log_ticks(axis.yaxis, (0.1, 1, 2, 5, 10, 50, 100))
        axis.set_title(text, loc='left')
        axis.set_xlabel('median step while sealed [ms]')
        axis.margins(x=0.2, y=0.1)
        for target in TARGETS:
            axis.axhline(target, color=style.GREY, linewidth=0.7, linestyle=':')
    axes[0].set_ylabel('distance from CalculiX [%]')
    axes[0].legend(loc='lower left')
    style.save(figure, 'cost')


def evaluate(results, quick):
    section = Section(NAME, 'Cost beside error', [
        'Errors against the converged solutions of CalculiX: pressed by 1 mm, and held at -6 kPa '
        '(A20, corotational), as distance from the spread between its two materials; zero within. '
        'Step times are medians over the sealed part of runs made one at a time, with one thread '
        f'(10 ms time step). What lies within the spread is drawn at {FLOOR:g} %, open.'])
    rows = measure(results, quick)
    if not rows:
        return section
    section.tables.append(Table('cost_answer', 'Which mesh for which error', [
        ('error at most [%]', 'g'), ('mesh with the shortest step', ''), ('elements', 'd'),
        ('its larger error [%]', '.2f'), ('step [ms]', '.1f')], answers(rows)))
    slowest = max(row[8] for row in rows)
    section.tables.append(Table('cost', 'Error and step time of each mesh', [
        ('mesh', ''), ('elements', 'd'), ('press [N]', '.4f'), ('error [%]', '+.2f'),
        ('hold [N]', '.4f'), ('error of it [%]', '+.2f'), ('of it, to the finest mesh [%]', '+.2f'),
        ('larger error [%]', '.2f'),
        ('step [ms]', '.2f'), ('of the slowest mesh', '.4f')],
        [(*row, row[8] / slowest) for row in rows]))
    draw(rows)
    section.figures.append(Figure('cost', 'Error over the time of a step; numbers are elements. '
                                  'Dotted: 5, 2 and 1 %.'))
    return section
