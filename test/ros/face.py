"""The face under test, as the tests of this folder see it: its latest messages, its services, and waiting with a time limit."""

import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from frontalis.msg import MuscleActivation, SimulationState
from frontalis.srv import ListMuscles, Step, SwitchEffect
from geometry_msgs.msg import PoseArray
from std_srvs.srv import SetBool, Trigger


class Face:
    def __init__(self, name="/face"):
        self.name = name
        self.state = None
        self.landmarks = None
        self.diagnostics = []
        self.activation = rospy.Publisher(name + "/muscle_activation", MuscleActivation, queue_size=10)
        self.list_muscles = rospy.ServiceProxy(name + "/list_muscles", ListMuscles)
        self.pause = rospy.ServiceProxy(name + "/pause", SetBool)
        self.reset = rospy.ServiceProxy(name + "/reset", Trigger)
        self.step = rospy.ServiceProxy(name + "/step", Step)
        self.switch_effect = rospy.ServiceProxy(name + "/switch_effect", SwitchEffect)
        rospy.Subscriber(name + "/state", SimulationState, self.take_state)
        rospy.Subscriber(name + "/landmarks", PoseArray, self.take_landmarks)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.take_diagnostics)

    def take_state(self, message):
        self.state = message

    def take_landmarks(self, message):
        self.landmarks = message

    def take_diagnostics(self, message):
        mine = [status for status in message.status if status.name.startswith(self.name.strip("/"))]
        self.diagnostics = mine or self.diagnostics

    def wait_for_service(self):
        rospy.wait_for_service(self.name + "/list_muscles", 60)

    def wait_until_ready(self, timeout=180):
        """Until the model is there and frames come."""
        self.wait_for_service()
        wait(lambda: self.list_muscles().success, "the model", timeout)
        wait(lambda: self.state is not None and self.landmarks is not None, "frames", 60)
        wait(lambda: self.activation.get_num_connections() > 0, "the face's ear", 30)

    def command(self, **activation):
        self.send(list(activation), list(activation.values()))

    def send(self, names, values):
        message = MuscleActivation(name=names, activation=values)
        message.header.stamp = rospy.Time.now()
        self.activation.publish(message)

    def target(self):
        answer = self.list_muscles()
        return dict(zip(answer.name, answer.target))

    def height(self, landmark):
        """Height of a landmark above the face frame's origin [m]."""
        return self.landmarks.poses[self.state.landmark.index(landmark)].position.z


def wait(condition, what, timeout):
    """Waits until the condition holds; fails with the name of what was waited for."""
    deadline = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("waited %g s in vain for %s" % (timeout, what))
        time.sleep(0.05)
