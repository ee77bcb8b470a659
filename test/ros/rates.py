#!/usr/bin/python3
"""Measures how often a running face publishes, and how long it takes to end.

usage: rates.py [SCENE] [topics:=TOPIC,...] [LAUNCH_ARGUMENT:=VALUE ...]

Launches a scene of config/ (forehead) with its demo, at 60 frames per second and accuracy draft unless the arguments of face.launch say
otherwise, and counts for 24 seconds what a program receives of its topics. topics:= names those to which it subscribes beside ~state
(skin,skin_points,landmarks). The real-time factor is the mean over this time. Needs the environment of the package's setup file.
"""

import os
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client

TOPICS = "skin,skin_points,landmarks"
WARM_UP, SECONDS = 5, 24  # [s] of wall time
TIMEOUT = 1200  # [s], for the bake


def measure(launch, topics):
    import rosgraph
    import rospy
    from frontalis.msg import SimulationState

    rospy.init_node("rates", disable_signals=True)
    counts = dict.fromkeys(topics, 0)
    states = []

    def count(message, topic):
        counts[topic] += 1
        if topic == "state":
            states.append(message)

    # other messages are not decoded, which would take longer than to receive them
    for topic in topics:
        rospy.Subscriber("/face/" + topic, SimulationState if topic == "state" else rospy.AnyMsg, count, topic)
    deadline = time.monotonic() + TIMEOUT
    while not all(counts.values()):
        if launch.poll() is not None or time.monotonic() > deadline:
            sys.exit("rates: the face did not start")
        time.sleep(0.2)
    time.sleep(WARM_UP)
    before, begin, first = dict(counts), time.monotonic(), states[-1]
    time.sleep(SECONDS)
    elapsed = time.monotonic() - begin
    rates = {topic: (counts[topic] - before[topic]) / elapsed for topic in topics}
    state = states[-1]
    factor = (state.time - first.time) / (state.wall_time - first.wall_time)
    print("%s; %d voxels, skin of %d vertices; real-time factor %.3f; load of the machine %.1f on %d cores"
          % (state.backend, state.voxels, state.skin_vertices, factor, os.getloadavg()[0], os.cpu_count()))
    for topic, rate in rates.items():
        print("~%-12s %5.1f per second" % (topic, rate))
    pid = xmlrpc.client.ServerProxy(rosgraph.Master("rates").lookupNode("/face")).getPid("rates")[2]
    begin = time.monotonic()
    os.kill(pid, signal.SIGINT)
    while os.path.exists("/proc/%d" % pid):
        time.sleep(0.005)
    print("ended %.2f s after it was told to" % (time.monotonic() - begin))


def main():
    arguments = [a for a in sys.argv[1:] if ":=" in a]
    scene = next((a for a in sys.argv[1:] if ":=" not in a), "forehead")
    if scene.startswith("-"):
        sys.exit(__doc__)
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = str(probe.getsockname()[1])
    os.environ["ROS_MASTER_URI"] = "http://localhost:" + port
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../config", scene + ".yaml")
    defaults = {"rviz": "false", "demo": "true", "accuracy": "draft", "frame_rate": "60"}
    defaults.update(a.split(":=", 1) for a in arguments)
    topics = ["state"] + defaults.pop("topics", TOPICS).split(",")
    launch = subprocess.Popen(["roslaunch", "-p", port, "frontalis", "face.launch", "scene:=" + os.path.normpath(path)]
                              + ["%s:=%s" % pair for pair in defaults.items()], stdout=subprocess.DEVNULL)
    try:
        measure(launch, dict.fromkeys(topics))
    finally:
        if launch.poll() is None:
            launch.send_signal(signal.SIGINT)
        launch.wait(60)


if __name__ == "__main__":
    main()
