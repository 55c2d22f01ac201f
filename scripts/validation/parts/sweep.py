"""(b2) Does the cup seal honestly at every pressure, pulled slowly and fast?"""

import matplotlib.pyplot as plt

from .. import style
from ..grip import Grip
from ..report_items import Check, Figure, Section, Table, check_small
from .seal_checks import MAX_PENETRATION, describe, seal_checks

NAME = 'sweep'
CUPS = {'a20': style.BLUE, 'a30': style.VERMILION}
QUICK = (-2e3, -6e3, -10e3, -15e3)
# Speed [m/s] and time step [s]: a fast pull is over in few steps, and needs them smaller.
PULLS = ((0.005, 0.01), (0.05, 0.005))
EXTREME = Grip(pressure=-20e3, may_fail=True)


def pressures(quick):
    return QUICK if quick else [-1e3 * k for k in range(1, 16)]


def curve(cup, pull, quick):
    speed, time_step = pull
    return [Grip(cup=cup, pressure=pressure, speed=speed, time_step=time_step)
            for pressure in pressures(quick)]


def jobs(quick):
    return [EXTREME] + [grip for cup in CUPS for pull in PULLS for grip in curve(cup, pull, quick)]


def row(grip, series):
    return (grip.cup.upper(), 1e-3 * grip.pressure, 1e3 * grip.speed, 1e3 * grip.time_step,
            series.hold_force, series.peak_force, 1e3 * series.lift_at_loss, series.seal_flips,
            series.undone_steps, series.max_penetration)


def draw(results, quick):
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH, 3.8), constrained_layout=True)
    for cup, color in CUPS.items():
        for pull, line, fill in zip(PULLS, ('-', (0, (4, 2))), (color, 'white')):
            found = [(g, results.series(g)) for g in curve(cup, pull, quick)]
            found = [(g, s) for g, s in found if s is not None]
            if not found:
                continue
            x = [-1e-3 * grip.pressure for grip, _ in found]
            for axis, y in ((axes[0], [s.peak_force for _, s in found]),
                            (axes[1], [1e3 * s.lift_at_loss for _, s in found])):
                axis.plot(x, y, color=color, linestyle=line, marker='o', markerfacecolor=fill,
                          label=f'{cup.upper()}, {1e3 * pull[0]:g} mm/s')
    axes[0].set_ylabel('largest force of the pull [N]')
    axes[1].set_ylabel('lift at which it lets go [mm]')
    for axis in axes:
        axis.set_xlabel('vacuum [kPa]')
        axis.set_ylim(bottom=0.0)
    axes[0].legend(loc='upper left')
    style.save(figure, 'sweep')


def evaluate(results, quick):
    section = Section(NAME, 'Sealing at every pressure', [
        f'{len(pressures(quick))} pressures from {-1e-3 * max(pressures(quick)):g} to '
        f'{-1e-3 * min(pressures(quick)):g} kPa below ambient, A20 and A30, pulled at 5 and '
        '50 mm/s. Each run must seal once and let go once (2 flips), with no step undone and no '
        'node deeper than 1e-6 m in the plate. At -20 kPa the A20 cup may wrinkle and steps may be '
        'undone, as long as the state stays finite and the report says so.'])
    rows = []
    for grip in jobs(quick):
        series = results.series(grip)
        if series is None:
            continue
        rows.append(row(grip, series))
        if grip == EXTREME:
            section.checks += [
                Check(NAME, f'{describe(grip)}: ends finite', float(series.finite), '1', 0.0, 0.0,
                      series.finite),
                check_small(NAME, f'{describe(grip)}: max penetration', series.max_penetration,
                              MAX_PENETRATION, 'm')]
        else:
            section.checks += seal_checks(NAME, grip, series)
    section.tables.append(Table('sweep', 'Every run of the sweep', [
        ('cup', ''), ('pressure [kPa]', 'g'), ('speed [mm/s]', 'g'), ('time step [ms]', 'g'),
        ('hold [N]', '.3f'), ('peak [N]', '.3f'), ('lift at loss [mm]', '.2f'),
        ('seal flips', 'd'), ('undone steps', 'd'), ('max penetration [m]', '.1e')], rows))
    if rows:
        draw(results, quick)
        section.figures.append(Figure('sweep', 'Largest force and lift at loss over the vacuum; '
                                      'filled: 5 mm/s, open: 50 mm/s.'))
    return section
