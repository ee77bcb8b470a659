#!/usr/bin/python3
"""Reads a bag of landmarks, and of joints if there are some, into tables for frontalis retarget and calibrate (doc/fitting.md).

usage: read_bag.py BAG FOLDER [--face face] [--joints joint_states] [--still SECONDS [--tolerance 1e-4] | --rate HZ]

Writes FOLDER/landmarks.csv: displacements of the landmarks from the first message, in the face frame, at times from that message on.
The names of landmarks come from the topic state of the face. With --still only poses are written in which the joints had not moved by
more than the tolerance [rad or m] for so long, and did not move until the next message of each joint. FOLDER/joints.csv has the latest
positions and efforts at the same times, of the joints that were known at the first of them. With --rate at most so many times per second
are written.
"""

import argparse
import csv
import itertools
import os
import sys

import rosbag


def fail(reason):
    sys.exit("read_bag: " + reason)


def full(topic):
    return "/" + topic.strip("/")


def moments(bag, options):
    """Yields the time [s], the landmarks, and position and effort of each joint by its name, of each moment to be written."""
    places, names = full(options.face) + "/landmarks", full(options.face) + "/state"
    joint_topic = full(options.joints)
    joints = {}  # the latest position and effort of each joint; several nodes may publish some of the joints each
    held = {}  # the positions at which the joints stand still since the time `moved`
    unheard = set()  # joints without a message since the landmarks of `pending`
    moved = start = due = names_of = pending = confirmed = None
    # rosbag record stores the names of topics as they were given, with or without the slash in front.
    stored = bag.get_type_and_topic_info().topics
    if options.still and joint_topic not in map(full, stored):
        fail("%s: has no messages on %s, but on %s" % (options.bag, joint_topic, ", ".join(stored)))
    topics = [topic for topic in stored if full(topic) in (places, names, joint_topic)]
    for topic, message, stamp in bag.read_messages(topics):
        topic, now = full(topic), stamp.to_sec()
        if topic == names:
            names_of = message.landmark
        elif topic == joint_topic:
            joints.update(zip(message.name, zip(message.position, message.effort or itertools.repeat(None))))
            unheard.difference_update(message.name)
            if any(name not in held or abs(joints[name][0] - held[name]) > options.tolerance for name in joints):
                if confirmed:
                    yield confirmed
                # The landmarks may have moved before the joints said so.
                pending = confirmed = None
                moved, held = now, {name: position for name, (position, _) in joints.items()}
            elif pending and not unheard:
                pending, confirmed = None, pending
        elif names_of is not None and len(names_of) == len(message.poses):
            start = now if start is None else start
            moment = now - start, dict(zip(names_of, (pose.position for pose in message.poses))), dict(joints)
            if start == now:
                due = now + 1 / options.rate if options.rate else now
                yield moment
            elif options.still:
                if pending is None and moved is not None and now - moved >= options.still:
                    pending, unheard = moment, set(joints)
            elif not options.rate or now >= due:
                # The next one is due one period later, so that messages that come a little early are not lost.
                if options.rate:
                    due = max(due, now - 1 / options.rate) + 1 / options.rate
                yield moment
    if confirmed:
        yield confirmed


def write(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def joint_table(used):
    names = list(used[0][2])
    efforts = [name for name in names if all(joints[name][1] is not None for _, _, joints in used)]
    table = [["time_s"] + names + [name + ".effort" for name in efforts]]
    for now, _, joints in used:
        values = [joints[name][0] for name in names] + [joints[name][1] for name in efforts]
        table.append(["%.6f" % now] + ["%.9g" % value for value in values])
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("folder")
    parser.add_argument("--face", default="face", help="name of the face's node")
    parser.add_argument("--joints", default="joint_states", help="topic of the joints")
    parser.add_argument("--still", type=float, default=0, help="time for which joints must have stood still [s]")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="change of a joint that is taken for noise [rad or m]")
    parser.add_argument("--rate", type=float, default=0, help="largest number of times per second")
    options = parser.parse_args()
    try:
        with rosbag.Bag(options.bag) as bag:
            found = list(moments(bag, options))
        os.makedirs(options.folder, exist_ok=True)
        if options.still and len(found) == 1:
            fail("%s: no pose in which all joints on /%s stand still for %g s (within %g rad or m)"
                 % (options.bag, options.joints.strip("/"), options.still, options.tolerance))
        if len(found) < 2:
            fail("%s: has %d poses; needed are messages on /%s/landmarks and state, at rest first" % (options.bag, len(found), options.face))
        rest = found[0][1]
        # the first moment is that of rest
        used = found[1:] if options.still else found
        landmarks = [["time_s", "landmark", "forward_mm", "left_mm", "up_mm"]]
        for now, places, _ in used:
            if places.keys() != rest.keys():
                fail("%s: its face has other landmarks from %.3f s on; cut the bag there" % (options.bag, now))
            for name, place in places.items():
                moved = (getattr(place, axis) - getattr(rest[name], axis) for axis in "xyz")
                landmarks.append(["%.6f" % now, name] + ["%.6f" % (1e3 * value) for value in moved])
        write(os.path.join(options.folder, "landmarks.csv"), landmarks)
        if used[0][2]:
            write(os.path.join(options.folder, "joints.csv"), joint_table(used))
    except (OSError, rosbag.ROSBagException) as error:
        fail(str(error))
    print("%d times in %s" % (len(used), options.folder))


if __name__ == "__main__":
    main()
