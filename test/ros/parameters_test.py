#!/usr/bin/python3
"""Every bad parameter stops the start with one line that names it."""

import copy
import os
import subprocess
import sys
import time
import unittest

import rospkg
import rospy
import rostest
import yaml
from roslib.packages import find_node

PACKAGE = rospkg.RosPack().get_path('vacuum_gripper_sim')
UNSET = object()
SCENE = '<robot name="r"><link name="a"><collision><geometry>%s</geometry></collision></link></robot>'

# Dotted name, values that must be refused besides "not set" and a wrong type.
WRONG = {
    'rate': [0.0, -100.0, 5.0, 1.0e+6, float('nan')],
    'world_frame': ['', '/world', 5],
    'cup_frame': ['', '/cup', 'world', 5],
    'actuator': ['robot', 3],
    'cups': [[], 2, [{'name': 'a'}], [{'name': 'a/b', 'position': [0.0, 0.0, 0.0]}],
             2 * [{'name': 'a', 'position': [0.0, 0.0, 0.0]}]],
    'cup': ['no_such_cup', 5, {'name': 'x'}],
    'margin_rate': [0.0, -1.0],
    'display_rate': [0.0, -1.0],
    'realtime_priority': [-1, 100, 1.5],
    'busy_wait': [-1.0e-4, 0.0091, float('nan'), 'long'],
    'diagnostic_period': [0.0],
    'ambient_pressure': [0.0, -1.0, 50000.0],
    'initial_position': [[0.0, 0.0], [0.0, 0.0, 'up'], 0.05, [0.0, 0.0, float('inf')]],
    'initial_rotation': [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.1, 0.0]],
    'max_speed': [0.0, -1.0],
    'max_angular_speed': [0.0],
    'longest_command_period': [-0.1, 11.0, float('nan')],
    'gravity': [[0.0, 0.0], -9.81],
    'roughness': [-1.0e-6],
    'friction': [-0.1, float('nan'), [0.5]],
    'regulator.default_pressure': [1000.0, -95000.0],
    'regulator.min_pressure': [0.0, 1.0, -200000.0],
    'regulator.ramp_rate': [0.0, -1.0],
    'seal.close_gap': [0.0, -1.0e-4],
    'seal.open_gap': [0.0, -1.0e-4],
    'seal.max_rounds': [0, 1.5],
    'seal.ramp_increments': [0],
    'contact.solver': ['magic'],
    'contact.tolerance': [0.0],
    'contact.acceptable_residual': [1.0e-12],
    'contact.max_iterations': [0],
    'contact.relaxation': [0.0, 2.0],
    'contact.alarm_distance': [0.0],
    'linear_solver.method': ['magic'],
    'linear_solver.precision': ['half'],
    'linear_solver.tolerance': [0.0],
    'linear_solver.position_tolerance': [-1.0e-9, 1.0e-3, float('nan')],
    'linear_solver.max_iterations': [0],
    'linear_solver.refactor_interval': [0],
    'linear_solver.threads': [0, 17],
    'vacuum.source': ['magic'],
    'vacuum.manifold_volume': [0.0],
    'vacuum.regulator.time_constant': [-0.1],
    'vacuum.regulator.rate_limit': [0.0],
    'vacuum.regulator.supply_flow': [0.0],
    'vacuum.ejector.free_flow': [0.0],
    'vacuum.ejector.ultimate_vacuum': [0.0, -101325.0],
    'vacuum.ejector.table': [[], [[0.0]], [[0.0, 1.0e-4]], [[-1.0, 1.0e-4], [-2.0, 0.0]]],
    'vacuum.pump.free_flow': [0.0],
    'vacuum.pump.ultimate_vacuum': [0.0, -101325.0],
    'vacuum.pump.table': [[[0.0, 1.0e-4], [-5.0e+4, 2.0e-4], [-6.0e+4, 0.0]]],
    'vacuum.valve.on_delay': [-0.1],
    'vacuum.valve.off_delay': [-0.1],
    'vacuum.valve.blow_off_duration': [-0.1],
    'vacuum.valve.blow_off_flow': [-1.0e-4],
    'vacuum.valve.vent_area': [0.0],
    'vacuum.line.dead_volume': [0.0],
    'vacuum.line.hose_area': [0.0],
    'vacuum.line.check_valve': [2],
    'vacuum.sensor.rate': [0.0],
    'vacuum.sensor.delay': [-0.1],
    'vacuum.sensor.pressure_noise': [-1.0],
    'vacuum.sensor.flow_noise': [-1.0],
    'vacuum.sensor.pressure_resolution': [-1.0],
    'vacuum.sensor.range_min': [-1.0],
    'vacuum.sensor.range_max': [0.0],
    'vacuum.sensor.seed': [-1, 1.5],
    'vacuum.sensor.part_present_level': [0.0],
    'vacuum.sensor.part_detached_level': [0.0, -5000.0],
    'vacuum.sensor.hysteresis': [-1.0, 3000.0],
    'vacuum.sensor.hold_time': [-0.1],
    'faults': [[{}], [{'fault': 'magic'}], [{'fault': 'pump_lost'}],
               [{'fault': 'sensor_stuck', 'target': 'a'}]],
}
# Not in the file: derived from the mesh or other keys, one cup, no fault, unless they are set.
OPTIONAL = {'cups', 'faults', 'roughness', 'seal.close_gap', 'seal.open_gap', 'vacuum.ejector.table',
            'vacuum.pump.table'}


