#!/usr/bin/python3
"""A gripper with an ejector, as a program sees it that knows ~grip, ~drop and ~vacuum_state only, and
what its faults make of it."""

import sys

import rospy
import rostest
from std_srvs.srv import Trigger

from gripper_client import PATIENCE, TOUCH, GripTestCase, SealState, wait_until
from vacuum_gripper_sim.msg import VacuumState
from vacuum_gripper_sim.srv import SetFault, SetFaultRequest

AMBIENT = 101325.0  # [Pa]
ULTIMATE = -50000.0  # [Pa], of the ejector


class VacuumTest(GripTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.states = []
        rospy.Subscriber(f'{cls.gripper.name}/vacuum_state', VacuumState, cls.states.append)
        rospy.wait_for_service(f'{cls.gripper.name}/set_fault', timeout=PATIENCE)
        cls.set_fault = staticmethod(rospy.ServiceProxy(f'{cls.gripper.name}/set_fault', SetFault))
        wait_until(lambda: cls.states, 'a vacuum state')

    def setUp(self):
        for fault in ('pump_lost', 'hose_kinked', 'cup_torn', 'dirty_lip', 'porous_object',
                      'sensor_stuck'):
            self.assertTrue(self.fault(fault, active=False).success)
        super().setUp()

    def fault(self, fault, active=True, **numbers):
        return self.set_fault(SetFaultRequest(fault=fault, active=active, **numbers))

    def wait_state(self, condition, what):
        wait_until(lambda: condition(self.states[-1]), what)
        return self.states[-1]

    def grip(self):
        self.gripper.move(TOUCH - 0.001)
        answer = self.gripper.call('grip', Trigger)
        self.assertTrue(answer.success)
        self.assertIn('-40000 Pa', answer.message)
        return self.wait_state(
            lambda s: s.in_control_range and s.gauge_pressure < ULTIMATE + 1000.0, 'all the vacuum')

    def test_grip_and_drop(self):
        state = self.grip()
        self.assertTrue(state.part_present)
        self.assertFalse(state.part_detached)
        self.assertEqual(state.header.frame_id, 'cup_mount')
        self.assertAlmostEqual(state.absolute_pressure, AMBIENT + state.gauge_pressure, delta=1e-6)
        self.assertAlmostEqual(state.actual_power, -state.gauge_pressure / AMBIENT, delta=1e-9)
        self.assertEqual(self.gripper.seal.status, SealState.SEALED)

        answer = self.gripper.call('drop', Trigger)
        self.assertTrue(answer.success)
        self.assertIn('blow-off for 0.1 s', answer.message)
        state = self.wait_state(lambda s: s.part_detached, 'detached')
        self.assertFalse(state.part_present)
        self.assertFalse(state.in_control_range)
        # The pulse of compressed air shows.
        self.assertGreater(max(s.gauge_pressure for s in self.states), 1000.0)

    def test_in_the_air_nothing_is_present(self):
        self.states.clear()
        self.assertTrue(self.gripper.call('grip', Trigger).success)
        wait_until(lambda: self.states and self.states[-1].flow > 1.0e-4, 'flow')
        self.gripper.let_pass(50)
        self.assertFalse(any(s.part_present or s.in_control_range for s in self.states))

    def test_comes_at_the_sensors_rate(self):
        begin, steps = len(self.states), self.gripper.steps
        self.gripper.let_pass(100)
        ratio = (len(self.states) - begin) / (self.gripper.steps - steps)
        self.assertAlmostEqual(ratio, 0.5, delta=0.1)

    def test_a_lost_pump_ends_the_grip_and_comes_back(self):
        self.grip()
        self.assertTrue(self.fault('pump_lost').success)
        self.wait_state(lambda s: s.part_detached, 'detached')
        self.assertEqual(self.gripper.seal.status, SealState.LOST)
        self.assertTrue(self.fault('pump_lost', active=False).success)
        self.wait_state(lambda s: s.part_present and not s.part_detached, 'gripped anew')

    def test_a_torn_cup_leaks_until_it_is_mended(self):
        self.grip()
        self.assertTrue(self.fault('cup_torn', value=1.0e-6).success)
        state = self.wait_state(lambda s: s.gauge_pressure > 0.7 * ULTIMATE, 'less vacuum')
        self.assertGreater(state.flow, 1.0e-5)
        self.gripper.let_pass(50)
        seal = self.gripper.seal
        self.assertAlmostEqual(seal.leak_flow, self.states[-1].flow, delta=0.1 * seal.leak_flow)
        self.assertGreater(seal.leak_area, 0.0)
        self.assertTrue(self.fault('cup_torn', active=False).success)
        self.wait_state(lambda s: s.gauge_pressure < ULTIMATE + 1000.0, 'all the vacuum again')

    def test_a_dirty_lip_and_a_porous_object_leak(self):
        for fault, numbers in (('dirty_lip', {'value': 1.0e-4, 'azimuth': 1.0, 'width': 0.3}),
                               ('porous_object', {'value': 1.0e-6})):
            self.grip()
            self.assertTrue(self.fault(fault, **numbers).success)
            self.wait_state(lambda s: s.gauge_pressure > ULTIMATE + 5000.0, f'{fault}: less vacuum')
            self.assertTrue(self.fault(fault, active=False).success)
            self.wait_state(lambda s: s.gauge_pressure < ULTIMATE + 1000.0, f'{fault} mended')

    def test_a_kinked_hose_hides_the_part(self):
        self.grip()
        self.assertTrue(self.fault('hose_kinked', value=0.0).success)
        self.assertTrue(self.gripper.call('drop', Trigger).success)
        self.wait_state(lambda s: s.part_detached, 'vented manifold')
        # The cup itself keeps its air.
        self.assertLess(self.gripper.seal.gauge_pressure, 0.5 * ULTIMATE)
        self.assertTrue(self.fault('hose_kinked', active=False).success)
        wait_until(lambda: self.gripper.seal.gauge_pressure > -100.0, 'vented cup')

    def test_a_stuck_sensor_repeats_itself(self):
        self.assertTrue(self.fault('sensor_stuck').success)
        self.gripper.let_pass(10)
        before = self.states[-1]
        self.gripper.move(TOUCH - 0.001)
        self.assertTrue(self.gripper.call('grip', Trigger).success)
        self.gripper.wait_status(SealState.SEALED)
        now = self.states[-1]
        self.assertGreater(now.header.stamp, before.header.stamp)
        self.assertEqual(now.absolute_pressure, before.absolute_pressure)
        self.assertTrue(self.fault('sensor_stuck', active=False).success)
        self.wait_state(lambda s: s.part_present, 'awake')

    def test_refusals_say_why(self):
        for command, words in (
                ({'fault': 'cup_tron'}, ('cup_tron', 'cup_torn')),
                ({'fault': 'cup_torn', 'value': 0.0}, ('value = 0', 'm^2')),
                ({'fault': 'cup_torn', 'value': float('nan')}, ('value = nan',)),
                ({'fault': 'cup_torn', 'value': 1.0e-6, 'target': 'left'}, ("target = 'left'",)),
                ({'fault': 'hose_kinked', 'value': 1.5}, ('value = 1.5', '0 to 1')),
                ({'fault': 'dirty_lip', 'value': 1.0e-4}, ('width = 0', '2 pi')),
                ({'fault': 'porous_object', 'value': 1.0e-9, 'target': 'moon'}, ('moon', 'world')),
                ({'fault': 'pump_lost', 'target': 'left'}, ("target = 'left'",))):
            with self.subTest(command):
                answer = self.fault(**command)
                self.assertFalse(answer.success)
                for word in words:
                    self.assertIn(word, answer.message)
        self.grip()  # nothing is broken


if __name__ == '__main__':
    rospy.init_node('vacuum_test')
    rostest.rosrun('vacuum_gripper_sim', 'vacuum_test', VacuumTest, sys.argv)
