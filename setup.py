"""Builds the Python package with CMake: pip install --no-build-isolation . (docs/python.md)."""

import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent
VERSION = re.search(r"project\(pillarfield VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    """Builds the target pillarfield_python and takes its library."""

    def build_extension(self, extension):
        build = pathlib.Path(self.build_temp).resolve()
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        f"-DPython_EXECUTABLE={sys.executable}",
                        "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=0",
                        *(f"-DPILLARFIELD_{part}=OFF" for part in ("TESTS", "LABORATORY", "VIEWER"))],
                       check=True)
        subprocess.run(["cmake", "--build", build, "--target", "pillarfield_python"], check=True)
        (library,) = (build / "python/pillarfield").glob("_core*.so")
        self.copy_file(library, self.get_ext_fullpath(extension.name))


setup(version=VERSION, ext_modules=[Extension("pillarfield._core", [])],
      packages=["pillarfield"], package_dir={"pillarfield": "python/pillarfield"},
      package_data={"pillarfield": ["py.typed", "*.pyi"]}, cmdclass={"build_ext": CMakeBuild})