def leaves(config, prefix=''):
    """Dotted names of all that is no map."""
    for key, value in config.items():
        if isinstance(value, dict):
            yield from leaves(value, f'{prefix}{key}.')
        else:
            yield prefix + key


def set_dotted(config, name, value):
    *path, key = name.split('.')
    for part in path:
        config = config[part]
    if value is UNSET:
        del config[key]
    else:
        config[key] = value


class BadParametersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.node = find_node('vacuum_gripper_sim', 'vacuum_gripper_node')[0]
        with open(os.path.join(PACKAGE, 'config', 'vacuum_gripper.yaml'), encoding='utf-8') as file:
            cls.good = yaml.safe_load(file)
        cls.count = 0

    def start(self, config, expect_end=True):
        """Runs a node with a config; returns exit status and what it said."""
        cls = self.__class__
        cls.count += 1
        name = f'gripper_{cls.count}'
        rospy.set_param('/' + name, config)
        environment = dict(os.environ, ROSCONSOLE_FORMAT='[${severity}] ${message}')
        process = subprocess.Popen([self.node, f'__name:={name}'], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, env=environment)
        try:
            if not expect_end:
                time.sleep(3.0)
                alive = process.poll() is None
                process.terminate()
                return alive, process.communicate(timeout=30.0)[0]
            output = process.communicate(timeout=30.0)[0]
            return process.returncode, output
        except subprocess.TimeoutExpired:
            process.kill()
            return None, process.communicate()[0]
        finally:
            rospy.delete_param('/' + name)

    def assert_refused(self, config, *words):
        status, output = self.start(config)
        self.assertIsNotNone(status, f'started all the same:\n{output}')
        self.assertGreater(status, 0, output)  # an exit status, no signal
        fatal = [line for line in output.splitlines() if 'FATAL' in line]
        self.assertEqual(len(fatal), 1, output)
        for word in words:
            self.assertIn(word, fatal[0])

    def test_the_file_lists_what_is_tested(self):
        self.assertEqual(set(leaves(self.good)) - {'mount_frame'}, set(WRONG) - OPTIONAL)

    def test_good_parameters_start(self):
        alive, output = self.start(self.good, expect_end=False)
        self.assertTrue(alive, output)
        self.assertNotIn('FATAL', output)

    def test_not_set(self):
        for name in set(WRONG) - OPTIONAL:
            with self.subTest(name):
                config = copy.deepcopy(self.good)
                set_dotted(config, name, UNSET)
                self.assert_refused(config, name, 'not set')

    def test_nothing_set(self):
        self.assert_refused({'unrelated': 1}, 'rate', 'not set')

    def test_wrong_type(self):
        for name in WRONG:
            if name in ('world_frame', 'cup_frame', 'actuator', 'cup', 'contact.solver',
                        'linear_solver.method', 'vacuum.source'):
                value = ['a', 'list']
            else:
                value = '593.0e3'  # what YAML 1.1 reads as text
            with self.subTest(name):
                config = copy.deepcopy(self.good)
                set_dotted(config, name, value)
                self.assert_refused(config, name)

    def test_out_of_range(self):
        for name, values in WRONG.items():
            for value in values:
                with self.subTest(name=name, value=value):
                    config = copy.deepcopy(self.good)
                    set_dotted(config, name, value)
                    self.assert_refused(config, name)

    def test_unknown_keys(self):
        for name in ('rtae', 'contact.toleranse', 'regulator.pressure', 'seal.gap',
                     'linear_solver.solver'):
            with self.subTest(name):
                config = copy.deepcopy(self.good)
                set_dotted(config, name, 1.0)
                self.assert_refused(config, name)

    def test_section_of_the_wrong_type(self):
        for name in ('regulator', 'seal', 'contact', 'linear_solver'):
            with self.subTest(name):
                self.assert_refused(dict(self.good, **{name: 1.0}), name)

    def test_tf_without_a_mount_frame(self):
        self.assert_refused(dict(self.good, actuator='tf'), 'mount_frame')

    def test_bad_mount_frame(self):
        for value in (5, '/tool'):
            with self.subTest(value=value):
                self.assert_refused(dict(self.good, actuator='tf', mount_frame=value),
                                    'mount_frame')

    def test_cup_as_a_map(self):
        cup = {'name': 'mine', 'mesh': os.path.join(PACKAGE, 'meshes', 'bell_linear_700.msh'),
               'young_modulus': -1.0, 'poisson_ratio': 0.45, 'density': 1080.0,
               'damping': {'mass': 0.0, 'stiffness': 0.002}}
        self.assert_refused(dict(self.good, cup=cup), 'cup.young_modulus', '-1')
        alive, output = self.start(dict(self.good, cup=dict(cup, young_modulus=400000.0)),
                                   expect_end=False)
        self.assertTrue(alive, output)

    def test_scene(self):
        for xml, words in ((5, 'scene_description'), ('this is no XML', ''),
                           (SCENE % '<sphere radius="-1"/>', 'a'),
                           ('<robot name="r"><link name="bare"/></robot>', 'collision')):
            with self.subTest(xml=xml):
                self.assert_refused(dict(self.good, scene_description=xml), words)


if __name__ == '__main__':
    rospy.init_node('parameters_test')
    rostest.rosrun('vacuum_gripper_sim', 'parameters_test', 'parameters_test', sys.argv)
