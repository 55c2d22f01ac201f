"""What a grip's time series says."""

import numpy as np

from .grip import CUP_LENGTH

OPEN, SEALED, REGULATING, LOST = range(4)
SLACK = 1e-9  # times are sums of steps [s]


class Series:
    """Columns of timeseries.csv by name, and the quantities that the parts compare.

    Forces on the mount are positive where the cup pulls it towards the plate. [N]
    """

    def __init__(self, file, grip):
        self.grip = grip
        with open(file, encoding='utf-8') as stream:
            names = stream.readline().strip().split(',')
            rows = np.loadtxt(stream, delimiter=',', ndmin=2)
        self.columns = {name: rows[:, i] for i, name in enumerate(names)}
        self.time = self.columns['time']
        self.force = -self.columns['force_z']
        self.lift = self.columns['mount_z'] - CUP_LENGTH
        self.status = self.columns['status'].astype(int)
        self.holds = (self.status == SEALED) | (self.status == REGULATING)

    def _last(self, rows):
        return self.force[np.flatnonzero(rows)[-1]] if rows.any() else np.nan

    @property
    def press_force(self):
        """At rest before suction; below zero: the mount is pushed up."""
        return self._last(self.time < self.grip.suction_at - SLACK)

    @property
    def hold_force(self):
        """At rest under suction, before the pull; NaN if the cup does not hold then."""
        before = self.time <= self.grip.pull_at + SLACK
        return self._last(before) if self.holds[before][-1] else np.nan

    @property
    def pulled(self):
        """Rows of the pull in which the cup holds."""
        return self.holds & (self.time > self.grip.pull_at - SLACK)

    @property
    def peak_force(self):
        return self.force[self.pulled].max() if self.pulled.any() else np.nan

    @property
    def lift_at_loss(self):
        """Of the mount, from where the lip of the undeformed cup touches [m]; NaN: never lost."""
        lost = np.flatnonzero(self.status == LOST)
        return self.lift[lost[0]] if lost.size else np.nan

    @property
    def seal_flips(self):
        """Changes between holding and not; 2: sealed once and lost once."""
        return int(np.count_nonzero(np.diff(np.concatenate([[False], self.holds]).astype(int))))

    @property
    def undone_steps(self):
        return int(np.count_nonzero(self.columns['outcome']))

    @property
    def max_penetration(self):
        """[m]"""
        return self.columns['max_penetration'].max()

    @property
    def sealed_step_ms(self):
        """Median wall time of a step while the cup holds. [ms]"""
        return np.median(self.columns['step_ms'][self.holds]) if self.holds.any() else np.nan

    @property
    def finite(self):
        return bool(np.isfinite(self.force).all() and np.isfinite(self.lift).all())
