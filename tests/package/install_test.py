"""Installs a copy, builds and runs the examples against it, and runs the README.

PILLARFIELD_BUILD is the installed build tree, PILLARFIELD_WORK the folder of the test.
"""

import csv
import gzip
import importlib.util
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
from xml.etree import ElementTree

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
HOME = WORK / "home"
PREFIX = HOME / ".local"
ENVIRONMENT = {**os.environ, "HOME": str(HOME), "PATH": f"{PREFIX}/bin:{os.environ['PATH']}"}
README = (SOURCE / "README.md").read_text()


def run(*command, cwd=WORK):
    done = subprocess.run([str(word) for word in command], cwd=cwd, env=ENVIRONMENT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def readme_blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def setUpModule():
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    run("cmake", "--install", os.environ["PILLARFIELD_BUILD"], "--prefix", PREFIX)
    run("cmake", "-S", SOURCE / "examples", "-B", "examples", "-G", "Ninja",
        "-D", f"CMAKE_PREFIX_PATH={PREFIX}", "-D", "CMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "--build", "examples")


class Examples(unittest.TestCase):
    def test_a_frame_in_memory(self):
        self.assertEqual(run("examples/solve_frame"),
                         "row 3, column 4: shear (0.199, 0.000) N, normal 0.500 N\n")

    def test_a_live_loop_with_tare(self):
        lines = run("examples/live").splitlines()
        tare = re.fullmatch(r"tare ([\d.]+) counts, noise ([\d.]+) counts, 0 sensels masked", lines[0])
        self.assertAlmostEqual(float(tare[1]), 100, delta=0.5)
        self.assertAlmostEqual(float(tare[2]), 1, delta=0.2)
        self.assertEqual(len(lines), 6)
        for pressed, line in enumerate(lines[1:]):
            total = float(re.fullmatch(r"frame \d+: ([\d.]+) N", line)[1])
            self.assertAlmostEqual(total, 0.5 * pressed, delta=0.02)

    def test_a_simulated_scene_and_its_contacts(self):
        errors = run("examples/simulate", SOURCE / "scenes/touch/spin.toml", "spin.h5")
        rms = {m[1]: float(m[2]) for m in re.finditer(r"region (\d): .* error ([\d.]+) N", errors)}
        self.assertLess(rms["1"], 0.001)
        self.assertGreater(rms["3"], rms["1"])
        table = list(csv.DictReader(io.StringIO(run("examples/contacts", "spin.h5"))))
        self.assertEqual([row["id"] for row in table], ["1"])
        # A ball of 60 N that spins about the centre of the patch.
        self.assertAlmostEqual(float(table[0]["normal_n"]), 60, delta=1)
        self.assertAlmostEqual(float(table[0]["shear_x_n"]), 0, delta=0.5)
        self.assertAlmostEqual(float(table[0]["x_mm"]), 0, delta=0.1)

    def test_solving_on_the_host_links_no_opencl(self):
        self.assertNotIn("libOpenCL", run("readelf", "--dynamic", "examples/simulate"))
        self.assertIn("libOpenCL", run("readelf", "--dynamic", "examples/solve_frame"))

    def test_the_core_is_found_without_opencl_and_hdf5(self):
        folder = WORK / "core"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(core LANGUAGES CXX)\n"
            "find_package(pillarfield REQUIRED COMPONENTS core)\n"
            "add_executable(core main.cpp)\ntarget_link_libraries(core PRIVATE pillarfield::core)\n")
        (folder / "main.cpp").write_text(
            "#include <pillarfield/pillarfield.h>\n"
            "int main() {\n"
            "  pillarfield::SolverPlan plan;\n"
            "  plan.skin.rows = plan.skin.cols = 2;\n"
            "  const std::uint8_t readings[] = {80, 80, 80, 80};  // 0.25 N\n"
            "  const auto forces = solve_on_host(plan, {readings, plan.sensel_type, 2, 2, 2});\n"
            "  return forces.normal[0] == 0.25F ? 0 : 1;\n"
            "}\n")
        run("cmake", "-S", "core", "-B", "core/build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={PREFIX}",
            "-DCMAKE_DISABLE_FIND_PACKAGE_OpenCL=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON")
        run("cmake", "--build", "core/build")
        run("core/build/core")


    def test_the_loop_of_the_docs_finds_the_six_bodies_of_a_relayed_scene(self):
        [loop] = re.findall(r"^## In C\+\+$.*?^```cpp\n(.*?)^```$", (SOURCE / "docs/streams.md").read_text(),
                            re.MULTILINE | re.DOTALL)
        includes, body = loop.split("using namespace pillarfield;\n")
        name = f"pillarfield-docs-{os.getpid()}"
        folder = WORK / "loop"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(loop LANGUAGES CXX)\n"
            "find_package(pillarfield REQUIRED)\nadd_executable(loop main.cpp)\n"
            "target_link_libraries(loop PRIVATE pillarfield::pillarfield)\n")
        (folder / "main.cpp").write_text(
            f"#include <cstdio>\n#include <cstdlib>\n{includes}using namespace pillarfield;\n"
            "void hold(std::uint64_t id, double normal_n, const std::optional<double>&) {\n"
            "  static int calls = 0;\n"
            "  std::printf(\"%d %.1f\\n\", static_cast<int>(id), normal_n);\n"
            "  if (++calls == 300) std::exit(0);\n}\n"
            f"int main() {{\n{body.replace('shm:skin', 'shm:' + name)}}}\n")
        run("cmake", "-S", "loop", "-B", "loop/build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={PREFIX}")
        run("cmake", "--build", "loop/build")
        stream = subprocess.Popen([PREFIX / "bin/pillarfield", "stream", SOURCE / "scenes/demo.toml", "--repeat",
                                   "--rate", "100", "--relay", f"shm:{name}"], env=ENVIRONMENT,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            lines = [line.split() for line in run("loop/build/loop").splitlines()]
        finally:
            stream.terminate()
            stream.wait()
        frames = [[]]
        for track, force in lines:
            if track in [seen for seen, _ in frames[-1]]:
                frames.append([])
            frames[-1].append((track, float(force)))
        sizes = [len(frame) for frame in frames[1:-1]]
        self.assertGreater(sizes.count(6), 0.9 * len(sizes), sizes)
        self.assertTrue(all(5 < force < 130 for frame in frames for _, force in frame))


class Desktop(unittest.TestCase):
    def test_man_pages_of_all_commands(self):
        if os.environ["PILLARFIELD_MAN_PAGES"] == "0":
            self.skipTest("built without help2man")
        commands = [line.split("\t")[0] for line in run("pillarfield", "completion", "words", "--").splitlines()]
        wanted = {"pillarfield", *(f"pillarfield-{name}" for name in commands if not name.startswith("--"))}
        pages = {path.name.removesuffix(".1.gz"): gzip.open(path, "rt").read()
                 for path in (PREFIX / "share/man/man1").iterdir()}
        self.assertEqual(wanted - pages.keys(), set())
        self.assertIn("pillarfield-calibrate-tare", pages)
        for name, text in pages.items():
            with self.subTest(page=name):
                self.assertIn(f".TH {name.upper()} ", text)
                self.assertIn(name.replace("-", "\\-") + " \\- ", text)
                if shutil.which("groff"):
                    done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], input=text, text=True,
                                          capture_output=True)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_completion(self):
        script = PREFIX / "share/bash-completion/completions/pillarfield"
        self.assertEqual(run("bash", "-c", f". {script}; COMP_WORDS=(pillarfield sol); COMP_CWORD=1; _pillarfield; "
                             "echo ${COMPREPLY[@]}"), "solve\n")

    def test_desktop_entry_and_icon(self):
        entry = PREFIX / "share/applications/pillarfield-viewer.desktop"
        if not entry.exists():
            self.skipTest("no viewer")
        if shutil.which("desktop-file-validate"):
            self.assertEqual(run("desktop-file-validate", entry), "")
        values = dict(re.findall("^([A-Z]\\w+)=(.*)$", entry.read_text(), re.MULTILINE))
        self.assertTrue((PREFIX / "bin" / values["Exec"].split()[0]).exists())
        drawing = ElementTree.parse(PREFIX / f"share/icons/hicolor/scalable/apps/{values['Icon']}.svg")
        self.assertEqual(drawing.getroot().tag, "{http://www.w3.org/2000/svg}svg")


