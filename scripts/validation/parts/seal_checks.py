"""What every pull has to keep."""

from ..report_items import check_small, check_equal

MAX_PENETRATION = 1e-6  # [m]


def describe(grip):
    return (f'{grip.cup.upper()}, {1e-3 * grip.pressure:g} kPa, {1e3 * grip.speed:g} mm/s, '
            f'{1e3 * grip.time_step:g} ms')


def seal_checks(part, grip, series):
    """Sealed once and lost once, no step undone, nothing in the plate."""
    name = describe(grip)
    return [check_equal(part, f'{name}: seal flips', series.seal_flips, 2),
            check_equal(part, f'{name}: undone steps', series.undone_steps, 0),
            check_small(part, f'{name}: max penetration', series.max_penetration,
                          MAX_PENETRATION, 'm')]
