#!/usr/bin/python3
"""The Python of scripts/validate: what it reads, measures and remembers."""

import dataclasses
import io
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / 'scripts'))
from validation.grip import Grip  # noqa: E402 (the path comes first)
from validation.meridian import boundary_faces, hausdorff, meridian, section  # noqa: E402
from validation.parts import (convergence, cost, force, geometry, loss, seal,  # noqa: E402
                              sweep, wrinkles)
from validation.parts.reference import parse_line  # noqa: E402
from validation.progress import Progress  # noqa: E402
from validation.report_items import check_relative, check_small  # noqa: E402
from validation.runner import Runner  # noqa: E402
from validation.series import Series  # noqa: E402


PARTS = (geometry, force, sweep, convergence, cost, seal, loss, wrinkles)


class ReferenceLineTest(unittest.TestCase):
    """As Judge() of test/validation/reference_case.h prints them."""

    def test_relative_error_and_spread(self):
        check = parse_line('A20, -6 kPa, lift 2 mm: force [N]                   3.12064, reference '
                           '      3.29673..3.31, error   -5.3414 %, tolerance 5 %, FAIL\n')
        self.assertEqual(check.name, 'A20, -6 kPa, lift 2 mm: force')
        self.assertEqual((check.unit, check.error_unit), ('N', '%'))
        self.assertEqual((check.value, check.reference), (3.12064, '3.29673..3.31'))
        self.assertEqual((check.error, check.tolerance, check.passed), (-5.3414, 5.0, False))

    def test_absolute_error_and_exponent(self):
        check = parse_line('disc linear, 50 Pa: max w [m]    9.16778e-05, reference 9.17e-05, '
                           'error +0.0000, tolerance 1e-05, PASS')
        self.assertEqual((check.value, check.error, check.tolerance), (9.16778e-05, 0.0, 1e-5))
        self.assertEqual(check.error_unit, 'm')
        self.assertTrue(check.passed)

    def test_a_value_that_is_no_number_stays_a_failure(self):
        check = parse_line('x [N]   nan, reference 1, error   +nan %, tolerance 5 %, FAIL')
        self.assertTrue(math.isnan(check.value))
        self.assertFalse(check.passed)

    def test_other_lines_are_none(self):
        for line in ('', '[ RUN      ] Beam.Linear', '[  PASSED  ] 3 tests.',
                     'error: 3.0, reference 1, PASS'):
            self.assertIsNone(parse_line(line), line)


class CheckTest(unittest.TestCase):
    def test_bounds_belong_to_the_tolerance_and_nan_fails(self):
        self.assertTrue(check_small('p', 'n', 0.3, 0.3).passed)
        self.assertFalse(check_small('p', 'n', 0.31, 0.3).passed)
        self.assertFalse(check_small('p', 'n', math.nan, 0.3).passed)
        self.assertTrue(check_relative('p', 'n', 0.96, 1.0, 5.0).passed)
        self.assertFalse(check_relative('p', 'n', 0.94, 1.0, 5.0).passed)
        self.assertFalse(check_relative('p', 'n', math.nan, 1.0, 5.0).passed)


class MeridianTest(unittest.TestCase):
    """A tube with 16 flat sides around the z axis, whose meridian is a band."""
    SIDES, RADIUS, HEIGHT = 16, 0.02, 0.01

    def tube(self):
        angles = 2.0 * np.pi * (np.arange(self.SIDES) + 0.5) / self.SIDES
        ring = np.column_stack([np.cos(angles), np.sin(angles)]) * self.RADIUS
        points = np.vstack([np.column_stack([ring, np.full(self.SIDES, z)])
                            for z in (0.0, self.HEIGHT)])
        faces = []
        for a in range(self.SIDES):
            b = (a + 1) % self.SIDES
            faces += [(a, b, a + self.SIDES), (b, b + self.SIDES, a + self.SIDES)]
        return points, np.array(faces)

    def test_hausdorff_distance_of_a_tube_from_a_circular_one(self):
        points, faces = self.tube()
        beyond = 0.001
        line = np.array([[self.RADIUS + beyond, z] for z in np.linspace(0.0, self.HEIGHT, 5)])
        distance, where, alone = hausdorff(line, *meridian(points, faces))
        inner = self.RADIUS * math.cos(math.pi / self.SIDES)  # middle of a side
        self.assertAlmostEqual(distance, self.RADIUS + beyond - inner, places=12)
        self.assertAlmostEqual(where[0], inner, places=12)
        self.assertAlmostEqual(alone, beyond, places=12)

    def test_distance_of_a_curve_that_the_shape_does_not_reach(self):
        points, faces = self.tube()
        line = np.array([[self.RADIUS, 0.0], [self.RADIUS, self.HEIGHT + 0.003]])
        distance, where, _ = hausdorff(line, *meridian(points, faces))
        self.assertAlmostEqual(distance, 0.003, places=12)
        self.assertAlmostEqual(where[1], self.HEIGHT + 0.003, places=12)

    def test_section_is_two_straight_lines(self):
        points, faces = self.tube()
        segments = section(points, faces)
        inner = self.RADIUS * math.cos(math.pi / self.SIDES)
        np.testing.assert_allclose(np.abs(segments[:, :, 0]), inner, rtol=1e-12)
        length = np.abs(segments[:, 1, 1] - segments[:, 0, 1]).sum()
        self.assertAlmostEqual(length, 2.0 * self.HEIGHT, places=12)

    def test_a_face_between_two_tetrahedra_is_not_boundary(self):
        faces = boundary_faces(np.array([[0, 1, 2, 3], [1, 2, 3, 4]]))
        self.assertEqual(len(faces), 6)
        self.assertNotIn({1, 2, 3}, [set(face) for face in faces])

    def test_mid_edge_nodes_lie_between_the_corners_of_a_face(self):
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
        edges = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
        points = np.vstack([corners, [0.5 * (corners[a] + corners[b]) for a, b in edges]])
        faces = boundary_faces(np.arange(10)[None, :])
        self.assertEqual(len(faces), 4)
        for face in faces:
            a, b, c, ab, bc, ca = points[face]
            np.testing.assert_allclose([ab, bc, ca], [(a + b) / 2, (b + c) / 2, (c + a) / 2])
            outwards = np.cross(b - a, c - a) @ (a + b + c - 3.0 * corners.mean(axis=0))
            self.assertGreater(outwards, 0.0)


