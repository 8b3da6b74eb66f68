"""./dev package --portable builds an archive and a wheel that need glibc 2.35 and GCC 12's libstdc++ alone; both run on
bare systems, which debootstrap makes once in PILLARFIELD_WORK.
"""

import os
import pathlib
import re
import shutil
import subprocess
import unittest
import zipfile

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
WORK = pathlib.Path(os.environ["PILLARFIELD_WORK"])
BUILT = SOURCE / "build/package"
UNPACKED = WORK / "unpacked"
# Libraries that every Linux has, and the loaders beside the programs.
NEEDED = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "libstdc++.so.6", "libgcc_s.so.1", "libOpenCL.so.1",
          "libvulkan.so.1"}
NEWEST = {"GLIBC": (2, 35), "GLIBCXX": (3, 4, 30), "CXXABI": (1, 3, 13)}
FIRST_MINUTES = re.search(r"^pillarfield simulate .*?^```", (SOURCE / "README.md").read_text(), re.M | re.S)[0]
SOLVE = """cd $(mktemp -d)
pillarfield simulate {0}/scenes/demo.toml -q -o demo.h5
pillarfield solve demo.h5 --device {1} -q -o forces.npy
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
    if not all(map(shutil.which, ("zstd", "help2man", "apt-get"))):
        print("skipped: ./dev setup package installs what is needed, on Debian 12")
        raise SystemExit(0)
    build()
    shutil.rmtree(UNPACKED, ignore_errors=True)
    (UNPACKED / "archive").mkdir(parents=True)
    run("tar", "-xf", only("*.tar.zst"), "-C", UNPACKED / "archive", "--strip-components=1")
    zipfile.ZipFile(only("*.whl")).extractall(UNPACKED / "wheel")


class Files(unittest.TestCase):
    def test_sizes_and_licences(self):
        self.assertLess(only("*.tar.zst").stat().st_size, 25e6)
        self.assertLess(only("*.whl").stat().st_size, 15e6)
        for name in "contains", "licences":
            self.assertGreater(len(list(next(UNPACKED.rglob(name)).iterdir())), 18)

    def test_symbols_and_needed_libraries(self):
        files = [path for path in sorted(UNPACKED.rglob("*"))
                 if path.is_file() and not path.is_symlink() and path.read_bytes()[:4] == b"\x7fELF"]
        self.assertGreater(len(files), 12)
        for path in files:
            read = run("readelf", "-Vd", path)
            for name, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([\d.]+)", read):
                self.assertLessEqual(tuple(map(int, version.split("."))), NEWEST[name], path)
            for name in re.findall(r"NEEDED.*\[(.*)\]", read):
                self.assertTrue(name in NEEDED or name.startswith("libpillarfield_"), f"{path}: {name}")
            for folders in re.findall(r"(?:RPATH|RUNPATH)\).*\[(.*)\]", read):
                self.assertTrue(all(each.startswith("$ORIGIN/") for each in folders.split(":")), f"{path}: {folders}")
            self.assertNotIn(os.fsencode(SOURCE), path.read_bytes(), path)

    def test_programs_link_its_library(self):
        said = run("bash", "-ec", f"""
            export PKG_CONFIG_PATH={UNPACKED}/archive/lib/pkgconfig LD_LIBRARY_PATH={UNPACKED}/archive/lib
            g++ -std=c++20 {SOURCE}/examples/solve_frame.cpp $(pkg-config --cflags --libs pillarfield) -o solve_frame
            ./solve_frame
            cmake -S {SOURCE}/examples -B examples -G Ninja -D CMAKE_PREFIX_PATH={UNPACKED}/archive >/dev/null
            cmake --build examples --target solve_frame >/dev/null
            examples/solve_frame""", cwd=WORK)
        self.assertEqual(len(set(said.splitlines())), 1, said)


class Debian13(unittest.TestCase):
    """A minimal system with nothing but Python."""

    suite = "trixie"

    def setUp(self):
        if os.geteuid() != 0 or not shutil.which("debootstrap"):
            self.skipTest("root and debootstrap make bare systems")
        bare = WORK / self.suite
        if not bare.exists():
            made = subprocess.run(["debootstrap", "--variant=minbase", "--include=python3", self.suite, f"{bare}.part"],
                                  stdout=subprocess.DEVNULL)
            if made.returncode:
                shutil.rmtree(f"{bare}.part", ignore_errors=True)
                self.skipTest("debootstrap does not reach a mirror of Debian")
            os.rename(f"{bare}.part", bare)
        self.root = WORK / f"{self.suite}.root"
        self.addCleanup(shutil.rmtree, self.root, ignore_errors=True)
        run("cp", "-a", bare, self.root)
        run("cp", "-a", "/etc/resolv.conf", self.root / "etc")
        run("cp", "-a", SOURCE / "scenes", UNPACKED / "archive", only("*.whl"), self.root / "opt")

    def enter(self, script, path="/opt/archive/bin:/usr/bin:/bin:/usr/sbin:/sbin"):
        within = 'mount --rbind /sys "$0/sys" && exec chroot "$0" bash -ec "$1"'
        return run("unshare", "-mpf", f"--mount-proc={self.root}/proc", "bash", "-c", within, self.root,
                   f"cd /opt\n{script}", env={"PATH": path, "HOME": "/root", "DEBIAN_FRONTEND": "noninteractive"})

    def test_archive(self):
        self.assertNotIn("not found", self.enter("ldd archive/bin/* archive/lib/libpillarfield_pipeline.so"))
        self.enter(re.sub(r"^(pillarfield-viewer|```).*\n?", "", FIRST_MINUTES, flags=re.M))
        path = f"{pathlib.Path(os.environ['PILLARFIELD']).parent}:{os.environ['PATH']}"
        released = run("bash", "-ec", SOLVE.format(SOURCE, "host"), env={**os.environ, "PATH": path})
        self.assertEqual(self.enter(SOLVE.format("/opt", "host")), released)
        said = self.enter("! pillarfield-viewer scenes/demo.toml --headless --png demo.png")
        self.assertRegex(said, r"\A[^\n]*Vulkan[^\n]*no driver[^\n]*mesa-vulkan-drivers[^\n]*\n\Z")
        self.enter("apt-get update -qq && apt-get install -qq --yes --no-install-recommends mesa-vulkan-drivers "
                   "pocl-opencl-icd")
        self.assertEqual(self.enter(SOLVE.format("/opt", "opencl")), released)
        self.enter("pillarfield-viewer scenes/demo.toml --headless --png demo.png && test -s demo.png")

    def test_wheel(self):
        self.enter("apt-get update -qq && apt-get install -qq --yes --no-install-recommends python3-numpy python3-pip")
        said = self.enter("""
            pip install --no-index --no-deps --break-system-packages *.whl
            pillarfield simulate scenes/demo.toml -o demo.h5
            ! pillarfield-viewer demo.h5 --headless --png demo.png
            python3 -c 'import numpy, pillarfield as pf
            print(repr(pf.solve(numpy.full((5, 8, 12), 32, numpy.uint8), counts_per_newton=320)))'
        """.replace("\n            ", "\n"), path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin")
        self.assertIn("<ForceField: 5 frames of 8 x 12 sensels, 0.1..0.1 N>", said)


class Debian12(Debian13):
    suite = "bookworm"


if __name__ == "__main__":
    unittest.main()
