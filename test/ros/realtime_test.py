#!/usr/bin/python3
"""A gripper whose steps three threads share and that wants a priority: all three get it, or none,
and the thread that publishes stays on the core of the one that steps, or goes where it likes. Half
of each period the loop stays awake, and hears what it is told all the same."""

import os
import pathlib
import sys
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Empty

from gripper_client import GripperClient, wait_until


class RealtimeTest(unittest.TestCase):
    def test_threads_that_a_step_waits_for_share_its_priority(self):
        gripper = GripperClient()
        gripper.connect()
        values = {}
        rospy.Subscriber('/diagnostics', DiagnosticArray, lambda message: values.update(
            (value.key, value.value) for status in message.status for value in status.values))
        wait_until(lambda: 'scheduling' in values, 'diagnostics')

        uri = rosgraph.Master('/realtime_test').lookupNode('/vacuum_gripper')
        pid = xmlrpc.client.ServerProxy(uri).getPid('/realtime_test')[2]
        threads = [int(task.name) for task in pathlib.Path(f'/proc/{pid}/task').iterdir()]
        first = [os.sched_getparam(thread).sched_priority for thread in threads
                 if os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO]

        def kept_on_a_core():
            return [os.sched_getaffinity(thread) for thread in threads
                    if len(os.sched_getaffinity(thread)) < len(os.sched_getaffinity(0))]

        def core_of_the_loop():
            stat = pathlib.Path(f'/proc/{pid}/task/{pid}/stat').read_text(encoding='ascii')
            return int(stat.rsplit(')', 1)[1].split()[36])

        if values['scheduling'] == 'normal':  # not allowed here, or given up
            self.assertEqual(first, [])
            self.assertEqual(kept_on_a_core(), [])
        else:
            self.assertEqual(values['scheduling'], 'SCHED_FIFO 5')
            self.assertEqual(first, [5, 5, 5])
            if len(os.sched_getaffinity(0)) > 1:
                wait_until(lambda: kept_on_a_core() == [{core_of_the_loop()}],
                           'the publishing thread on the core of the one that steps')
        self.assertGreater(len(threads), 3)

    def test_the_loop_stays_awake_for_busy_wait(self):
        gripper = GripperClient()
        gripper.connect()
        uri = rosgraph.Master('/realtime_test').lookupNode('/vacuum_gripper')
        pid = xmlrpc.client.ServerProxy(uri).getPid('/realtime_test')[2]

        def computed():
            """By the thread that steps. [s]"""
            stat = pathlib.Path(f'/proc/{pid}/task/{pid}/stat').read_text(encoding='ascii')
            ticks = stat.rsplit(')', 1)[1].split()[11:13]
            return sum(map(int, ticks)) / os.sysconf('SC_CLK_TCK')

        # 5 of 10 ms; a step of this cup takes less than one.
        before = computed()
        rospy.sleep(2.0)
        self.assertGreater(computed() - before, 0.2 * 2.0)
        rospy.ServiceProxy('/vacuum_gripper/on', Empty)()
        wait_until(lambda: gripper.seal.setpoint < 0.0, 'a set-point from a service')


if __name__ == '__main__':
    rospy.init_node('realtime_test')
    rostest.rosrun('vacuum_gripper_sim', 'realtime_test', 'realtime_test', sys.argv)
