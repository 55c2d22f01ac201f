#!/usr/bin/python3
"""A free box on a table: on tf, lifted, weighed by ~contact_wrenches, put back by ~reset."""

import math
import sys
import unittest

import rospy
import rostest
import tf2_ros
from std_srvs.srv import Trigger

from gripper_client import (ON, TOUCH, Broadcaster, GripperClient, SealState, angle_between, pose,
                            wait_until)
from vacuum_gripper_sim.msg import ContactWrenches

TABLE = 0.1  # [m] height of the table's upper face
FACE = TABLE + 0.04  # [m] of the box's
MASS = 0.1  # [kg]
YAW = (0.0, 0.0, math.sin(0.25), math.cos(0.25))  # of the box's joint


class FreeObjectTest(unittest.TestCase):
    """One story, told in order: the box comes, is lifted, reset, and the table jumps into the cup."""

    def setUp(self):
        self.gripper = GripperClient()
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.wrenches = None
        rospy.Subscriber('/vacuum_gripper/contact_wrenches', ContactWrenches,
                         lambda m: setattr(self, 'wrenches', m))
        self.gripper.connect()
        self.gripper.height = 0.2

    def box(self):
        """Position and quaternion of the box on tf; none if tf does not know it."""
        try:
            found = self.buffer.lookup_transform('world', 'box', rospy.Time(0)).transform
        except tf2_ros.TransformException:
            return None
        t, q = found.translation, found.rotation
        return (t.x, t.y, t.z), (q.x, q.y, q.z, q.w)

    def wrench(self, name):
        return {w.name: w for w in self.wrenches.wrenches}[name].wrench

    def at_start(self):
        found = self.box()
        return (found is not None and math.dist(found[0], (0.0, 0.0, TABLE + 0.02)) < 2e-5
                and angle_between(found[1], YAW) < 1e-3)

    def test_story(self):
        gripper = self.gripper
        # Nobody knows where the table is: neither it nor the box is in the world.
        gripper.wait_warning("'table'", 'free links')
        gripper.let_pass(50)
        self.assertIsNone(self.box())
        self.assertEqual(self.wrenches.wrenches, [])

        table = Broadcaster('world', 'table', [0.0, 0.0, TABLE])
        try:
            self.check_box_comes_to_rest()
            self.check_lift()
            self.check_reset()
            self.check_table_jumps_into_the_cup(table)
        finally:
            table.stop()

    def check_box_comes_to_rest(self):
        wait_until(self.at_start, 'the box on the table')
        self.gripper.let_pass(50)
        self.assertTrue(self.at_start(), self.box())
        self.assertEqual(self.wrenches.header.frame_id, 'world')
        self.assertEqual([w.name for w in self.wrenches.wrenches], ['table', 'box'])
        self.assertEqual([w.frame for w in self.wrenches.wrenches], ['table', 'box'])
        self.assertEqual(self.wrench('box').force.z, 0.0)  # nothing touches it

    def check_lift(self):
        gripper = self.gripper
        gripper.move(FACE + TOUCH - 0.001, speed=0.1)
        self.assertLess(self.wrench('box').force.z, -0.1)  # pressed down
        gripper.set_pressure(ON)
        gripper.wait_status(SealState.SEALED)
        gripper.move(FACE + 0.1, speed=0.1)
        gripper.let_pass(100)
        (_, _, z), _ = self.box()
        self.assertGreater(z, TABLE + 0.05)
        force = self.wrench('box').force
        self.assertAlmostEqual(force.z, MASS * 9.81, delta=0.01)
        # Turned by the box's yaw against the world: no part of a vertical force.
        self.assertLess(math.hypot(force.x, force.y), 0.02)
        # The mount carries the box and the cup's own weight: z of cup_frame points down.
        weight_of_cup = gripper.force()[2] - MASS * 9.81
        self.assertGreater(weight_of_cup, 0.02)
        self.assertLess(weight_of_cup, 0.1)
        self.assertEqual(self.wrench('table').force.z, 0.0)

    def check_reset(self):
        gripper = self.gripper
        response = gripper.call('reset', Trigger)
        self.assertTrue(response.success)
        self.assertIn('free objects', response.message)
        wait_until(self.at_start, 'the box where it began')
        gripper.let_pass(50)
        self.assertTrue(self.at_start(), self.box())
        self.assertEqual(gripper.seal.status, SealState.OPEN)

    def check_table_jumps_into_the_cup(self, table):
        gripper = self.gripper
        gripper.move(FACE + 0.1)
        gripper.warnings = []
        table.position[2] = TABLE + 0.15
        gripper.wait_warning('step undone', "'table' was moved by")
        table.position[2] = TABLE
        gripper.call('reset', Trigger)
        wait_until(self.at_start, 'the box where it began')
        gripper.send(pose((0.0, 0.0, FACE + 0.05)))
        gripper.let_pass(50)
        self.assertTrue(all(math.isfinite(f) for f in gripper.force()))
        self.assertLess(abs(gripper.force()[2]), 0.2)  # hangs free


if __name__ == '__main__':
    rospy.init_node('free_object_test')
    rostest.rosrun('vacuum_gripper_sim', 'free_object_test', 'free_object_test', sys.argv)
