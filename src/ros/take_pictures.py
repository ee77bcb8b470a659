#!/usr/bin/python3
"""Takes pictures of a scene's face: at rest, in each of its expressions, and relaxed again; or at moments of its demo.
A robot's poses take the place of expressions (facial_robot).

usage: take_pictures.py SCENE FOLDER [at:=SECONDS,SECONDS,...] [panel:=true] [displays:=NAME,NAME,...]
                        [LAUNCH_ARGUMENT:=VALUE ...]

Launches SCENE.launch of this package in lock-step, with rviz full screen (with panel:=true: in a window with its
panels), under Xvfb if there is no display. rviz shows the named displays of the scene's .rviz file, with _ for
spaces, such as Skin_points; without names, those that are ticked there. Moves the face by ~expression and ~step, so
that each picture shows an exact simulated time, and prints the path of each picture and how far the landmarks moved.
Needs the environment of the package's setup file, Xvfb and ImageMagick.
"""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time

SCREEN = "1280x900x24"
RAMP = 0.3  # [s] simulated time from one expression to the next
DEMO_STEP = 0.05  # [s] simulated time per step of a demo, over which activations and bones move linearly
HOLD = 0.9  # [s] simulated time from then to the picture
# Far longer than usual, since they only end a wait that would otherwise have no end.
START_TIMEOUT = 1200  # [s] wall time, for baking and for rviz to start
DRAW_TIMEOUT = 180  # [s] wall time, for rviz to show a new skin


def fail(message):
    sys.stderr.write("take_pictures: %s\n" % message)
    sys.exit(1)


def enter_display():
    """Runs this script again under Xvfb if there is no display."""
    if os.environ.get("DISPLAY"):
        return
    if not shutil.which("xvfb-run"):
        fail("there is no display, and xvfb-run was not found; install the packages xvfb and xauth")
    command = ["xvfb-run", "-a", "-s", "-screen 0 " + SCREEN, sys.executable]
    os.execvp(command[0], command + sys.argv)


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def grab():
    """The screen as a portable pixmap."""
    return subprocess.run(
        ["import", "-window", "root", "-depth", "8", "ppm:-"], check=True, stdout=subprocess.PIPE
    ).stdout


