"""The face under test: its latest messages, its services, and waiting for conditions.

Waits end as soon as their condition holds. Their time limits only end a test that would otherwise never end, so that the tests
pass on slow machines too.
"""

import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from frontalis.msg import Expression, MuscleActivation, SimulationState
from frontalis.srv import ListMuscles, Step, SwitchEffect
from geometry_msgs.msg import PoseArray
from std_srvs.srv import SetBool, Trigger

LIMIT = 180  # [s] of wall time for each wait


class Face:
    def __init__(self, name="/face"):
        self.name = name
        self.state = None
        self.states = 0  # number of messages on ~state
        self.landmarks = None
        self.diagnostics = []
        self.activation = rospy.Publisher(name + "/muscle_activation", MuscleActivation, queue_size=10)
        self.expression = rospy.Publisher(name + "/expression", Expression, queue_size=10)
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
        self.states += 1

    def take_landmarks(self, message):
        self.landmarks = message

    def take_diagnostics(self, message):
        mine = [status for status in message.status if status.name.startswith(self.name.strip("/"))]
        self.diagnostics = mine or self.diagnostics

    def wait_for_service(self):
        rospy.wait_for_service(self.name + "/list_muscles", LIMIT)

    def wait_until_ready(self):
        """Waits until the face has a model, sends frames and receives commands."""
        self.wait_for_service()
        wait(lambda: self.list_muscles().success, "the model")
        wait(lambda: self.state is not None and self.landmarks is not None, "frames")
        wait(lambda: self.activation.get_num_connections() and self.expression.get_num_connections(), "connections")

    def wait_for_frame(self, condition, what):
        """Waits until the latest state and landmarks belong to the same frame and the condition holds."""
        wait(lambda: self.state.header.stamp == self.landmarks.header.stamp and condition(), what)

    def wait_for_states(self, count):
        """Waits until `count` further states have come."""
        end = self.states + count
        wait(lambda: self.states >= end, "%d more states" % count)

    def command(self, **activation):
        self.send(list(activation), list(activation.values()))

    def send(self, names, values):
        # the message has no stamp, so that a slow machine does not make it stale
        self.activation.publish(MuscleActivation(name=names, activation=values))

    def express(self, *names, **fields):
        self.expression.publish(Expression(name=names, **fields))

    def diagnostic(self, key):
        """A value of the latest diagnostics; None if there is no such key."""
        values = [pair.value for status in self.diagnostics for pair in status.values if pair.key == key]
        return values[0] if values else None

    def target(self):
        answer = self.list_muscles()
        return dict(zip(answer.name, answer.target))

    def place(self, landmark):
        """Position of a landmark in the face frame [m]."""
        position = self.landmarks.poses[self.state.landmark.index(landmark)].position
        return position.x, position.y, position.z

    def height(self, landmark):
        """Height of a landmark above the face frame's origin [m]."""
        return self.place(landmark)[2]

    def advance(self, seconds):
        """Steps, and waits for the frame at the end of the step."""
        answer = self.step(seconds)
        assert answer.success, answer.message
        self.wait_for_frame(lambda: abs(self.state.time - answer.time) < 1e-9, "the state")


def wait(condition, what):
    """Waits until the condition holds. Fails if it does not hold within the time limit; `what` names it."""
    deadline = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("waited %g s in vain for %s" % (LIMIT, what))
        time.sleep(0.05)
