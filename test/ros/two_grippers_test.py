#!/usr/bin/python3
"""Two grippers in one graph do not hear each other."""

import sys
import unittest

import rospy
import rostest
import tf2_ros

from gripper_client import ON, TOUCH, GripperClient, SealState, wait_until


class TwoGrippersTest(unittest.TestCase):
    def test_two_names_are_two_grippers(self):
        left, right = GripperClient('/left'), GripperClient('/arm/right')
        left.connect()
        right.connect()
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)

        left.move(TOUCH - 0.001)
        left.set_pressure(ON)
        right.set_pressure(2.0 * ON)
        left.wait_status(SealState.SEALED)
        wait_until(lambda: right.seal.setpoint == 2.0 * ON, 'set-point of the other')
        self.assertEqual(left.seal.setpoint, ON)
        self.assertEqual(right.seal.status, SealState.OPEN)
        self.assertEqual(left.wrench.header.frame_id, 'left_mount')
        self.assertEqual(right.wrench.header.frame_id, 'right_mount')
        for frame, height in (('left_mount', TOUCH - 0.001), ('right_mount', 0.05)):
            wait_until(lambda: buffer.can_transform('world', frame, rospy.Time(0)), frame)
            z = buffer.lookup_transform('world', frame, rospy.Time(0)).transform.translation.z
            self.assertAlmostEqual(z, height, delta=1e-9)

        right.move(TOUCH - 0.001)
        right.call('on')
        # It may have sealed at its earlier set-point already, and then goes to the new one.
        wait_until(lambda: right.seal.setpoint == ON and right.seal.status == SealState.SEALED,
                   'sealed at the default set-point')
        left.call('off')
        left.wait_status(SealState.OPEN)
        self.assertEqual(right.seal.status, SealState.SEALED)
        del listener


if __name__ == '__main__':
    rospy.init_node('two_grippers_test')
    rostest.rosrun('vacuum_gripper_sim', 'two_grippers_test', 'two_grippers_test', sys.argv)