@dataclasses.dataclass(frozen=True)
class CountingJob:
    """Appends a line to a file each time that it runs, and ends with a status."""
    counter: pathlib.Path
    source: pathlib.Path
    status: int = 0
    id: str = 'job'
    alone: bool = False
    cost: float = 1.0

    def command(self, _folder):
        return ['/bin/sh', '-c', f'echo run >> "{self.counter}"; echo last; exit {self.status}']

    def inputs(self):
        return [self.source]

    def allowed(self):
        return (0,)


class RunnerTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        root = pathlib.Path(self.folder.name)
        self.job = CountingJob(root / 'counter', root / 'source')
        self.job.source.write_text('first')
        self.root = root

    def perform(self, *jobs, fresh=False):
        runner = Runner(self.root / 'runs', self.root)
        return runner.perform(jobs or [self.job], 2, fresh, Progress(io.StringIO()))

    def runs(self):
        return len(self.job.counter.read_text().splitlines())

    def test_a_finished_run_is_not_repeated(self):
        self.perform()
        records = self.perform()
        self.assertEqual(self.runs(), 1)
        self.assertEqual(records[self.job]['status'], 0)

    def test_equal_jobs_are_one(self):
        self.perform(self.job, dataclasses.replace(self.job))
        self.assertEqual(self.runs(), 1)

    def test_another_input_is_another_run(self):
        self.perform()
        self.job.source.write_text('other')
        self.perform()
        self.assertEqual(self.runs(), 2)

    def test_other_arguments_are_another_run(self):
        self.perform()
        self.perform(dataclasses.replace(self.job, status=3))
        self.assertEqual(self.runs(), 2)

    def test_an_interrupted_run_is_repeated(self):
        self.perform()
        (self.root / 'runs' / 'job' / 'run.json').unlink()
        self.perform()
        self.assertEqual(self.runs(), 2)

    def test_a_run_that_was_killed_is_repeated(self):
        for count in (1, 2):
            self.perform(dataclasses.replace(self.job, status='$(kill -9 $$)'))
            self.assertEqual(self.runs(), count)

    def test_fresh_repeats(self):
        self.perform()
        self.perform(fresh=True)
        self.assertEqual(self.runs(), 2)

    def test_a_failure_is_remembered_with_its_last_line(self):
        job = dataclasses.replace(self.job, status=2)
        record = self.perform(job)[job]
        self.assertEqual((record['status'], record['last_line']), (2, 'last'))

    def test_those_alone_run_too(self):
        jobs = [dataclasses.replace(self.job, id='a'),
                dataclasses.replace(self.job, id='b', alone=True)]
        self.assertEqual(set(self.perform(*jobs)), set(jobs))


class GripTest(unittest.TestCase):
    def test_every_run_has_a_folder_of_its_own(self):
        grips = {grip for part in PARTS
                 for quick in (False, True) for grip in part.jobs(quick)}
        self.assertEqual(len({grip.id for grip in grips}), len(grips))

    def test_the_quick_run_asks_for_nothing_new(self):
        for part in PARTS:
            self.assertLessEqual(set(part.jobs(True)), set(part.jobs(False)), part.NAME)

    def test_times_ascend_and_the_pull_has_its_speed(self):
        grip = Grip(speed=0.02, lift=0.008, press=0.002)
        times = [time for time, _, _ in grip.keyframes()]
        self.assertEqual(times, sorted(set(times)))
        (begin, low, _), (end, high, _) = grip.keyframes()[-2:]
        self.assertAlmostEqual((high - low) / (end - begin), 0.02)
        self.assertAlmostEqual(high - low, 0.010)


class SeriesTest(unittest.TestCase):
    """Five steps: pressed, drawn on, held, pulled, lost."""

    def series(self):
        grip = Grip()
        steps = [(grip.suction_at - 0.01, -0.001, 0, 0.3), (grip.suction_at, -0.001, 2, -1.0),
                 (grip.pull_at, -0.001, 1, -3.0), (grip.pull_at + 1.0, 0.004, 1, -4.0),
                 (grip.pull_at + 1.2, 0.005, 3, -9.0)]
        text = 'time,mount_z,status,force_z,outcome,max_penetration,step_ms\n' + ''.join(
            f'{time},{0.020 + lift},{status},{force_},0,1e-9,{5 + i}\n'
            for i, (time, lift, status, force_) in enumerate(steps))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, 'timeseries.csv')
            file.write_text(text)
            return Series(file, grip)

    def test_forces_are_those_of_their_phases(self):
        series = self.series()
        self.assertEqual(series.press_force, -0.3)
        self.assertEqual(series.hold_force, 3.0)
        self.assertEqual(series.peak_force, 4.0)  # the step of the loss does not count

    def test_seal(self):
        series = self.series()
        self.assertEqual(series.seal_flips, 2)
        self.assertAlmostEqual(series.lift_at_loss, 0.005)
        self.assertEqual(series.sealed_step_ms, 7.0)
        self.assertEqual(series.undone_steps, 0)


if __name__ == '__main__':
    unittest.main()
