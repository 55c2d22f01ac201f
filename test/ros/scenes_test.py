#!/usr/bin/python3
"""Runs the launch files of the scenes as a user would and reads the verdicts they leave."""

import os
import subprocess
import sys
import tempfile
import unittest

import rospkg
import rostest
import yaml

PACKAGE = rospkg.RosPack().get_path('vacuum_gripper_sim')
LONGEST = 120.0  # [s], wall


class ScenesTest(unittest.TestCase):
    def play(self, name):
        """The summary of a scene. Its gripper has the scene's name: no two of them meet."""
        with tempfile.TemporaryDirectory() as folder:
            launch = os.path.join(PACKAGE, 'launch', f'{name}.launch')
            done = subprocess.run(
                ['roslaunch', launch, f'name:={name}_gripper', f'output:={folder}'],
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                text=True, timeout=LONGEST, check=False)
            path = os.path.join(folder, f'{name}_summary.yaml')
            self.assertTrue(os.path.exists(path), done.stdout)
            with open(path, encoding='utf-8') as file:
                summary = yaml.safe_load(file)
            self.assertEqual(summary['verdict'], 'ok', done.stdout)
        return summary

    def test_pick_and_place(self):
        self.assertAlmostEqual(self.play('pick_and_place')['objects']['box'][2], 0.12, delta=1e-3)

    def test_bottle(self):
        self.assertTrue(self.play('bottle')['sealed'])

    def test_ball(self):
        self.assertTrue(self.play('ball')['sealed'])

    def test_scan(self):
        self.assertTrue(self.play('scan')['sealed'])

    def test_edge(self):
        self.assertFalse(self.play('edge')['sealed'])

    def test_four_cups(self):
        self.assertAlmostEqual(self.play('four_cups')['objects']['box'][2], 0.03, delta=1e-3)

    def test_drag(self):
        self.assertAlmostEqual(self.play('drag')['friction'], 0.5, delta=0.015)


if __name__ == '__main__':
    rostest.rosrun('vacuum_gripper_sim', 'scenes_test', 'scenes_test', sys.argv)
