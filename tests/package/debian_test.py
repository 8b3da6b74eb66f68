"""./dev package builds the Debian packages; each holds what it should, and lintian finds no error."""

import os
import pathlib
import re
import shutil
import subprocess
import unittest

SOURCE = pathlib.Path(os.environ["PILLARFIELD_SOURCE"])
BUILT = SOURCE / "build/package"
WANTED = {
    r"pillarfield": [r"/usr/bin/pillarfield$", r"/man1/pillarfield\.1\.gz$", r"/man1/pillarfield-solve\.1\.gz$",
                     r"/bash-completion/completions/pillarfield$", r"/vendor-completions/_pillarfield$",
                     r"/vendor_completions\.d/pillarfield\.fish$"],
    r"pillarfield-viewer": [r"/usr/bin/pillarfield-viewer$", r"/applications/pillarfield-viewer\.desktop$",
                            r"/apps/pillarfield-viewer\.svg$", r"/man1/pillarfield-viewer\.1\.gz$"],
    r"libpillarfield\d+\.\d+": [rf"/libpillarfield_{layer}\.so\.\d+\.\d+$"
                                for layer in ("core", "device", "io", "streams", "pipeline")],
    r"libpillarfield-dev": [r"/include/pillarfield/pillarfield\.h$", r"/pillarfieldConfig\.cmake$",
                            r"/pkgconfig/pillarfield\.pc$", r"/libpillarfield_core\.so$", r"/solve_frame\.cpp$"],
    r"pillarfield-doc": [r"/html/index\.html$", r"/html/tutorial\.html$", r"/scenes/demo\.toml$", r"/CITATION\.cff$"],
    r"python3-pillarfield": [r"/python3/dist-packages/pillarfield/__init__\.py$", r"/pillarfield/_core\..*\.so$"],
}


def output(*command):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout


def setUpModule():
    if not all(map(shutil.which, ("dpkg-shlibdeps", "help2man", "lintian", "doxygen"))):
        print("skipped: ./dev setup package docs installs what is needed")
        raise SystemExit(0)
    done = subprocess.run([SOURCE / "dev", "package"], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        raise AssertionError(done.stdout[-4000:])


class Packages(unittest.TestCase):
    def setUp(self):
        self.packages = {path.name.split("_")[0]: path for path in BUILT.glob("*.deb")}
        self.files = {name: [line.split(None, 5)[5].split(" -> ")[0].removeprefix(".")
                             for line in output("dpkg-deb", "-c", str(path)).splitlines()]
                      for name, path in self.packages.items()}

    def test_each_holds_what_it_should(self):
        for name, wanted in WANTED.items():
            found = [files for package, files in self.files.items() if re.fullmatch(name, package)]
            self.assertEqual(len(found), 1, name)
            for pattern in [*wanted, r"/copyright$", r"/changelog\.Debian\.gz$"]:
                self.assertTrue(any(re.search(pattern, file) for file in found[0]), f"{name}: {pattern}")
        self.assertEqual(len(self.packages), len(WANTED))

    def test_no_file_is_in_two(self):
        files = [file for held in self.files.values() for file in held if not file.endswith("/")]
        self.assertEqual(len(files), len(set(files)))

    def test_nothing_names_the_build_tree(self):
        for name, path in self.packages.items():
            content = subprocess.run(["dpkg-deb", "--fsys-tarfile", path], check=True, stdout=subprocess.PIPE).stdout
            self.assertNotIn(os.fsencode(SOURCE), content, name)

    def test_lintian_finds_no_error(self):
        done = subprocess.run(["lintian", "--allow-root", *self.packages.values()], text=True,
                              stdout=subprocess.PIPE)
        self.assertEqual([line for line in done.stdout.splitlines() if line.startswith("E:")], [])


if __name__ == "__main__":
    unittest.main()
