"""(c) What mesh, time step and damping do to the forces and to the lift at loss."""

import matplotlib.pyplot as plt

from .. import style
from ..grip import Grip
from ..meshes import CATALOGUE
from ..reference_data import force_at
from ..report_items import Figure, Section, Table, check_relative

NAME = 'convergence'
MATERIALS = ('corotational', 'neo_hookean')
MESHES = ('linear_700', 'linear_3000', 'linear_10000', 'linear_30000',
          'quadratic_700', 'quadratic_1500', 'quadratic_3000', 'quadratic_6000')
QUICK_MESHES = ('linear_700', 'linear_3000', 'linear_10000',
                'quadratic_700', 'quadratic_1500', 'quadratic_3000')
TIME_STEPS = (0.001, 0.002, 0.005, 0.01, 0.02)
QUICK_TIME_STEPS = (0.002, 0.005, 0.01, 0.02)
DAMPINGS = (0.0005, 0.001, 0.002, 0.004, 0.008)
QUICK_DAMPINGS = (0.0005, 0.002, 0.008)
ELEMENT_TICKS = (700, 1500, 3000, 6000, 10000, 30000)
COLORS = {'corotational': style.BLUE, 'neo_hookean': style.VERMILION}
SETTLED_TOLERANCE = 0.1  # change of forces at rest with the time step [%]
QUANTITIES = (('press', 'force that presses it by 1 mm [N]', lambda s: -s.press_force),
              ('hold', 'force held at -6 kPa [N]', lambda s: s.hold_force),
              ('lift', 'lift at loss [mm]', lambda s: 1e3 * s.lift_at_loss),
              ('peak', 'largest force [N]', lambda s: s.peak_force))


def mesh_grips(material, quick):
    return [Grip(mesh=mesh, material=material) for mesh in (QUICK_MESHES if quick else MESHES)]


def step_grips(material, quick):
    return [Grip(material=material, time_step=h)
            for h in (QUICK_TIME_STEPS if quick else TIME_STEPS)]


def damping_grips(material, quick):
    return [Grip(material=material, damping=damping)
            for damping in (QUICK_DAMPINGS if quick else DAMPINGS)]


def settings_materials(quick):
    """Materials whose time step and damping are studied."""
    return MATERIALS[:1] if quick else MATERIALS


def jobs(quick):
    grips = [grip for material in MATERIALS for grip in mesh_grips(material, quick)]
    for material in settings_materials(quick):
        grips += step_grips(material, quick) + damping_grips(material, quick)
    return grips


def found(results, grips):
    """The grips that ran and their series."""
    return [(grip, results.series(grip)) for grip in grips if results.series(grip) is not None]



def references():
    """(lowest, highest) of the converged solutions, of quantities that have one."""
    names = ('a20_hold_svk.csv', 'a20_hold_neohooke.csv')
    return {'press': sorted(-force_at(name, -0.001, 0.0) for name in names),
            'hold': sorted(force_at(name, -0.001, -6000.0) for name in names)}


def draw_meshes(results, quick):
    figure, axes = plt.subplots(2, 2, figsize=(style.WIDTH, 6.0), sharex=True,
                                constrained_layout=True)
    for axis, (key, text, value) in zip(axes.flat, QUANTITIES):
        if key in references():
            axis.axhspan(*references()[key], color='0.75', linewidth=1.0)
        for material, color in COLORS.items():
            for order, marker, fill in ((2, 'o', color), (1, '^', 'white')):
                points = [(results.num_elements(grip), value(series))
                          for grip, series in found(results, mesh_grips(material, quick))
                          if CATALOGUE[grip.mesh].order == order]
                axis.plot(*zip(*points) if points else ((), ()), color=color, marker=marker,
                          markerfacecolor=fill, linestyle='-' if order == 2 else (0, (4, 2)),
                          label=f'{material}, {"quadratic" if order == 2 else "linear"}')
        axis.set_title(text, loc='left')
        style.log_ticks(axis.xaxis, ELEMENT_TICKS)
    for axis in axes[-1]:
        axis.set_xlabel('number of elements')
    handles, labels = axes[0, 0].get_legend_handles_labels()
    handles.append(plt.Rectangle((0, 0), 1, 1, color='0.75'))
    labels.append('CalculiX, both materials')
    style.legend_below(figure, handles, labels, columns=3)
    style.save(figure, 'convergence_mesh')


