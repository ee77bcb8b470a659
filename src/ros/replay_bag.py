#!/usr/bin/python3
"""Replays a bag of commands to a face in lock-step and writes what the face publishes to another bag (doc/ros.md).

usage: replay_bag.py BAG OUTPUT.bag [--face face] [--rate 30] [--topics state landmarks skin_points]

The face must run with /use_sim_time true and ~pace lock_step. This script is the clock. It resets the face; then, frame by frame, it
sends each command at its time in the bag, waits until the face has read it, and calls ~step. So equal bags give equal outputs, however
fast the machine is. Commands act from the beginning of the frame in which they came.
"""

import argparse
import os
import sys
import time

import rosbag
import rospy
from frontalis.srv import ListMuscles, Step
from rosgraph_msgs.msg import Clock
from roslib.message import get_message_class
from std_srvs.srv import Trigger

INPUTS = ("muscle_activation", "joint_states", "joint_trajectory", "expression", "action_units", "blendshapes", "bone_pose")
LIMIT = 120  # [s] of wall time for each wait


def wait(condition, what):
    deadline = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > deadline:
            sys.exit("replay_bag: waited %g s in vain for %s" % (LIMIT, what))
        time.sleep(0.002)


class Replay:
    def __init__(self, face, topics):
        self.face = "/" + face.strip("/")
        try:
            rospy.wait_for_service(self.face + "/step", 3)
        except rospy.ROSException:
            print("replay_bag: waiting for the service %s/step" % self.face, flush=True)
            rospy.wait_for_service(self.face + "/step", LIMIT)
        pace = rospy.get_param(self.face + "/pace", "real_time")
        if pace != "lock_step":
            sys.exit("replay_bag: %s has the pace %s; it must run with pace:=lock_step" % (self.face, pace))
        self.list_muscles = rospy.ServiceProxy(self.face + "/list_muscles", ListMuscles, persistent=True)
        self.step = rospy.ServiceProxy(self.face + "/step", Step, persistent=True)
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.inputs, self.outputs = {}, {}
        wait(lambda: self.list_muscles().success, "the model of " + self.face)
        types = dict(rospy.get_published_topics(self.face))
        for topic in topics:
            name = "%s/%s" % (self.face, topic)
            if name not in types:
                sys.exit("replay_bag: %s does not publish %s" % (self.face, name))
            message_class = get_message_class(types[name])
            if "header" not in message_class.__slots__:
                sys.exit("replay_bag: messages on %s have no header with a time; give other --topics" % name)
            subscriber = rospy.Subscriber(
                name, message_class, lambda message, name=name: self.outputs.update({name: message})
            )
            self.outputs[name] = None
            wait(subscriber.get_num_connections, "a connection to " + name)

    def call(self, service, *arguments):
        answer = service(*arguments)
        if not answer.success:
            sys.exit("replay_bag: %s: %s" % (service.resolved_name, answer.message))

    def set_clock(self, now):
        def reached():
            self.clock.publish(Clock(now))
            return self.list_muscles().stamp == now

        wait(reached, "the face to read /clock; does it run with /use_sim_time true?")

    def send(self, topic, message):
        if topic not in self.inputs:
            self.inputs[topic] = rospy.Publisher(topic, type(message), queue_size=10)
            wait(self.inputs[topic].get_num_connections, "a connection to " + topic)
        before = self.list_muscles().messages
        self.inputs[topic].publish(message)
        wait(lambda: self.list_muscles().messages > before, "the face to read " + topic)

    def reset(self, start):
        """Resets the face until its frames arrive, because rospy counts connections before they stand."""
        reset = rospy.ServiceProxy(self.face + "/reset", Trigger)
        for _ in range(5):
            self.call(reset)
            deadline = time.monotonic() + 1
            while time.monotonic() < deadline:
                if all(message and message.header.stamp == start for message in self.outputs.values()):
                    return
                time.sleep(0.002)

    def run(self, bag, rate, output):
        names = ["%s/%s" % (self.face, topic) for topic in INPUTS]
        # rosbag record stores the names of topics as they were given, with or without the slash in front.
        stored = [topic for topic in bag.get_type_and_topic_info().topics if "/" + topic.strip("/") in names]
        commands = [(stamp, "/" + topic.strip("/"), message) for topic, message, stamp in (bag.read_messages(stored) if stored else ())]
        if not commands:
            sys.exit("replay_bag: the bag has no message on any of " + " ".join(names))
        start = commands[0][0]
        self.set_clock(start)
        self.reset(start)
        frames = sent = 0
        while sent < len(commands):
            frames += 1
            # Whole nanoseconds: a sum of rounded durations would drift, and the last command could be after the last frame.
            end = rospy.Time(*divmod(start.to_nsec() + round(frames * 1e9 / rate), 10**9))
            while sent < len(commands) and commands[sent][0] < end:
                stamp, topic, message = commands[sent]
                self.set_clock(stamp)
                self.send(topic, message)
                sent += 1
            self.set_clock(end)
            self.call(self.step, 1 / rate)
            for name in self.outputs:
                wait(lambda name=name: self.outputs[name] and self.outputs[name].header.stamp == end, name)
                output.write(name, self.outputs[name], end)
        return frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("output")
    parser.add_argument("--face", default="face", help="name of the face's node")
    parser.add_argument("--rate", type=float, default=30, help="frames per simulated second")
    parser.add_argument("--topics", nargs="+", default=["state", "landmarks", "skin_points"], help="topics of the face, with a header")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("replay_bag", anonymous=True, disable_signals=True)
    partial = options.output + ".partial"
    try:
        if os.path.exists(options.output) and os.path.samefile(options.bag, options.output):
            raise OSError("OUTPUT is the recording itself")
        with rosbag.Bag(options.bag) as bag, rosbag.Bag(partial, "w") as output:
            frames = Replay(options.face, options.topics).run(bag, options.rate, output)
        os.replace(partial, options.output)
    except (OSError, rosbag.ROSBagException, rospy.ROSException, rospy.ServiceException) as error:
        sys.exit("replay_bag: %s" % error)
    print("%d frames in %s" % (frames, options.output))


if __name__ == "__main__":
    main()
