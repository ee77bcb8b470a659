#!/usr/bin/python3
"""Whether an effect costs a scene without it nothing: the solver's library is linked again with those sources compiled
without the effect that know of it, and the instructions of the same steps are counted by valgrind with both libraries."""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

# an effect goes with those that need it
EFFECTS = (("viscosity",), ("contraction", "fibre_stiffness"), ("gravity",), ("surface_loads",), ("sliding", "friction"))
# all that includes built_effects.hpp; valgrind knows no AVX-512
SOURCES = ("cpu_kernel_avx2.cpp", "restricted_nodes.cpp", "stepping_solver.cpp")
STEPS = "frontalis::SteppingSolver::advance*"


def library_without(effects, build, folder):
    """Path of a solver's library without the effects."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        commands = json.load(file)
    objects = os.path.join(build, "CMakeFiles", "frontalis_solver.dir")
    replaced = {}
    for entry in commands:
        name = os.path.basename(entry["file"])
        if name in SOURCES and "/src/solver/" in entry["file"]:
            words = shlex.split(entry["command"])
            old = words[words.index("-o") + 1]
            new = os.path.join(folder, name + ".o")
            words[words.index("-o") + 1] = new
            words += ["-DFRONTALIS_WITHOUT_" + effect.upper() for effect in effects]
            subprocess.run(words, cwd=entry["directory"], check=True)
            replaced[os.path.normpath(os.path.join(entry["directory"], old))] = new
    files = []
    for place, _, names in os.walk(objects):
        for name in names:
            if name.endswith(".o"):
                path = os.path.normpath(os.path.join(place, name))
                files.append(replaced.get(path, path))
    library = os.path.join(folder, "libfrontalis_solver.so")
    subprocess.run(["c++", "-shared", "-o", library, "-Wl,-soname,libfrontalis_solver.so"] + sorted(files), check=True)
    return library


def instructions(program, model, library, folder):
    """Instructions of a run's steps."""
    environment = dict(os.environ, FRONTALIS_INSTRUCTION_SET="avx2")
    if library:
        environment["LD_PRELOAD"] = library
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=" + os.path.join(folder, "callgrind"),
               "--toggle-collect=" + STEPS, program, "run", model, "--backend", "cpu", "--threads", "1",
               "--seconds", "0.004", "--frame-rate", "250", "--guard", "0"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return int(re.search(r"Collected : (\d+)", done.stderr).group(1))


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: effect_absence.py BUILD PROGRAM SCENE")
    build, program, scene = sys.argv[1:]
    print("%-28s %16s %16s %10s" % ("absent", "instructions", "without it", "more [%]"))
    with open(scene, encoding="utf-8") as file:
        text = file.read()
    for effects in EFFECTS:
        with tempfile.TemporaryDirectory() as folder:
            changed, model = os.path.join(folder, "scene.yaml"), os.path.join(folder, "model.vtkhdf")
            with open(changed, "w", encoding="utf-8") as file:
                file.write(text + "effects: {%s}\n" % ", ".join(effect + ": off" for effect in effects))
            subprocess.run([program, "bake", changed, "-o", model], capture_output=True, check=True)
            library = library_without(effects, build, folder)
            here, there = (instructions(program, model, which, folder) for which in (None, library))
            print("%-28s %16d %16d %10.4f" % (", ".join(effects), here, there, 100 * (here - there) / there), flush=True)


if __name__ == "__main__":
    main()
