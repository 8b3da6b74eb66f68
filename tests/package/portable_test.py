"""./dev package --portable builds an archive and a wheel that need glibc 2.35 and GCC 12's libstdc++ alone; both run on
bare systems.

PILLARFIELD_WORK keeps the bare systems, which debootstrap makes once from Debian's mirror.
"""

import os
import pathlib
import re
import shutil
import subprocess
import tarfile
import unittest
import zipfile

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
BUILT = SOURCE / "build/package"
# Libraries that every Linux has, and the loaders beside the programs.
ALLOWED = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "libstdc++.so.6", "libgcc_s.so.1",
           "libOpenCL.so.1", "libvulkan.so.1"}
(SCENE,) = SOURCE.glob("scenes/**/spin.toml")
# The README's first five minutes.
FIRST = """
pillarfield simulate /opt/spin.toml -o spin.h5
pillarfield solve spin.h5 -o forces.h5
pillarfield compare forces.h5 spin.h5
pillarfield solve spin.h5 -o contact.h5 --estimator contact --contacts contacts.csv
"""
SOLVE = """cd $(mktemp -d)
pillarfield simulate %s -q -o spin.h5
pillarfield solve spin.h5 --device %s -q -o forces.npy
cat *.npy | sha256sum"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          **options)
    if done.returncode:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout[-4000:]}")
    return done.stdout


def only(pattern):
    (path,) = BUILT.glob(pattern)
    return path


def build():
    for old in [*BUILT.glob("*.whl"), *BUILT.glob("*.tar.*")]:
        old.unlink()
    run(SOURCE / "dev", "package", "--portable")


def setUpModule():
    if not all(map(shutil.which, ("zstd", "help2man"))) or not pathlib.Path("/etc/debian_version").exists():
        print("skipped: ./dev setup package installs what is needed, on Debian 12")
        raise SystemExit(0)
    shutil.rmtree(WORK / "unpacked", ignore_errors=True)
    (WORK / "unpacked/wheel").mkdir(parents=True)
    build()
    run("tar", "-xf", only("*.tar.zst"), "-C", WORK / "unpacked")
    zipfile.ZipFile(only("*.whl")).extractall(WORK / "unpacked/wheel")


def compiled_files():
    for path in sorted((WORK / "unpacked").rglob("*")):
        if path.is_file() and not path.is_symlink():
            with open(path, "rb") as file:
                if file.read(4) == b"\x7fELF":
                    yield path


class Files(unittest.TestCase):
    def test_sizes(self):
        self.assertLess(only("*.tar.zst").stat().st_size, 25e6)
        self.assertLess(only("*.whl").stat().st_size, 15e6)

    def test_symbols_are_as_old_as_the_tag(self):
        newest = {"GLIBC": (2, 35), "GLIBCXX": (3, 4, 30), "CXXABI": (1, 3, 13)}
        files = list(compiled_files())
        self.assertGreater(len(files), 12)
        for path in files:
            for name, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([\d.]+)", run("readelf", "-V", path)):
                self.assertLessEqual(tuple(map(int, version.split("."))), newest[name], path)

    def test_needs(self):
        for path in compiled_files():
            dynamic = run("readelf", "-d", path)
            for name in re.findall(r"NEEDED.*\[(.*)\]", dynamic):
                self.assertTrue(name in ALLOWED or name.startswith("libpillarfield_"), f"{path}: {name}")
            for folder in ":".join(re.findall(r"(?:RPATH|RUNPATH).*\[(.*)\]", dynamic)).split(":"):
                self.assertRegex(folder, r"^(\$ORIGIN.*|)$", path)
            self.assertNotIn(os.fsencode(SOURCE), path.read_bytes(), path)

    def test_licences_of_what_is_inside(self):
        for folder in (WORK / "unpacked").rglob("contains"), (WORK / "unpacked").rglob("licences"):
            (licences,) = folder
            self.assertGreater(len(list(licences.iterdir())), 18)

    def test_programs_link_its_library(self):
        (archive,) = (WORK / "unpacked").glob("pillarfield-*")
        said = run("bash", "-ec", f"""
            export PKG_CONFIG_PATH={archive}/lib/pkgconfig LD_LIBRARY_PATH={archive}/lib
            g++ -std=c++20 {SOURCE}/examples/solve_frame.cpp $(pkg-config --cflags --libs pillarfield) -o solve_frame
            ./solve_frame
            cmake -S {SOURCE}/examples -B examples -G Ninja -D CMAKE_PREFIX_PATH={archive} >/dev/null
            cmake --build examples --target solve_frame >/dev/null
            examples/solve_frame""", cwd=WORK / "unpacked")
        self.assertEqual(len(set(said.splitlines())), 1, said)

    def test_source_builds_from_its_own_files(self):
        with tarfile.open(only("*.tar.gz")) as source:
            names = {name.partition("/")[2] for name in source.getnames()}
        self.assertLessEqual({"PKG-INFO", "pyproject.toml", "setup.py", "CMakeLists.txt", "kernels/all.h"}, names)


class Bare:
    """A minimal Debian with nothing but Python."""

    suite = ""

    @classmethod
    def setUpClass(cls):
        if os.geteuid() != 0 or not shutil.which("debootstrap"):
            raise unittest.SkipTest("root and debootstrap make bare systems")
        pristine = WORK / cls.suite
        if not pristine.exists():
            made = subprocess.run(["debootstrap", "--variant=minbase", "--include=python3", cls.suite,
                                   f"{pristine}.part"], stdout=subprocess.DEVNULL)
            if made.returncode:
                shutil.rmtree(f"{pristine}.part", ignore_errors=True)
                raise unittest.SkipTest("debootstrap does not reach a mirror of Debian")
            os.rename(f"{pristine}.part", pristine)
        cls.root = WORK / f"{cls.suite}.root"
        shutil.rmtree(cls.root, ignore_errors=True)
        run("cp", "-a", pristine, cls.root)
        shutil.copy("/etc/resolv.conf", cls.root / "etc")
        (unpacked,) = (WORK / "unpacked").glob("pillarfield-*")
        run("cp", "-a", unpacked, cls.root / "opt/pillarfield")
        for file in only("*.whl"), SCENE:
            shutil.copy(file, cls.root / "opt")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def enter(self, script, path="/opt/pillarfield/bin:/usr/bin:/bin:/usr/sbin:/sbin"):
        within = 'mount --rbind /sys "$0/sys" && exec chroot "$0" bash -ec "$1"'
        return run("unshare", "-mpf", f"--mount-proc={self.root}/proc", "bash", "-c", within, self.root,
                   f"cd $(mktemp -d)\n{script}",
                   env={"PATH": path, "HOME": "/root", "DEBIAN_FRONTEND": "noninteractive"})

    def install(self, packages):
        self.enter(f"apt-get update -qq && apt-get install -qq --yes --no-install-recommends {packages}")

    def test_1_archive(self):
        self.enter(FIRST)
        self.assertIn("host", self.enter("pillarfield info --devices"))
        self.assertNotIn("not found", self.enter("cd /opt/pillarfield && ldd bin/* lib/libpillarfield_pipeline.so"))

    def test_2_results_are_those_of_the_release(self):
        path = f"{pathlib.Path(os.environ['PILLARFIELD']).parent}:{os.environ['PATH']}"
        local = run("bash", "-ec", SOLVE % (SCENE, "host"), env={**os.environ, "PATH": path})
        self.assertEqual(self.enter(SOLVE % ("/opt/spin.toml", "host")), local)

    def test_3_viewer_without_vulkan_says_what_is_missing(self):
        said = self.enter("! pillarfield-viewer /opt/spin.toml --headless --png spin.png 2>&1")
        self.assertRegex(said, r"\A[^\n]*Vulkan[^\n]*no driver[^\n]*mesa-vulkan-drivers[^\n]*\n\Z")

    def test_4_wheel(self):
        self.install("python3-numpy python3-pip")
        said = self.enter("""
            pip install --no-index --no-deps --break-system-packages /opt/*.whl
            pillarfield --version
            pillarfield simulate /opt/spin.toml -o spin.h5
            ! pillarfield-viewer spin.h5 --headless --png spin.png
            cd /
            python3 -c 'if True:
                import numpy, pillarfield as pf
                frames = numpy.full((5, 8, 12), 32, numpy.uint8)
                print(repr(pf.solve(frames, counts_per_newton=320)))'
        """, path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin")
        self.assertIn("<ForceField: 5 frames of 8 x 12 sensels, 0.1..0.1 N>", said)

    def test_5_viewer_and_devices_with_drivers(self):
        self.install("mesa-vulkan-drivers pocl-opencl-icd")
        host, device = (self.enter(SOLVE % ("/opt/spin.toml", device)) for device in ("host", "opencl"))
        self.assertEqual(device, host)
        self.enter("pillarfield-viewer /opt/spin.toml --headless --png spin.png && test -s spin.png")


class Debian12(Bare, unittest.TestCase):
    suite = "bookworm"


class Debian13(Bare, unittest.TestCase):
    suite = "trixie"


if __name__ == "__main__":
    unittest.main()
