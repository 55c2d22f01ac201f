#!/usr/bin/python3
"""Suction, wrench, services, refusals and displays of a gripper above the default plane."""

import math
import sys
import time

import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from vacuum_gripper_sim.msg import HoldingMargin

from gripper_client import (OFF, ON, TOUCH, GripTestCase, SealState, angle_between, pose,
                            transform, wait_until)

AMBIENT = 101325.0
LISTENER = {}


def tf_buffer():
    if not LISTENER:
        LISTENER['buffer'] = tf2_ros.Buffer()
        LISTENER['listener'] = tf2_ros.TransformListener(LISTENER['buffer'])
        LISTENER['static'] = tf2_ros.StaticTransformBroadcaster()
        # The table stands on its side and is turned: no axis keeps its name.
        LISTENER['static'].sendTransform(
            transform('world', 'table', (0.1, 0.2, 0.3), (0.5, 0.5, 0.5, 0.5)))
    return LISTENER['buffer']


def cup_pose():
    """Where tf has the mount in the world; waits for tf at the start."""
    buffer = tf_buffer()
    wait_until(lambda: buffer.can_transform('world', 'cup_mount', rospy.Time(0)), 'tf of the cup')
    return buffer.lookup_transform('world', 'cup_mount', rospy.Time(0)).transform


class HoldingMarginTest(GripTestCase):
    """What is left of a grip, and that pulling uses it up."""

    def setUp(self):
        super().setUp()
        self.margins = []
        self.subscriber = rospy.Subscriber(f'{self.gripper.name}/holding_margin', HoldingMargin,
                                           self.margins.append)

    def tearDown(self):
        self.subscriber.unregister()
        super().tearDown()

    def next_margin(self, holds):
        self.margins.clear()
        now = rospy.Time.now()
        wait_until(lambda: self.margins and self.margins[-1].holds == holds
                   and self.margins[-1].header.stamp >= now, f'a margin with holds = {holds}')
        return self.margins[-1]

    def test_shrinks_as_the_mount_pulls(self):
        self.assertEqual(self.next_margin(False).normal_force, 0.0)
        self.seal()
        pressed = self.next_margin(True)
        self.assertEqual(pressed.header.frame_id, 'cup_mount')
        self.assertGreater(pressed.normal_force, 1.0)
        self.assertLess(pressed.normal_force, 10.0)
        self.assertGreaterEqual(pressed.shear_force, 0.0)
        self.assertGreaterEqual(pressed.tilting_moment, 0.0)
        force = self.gripper.wrench.wrench.force.z
        self.gripper.move(TOUCH + 0.003)
        pulled = self.next_margin(True)
        gained = self.gripper.wrench.wrench.force.z - force
        self.assertGreater(gained, 0.3)
        # What bears more already has less left.
        self.assertAlmostEqual(pressed.normal_force - pulled.normal_force, gained,
                               delta=0.15 * pressed.normal_force)


