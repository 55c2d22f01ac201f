"""A gripper as another node sees it: topics, services and tf, nothing else."""

import math
import threading
import time
import unittest

import rospy
import tf2_ros
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import FluidPressure
from std_msgs.msg import Bool
from std_srvs.srv import Empty, Trigger

from vacuum_gripper_sim.msg import PressureSetpoint, SealState

PATIENCE = 40.0  # [wall s] for anything that must happen; generous, the machine may be busy
DOWN = (1.0, 0.0, 0.0, 0.0)  # quaternion x y z w of a cup that points down
TOUCH = 0.020  # [m] mount above a surface that the lip touches
ON, OFF = -6000.0, 0.0  # [Pa]


def wait_until(condition, what, seconds=PATIENCE):
    """Waits in wall time, so that a clock that stands still cannot hang a test."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if rospy.is_shutdown():
            raise AssertionError(f'shut down while waiting for: {what}')
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError(f'not within {seconds} s: {what}')


def pose(position, frame='world', orientation=DOWN, stamp=None):
    message = PoseStamped()
    message.header.frame_id = frame
    message.header.stamp = stamp or rospy.Time(0)
    message.pose.position.x, message.pose.position.y, message.pose.position.z = position
    q = message.pose.orientation
    q.x, q.y, q.z, q.w = orientation
    return message


def transform(parent, child, position, orientation=(0.0, 0.0, 0.0, 1.0)):
    message = TransformStamped()
    message.header.frame_id = parent
    message.header.stamp = rospy.Time.now()
    message.child_frame_id = child
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = position
    q.x, q.y, q.z, q.w = orientation
    return message


class Broadcaster:
    """Keeps a moving frame on tf alive at 50 Hz."""

    def __init__(self, parent, child, position):
        self._parent, self._child = parent, child
        self.position = position
        self._stop = threading.Event()
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        while not self._stop.wait(0.02) and not rospy.is_shutdown():
            self._broadcaster.sendTransform(
                transform(self._parent, self._child, self.position))

    def stop(self):
        self._stop.set()
        self._thread.join()


class GripperClient:
    def __init__(self, name='/vacuum_gripper'):
        self.name = name
        self.seal = self.wrench = self.pressure = self.grasping = None
        self.steps = 0  # wrenches received
        self.warnings = []
        self.height = 0.05
        self._setpoint = rospy.Publisher(f'{name}/pressure_setpoint', PressureSetpoint,
                                         queue_size=10)
        self._pose = rospy.Publisher(f'{name}/pose_command', PoseStamped, queue_size=10)
        self._seal_subscriber = None
        self.resubscribe_seal()
        rospy.Subscriber(f'{name}/wrench', WrenchStamped, self._on_wrench)
        rospy.Subscriber(f'{name}/pressure', FluidPressure, lambda m: setattr(self, 'pressure', m))
        rospy.Subscriber(f'{name}/grasping', Bool, lambda m: setattr(self, 'grasping', m.data))
        rospy.Subscriber('/rosout', Log, self._on_log)

    def resubscribe_seal(self):
        """Joins anew, as a node that starts late would."""
        if self._seal_subscriber is not None:
            self._seal_subscriber.unregister()
            time.sleep(0.5)
        self._seal_subscriber = rospy.Subscriber(f'{self.name}/seal_state', SealState,
                                                 lambda m: setattr(self, 'seal', m))

    def _on_wrench(self, message):
        self.wrench = message
        self.steps += 1

    def _on_log(self, message):
        if message.name == self.name and message.level >= Log.WARN:
            self.warnings.append(message.msg)

    def connect(self, pose_command=True):
        wait_until(lambda: self.seal is not None, f'seal_state of {self.name}')
        wait_until(lambda: self._setpoint.get_num_connections() > 0, 'set-point subscribed')
        if pose_command:
            wait_until(lambda: self._pose.get_num_connections() > 0, 'pose command subscribed')

    def set_pressure(self, gauge_pressure):
        self._setpoint.publish(PressureSetpoint(gauge_pressure=gauge_pressure))

    def send(self, message):
        self._pose.publish(message)

    def move(self, height, speed=0.02, **kwargs):
        """Goes to a height above the origin of a frame and waits there for the cup to settle."""
        start = self.height
        pieces = max(1, int(abs(height - start) / speed * 50.0))
        for i in range(1, pieces + 1):
            self.send(pose((0.0, 0.0, start + (height - start) * i / pieces), **kwargs))
            time.sleep(0.02)
        self.height = height
        self.let_pass(30)

    def let_pass(self, steps):
        """Waits for a number of steps to come."""
        goal = self.steps + steps
        wait_until(lambda: self.steps >= goal, f'{steps} more steps of {self.name}')

    def wait_status(self, status):
        wait_until(lambda: self.seal.status == status,
                   f'{self.name} status {status}; last:\n{self.seal}')

    def wait_warning(self, *words):
        wait_until(lambda: any(all(word in text for word in words) for text in self.warnings),
                   f'a warning with {words}; so far: {self.warnings}')

    def call(self, service, kind=Empty):
        rospy.wait_for_service(f'{self.name}/{service}', timeout=PATIENCE)
        return rospy.ServiceProxy(f'{self.name}/{service}', kind)()

    def force(self):
        f = self.wrench.wrench.force
        return (f.x, f.y, f.z)


class GripTestCase(unittest.TestCase):
    """Every test begins with a cup at rest, vented, 50 mm above the origin."""

    gripper = None

    @classmethod
    def setUpClass(cls):
        if GripTestCase.gripper is None:
            GripTestCase.gripper = GripperClient()
            GripTestCase.gripper.connect()

    def setUp(self):
        self.gripper.set_pressure(OFF)
        self.gripper.send(pose((0.0, 0.0, 0.05)))
        self.gripper.height = 0.05
        self.gripper.let_pass(20)
        self.gripper.call('reset', Trigger)
        self.gripper.let_pass(20)
        self.gripper.warnings = []

    def seal(self, pressure=ON):
        self.gripper.move(TOUCH - 0.001)
        self.gripper.set_pressure(pressure)
        self.gripper.wait_status(SealState.SEALED)


def angle_between(q1, q2):
    dot = abs(sum(a * b for a, b in zip(q1, q2)))
    return 2.0 * math.acos(min(1.0, dot))
