#!/usr/bin/python3
"""A gripper asked for ten thousand quadratic steps a second, which no machine makes: it says so."""

import math
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from gripper_client import GripperClient, wait_until

START_UP = 10000  # steps that do not count: a second of simulated time


class OverloadTest(unittest.TestCase):
    def setUp(self):
        self.statuses = []
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics)

    def on_diagnostics(self, message):
        self.statuses.extend(s for s in message.status if s.name.startswith('vacuum_gripper:'))

    def values(self):
        return {value.key: value.value for value in self.statuses[-1].values}

    def test_steps_longer_than_their_period_are_counted(self):
        gripper = GripperClient()
        gripper.connect()
        wait_until(lambda: self.statuses and int(self.values()['steps']) > START_UP + 500,
                   'steps that count', 120.0)
        status, values = self.statuses[-1], self.values()
        counted = int(values['steps']) - START_UP
        overlong = int(values['steps computed longer than their period'])
        self.assertLessEqual(overlong, counted)
        self.assertGreater(overlong, 0.9 * counted)
        self.assertGreater(int(values['missed deadlines']), 0.9 * counted)
        self.assertLess(float(values['real-time factor']), 1.0)
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertRegex(status.message, r'^late: [1-9]\d* deadlines missed, .* [1-9]\d* steps '
                                         r'computed for longer than their period$')
        self.assertTrue(all(map(math.isfinite, gripper.force())))


if __name__ == '__main__':
    rospy.init_node('overload_test')
    rostest.rosrun('vacuum_gripper_sim', 'overload_test', 'overload_test', sys.argv)
