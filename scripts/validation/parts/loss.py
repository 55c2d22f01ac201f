"""The early loss under strong vacuum: over mesh, time step and speed of the pull."""

import dataclasses

import matplotlib.pyplot as plt

from .. import style
from ..grip import Grip
from ..report_items import Figure, Section, Table

NAME = 'loss'
PRESSURES = (-8e3, -10e3, -12e3)
# One at a time around the default; values as they stand on the axis.
STUDIES = (('mesh', 'quadratic elements', ('quadratic_700', 'quadratic_1500', 'quadratic_3000'),
            lambda value: value.split('_')[1]),
           ('time_step', 'time step [ms]', (0.002, 0.005, 0.01), lambda value: f'{1e3 * value:g}'),
           ('speed', 'speed of the pull [mm/s]', (0.001, 0.005, 0.05),
            lambda value: f'{1e3 * value:g}'))


def grip_of(pressure, key, value):
    grip = dataclasses.replace(Grip(pressure=pressure), **{key: value})
    # A fast pull is over in few steps of the default.
    return dataclasses.replace(grip, time_step=0.002) if grip.speed > 0.01 else grip


def jobs(quick):
    if quick:
        return []
    return [grip_of(pressure, key, value) for pressure in PRESSURES
            for key, _, values, _ in STUDIES for value in values]


def evaluate(results, quick):
    section = Section(NAME, 'Loss under strong vacuum', [
        'A20 beyond -8 kPa, where the force sags before the cup lets go: mesh, time step and speed '
        'of the pull are changed one at a time around the default mesh, 10 ms and 5 mm/s '
        '(at 50 mm/s: 2 ms). No tolerance stands on these.'])
    if quick:
        section.paragraphs.append('Only in the full run.')
        return section
    rows = []
    figure, axes = plt.subplots(2, 3, figsize=(style.WIDTH, 5.4), sharey='row', sharex='col',
                                constrained_layout=True)
    for pressure, color in zip(PRESSURES, (style.BLUE, style.VERMILION, style.BLACK)):
        for column, (key, _, values, text) in enumerate(STUDIES):
            points = []
            for position, value in enumerate(values):
                grip = grip_of(pressure, key, value)
                series = results.series(grip)
                if series is None:
                    continue
                points.append((position, 1e3 * series.lift_at_loss, series.peak_force))
                rows.append((1e-3 * pressure, grip.mesh, 1e3 * grip.time_step, 1e3 * grip.speed,
                             series.hold_force, series.peak_force, 1e3 * series.lift_at_loss,
                             series.seal_flips, series.undone_steps))
            for line in (1, 2):
                axes[line - 1, column].plot([p[0] for p in points], [p[line] for p in points],
                                            color=color, marker='o',
                                            label=f'{1e-3 * pressure:g} kPa')
    for column, (_, name, values, text) in enumerate(STUDIES):
        axes[1, column].set_xticks(range(len(values)))
        axes[1, column].set_xticklabels([text(value) for value in values])
        axes[1, column].set_xlabel(name)
        axes[1, column].set_xlim(-0.3, len(values) - 0.7)
    axes[0, 0].set_ylabel('lift at loss [mm]')
    axes[1, 0].set_ylabel('largest force [N]')
    for axis in axes[:, 0]:
        axis.set_ylim(bottom=0.0)
    style.legend_below(figure, *axes[0, 0].get_legend_handles_labels(), columns=3)
    style.save(figure, 'loss')
    section.tables.append(Table('loss', 'Every run of the study', [
        ('pressure [kPa]', 'g'), ('mesh', ''), ('time step [ms]', 'g'), ('speed [mm/s]', 'g'),
        ('hold [N]', '.3f'), ('peak [N]', '.3f'), ('lift at loss [mm]', '.2f'),
        ('seal flips', 'd'), ('undone steps', 'd')], list(dict.fromkeys(rows))))
    section.figures.append(Figure('loss', 'Lift at loss and largest force, one setting changed at '
                                  'a time.'))
    return section
