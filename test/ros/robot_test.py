#!/usr/bin/python3
"""A robot face: joints follow trajectories and poses, anchors follow joints, skin follows anchors, and joints report efforts."""

import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from face import Face, wait

BROW, BROW_ANCHOR = "inner_brow_left_lift", "anchor_inner_brow_left"
LIFT = 0.006  # [m]
OPENING = 0.1  # [rad] of the jaw
LIP_FROM_HINGE = (0.087, 0.0, -0.052)  # the lower lip's anchor in the frame of the jaw [m], as config/facial_robot.urdf says


class Robot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.face = Face()
        cls.joints, cls.wrenches = {}, {}
        rospy.Subscriber("joint_states", JointState, cls.take_joints)
        for bone in (BROW_ANCHOR, "anchor_lower_lip", "jaw"):  # not that of the upper lip, which a test subscribes to
            rospy.Subscriber("/face/wrench/" + bone, WrenchStamped, cls.take_wrench, bone)
        # A queue of one would drop the first of two messages in a row if the machine is slow.
        cls.command = rospy.Publisher("/robot_controller/command", JointTrajectory, queue_size=10)
        cls.pose = rospy.Publisher("/robot_controller/pose", String, queue_size=10)
        cls.face.wait_until_ready()
        wait(lambda: cls.command.get_num_connections() and cls.pose.get_num_connections(), "the controller")
        cls.rest = {name: cls.face.place(name) for name in cls.face.state.landmark}

    @classmethod
    def take_joints(cls, message):
        cls.joints = {name: values for name, *values in zip(message.name, message.position, message.effort)}

    @classmethod
    def take_wrench(cls, message, bone):
        cls.wrenches[bone] = message

    def moved(self, landmark, axis):
        """How far a landmark has moved from rest [m] along an axis: 0 forward, 1 left, 2 up."""
        return self.face.place(landmark)[axis] - self.rest[landmark][axis]

    def send(self, joint, position, seconds=0.1, begins_in=None):
        point = JointTrajectoryPoint(positions=[position], time_from_start=rospy.Duration(seconds))
        trajectory = JointTrajectory(joint_names=[joint], points=[point])
        if begins_in is not None:
            trajectory.header.stamp = rospy.Time.now() + rospy.Duration(begins_in)
        self.command.publish(trajectory)

    def step_until(self, condition, what):
        def holds():
            self.face.advance(0.1)
            return condition()

        wait(holds, what)

    def wait_for_effort(self, joint, wanted):
        wait(lambda: abs(self.joints[joint][1] - wanted()) < 1e-6, "the effort of " + joint)

    def tearDown(self):
        # on the topic of the next test's commands, so that none of them comes before it
        point = JointTrajectoryPoint(positions=[0] * len(self.joints), time_from_start=rospy.Duration(0.1))
        self.command.publish(JointTrajectory(joint_names=list(self.joints), points=[point]))
        wait(lambda: not any(position for position, _ in self.joints.values()), "joints at rest")
        self.step_until(lambda: all(abs(self.moved(name, 2)) < 3e-4 for name in self.rest), "the face at rest")

    def test_waits_for_a_trajectory_that_begins_later_and_jumps(self):
        begin = rospy.Time.now() + rospy.Duration(0.4)
        early = []
        states = rospy.Subscriber("/joint_states", JointState,
                                  lambda s: early.append(s) if s.header.stamp < begin and any(s.position) else None)
        self.send(BROW, LIFT, seconds=0, begins_in=0.5)
        wait(lambda: self.joints.get(BROW, [0])[0] == LIFT, "the joint")
        states.unregister()
        self.assertEqual(early, [])

    def test_moves_and_feels_its_skin(self):
        self.send(BROW, LIFT)
        wait(lambda: self.joints.get(BROW, [0])[0] == LIFT, "the joint")
        self.step_until(lambda: self.moved("brow_medial_left", 2) > 0.8 * LIFT, "the brow")
        self.assertLess(self.moved("brow_medial_left", 2), 1.1 * LIFT)
        # the skin pulls the anchor down, and the joint pulls it up
        down = lambda: self.wrenches[BROW_ANCHOR].wrench.force.z
        self.step_until(lambda: BROW_ANCHOR in self.wrenches and down() < -0.01, "the wrench")
        self.wait_for_effort(BROW, lambda: -down())
        self.assertEqual(self.wrenches[BROW_ANCHOR].header.frame_id, "face_robot/bone/" + BROW_ANCHOR)

        # trajectories with faults move nothing
        for joint, position in (("nose", 0), (BROW, 0.1), (BROW, float("nan"))):
            self.send(joint, position)
        self.send(BROW, 0, begins_in=-100)
        self.send("upper_lip_lift", 0.001)
        wait(lambda: self.joints["upper_lip_lift"][0] == 0.001, "a good trajectory after bad ones")
        self.assertEqual(self.joints[BROW][0], LIFT)
        # one that begins too late does not stop the one before
        self.send(BROW, 0.5 * LIFT, 0.5)
        self.send(BROW, LIFT, begins_in=1000)
        wait(lambda: self.joints[BROW][0] == 0.5 * LIFT, "the trajectory before")

    def test_jaw_turns_and_carries_the_lower_lip(self):
        self.send("jaw_open", OPENING)
        wait(lambda: self.joints.get("jaw_open", [0])[0] == OPENING, "the jaw")
        # about the hinge, by the angle times the horizontal distance
        felt = lambda: {"jaw", "anchor_lower_lip"} <= set(self.wrenches)
        down = lambda: self.moved("chin", 2) < -0.07 * OPENING and self.moved("lower_lip", 2) < -0.06 * OPENING
        self.step_until(lambda: down() and felt(), "chin and lip")

        def torque():
            # the frame of the jaw has its origin on the hinge, and turns with it, as that of the lip does
            jaw, lip = (self.wrenches[bone].wrench for bone in ("jaw", "anchor_lower_lip"))
            arm = LIP_FROM_HINGE[2] * lip.force.x - LIP_FROM_HINGE[0] * lip.force.z
            return -(jaw.torque.y + lip.torque.y + arm)

        # the skin closes the jaw; the first wrenches may be those of rest
        self.step_until(lambda: self.joints["jaw_open"][1] > 0.001, "an effort against the skin")
        self.wait_for_effort("jaw_open", torque)

    def test_an_expression_that_could_move_nothing_is_refused(self):
        self.face.express("smile")
        wait(lambda: "follow frames" in (self.face.diagnostic("latest refusal on ~expression") or ""), "a refusal")

    def test_the_first_step_after_a_subscription_has_forces(self):
        forces = []
        topic = rospy.Subscriber("/face/wrench/anchor_upper_lip", WrenchStamped, forces.append)
        wait(topic.get_num_connections, "a connection")
        self.face.advance(0.01)
        wait(lambda: forces, "the force of this step")

    def test_takes_poses_by_name(self):
        self.pose.publish("a pose that there is not")
        self.pose.publish("smile")
        wait(lambda: self.joints["mouth_corner_left_lift"][0] == 0.008, "the smile")
        # Voxels of 6 mm join the lips, so that the corners follow their anchors by little more than half.
        self.step_until(lambda: self.moved("mouth_corner_left", 2) > 0.004, "the corner of the mouth")
        for side, sign in (("left", 1), ("right", -1)):
            self.assertGreater(sign * self.moved("mouth_corner_" + side, 1), 0.0035)
            self.assertGreater(self.moved("mouth_corner_" + side, 2), 0.004)


if __name__ == "__main__":
    rospy.init_node("robot_test")
    rostest.rosrun("frontalis", "robot_test", Robot)