class SuctionTest(GripTestCase):
    def test_seals_and_vents(self):
        self.assertEqual(self.gripper.seal.status, SealState.OPEN)
        self.seal()
        seal = self.gripper.seal
        self.assertAlmostEqual(seal.gauge_pressure, ON, delta=1.0)
        self.assertEqual(seal.setpoint, ON)
        self.assertEqual(seal.header.frame_id, 'cup_mount')
        self.assertGreater(seal.cavity_area, 5.0e-4)
        self.assertLess(seal.cavity_area, 1.3e-3)  # the lip's disc is 1257 mm^2
        self.assertGreater(seal.cavity_volume, 0.0)
        self.assertGreater(seal.contact_force, 1.0)
        self.assertGreater(seal.num_contacts, 10)
        self.assertGreater(sum(seal.zone_counts), 50)
        wait_until(lambda: abs(self.gripper.pressure.fluid_pressure - AMBIENT - ON) < 1.0,
                   'absolute pressure')
        wait_until(lambda: self.gripper.grasping, 'grasping')

        self.gripper.set_pressure(OFF)
        self.gripper.wait_status(SealState.OPEN)
        wait_until(lambda: self.gripper.pressure.fluid_pressure == AMBIENT, 'ambient pressure')
        wait_until(lambda: not self.gripper.grasping, 'not grasping')

    def test_suction_in_the_air_does_nothing(self):
        self.gripper.set_pressure(ON)
        self.gripper.let_pass(50)
        self.assertEqual(self.gripper.seal.status, SealState.OPEN)
        self.assertEqual(self.gripper.seal.gauge_pressure, 0.0)
        self.assertEqual(self.gripper.seal.setpoint, ON)
        self.assertFalse(self.gripper.grasping)

    def test_pull_until_lost(self):
        self.seal()
        self.gripper.move(TOUCH)
        held = self.gripper.force()[2]
        self.gripper.move(TOUCH + 0.015)
        self.gripper.wait_status(SealState.LOST)
        wait_until(lambda: not self.gripper.grasping, 'not grasping')
        self.gripper.let_pass(20)
        self.assertGreater(held, 1.0)
        self.assertLess(abs(self.gripper.force()[2]), 0.2)  # only its own weight is left
        self.gripper.set_pressure(OFF)
        self.gripper.wait_status(SealState.OPEN)

    def test_wrench_sign_and_frame(self):
        self.gripper.move(TOUCH + 0.005)
        wrench = self.gripper.wrench
        self.assertEqual(wrench.header.frame_id, 'cup_mount')
        self.assertLess(abs((rospy.Time.now() - wrench.header.stamp).to_sec()), 5.0)
        # Points down: the cup's own weight pulls at the mount along +z of cup_frame.
        weight = self.gripper.force()[2]
        self.assertGreater(weight, 0.01)
        self.assertLess(weight, 0.2)
        self.gripper.move(TOUCH - 0.001)
        self.assertLess(self.gripper.force()[2], -0.1)  # pressed: pushes the mount away
        self.gripper.set_pressure(ON)
        self.gripper.wait_status(SealState.SEALED)
        self.gripper.move(TOUCH + 0.001)
        force = self.gripper.force()
        self.assertGreater(force[2], 1.0)  # pulled up: pulls its mount towards the object
        self.assertLess(math.hypot(force[0], force[1]), 0.1)

    def test_steps_at_the_rate_of_ros_time(self):
        first = self.gripper.seal
        stamps = []
        for _ in range(5):
            self.gripper.let_pass(20)
            stamps.append(self.gripper.wrench.header.stamp)
        self.assertEqual(stamps, sorted(stamps))
        self.assertGreater(stamps[0], first.header.stamp)