def draw_settings(results, quick):
    """Changes in percent of the default's value over time step and damping."""
    figure, axes = plt.subplots(1, 2, figsize=(style.WIDTH, 3.7), sharey=True,
                                constrained_layout=True)
    looks = ((style.BLACK, 's', 8), (style.BLUE, 'o', 4), (style.VERMILION, '^', 5),
             (style.GREEN, 'D', 4))
    names = ('force pressed', 'force held', 'lift at loss', 'largest force')
    for axis, study, x, unit in (
            (axes[0], step_grips, lambda g: 1e3 * g.time_step, 'time step [ms]'),
            (axes[1], damping_grips, lambda g: 1e3 * g.damping, 'stiffness damping [ms]')):
        for material in settings_materials(quick):
            runs, default = found(results, study(material, quick)), \
                results.series(Grip(material=material))
            if default is None:
                continue
            main = material == MATERIALS[0]
            for (_, _, value), (color, marker, size), name in zip(QUANTITIES, looks, names):
                axis.plot([x(grip) for grip, _ in runs],
                          [100.0 * (value(series) / value(default) - 1.0) for _, series in runs],
                          color=color, marker=marker, markersize=size,
                          markerfacecolor='white' if size == 8 or not main else color,
                          linestyle='-' if main else (0, (4, 2)),
                          label=name if main else None)
        style.log_ticks(axis.xaxis, [x(grip) for grip in study(MATERIALS[0], quick)])
        axis.set_xlabel(unit)
    axes[0].set_ylabel('change from the default [%]')
    style.legend_below(figure, *axes[0].get_legend_handles_labels(), columns=4)
    style.save(figure, 'convergence_settings')


def settled_checks(results, quick):
    """Forces at rest must not depend on the time step."""
    checks = []
    for material in settings_materials(quick):
        default = results.series(Grip(material=material))
        for grip, series in found(results, step_grips(material, quick)):
            if default is None or grip == default.grip:
                continue
            checks += [check_relative(NAME, f'{material}, time step {1e3 * grip.time_step:g} ms: '
                                      f'force {name}', value(series), value(default),
                                      SETTLED_TOLERANCE, 'N')
                       for name, (_, _, value) in zip(('pressed', 'held'), QUANTITIES)]
    return checks


def evaluate(results, quick):
    section = Section(NAME, 'Convergence', [
        'A20, pressed by 1 mm, held at -6 kPa, pulled at 5 mm/s. Over meshes of both orders and '
        'both materials; over the time step and over the stiffness damping with the default cup. '
        f'Forces at rest must not depend on the time step: by {SETTLED_TOLERANCE:g} % at most.'],
        checks=settled_checks(results, quick))
    rows = [(grip.material, grip.mesh, results.num_elements(grip), 1e3 * grip.time_step,
             1e3 * grip.damping, *(value(series) for _, _, value in QUANTITIES),
             series.seal_flips, series.undone_steps)
            for grip, series in found(results, dict.fromkeys(jobs(quick)))]
    section.tables.append(Table('convergence', 'Every run of the study', [
        ('material', ''), ('mesh', ''), ('elements', 'd'), ('time step [ms]', 'g'),
        ('damping [ms]', 'g'), ('press [N]', '.4f'), ('hold [N]', '.4f'),
        ('lift at loss [mm]', '.2f'), ('peak [N]', '.3f'), ('seal flips', 'd'),
        ('undone steps', 'd')], rows))
    if rows:
        draw_meshes(results, quick)
        draw_settings(results, quick)
        section.figures += [
            Figure('convergence_mesh', 'Over the mesh. Filled: quadratic, open: linear elements; '
                   'grey: between the two materials of CalculiX.'),
            Figure('convergence_settings', 'Over time step and damping, quadratic_700. Full lines: '
                   'corotational, dashed: neo_hookean.')]
    return section
