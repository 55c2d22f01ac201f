#!/usr/bin/python3
"""A plate from a URDF that tf places, moves and loses."""

import sys
import time

import rospy
import rostest

from gripper_client import ON, TOUCH, Broadcaster, GripTestCase, SealState, pose, wait_until


class SceneTest(GripTestCase):
    def test_plate_comes_moves_and_is_lost(self):
        gripper = self.gripper
        # tf does not know the plate yet: the node runs and says so, and there is nothing to touch.
        gripper.move(TOUCH - 0.002)
        gripper.wait_warning('plate', 'left out')
        self.assertEqual(gripper.seal.num_contacts, 0)
        gripper.move(0.13)

        plate = Broadcaster('world', 'plate', [0.0, 0.0, 0.1])
        try:
            wait_until(lambda: gripper.send(pose((0.0, 0.0, 0.1 + TOUCH - 0.001)))
                       or gripper.seal.num_contacts > 10, 'contact with the plate at 0.1 m')
            gripper.let_pass(30)
            gripper.set_pressure(ON)
            gripper.wait_status(SealState.SEALED)

            # The plate rises and pushes, the mount stands still.
            before = gripper.force()[2]
            for _ in range(10):
                plate.position[2] += 0.0001
                time.sleep(0.05)
            gripper.let_pass(30)
            self.assertEqual(gripper.seal.status, SealState.SEALED)
            self.assertLess(gripper.force()[2], before)

            # It is lost by tf: it stays where it was.
            plate.stop()
            gripper.warnings = []
            gripper.wait_warning('plate', 'stays where it was last seen')
            gripper.let_pass(30)
            self.assertEqual(gripper.seal.status, SealState.SEALED)

            # It comes back and sinks out of reach.
            plate = Broadcaster('world', 'plate', plate.position)
            for _ in range(60):
                plate.position[2] -= 0.0003
                time.sleep(0.05)
            gripper.wait_status(SealState.LOST)
            gripper.let_pass(30)
            self.assertEqual(gripper.seal.num_contacts, 0)
        finally:
            plate.stop()


if __name__ == '__main__':
    rospy.init_node('scene_test')
    rostest.rosrun('vacuum_gripper_sim', 'scene_test', 'scene_test', sys.argv)
