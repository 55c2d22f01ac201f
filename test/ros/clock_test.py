#!/usr/bin/python3
"""A gripper on a simulated clock that this test drives, stops and turns back."""

import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from gripper_client import ON, TOUCH, GripperClient, SealState, pose, wait_until

TICK = 0.01  # [s], the node's time step


class ClockTest(unittest.TestCase):
    """One story, in order: tests are numbered."""

    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        cls.gripper = GripperClient()
        cls.ticks = 1000
        wait_until(lambda: cls.clock.get_num_connections() >= 2, 'clock subscribed')
        cls.gripper.connect()  # The latched state comes without any clock.

    def publish(self):
        self.clock.publish(Clock(rospy.Time.from_sec(self.ticks * TICK)))

    def tick(self, count=1):
        """Advances the clock step by step and sees each step done."""
        for _ in range(count):
            self.__class__.ticks += 1
            goal = self.gripper.steps + 1
            self.publish()
            wait_until(lambda: self.gripper.steps >= goal, f'step {self.ticks}')

    def assert_stands_still(self, seconds=0.5):
        steps = self.gripper.steps
        time.sleep(seconds)
        self.assertEqual(self.gripper.steps, steps)

    def move(self, start, target, pieces=20):
        for i in range(1, pieces + 1):
            self.gripper.send(pose((0.0, 0.0, start + (target - start) * i / pieces)))
            time.sleep(0.01)
            self.tick(3)

    def test_1_no_step_without_a_clock(self):
        self.assert_stands_still()
        self.publish()  # the first reading starts the count; nothing has passed yet
        self.assert_stands_still()

    def test_2_a_step_a_tick(self):
        before = self.gripper.steps
        self.tick(50)
        self.assert_stands_still(0.3)
        self.assertEqual(self.gripper.steps - before, 50)
        stamp = self.gripper.wrench.header.stamp.to_sec()
        self.assertAlmostEqual(stamp, self.ticks * TICK, delta=1e-6)

    def test_3_grips_on_simulated_time(self):
        self.move(0.05, TOUCH - 0.001)
        self.gripper.set_pressure(ON)
        time.sleep(0.1)
        self.tick(60)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)

    def test_4_paused_clock(self):
        self.assert_stands_still(1.0)
        # Callbacks are served meanwhile ...
        self.gripper.set_pressure(5000.0)
        self.gripper.wait_warning('gauge_pressure', 'positive')
        # ... and who joins now gets the latched state.
        last = self.gripper.seal
        self.gripper.seal = None
        self.gripper.resubscribe_seal()
        wait_until(lambda: self.gripper.seal is not None, 'latched seal_state')
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)
        self.assertEqual(self.gripper.seal.header.stamp, last.header.stamp)
        self.assert_stands_still(0.3)
        self.tick(5)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)

    def test_5_small_leap(self):
        before = self.gripper.steps
        self.__class__.ticks += 5
        self.publish()
        wait_until(lambda: self.gripper.steps >= before + 5, 'five steps for five ticks at once')
        self.assert_stands_still(0.3)
        self.assertEqual(self.gripper.steps, before + 5)

    def test_6_huge_leap_is_bounded(self):
        before = self.gripper.steps
        self.__class__.ticks += 100000
        self.publish()
        wait_until(lambda: self.gripper.steps > before, 'steps')
        time.sleep(1.0)
        self.assertLess(self.gripper.steps - before, 100)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)
        self.tick(5)

    def test_7_jump_back_resets(self):
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)
        self.__class__.ticks = 500
        self.publish()
        self.gripper.wait_status(SealState.OPEN)
        self.gripper.wait_warning('jumped back')
        self.assertEqual(self.gripper.seal.setpoint, 0.0)
        self.assertAlmostEqual(self.gripper.seal.header.stamp.to_sec(), 5.0, delta=1e-6)
        self.tick(20)  # and it goes on
        self.gripper.set_pressure(ON)
        time.sleep(0.1)
        self.tick(60)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)

    def test_8_reset_while_paused(self):
        stamp = rospy.Time.from_sec(self.ticks * TICK)
        self.assertTrue(self.gripper.call('reset', Trigger).success)
        self.gripper.wait_status(SealState.OPEN)
        self.assertEqual(self.gripper.seal.header.stamp, stamp)
        self.assert_stands_still(0.3)


if __name__ == '__main__':
    rospy.init_node('clock_test')
    rostest.rosrun('vacuum_gripper_sim', 'clock_test', 'clock_test', sys.argv)
