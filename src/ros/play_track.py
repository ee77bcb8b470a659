#!/usr/bin/python3
"""Plays a table of activations over time (CSV), such as `frontalis retarget` writes, on a running face.

usage: play_track.py TABLE [FACE]

Sends the muscles of the table as one message on FACE/joint_trajectory (default: face). Leaves out columns of bones, such as jaw.x, and
lists them.
"""

import csv
import sys

import rospy
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

CONNECTION_TIMEOUT = 30  # [s] wall time


def trajectory(path):
    """Return the table as a trajectory, and the names of its columns of bones."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file, skipinitialspace=True))
    if not rows or "time" not in rows[0]:
        raise ValueError(path + ": must have a column time and a row below the header")
    columns = [name for name in rows[0] if name != "time"]
    muscles = [name for name in columns if "." not in name]
    message = JointTrajectory(joint_names=muscles)
    for row in rows:
        point = JointTrajectoryPoint(positions=[float(row[name]) for name in muscles])
        point.time_from_start = rospy.Duration(float(row["time"]))
        message.points.append(point)
    return message, [name for name in columns if "." in name]


def main():
    arguments = rospy.myargv(sys.argv)[1:]
    if len(arguments) not in (1, 2):
        sys.exit(__doc__)
    try:
        message, left_out = trajectory(arguments[0])
    except (OSError, TypeError, ValueError) as error:
        sys.exit("play_track: %s" % error)
    if left_out:
        sys.stderr.write("play_track: left out: %s\n" % ", ".join(left_out))
    rospy.init_node("play_track", anonymous=True)
    face = arguments[1] if len(arguments) == 2 else "face"
    publisher = rospy.Publisher(face + "/joint_trajectory", JointTrajectory, queue_size=1)
    for _ in range(10 * CONNECTION_TIMEOUT):
        if rospy.is_shutdown():
            sys.exit(1)
        if publisher.get_num_connections() > 0:
            break
        rospy.rostime.wallsleep(0.1)
    else:
        sys.exit("play_track: nobody listens to %s" % publisher.resolved_name)
    publisher.publish(message)
    rospy.rostime.wallsleep(0.5)  # time to send the message


if __name__ == "__main__":
    main()
