#!/usr/bin/python3
"""Whether an effect costs a scene without it nothing. The solver's library is linked again with those sources compiled
without the effect that know of it: the instructions of the same steps are counted by valgrind with both libraries, and
the bytes that both hold, array by array, are compared. Where nvcc is, the GPU's step kernels are compiled both ways too,
and the machine code of those that a scene without the effect can be given is compared byte for byte."""

import concurrent.futures
import json
import os
import re
import shlex
import struct
import subprocess
import sys
import tempfile

# an effect goes with those that need it, and passive with active fibres, which share what is stored
EFFECTS = (("viscosity",), ("contraction", "fibre_stiffness"), ("gravity",), ("surface_loads",),
           ("prescribed_displacement",), ("rigid_nodes",), ("sliding", "friction"), ("friction",))
STEPS = "frontalis::SteppingSolver::advance*"
KERNELS = tuple(kind + "_kernel" + nodes + ".cu" for kind in ("patch", "step")
                for nodes in ("", "_sliding", "_friction"))
# bits of Effects (cuda/step_kernel.hpp)
KERNEL_BITS = {"contraction": 1, "fibre_stiffness": 1, "viscosity": 2, "sliding": 8, "friction": 32}


def commands_of(build):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        return json.load(file)


def definitions(effects):
    return ["-DFRONTALIS_WITHOUT_" + effect.upper() for effect in effects]


def knows_of_effects(entry):
    """Whether built_effects.hpp is among what a source includes; valgrind knows no AVX-512."""
    if "frontalis_solver.dir" not in entry["command"] or not entry["file"].endswith(".cpp"):
        return False
    if re.search(r"_(avx512|baseline)\.cpp$", entry["file"]):
        return False
    words = shlex.split(entry["command"])
    words = words[:words.index("-o")] + ["-MM", entry["file"]]
    done = subprocess.run(words, cwd=entry["directory"], capture_output=True, text=True, check=True)
    return "built_effects.hpp" in done.stdout


def library_without(effects, entries, build, folder):
    """Path of a solver's library without the effects."""
    def compiled(entry):
        words = shlex.split(entry["command"])
        at = words.index("-o") + 1
        old, words[at] = words[at], os.path.join(folder, os.path.basename(entry["file"]) + ".o")
        subprocess.run(words + definitions(effects), cwd=entry["directory"], check=True)
        return os.path.normpath(os.path.join(entry["directory"], old)), words[at]

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        replaced = dict(pool.map(compiled, entries))
    files = []
    for place, _, names in os.walk(os.path.join(build, "CMakeFiles", "frontalis_solver.dir")):
        for name in names:
            if name.endswith(".o"):
                path = os.path.normpath(os.path.join(place, name))
                files.append(replaced.get(path, path))
    library = os.path.join(folder, "libfrontalis_solver.so")
    cudart = [path for path in ("/usr/local/cuda/lib64/libcudart_static.a",) if os.path.exists(path)]
    subprocess.run(["c++", "-shared", "-o", library, "-Wl,-soname,libfrontalis_solver.so"] + sorted(files) + cudart +
                   ["-ldl", "-lrt", "-lpthread"], check=True)
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


