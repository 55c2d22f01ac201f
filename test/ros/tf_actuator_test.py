#!/usr/bin/python3
"""A mount that follows a tf frame, as on a robot's tool."""

import statistics
import sys
import time
import unittest

import rospy
import rosgraph
import rostest
import tf2_ros
from geometry_msgs.msg import WrenchStamped

from gripper_client import DOWN, ON, TOUCH, GripperClient, SealState, transform


class TfActuatorTest(unittest.TestCase):
    def test_follows_the_tool(self):
        gripper = GripperClient()
        gripper.connect(pose_command=False)
        # Without tf: alive, waiting, and it says for what.
        gripper.wait_warning('mount_frame', 'tool')
        gripper.let_pass(20)
        subscribed = {topic for topic, nodes in rosgraph.Master('/test').getSystemState()[1]
                      if '/vacuum_gripper' in nodes}
        self.assertNotIn('/vacuum_gripper/pose_command', subscribed)
        self.assertIn('/vacuum_gripper/pressure_setpoint', subscribed)

        broadcaster = tf2_ros.TransformBroadcaster()

        def go(height, target, speed=0.02):
            pieces = max(1, int(abs(target - height) / speed * 50.0))
            for i in range(1, pieces + 1):
                z = height + (target - height) * i / pieces
                broadcaster.sendTransform(transform('world', 'tool', (0.3, -0.2, z), DOWN))
                time.sleep(0.02)
            gripper.let_pass(30)

        go(0.04, TOUCH - 0.001)
        gripper.set_pressure(ON)
        gripper.wait_status(SealState.SEALED)
        go(TOUCH - 0.001, TOUCH + 0.001)
        self.assertGreater(gripper.force()[2], 1.0)
        # Its frame belongs to the robot: the node broadcasts nothing.
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        time.sleep(1.0)
        self.assertFalse(buffer.can_transform('world', 'cup_mount', rospy.Time(0)))
        del listener
        go(TOUCH + 0.001, TOUCH + 0.02)
        gripper.wait_status(SealState.LOST)

        # Evenly, although tf is rarer than steps: the cup's mass would answer every jerk.
        forces = []
        subscriber = rospy.Subscriber('/vacuum_gripper/wrench', WrenchStamped,
                                      lambda message: forces.append(message.wrench.force.z))
        go(TOUCH + 0.02, 0.3, speed=0.1)
        subscriber.unregister()
        steady = forces[len(forces) // 4:len(forces) // 2]  # up there, on its way
        changes = [abs(after - before) for before, after in zip(steady, steady[1:])]
        self.assertLess(statistics.mean(changes), 0.05)  # [N] 0.003, and 0.18 with jerks


if __name__ == '__main__':
    rospy.init_node('tf_actuator_test')
    rostest.rosrun('vacuum_gripper_sim', 'tf_actuator_test', 'tf_actuator_test', sys.argv)
