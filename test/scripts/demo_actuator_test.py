#!/usr/bin/python3
"""What scripts/demo_actuator makes of the gripper's messages, without a graph."""

import importlib.machinery
import importlib.util
import pathlib
import unittest
from unittest import mock

import rospy
from geometry_msgs.msg import WrenchStamped

from vacuum_gripper_sim.msg import SealState

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / 'scripts' / 'demo_actuator'


def load(path):
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(path.name, loader))
    loader.exec_module(module)
    return module


class Steps:
    """Of a gripper that is no node: its callbacks, and the rows that it writes."""

    def __init__(self):
        subscribed = {}
        self.rows = mock.Mock()
        with mock.patch.multiple(
                rospy, Publisher=mock.DEFAULT, ServiceProxy=mock.DEFAULT,
                Subscriber=lambda topic, _type, callback, **_: subscribed.update(
                    {topic: callback})):
            self.gripper = load(SCRIPT).Gripper('cup', self.rows)
        self._on_wrench, self._on_seal = subscribed['cup/wrench'], subscribed['cup/seal_state']

    def wrench(self, step, force):
        message = WrenchStamped()
        message.header.stamp = rospy.Time.from_sec(100.0 + step)
        message.wrench.force.z = force
        self._on_wrench(message)

    def seal(self, step):
        message = SealState()
        message.header.stamp = rospy.Time.from_sec(100.0 + step)
        self._on_seal(message)

    def written(self):
        """(time, force z) of every row."""
        return [(float(row[0]), float(row[9]))
                for (row,), _ in self.rows.writerow.call_args_list]


class DemoActuatorTest(unittest.TestCase):
    def test_writes_every_step_whichever_message_comes_first(self):
        steps = Steps()
        steps.wrench(0, 1.0)
        steps.seal(0)
        steps.seal(1)
        steps.wrench(1, 2.0)
        steps.seal(2)
        steps.seal(3)
        steps.wrench(2, 3.0)
        steps.wrench(3, 4.0)
        self.assertEqual(steps.written(), [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (3.0, 4.0)])
        self.assertEqual(steps.gripper.force_z, 4.0)

    def test_a_state_without_a_step_makes_no_row(self):
        steps = Steps()
        steps.seal(0)  # of a reset
        steps.seal(1)
        steps.wrench(1, 2.0)
        self.assertEqual(steps.written(), [(0.0, 2.0)])

    def test_the_peak_is_of_all_steps_of_the_lift(self):
        steps = Steps()
        steps.gripper.label = ('1', 'lift')
        steps.seal(0)
        steps.wrench(0, 5.0)
        steps.wrench(1, 2.0)
        steps.seal(1)
        self.assertEqual(steps.gripper.peak_force_z, 5.0)


if __name__ == '__main__':
    unittest.main()