class CommandTest(GripTestCase):
    def assert_stays(self, seconds_of_steps=20):
        """The node lives on and neither pose nor set-point has changed."""
        self.gripper.let_pass(seconds_of_steps)
        found = cup_pose()
        self.assertAlmostEqual(found.translation.x, 0.0, delta=1e-9)
        self.assertAlmostEqual(found.translation.z, 0.05, delta=1e-9)

    def test_pose_in_another_frame(self):
        buffer = tf_buffer()
        wait_until(lambda: buffer.can_transform('world', 'table', rospy.Time(0)), 'table on tf')
        # table's axes x y z are world's y z x; the cup is turned about z of the table.
        half = math.sqrt(0.5)
        self.gripper.send(pose((0.01, 0.02, 0.03), frame='table',
                               orientation=(0.0, 0.0, half, half)))

        def arrived():
            found = buffer.lookup_transform('table', 'cup_mount', rospy.Time(0)).transform
            t, q = found.translation, found.rotation
            return (math.dist((t.x, t.y, t.z), (0.01, 0.02, 0.03)) < 1e-6
                    and angle_between((q.x, q.y, q.z, q.w), (0.0, 0.0, half, half)) < 1e-4)
        wait_until(arrived, 'cup_mount at the pose in table')
        found = cup_pose().translation
        for value, expected in zip((found.x, found.y, found.z), (0.13, 0.21, 0.32)):
            self.assertAlmostEqual(value, expected, delta=1e-6)

    def test_far_command_is_a_motion(self):
        self.gripper.send(pose((0.0, 0.0, 1.05)))  # a metre at max_speed 1 m/s: 100 steps
        begin = self.gripper.steps
        heights = []

        def arrived():
            heights.append(cup_pose().translation.z)
            return abs(heights[-1] - 1.05) < 1e-9
        wait_until(arrived, 'mount at 1.05 m')
        self.assertGreater(self.gripper.steps - begin, 80)
        self.assertEqual(heights, sorted(heights))

    def test_setpoint_refusals(self):
        self.gripper.set_pressure(-3000.0)
        wait_until(lambda: self.gripper.seal.setpoint == -3000.0, 'set-point accepted')
        for value, word in ((float('nan'), 'finite'), (float('-inf'), 'finite'),
                            (5000.0, 'positive'), (-90000.1, 'min_pressure')):
            with self.subTest(value=value):
                self.gripper.warnings = []
                self.gripper.set_pressure(value)
                self.gripper.wait_warning('pressure_setpoint', 'gauge_pressure', word, '-90000')
                self.gripper.let_pass(10)
                self.assertEqual(self.gripper.seal.setpoint, -3000.0)
                time.sleep(1.1)  # warnings are throttled
        self.gripper.set_pressure(-90000.0)
        wait_until(lambda: self.gripper.seal.setpoint == -90000.0, 'the limit itself accepted')

    def test_pose_refusals(self):
        nan = float('nan')
        cases = {
            'pose.position.y = nan': pose((0.0, nan, 0.1)),
            'pose.position.z = inf': pose((0.0, 0.0, math.inf)),
            'pose.orientation.w = nan': pose((0.0, 0.0, 0.1), orientation=(1.0, 0.0, 0.0, nan)),
            'norm 0,': pose((0.0, 0.0, 0.1), orientation=(0.0, 0.0, 0.0, 0.0)),
            'norm 1.0': pose((0.0, 0.0, 0.1), orientation=(1.0015, 0.0, 0.0, 0.0)),
            "'nowhere'": pose((0.0, 0.0, 0.1), frame='nowhere'),
            'frame_id is empty': pose((0.0, 0.0, 0.1), frame=''),
            "'/world'": pose((0.0, 0.0, 0.1), frame='/world'),
        }
        for words, message in cases.items():
            with self.subTest(words):
                self.gripper.warnings = []
                self.gripper.send(message)
                self.gripper.wait_warning('pose_command refused', words)
                self.assert_stays()
                time.sleep(1.1)

    def test_almost_unit_quaternion_is_accepted(self):
        self.gripper.send(pose((0.0, 0.0, 0.07), orientation=(1.0009, 0.0, 0.0, 0.0)))
        wait_until(lambda: abs(cup_pose().translation.z - 0.07) < 1e-9, 'moved')
        self.assertAlmostEqual(cup_pose().rotation.x, 1.0, delta=1e-9)

    def test_on_off_grasping(self):
        self.gripper.move(TOUCH - 0.001)
        self.gripper.call('on')
        self.gripper.wait_status(SealState.SEALED)
        self.assertEqual(self.gripper.seal.setpoint, -6000.0)
        wait_until(lambda: self.gripper.grasping, 'grasping')
        self.gripper.call('off')
        self.gripper.wait_status(SealState.OPEN)
        self.assertEqual(self.gripper.seal.setpoint, 0.0)
        wait_until(lambda: not self.gripper.grasping, 'not grasping')

    def test_reset(self):
        self.seal()
        before = self.gripper.seal.header.stamp
        response = self.gripper.call('reset', Trigger)
        self.assertTrue(response.success)
        self.assertIn('0.019', response.message)
        self.gripper.wait_status(SealState.OPEN)
        self.assertEqual(self.gripper.seal.setpoint, 0.0)
        wait_until(lambda: not self.gripper.grasping, 'not grasping')
        self.gripper.let_pass(5)
        self.assertGreater(self.gripper.seal.header.stamp, before)  # time goes on
        self.gripper.set_pressure(ON)  # and it works again, at the same pose
        self.gripper.wait_status(SealState.SEALED)


