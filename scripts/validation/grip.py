"""One run of the experiment tool: a cup is pressed onto a plate, drawn on, and pulled or held."""

import dataclasses
import os
from typing import Optional

from . import meshes
from .paths import EXPERIMENT, REPOSITORY

SCENARIO = REPOSITORY / 'config' / 'experiments' / 'pull_off_a20.yaml'
CUP_LENGTH = 0.020      # mount to lip of the bell at rest [m]
START = 0.0202          # the mount's first height [m]
PRESS_SPEED = 0.01      # [m/s]
RAMP_RATE = 1e5         # of the regulator [Pa/s]
SETTLING_TIME = 0.2     # forces are then within 1e-5 of those at rest [s]
STOP_AFTER_LOSS = 0.1   # time in which a flicker of the seal would show [s]
TYPICAL_LIFT = 0.006    # at loss; for estimates of time only [m]


@dataclasses.dataclass(frozen=True)
class Grip:
    """Equal grips are one run, whatever part asks for them. Lifts are those of the mount from where
    the lip of the undeformed cup touches the plate."""
    cup: str = 'a20'
    mesh: str = 'quadratic_700'
    material: str = 'corotational'
    pressure: float = -6000.0       # [Pa], gauge
    press: float = 0.001            # how far the mount goes down from where the lip touches [m]
    speed: Optional[float] = 0.005  # of the pull [m/s]; None: held where it is
    lift: float = 0.012             # of the mount where the pull ends at the latest [m]
    time_step: float = 0.01         # [s]
    damping: float = 0.002          # of the stiffness [s]
    seal_gap: Optional[float] = None  # that counts as sealed [m]; None: derived from the mesh
    alone: bool = False             # nothing runs beside it: its step times count
    may_fail: bool = False          # steps may be undone, as long as it says so

    @property
    def id(self):
        """The folder's name: what the run is, and what differs from the default."""
        words = [self.cup, self.mesh, f'{1e-3 * self.pressure:g}kPa',
                 f'press{1e3 * self.press:g}mm']
        words.append('held' if self.speed is None else f'pull{1e3 * self.speed:g}mms')
        words.append(f'h{1e3 * self.time_step:g}ms')
        default = Grip()
        if self.material != default.material:
            words.append(self.material)
        if self.speed is not None and self.lift != default.lift:
            words.append(f'to{1e3 * self.lift:g}mm')
        if self.damping != default.damping:
            words.append(f'damping{1e3 * self.damping:g}ms')
        if self.seal_gap is not None:
            words.append(f'seal{1e6 * self.seal_gap:.0f}um')
        if self.alone:
            words.append('alone')
        return '_'.join(words)

    @property
    def suction_at(self):
        """[s]"""
        return (START - CUP_LENGTH + self.press) / PRESS_SPEED + SETTLING_TIME

    @property
    def pull_at(self):
        """[s]"""
        return self.suction_at + abs(self.pressure) / RAMP_RATE + SETTLING_TIME

    @property
    def end(self):
        """[s]"""
        if self.speed is None:
            return self.pull_at
        return self.pull_at + (self.lift + self.press) / self.speed

    def keyframes(self):
        """Rows of time [s], height of the mount [m] and set-point [Pa]."""
        down = CUP_LENGTH - self.press
        rows = [(0.0, START, 0.0),
                (self.suction_at - SETTLING_TIME, down, 0.0),
                (self.suction_at, down, self.pressure),
                (self.pull_at, down, self.pressure)]
        if self.speed is not None:
            rows.append((self.end, CUP_LENGTH + self.lift, self.pressure))
        return rows

    def settings(self):
        """Keys of the scenario that are set, with their values."""
        frames = ', '.join(f'{{time: {time:.9f}, position: [0.0, 0.0, {height:.9f}], '
                           f'pressure_setpoint: {setpoint:.3f}}}'
                           for time, height, setpoint in self.keyframes())
        settings = {
            'name': self.id,
            'cup': self.cup,
            'cup.mesh': os.path.relpath(meshes.path(self.mesh), SCENARIO.parent),
            'cup.damping.stiffness': f'{self.damping:.9f}',
            'time_step': f'{self.time_step:.9f}',
            'timeline': f'[{frames}]',
            'stop_after_loss': STOP_AFTER_LOSS,
        }
        if self.material != 'corotational':
            settings['cup.material'] = self.material
        if self.seal_gap is not None:
            settings['seal.close_gap'] = settings['seal.open_gap'] = f'{self.seal_gap:.9f}'
        return settings

    def command(self, folder):
        """Writes into the folder. Paths are relative to the repository."""
        words = [EXPERIMENT.relative_to(REPOSITORY), SCENARIO.relative_to(REPOSITORY)]
        for key, value in self.settings().items():
            words += ['--set', f'{key}={value}']
        return [*words, '--out', folder.relative_to(REPOSITORY), '--quiet']

    def inputs(self):
        """The files that the result depends on."""
        return [EXPERIMENT, SCENARIO, REPOSITORY / 'config' / 'cups' / f'{self.cup}.yaml',
                meshes.path(self.mesh)]

    def allowed(self):
        """Exit statuses of a run that did what it should; 3: steps were undone."""
        return (0, 3) if self.may_fail else (0,)

    @property
    def cost(self):
        """Rough duration [s]."""
        end = min(self.end, self.pull_at + TYPICAL_LIFT / self.speed) if self.speed else self.end
        return meshes.CATALOGUE[self.mesh].seconds * end / self.time_step