def is_blank(picture):
    """Whether the middle of the screen shows no face. A shaded face has many colours."""
    header, size = picture[:15].split(b"\n")[0:2]
    assert header == b"P6", "unexpected picture format"
    width, height = (int(number) for number in size.split())
    row = len(picture) - 3 * width * (height - height // 2)
    pixels = picture[row : row + 3 * width]
    return len({pixels[i : i + 3] for i in range(0, len(pixels), 3)}) < 16


def settled_picture(before):
    """Waits until two pictures in a row are equal, show a face, and differ from the picture `before`."""
    deadline = time.monotonic() + DRAW_TIMEOUT
    last = None
    while time.monotonic() < deadline:
        picture = grab()
        if picture == last and picture != before and not is_blank(picture):
            return picture
        last = picture
        time.sleep(0.7)
    fail("rviz showed no new face within %d s" % DRAW_TIMEOUT)
    return None


def save(picture, path):
    subprocess.run(
        ["convert", "ppm:-", "-define", "png:exclude-chunks=date,time", path], check=True, input=picture
    )


def config_with(scene, names, folder):
    """Writes a copy of the scene's .rviz file that shows the named displays only, and returns its path."""
    import rospkg
    import yaml

    path = os.path.join(rospkg.RosPack().get_path("frontalis"), "config", scene + ".rviz")
    if not os.path.isfile(path):
        fail("displays:= needs %s, which there is not" % path)
    with open(path, encoding="utf-8") as file:
        config = yaml.safe_load(file)
    displays = {display["Name"].replace(" ", "_"): display for display in config["Visualization Manager"]["Displays"]}
    for name in names:
        if name not in displays:
            fail("%s has no display %s; it has %s" % (path, name, ", ".join(displays)))
    for name, display in displays.items():
        display["Enabled"] = display["Value"] = name in names
    copy = os.path.join(folder, scene + ".rviz")
    with open(copy, "w", encoding="utf-8") as file:
        yaml.safe_dump(config, file)
    return copy


class Face:
    """The face /face. ROS is imported here, after the address of the master has been set."""

    def __init__(self):
        import rosgraph
        import rospy
        from frontalis.msg import Expression, SimulationState
        from frontalis.srv import ListMuscles, Step
        from geometry_msgs.msg import PoseArray
        from sensor_msgs.msg import JointState
        from std_msgs.msg import String
        from visualization_msgs.msg import Marker

        rospy.init_node("take_pictures", disable_signals=True)
        self.master = rosgraph.Master("take_pictures")
        self.landmarks = None
        self.state = None
        self.caption = ""
        self.poses = lambda: rospy.get_param("/robot_controller/poses", {})
        self.joints = {}
        self.pose = rospy.Publisher("/robot_controller/pose", String, queue_size=1)
        self.expression = rospy.Publisher("/face/expression", Expression, queue_size=1)
        self.muscles = rospy.ServiceProxy("/face/list_muscles", ListMuscles)
        self.advance = rospy.ServiceProxy("/face/step", Step)
        rospy.Subscriber("/face/landmarks", PoseArray, lambda message: setattr(self, "landmarks", message.poses))
        rospy.Subscriber("/face/state", SimulationState, lambda message: setattr(self, "state", message))
        rospy.Subscriber("/joint_states", JointState, lambda message: setattr(self, "joints", message))
        rospy.Subscriber("/face/caption", Marker, lambda message: setattr(self, "caption", message.text))

    def is_seen(self):
        """Whether rviz has subscribed to what it draws."""
        drawn = ["/face/" + topic for topic in ("skin", "skin_points", "muscles", "landmarks", "bodies", "eyes")]
        subscribers = dict(self.master.getSystemState()[1])
        return any("rviz" in node for topic in drawn for node in subscribers.get(topic, []))

    def express(self, name):
        """Commands an expression and steps until the face holds it. Returns the simulated time [s]."""
        # topics and services are not ordered: go on only after the command has arrived
        if self.poses():
            self.strike(name)
        else:
            self.command("relax")
            if name != "relax":
                self.command(name)
        for seconds in (RAMP, HOLD):
            answer = self.advance(seconds)
            if not answer.success:
                fail("the simulation failed in '%s': %s" % (name, answer.message))
        return answer.time

    def strike(self, name):
        """Moves a robot's joints to a pose and waits until they are there; joints that it does not name go to 0."""
        goals = self.poses().get(name, {})
        for _ in range(100):
            self.pose.publish(name)
            time.sleep(1)
            if all(position == goals.get(joint, 0) for joint, position in zip(self.joints.name, self.joints.position)):
                return
        fail("the joints did not reach the pose '%s'" % name)

    def command(self, name):
        before = None
        for _ in range(100):
            if before is None and self.expression.get_num_connections() > 0:
                before = self.muscles().messages
                self.expression.publish(name=[name])
            if before is not None and self.muscles().messages > before:
                return
            time.sleep(0.1)
        fail("expression '%s' did not reach the face" % name)


def wait_for(what, ready, launch, timeout):
    deadline = time.monotonic() + timeout
    while True:
        if launch.poll() is not None:
            fail("roslaunch ended early, with %d" % launch.returncode)
        try:
            if ready():
                return
        except Exception as error:  # pylint: disable=broad-except
            if time.monotonic() > deadline:
                fail("%s: %s" % (what, error))
        if time.monotonic() > deadline:
            fail("%s: not within %d s" % (what, timeout))
        time.sleep(0.5)


def is_ready(face):
    answer = face.muscles()
    if face.state is not None and face.state.failed:
        fail(face.state.message)
    return answer.success and face.landmarks is not None


def movement(face, rest):
    """Upward movement of the landmarks in millimetres, as text."""
    moved = ["%s %+.1f" % (name, 1e3 * (now.position.z - then.position.z))
             for name, now, then in zip(face.state.landmark, face.landmarks, rest)]
    return "landmarks up [mm]: " + ", ".join(moved) if moved else ""


def take_demo(face, folder, moments):
    """Plays the demo in short steps: in each, activations and bones move linearly to where the demo has them at its end."""
    picture = None
    time_now = 0
    for moment in moments:
        while moment - time_now > 1e-6:
            answer = face.advance(min(DEMO_STEP, moment - time_now))
            if not answer.success:
                fail("the simulation failed after %g s: %s" % (time_now, answer.message))
            time_now = answer.time
        picture = settled_picture(picture)
        name = face.caption.split("\n")[0].replace(" ", "_") or "demo"
        path = os.path.join(folder, "%05.2f_%s.png" % (moment, name))
        save(picture, path)
        print("%s  at %.1f s" % (path, time_now), flush=True)


def take(folder, launch, moments):
    face = Face()
    wait_for("the face", lambda: is_ready(face), launch, START_TIMEOUT)
    wait_for("rviz", face.is_seen, launch, START_TIMEOUT)
    rest = face.landmarks
    if moments:
        take_demo(face, folder, moments)
        return
    at_rest = ("relax", "neutral")
    names = [name for name in face.poses() or face.muscles().expressions if name not in at_rest]
    picture = None
    for title, expression in [("neutral", None)] + [(name, name) for name in names] + [
        ("relaxed", at_rest[1] if face.poses() else at_rest[0])
    ]:
        moment = face.express(expression or title) if expression or face.poses() else 0
        picture = settled_picture(picture)
        path = os.path.join(folder, title + ".png")
        save(picture, path)
        print("%s  at %.1f s  %s" % (path, moment, movement(face, rest)), flush=True)


def main():
    if len(sys.argv) < 3:
        sys.stderr.write(__doc__)
        sys.exit(2)
    scene, folder = sys.argv[1], os.path.abspath(sys.argv[2])
    moments = [float(t) for a in sys.argv[3:] if a.startswith("at:=") for t in a[4:].split(",")]
    displays = [a[10:].split(",") for a in sys.argv[3:] if a.startswith("displays:=")]
    arguments = [a for a in sys.argv[3:] if not a.startswith(("at:=", "panel:=", "displays:="))]
    rviz_args = "" if "panel:=true" in sys.argv else "--fullscreen"
    enter_display()
    os.makedirs(folder, exist_ok=True)
    if displays:
        arguments.append("rviz_config:=" + config_with(scene, displays[0], folder))

    # software rendering, and a ROS master of its own so that no other nodes take part
    os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
    port = str(free_port())
    os.environ["ROS_MASTER_URI"] = "http://localhost:" + port
    launch = subprocess.Popen(
        ["roslaunch", "-p", port, "frontalis", scene + ".launch", "pace:=lock_step", "rviz:=true",
         "demo:=" + ("true" if moments else "false"), "rviz_args:=" + rviz_args] + arguments
    )
    try:
        take(folder, launch, moments)
    finally:
        if launch.poll() is None:
            launch.send_signal(signal.SIGINT)
        try:
            launch.wait(30)
        except subprocess.TimeoutExpired:
            launch.kill()


if __name__ == "__main__":
    main()