class DisplayTest(GripTestCase):
    def test_late_joiner_gets_latched_grasping(self):
        self.seal()
        wait_until(lambda: self.gripper.grasping, 'grasping')
        received = []
        subscriber = rospy.Subscriber('/vacuum_gripper/grasping', Bool,
                                      lambda m: received.append(m.data))
        wait_until(lambda: received, 'latched grasping')
        self.assertEqual(received, [True])
        subscriber.unregister()

    def test_markers_while_somebody_listens(self):
        self.seal()
        arrays = []
        subscriber = rospy.Subscriber('/vacuum_gripper/markers', MarkerArray, arrays.append)
        wait_until(lambda: len(arrays) >= 5, 'markers')
        subscriber.unregister()
        markers = {marker.ns: marker for marker in arrays[-1].markers}
        self.assertEqual(set(markers), {'deformed_mesh', 'zones', 'wrench'})
        mesh = markers['deformed_mesh']
        self.assertEqual(mesh.type, Marker.TRIANGLE_LIST)
        self.assertEqual(mesh.header.frame_id, 'world')
        self.assertGreater(len(mesh.points), 300)
        self.assertEqual(len(mesh.points) % 3, 0)
        self.assertEqual(len(mesh.colors), len(mesh.points))
        self.assertEqual((mesh.scale.x, mesh.scale.y, mesh.scale.z), (1.0, 1.0, 1.0))
        for array in arrays:
            for marker in array.markers:
                for point in marker.points:
                    self.assertTrue(math.isfinite(point.x + point.y + point.z))
        counts = {len(marker.points) for array in arrays for marker in array.markers
                  if marker.ns == 'deformed_mesh'}
        self.assertEqual(len(counts), 1)
        arrow = markers['wrench']
        self.assertEqual(arrow.type, Marker.ARROW)
        self.assertLess(arrow.points[1].z, arrow.points[0].z)  # towards the plane

        arrays.clear()
        self.gripper.let_pass(50)
        self.assertEqual(arrays, [])
        subscriber = rospy.Subscriber('/vacuum_gripper/markers', MarkerArray, arrays.append)
        wait_until(lambda: len(arrays) >= 2, 'markers again')
        subscriber.unregister()

    def test_surface_points(self):
        self.seal()
        clouds = []
        subscriber = rospy.Subscriber('/vacuum_gripper/surface_points', PointCloud2, clouds.append)
        wait_until(lambda: len(clouds) >= 3, 'surface points')
        subscriber.unregister()
        cloud = clouds[-1]
        types = {field.name: field.datatype for field in cloud.fields}
        self.assertEqual(types, {'x': PointField.FLOAT32, 'y': PointField.FLOAT32,
                                 'z': PointField.FLOAT32, 'gap': PointField.FLOAT32,
                                 'rgb': PointField.FLOAT32, 'zone': PointField.UINT8})
        self.assertEqual(cloud.header.frame_id, 'world')
        points = list(point_cloud2.read_points(cloud, field_names=('x', 'y', 'z', 'gap', 'zone')))
        self.assertEqual(len(points), sum(self.gripper.seal.zone_counts))
        for x, y, z, gap, zone in points:
            self.assertLess(math.hypot(x, y), 0.03)
            self.assertIn(zone, range(5))
            self.assertAlmostEqual(gap, z, delta=1e-6)  # above the plane z = 0
        self.assertIn(4, {point[4] for point in points})  # sealed: some are strictly inside

    def test_diagnostics(self):
        self.gripper.set_pressure(OFF)
        statuses = []
        subscriber = rospy.Subscriber(
            '/diagnostics', DiagnosticArray,
            lambda m: statuses.extend(s for s in m.status if s.name.startswith('vacuum_gripper:')))
        wait_until(lambda: len(statuses) >= 2, 'diagnostics')
        subscriber.unregister()
        values = {value.key: value.value for value in statuses[-1].values}
        for key in ('step time mean [ms]', 'step time 99th percentile [ms]',
                    'posting share [%]', 'publishing share [%]', 'step budget [ms]',
                    'missed deadlines', 'missed by steps that only began late',
                    'steps computed longer than their period',
                    'real-time factor', 'contacts', 'solver iterations max',
                    'solver residual max [m]', 'set-point age [s]'):
            self.assertIn(key, values)
            self.assertTrue(math.isfinite(float(values[key])), key)
        self.assertAlmostEqual(float(values['step budget [ms]']), 10.0, delta=1e-6)
        self.assertIn(statuses[-1].level, (DiagnosticStatus.OK, DiagnosticStatus.WARN))


if __name__ == '__main__':
    rospy.init_node('grip_test')
    rostest.rosrun('vacuum_gripper_sim', 'grip_test', 'grip_test', sys.argv)