def allocations(program, model, library):
    """Bytes of each array of a solver."""
    environment = dict(os.environ, **({"LD_PRELOAD": library} if library else {}))
    command = [program, "effects", model, "--backend", "cpu", "--threads", "1", "--arrays"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout


def compare_on_cpu(build, program, scene):
    print("%-28s %16s %16s %10s  %s" % ("absent", "instructions", "without it", "more [%]", "arrays"))
    entries = [entry for entry in commands_of(build) if knows_of_effects(entry)]
    with open(scene, encoding="utf-8") as file:
        text = file.read()
    for effects in EFFECTS:
        with tempfile.TemporaryDirectory() as folder:
            changed, model = os.path.join(folder, "scene.yaml"), os.path.join(folder, "model.vtkhdf")
            with open(changed, "w", encoding="utf-8") as file:
                file.write(text + "effects: {%s}\n" % ", ".join(effect + ": off" for effect in effects))
            subprocess.run([program, "bake", changed, "-o", model], capture_output=True, check=True)
            library = library_without(effects, entries, build, folder)
            here, there = (instructions(program, model, which, folder) for which in (None, library))
            same = allocations(program, model, None) == allocations(program, model, library)
            print("%-28s %16d %16d %10.4f  %s" % (", ".join(effects), here, there, 100 * (here - there) / there,
                                                  "the same bytes" if same else "differ"), flush=True)


def without_targets(code):
    """Instructions, 16 bytes each, where calls (CALL.REL) do not say where the called function has come to lie."""
    instructions = (code[i:i + 16] for i in range(0, len(code), 16))
    return b"".join(i[:2] + bytes(14) if struct.unpack_from("<H", i)[0] & 0xfff == 0x944 else i for i in instructions)


def machine_code(cubin):
    """Of each kernel and of each function that it calls: its name, its code. A kernel's own code lies before that of the
    functions."""
    with open(cubin, "rb") as file:
        data = file.read()
    header, = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<HH", data, 58)
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, header + i * size) for i in range(count)]
    table = next(section for section in sections if section[1] == 2)
    strings = sections[table[6]][4]
    functions = []
    for at in range(table[4], table[4] + table[5], 24):
        name, info, _, section, value, length = struct.unpack_from("<IBBHQQ", data, at)
        if info & 15 == 2 and 0 < section < count:
            text = data[strings + name:data.index(b"\0", strings + name)].decode()
            functions.append((text, section, value, length))
    code = {}
    for name, section, value, length in functions:
        if name.startswith("$"):
            continue
        inner = [f[2] for f in functions if f[1] == section and f[0].startswith("$")]
        start = sections[section][4] + value
        code[name] = without_targets(data[start:start + min([length] + inner)])
    return code


def cubins(entries, effects, folder):
    """Machine code of all step kernels, compiled without the effects."""
    def compiled(entry):
        words = [word for word in shlex.split(entry["command"]) if not word.startswith("--generate-code")]
        # not through a cache of compilations: what it stores is another kind of file
        words = words[next(i for i, word in enumerate(words) if os.path.basename(word) == "nvcc"):]
        words[words.index("-o") + 1] = os.path.join(folder, os.path.basename(entry["file"]) + ".cubin")
        words[words.index("-c")] = "-cubin"
        words = [word for word in words if word != "-MD"]
        for flag in ("-MT", "-MF"):
            if flag in words:
                del words[words.index(flag):words.index(flag) + 2]
        subprocess.run(words + ["-arch=sm_90"] + definitions(effects), cwd=entry["directory"], check=True)
        return machine_code(words[words.index("-o") + 1])

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return {name: code for codes in pool.map(compiled, entries) for name, code in codes.items()}


def compare_on_gpu(build):
    entries = [entry for entry in commands_of(build) if os.path.basename(entry["file"]) in KERNELS]
    if not entries:
        print("no nvcc: kernels of the GPU are not compared")
        return
    print("%-28s %16s %16s %24s" % ("absent", "kernels for it", "the same code", "as many instructions"))
    with tempfile.TemporaryDirectory() as folder:
        whole = cubins(entries, (), folder)
    for effects in EFFECTS:
        bits = 0
        for effect in effects:
            bits |= KERNEL_BITS.get(effect, 0)
        with tempfile.TemporaryDirectory() as folder:
            without = cubins(entries, effects, folder)
        # the last number in a kernel's name is its set of effects
        sets = {name: re.findall(r"Li(\d+)E", name) for name in whole}
        chosen = [name for name in whole if sets[name] and not int(sets[name][-1]) & bits]
        same = sum(whole[name] == without[name] for name in chosen)
        as_many = sum(len(whole[name]) == len(without[name]) for name in chosen)
        print("%-28s %16d %16d %24d" % (", ".join(effects), len(chosen), same, as_many), flush=True)


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: effect_absence.py BUILD PROGRAM SCENE")
    compare_on_cpu(*sys.argv[1:])
    compare_on_gpu(sys.argv[1])


if __name__ == "__main__":
    main()
