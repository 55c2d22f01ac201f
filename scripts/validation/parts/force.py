"""(b) Pulled at 5 mm/s until the cup lets go: the force over time, as in Fig. 8 of the paper."""

import matplotlib.pyplot as plt
from .. import style
from ..grip import Grip
from ..reference_data import uplift
from ..report_items import Figure, Section, Table
from .seal_checks import seal_checks

NAME = 'force'
PRESSURES = {'a20': (-2e3, -4e3, -6e3, -8e3, -10e3), 'a30': (-4e3, -8e3, -11e3)}
# Of CalculiX: file, pressure [Pa], colour, marker, what it is.
UPLIFTS = (('a20_uplift_2kPa_svk.csv', -2e3, style.BLUE, 'o', 'CalculiX, St. Venant-Kirchhoff'),
           ('a20_uplift_6kPa_svk.csv', -6e3, style.BLUE, 'o', None),
           ('a20_uplift_6kPa_neohooke.csv', -6e3, style.VERMILION, 's', 'CalculiX, neo-Hooke'))


def grips(cup):
    return [Grip(cup=cup, pressure=pressure) for pressure in PRESSURES[cup]]


def jobs(_quick):
    return [grip for cup in PRESSURES for grip in grips(cup)]


def draw_over_time(all_series):
    """As Fig. 8: the force until shortly after the loss."""
    figure, axes = plt.subplots(1, 2, sharey=True, figsize=(style.WIDTH, 3.9),
                                constrained_layout=True)
    for axis, cup in zip(axes, PRESSURES):
        for grip in grips(cup):
            color = style.vacuum_color(grip.pressure)
            series = all_series.get(grip)
            if series is None:
                continue
            time = series.time - grip.pull_at
            lost = time[series.holds][-1] if series.holds.any() else time[-1]
            shown = time <= lost + 0.1
            axis.plot(time[shown], series.force[shown], color=color)
            style.label(axis, -0.32, series.hold_force, f'{1e-3 * grip.pressure:g} kPa', color,
                        dx=0, ha='right')
        axis.axvline(0.0, color=style.GREY, linewidth=0.7, linestyle=':')
        axis.axhline(0.0, color=style.GREY, linewidth=0.7)
        axis.set_title(f'{cup.upper()}, pulled at 5 mm/s', loc='left')
        axis.set_xlabel('time since the pull began [s]')
    axes[0].set_ylabel('force on the mount [N]')
    style.save(figure, 'force_over_time')


def draw_over_lift(all_series):
    figure, axis = plt.subplots(figsize=(0.85 * style.WIDTH, 4.4), constrained_layout=True)
    for grip in grips('a20'):
        color = style.vacuum_color(grip.pressure)
        series = all_series.get(grip)
        if series is None:
            continue
        lift, force = 1e3 * series.lift[series.pulled], series.force[series.pulled]
        axis.plot(lift, force, color=color)
        style.label(axis, lift[-1], force[-1], f'{1e-3 * grip.pressure:g} kPa', color)
    for name, pressure, color, marker, text in UPLIFTS:
        lift, force = uplift(name, pressure)
        axis.plot(1e3 * lift, force, marker, color=color, markerfacecolor='white', label=text)
    axis.plot([], [], color=style.GREY, label='simulation, pulled at 5 mm/s')
    style.legend_below(figure, *axis.get_legend_handles_labels(), columns=3)
    axis.set_xlabel('lift of the mount, from where the lip touches [mm]')
    axis.set_ylabel('force on the mount [N]')
    axis.margins(x=0.09)
    style.save(figure, 'force_over_lift')


def evaluate(results, _quick):
    section = Section(NAME, 'Force until the cup lets go', [
        'Pressed by 1 mm, drawn on, pulled at 5 mm/s (the force experiment of the paper, Sec. '
        'IV-C). The force on the mount grows, peaks, and falls to zero as the leak opens. The '
        'force before the pull, with the mount still down, is the hold.'])
    all_series, rows = {}, []
    for grip in jobs(False):
        series = results.series(grip)
        if series is None:
            continue
        all_series[grip] = series
        section.checks += seal_checks(NAME, grip, series)
        rows.append((grip.cup.upper(), 1e-3 * grip.pressure, -series.press_force, series.hold_force,
                     series.peak_force, 1e3 * series.lift_at_loss, series.seal_flips,
                     series.undone_steps, series.max_penetration))
    section.tables.append(Table('force', 'What the pulls gave', [
        ('cup', ''), ('pressure [kPa]', 'g'), ('press [N]', '.3f'), ('hold [N]', '.3f'),
        ('peak [N]', '.3f'), ('lift at loss [mm]', '.2f'), ('seal flips', 'd'),
        ('undone steps', 'd'), ('max penetration [m]', '.1e')], rows))
    if all_series:
        draw_over_time(all_series)
        draw_over_lift(all_series)
        section.figures += [
            Figure('force_over_time', 'Force over time, as Fig. 8 of the paper.'),
            Figure('force_over_lift', 'Force over lift, A20, and the quasi-static solutions of '
                   'CalculiX (axisymmetric; points whose seal was found consistently).')]
    return section