class Version(unittest.TestCase):
    def test_citation_changelog_and_program_agree(self):
        version = run("pillarfield", "--version").split()[1]
        keys = dict(re.findall(r"^([a-z-]+): *(.*)$", (SOURCE / "CITATION.cff").read_text(), re.MULTILINE))
        self.assertLessEqual({"cff-version", "message", "title", "type", "authors", "license"}, keys.keys())
        self.assertEqual(keys["version"], version)
        newest = re.search(r"^## \[(\d.*?)\] - (.*)$", (SOURCE / "CHANGELOG.md").read_text(), re.MULTILINE)
        self.assertEqual((newest[1], newest[2]), (version, keys["date-released"]))


class Readme(unittest.TestCase):
    def test_its_program_is_of_the_example(self):
        self.assertIn(readme_blocks("cpp")[0], (SOURCE / "examples/solve_frame.cpp").read_text())

    def test_its_commands_work_as_printed(self):
        folder = WORK / "readme"
        folder.mkdir()
        for name in ("scenes", "examples"):
            (folder / name).symlink_to(SOURCE / name)
        build, first, own, program = readme_blocks("sh")
        self.assertIn("./dev demo", build)
        self.assertIn("cmake --install build/release --prefix $HOME/.local", build)
        if not (PREFIX / "bin/pillarfield-viewer").exists():
            first = re.sub("^pillarfield-viewer.*\n", "", first, flags=re.MULTILINE)
        run("bash", "-ec", first, cwd=folder)
        own_frames, plot = readme_blocks("python")
        run(sys.executable, "-c", own_frames, cwd=folder)
        if list(PREFIX.glob("lib/python3*/site-packages/pillarfield")) and importlib.util.find_spec("matplotlib"):
            begin = "import matplotlib\nmatplotlib.use('Agg')\n"  # Python finds the package of the user.
            run(sys.executable, "-c", begin + own_frames + plot, cwd=folder)
            self.assertTrue((folder / "mine.png").exists())
        run("bash", "-ec", own, cwd=folder)
        output = run("bash", "-ec", program, cwd=folder).splitlines()[-2:]
        self.assertEqual(output, 2 * [re.search("# (row 3.*)", program)[1]])

        import h5py
        with h5py.File(folder / "mine_forces.h5") as forces:
            normal = forces["force/normal"][:].sum(axis=(1, 2))
        self.assertAlmostEqual(normal[:100].max(), 0, delta=0.1)
        self.assertAlmostEqual(normal[100:].mean(), 100, delta=0.5)  # 200 sensels of 160 counts


if __name__ == "__main__":
    unittest.main()
