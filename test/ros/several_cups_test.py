#!/usr/bin/python3
"""Two cups on one gripper, one of them turned by 90 degrees about its axis, above the plane z = 0."""

import math
import sys

import rospy
import rostest
import tf2_ros

from gripper_client import (ON, TOUCH, GripperClient, GripTestCase, SealState, pose, wait_until)

AMBIENT = 101325.0  # [Pa]


def vector(message):
    return (message.x, message.y, message.z)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turn(q, v):
    """v turned by a quaternion."""
    axis, w = (q.x, q.y, q.z), q.w
    t = tuple(2.0 * c for c in cross(axis, v))
    return add(add(v, tuple(w * c for c in t)), cross(axis, t))


class SeveralCupsTest(GripTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # A cup's topics are a gripper's, below its own name.
        cls.cups = [GripperClient(f'{cls.gripper.name}/cups/{name}') for name in ('left', 'right')]
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        for cup in cls.cups:
            wait_until(lambda cup=cup: cup.seal and cup.wrench and cup.pressure, cup.name)

    def assert_sums(self):
        """Force, torque and seal of the gripper are those of its cups, placed by tf."""
        force = torque = (0.0, 0.0, 0.0)
        for cup in self.cups:
            frame = cup.wrench.header.frame_id
            X = self.buffer.lookup_transform('cup_mount', frame, rospy.Time(0)).transform
            f = turn(X.rotation, vector(cup.wrench.wrench.force))
            force = add(force, f)
            torque = add(torque, turn(X.rotation, vector(cup.wrench.wrench.torque)))
            torque = add(torque, cross(vector(X.translation), f))
        sum_ = self.gripper.wrench.wrench
        for found, wish in zip(vector(sum_.force) + vector(sum_.torque), force + torque):
            self.assertAlmostEqual(found, wish, delta=1e-4)
        for field in ('cavity_area', 'cavity_volume', 'contact_force', 'num_contacts'):
            self.assertAlmostEqual(getattr(self.gripper.seal, field),
                                   sum(getattr(cup.seal, field) for cup in self.cups), delta=1e-4)

    def test_frames_are_those_of_the_list(self):
        for cup, x in zip(self.cups, (-0.03, 0.03)):
            frame = 'cup_mount/' + cup.name.rsplit('/', 1)[1]
            self.assertEqual(cup.wrench.header.frame_id, frame)
            self.assertEqual(cup.seal.header.frame_id, frame)
            self.assertEqual(cup.pressure.header.frame_id, frame)
            wait_until(lambda frame=frame: self.buffer.can_transform('world', frame, rospy.Time(0)),
                       f'{frame} on tf')
            X = self.buffer.lookup_transform('cup_mount', frame, rospy.Time(0)).transform
            self.assertEqual(vector(X.translation), (x, 0.0, 0.0))

    def test_both_seal_and_the_gripper_is_their_sum(self):
        self.seal()
        self.gripper.let_pass(60)
        for cup in self.cups:
            self.assertEqual(cup.seal.status, SealState.SEALED)
            self.assertEqual(cup.seal.setpoint, ON)
            self.assertEqual(cup.pressure.fluid_pressure, AMBIENT + ON)
            self.assertGreater(cup.wrench.wrench.force.z, 1.0)
        self.assert_sums()
        self.assertTrue(self.gripper.grasping)
        self.gripper.call('off')
        for cup in self.cups:
            cup.wait_status(SealState.OPEN)

    def test_one_in_the_air_leaves_the_grip_to_the_other(self):
        # Tilted about y of the world, so that the right cup is 5 mm higher.
        half = math.radians(-5.0) / 2.0
        self.gripper.send(pose((0.0, 0.0, TOUCH - 0.0002),
                               orientation=(math.cos(half), 0.0, -math.sin(half), 0.0)))
        self.gripper.let_pass(60)
        self.gripper.set_pressure(ON)
        left, right = self.cups
        left.wait_status(SealState.SEALED)
        self.gripper.let_pass(60)
        self.assertEqual(right.seal.status, SealState.OPEN)
        self.assertEqual(right.pressure.fluid_pressure, AMBIENT)
        self.assertEqual(left.pressure.fluid_pressure, AMBIENT + ON)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)
        self.assertEqual(self.gripper.pressure.fluid_pressure, AMBIENT + ON)
        # Where the gripper is open is where the open cup is.
        # (The two messages may be of two steps, which differ in the last digits.)
        self.assertAlmostEqual(self.gripper.seal.opening_gap, right.seal.opening_gap, delta=1e-9)
        self.assert_sums()


if __name__ == '__main__':
    rospy.init_node('several_cups_test')
    rostest.rosrun('vacuum_gripper_sim', 'several_cups_test', SeveralCupsTest, sys.argv)
