#!/usr/bin/python3
"""Reads a bag of landmarks, and of joints if there are some, into tables for frontalis retarget and calibrate (doc/fitting.md).

usage: read_bag.py BAG FOLDER [--face face] [--joints joint_states] [--still SECONDS | --rate HZ]

Writes FOLDER/landmarks.csv: displacements of the landmarks from the first message, in the face frame, at times from that message on.
The names of landmarks come from the topic state of the face. With --still only poses are written in which the joints had not moved for
so long; FOLDER/joints.csv has their positions and efforts at the same times. With --rate at most so many times per second are written.
"""

import argparse
import csv
import os
import sys

import rosbag


def fail(reason):
    sys.exit("read_bag: " + reason)


def moments(bag, options):
    """Yields the time [s], the landmarks and the latest joints of each moment to be written."""
    places, names = "/%s/landmarks" % options.face.strip("/"), "/%s/state" % options.face.strip("/")
    joint_topic = "/" + options.joints.strip("/")
    joints = moved = start = last = names_of = pending = None
    for topic, message, stamp in bag.read_messages([places, names, joint_topic]):
        now = stamp.to_sec()
        if topic == names:
            names_of = message.landmark
        elif topic == joint_topic:
            if joints is None or list(message.position) != list(joints.position):
                if pending:
                    yield pending
                pending, moved = None, now
            joints = message
        elif names_of is not None and len(names_of) == len(message.poses):
            start = now if start is None else start
            moment = now - start, dict(zip(names_of, (pose.position for pose in message.poses))), joints
            if start == now:
                last = now
                yield moment
            elif options.still:
                # the last moment before the joints move again
                pending = moment if moved is not None and now - moved >= options.still else None
            elif not options.rate or last is None or now - last >= 1 / options.rate:
                last = now
                yield moment
    if pending:
        yield pending


def write(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def joint_table(used):
    names = list(used[0][2].name)
    has_efforts = all(len(joints.effort) == len(joints.name) for _, _, joints in used)
    table = [["time_s"] + names + [name + ".effort" for name in names if has_efforts]]
    for now, _, joints in used:
        row = ["%.6f" % now]
        for values in [joints.position] + [joints.effort] * has_efforts:
            row += ["%.9g" % dict(zip(joints.name, values))[name] for name in names]
        table.append(row)
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("folder")
    parser.add_argument("--face", default="face", help="name of the face's node")
    parser.add_argument("--joints", default="joint_states", help="topic of the joints")
    parser.add_argument("--still", type=float, default=0, help="time for which joints must have stood still [s]")
    parser.add_argument("--rate", type=float, default=0, help="largest number of times per second")
    options = parser.parse_args()
    try:
        with rosbag.Bag(options.bag) as bag:
            found = list(moments(bag, options))
        os.makedirs(options.folder, exist_ok=True)
        if len(found) < 2:
            fail("%s: has %d poses; needed are messages on /%s/landmarks and state, at rest first" % (options.bag, len(found), options.face))
        rest = found[0][1]
        # the first moment is that of rest
        used = found[1:] if options.still else found
        landmarks = [["time_s", "landmark", "forward_mm", "left_mm", "up_mm"]]
        for now, places, _ in used:
            for name, place in places.items():
                moved = (getattr(place, axis) - getattr(rest[name], axis) for axis in "xyz")
                landmarks.append(["%.6f" % now, name] + ["%.6f" % (1e3 * value) for value in moved])
        write(os.path.join(options.folder, "landmarks.csv"), landmarks)
        if all(joints is not None for _, _, joints in used):
            write(os.path.join(options.folder, "joints.csv"), joint_table(used))
    except (OSError, rosbag.ROSBagException) as error:
        fail(str(error))
    print("%d times in %s" % (len(used), options.folder))


if __name__ == "__main__":
    main()
