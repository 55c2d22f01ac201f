#!/usr/bin/python3
"""scripts/payload_sweep as a user runs it, with the fast cup."""

import pathlib
import re
import subprocess
import unittest

SWEEP = pathlib.Path(__file__).resolve().parent.parent.parent / 'scripts' / 'payload_sweep'


class PayloadSweepTest(unittest.TestCase):
    def test_agrees_with_the_pull_off_force(self):
        done = subprocess.run([SWEEP, '--cup', 'a20_linear', '--precision', '0.02'],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        force = float(re.search(r'pulled off a plate at ([\d.]+) N', done.stdout).group(1))
        weight = float(re.search(r'heaviest box lifted: [\d.]+ kg, ([\d.]+) N',
                                 done.stdout).group(1))
        self.assertAlmostEqual(weight / force, 1.0, delta=0.05)
        masses = {outcome: [float(mass) for mass in
                            re.findall(rf'^ *([\d.]+) +[\d.]+ +{outcome}', done.stdout, re.M)]
                  for outcome in ('lifted', 'dropped')}
        self.assertLess(max(masses['lifted']), min(masses['dropped']))

    def test_bad_input_is_told(self):
        done = subprocess.run([SWEEP, '--cup', 'no_such_cup'], capture_output=True, text=True,
                              check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('no_such_cup', done.stderr)


if __name__ == '__main__':
    unittest.main()
