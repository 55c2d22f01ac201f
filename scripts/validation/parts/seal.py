"""(e) Does the lift at loss hang on the seal's tolerance, the rim's mesh or the time step?"""

import dataclasses

import matplotlib.pyplot as plt

from .. import style
from ..grip import Grip
from ..report_items import Figure, Section, Table, check_relative

NAME = 'seal'
PRESSURES = (-2e3, -4e3, -6e3)
QUICK_PRESSURES = (-2e3, -6e3)
TOLERANCE = 5.0  # change of the lift at loss [%]
# What is changed from the default: name, how, colour and marker.
GAP_VARIANTS = (('seal gaps / 3', 1.0 / 3.0, style.BLUE, 'v'),
                ('seal gaps x 3', 3.0, style.BLUE, '^'))
VARIANTS = (('rim twice as fine', {'mesh': 'quadratic_700_fine_rim'}, style.GREEN, 's'),
            ('time step 1 ms', {'time_step': 0.001}, style.VERMILION, 'o'))


def pressures(quick):
    return QUICK_PRESSURES if quick else PRESSURES


def jobs(quick):
    default = [Grip(pressure=pressure) for pressure in pressures(quick)]
    return default + [dataclasses.replace(grip, **change) for grip in default
                      for _, change, _, _ in VARIANTS]


def gap_variants(results, grip):
    """(name, grip, colour, marker) with gaps that are a multiple of those of the mesh."""
    if not results.ok(grip):
        return []
    gap = results.summary(grip)['seal_open_gap']
    return [(name, dataclasses.replace(grip, seal_gap=factor * gap), color, marker)
            for name, factor, color, marker in GAP_VARIANTS]


def followups(results, quick):
    """Runs that can be told only from the results of jobs()."""
    return [grip for pressure in pressures(quick)
            for _, grip, _, _ in gap_variants(results, Grip(pressure=pressure))]


def evaluate(results, quick):
    section = Section(NAME, 'What the loss hangs on', [
        'A20, pulled at 5 mm/s: the lift at loss with the default settings, and with one of them '
        f'changed. It must not change by more than {TOLERANCE:g} %.'])
    rows = []
    figure, axis = plt.subplots(figsize=(0.75 * style.WIDTH, 3.6), constrained_layout=True)
    axis.axhspan(-TOLERANCE, TOLERANCE, color='0.94', linewidth=0)
    for pressure in pressures(quick):
        grip = Grip(pressure=pressure)
        default = results.series(grip)
        if default is None:
            continue
        rows.append((1e-3 * pressure, 'default', 1e3 * default.lift_at_loss, 0.0,
                     default.peak_force, 0.0))
        variants = gap_variants(results, grip) + [
            (name, dataclasses.replace(grip, **change), color, marker)
            for name, change, color, marker in VARIANTS]
        for k, (name, variant, color, marker) in enumerate(variants):
            series = results.series(variant)
            if series is None:
                continue
            check = check_relative(NAME, f'A20, {1e-3 * pressure:g} kPa, {name}: lift at loss',
                                   1e3 * series.lift_at_loss, 1e3 * default.lift_at_loss,
                                   TOLERANCE, 'mm')
            section.checks.append(check)
            rows.append((1e-3 * pressure, name, check.value, check.error, series.peak_force,
                         100.0 * (series.peak_force / default.peak_force - 1.0)))
            axis.plot(-1e-3 * pressure + 0.12 * (k - 1.5), check.error, marker, color=color,
                      markersize=6, label=name if pressure == pressures(quick)[0] else None)
    axis.axhline(0.0, color=style.GREY, linewidth=0.8)
    axis.set_xticks([-1e-3 * pressure for pressure in pressures(quick)])
    axis.set_xlabel('vacuum [kPa]')
    axis.set_ylabel('change of the lift at loss [%]')
    style.legend_below(figure, *axis.get_legend_handles_labels(), columns=4)
    style.save(figure, 'seal')
    section.tables.append(Table('seal', 'Lift at loss with one setting changed', [
        ('pressure [kPa]', 'g'), ('changed', ''), ('lift at loss [mm]', '.2f'),
        ('change [%]', '+.2f'), ('peak [N]', '.3f'), ('change of it [%]', '+.2f')], rows))
    section.figures.append(Figure('seal', 'Change of the lift at loss; grey: the tolerance.'))
    return section
