"""Builds the module of the Python package with CMake; everything else is in pyproject.toml."""
import os
import pathlib
import re
import shlex
import subprocess
import sys

import pybind11
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def version():
    """The library's, from CMakeLists.txt."""
    return re.search(r"project\(tetproof VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        # Another folder may be kept, so that not everything is compiled again.
        build = os.environ.get("TETPROOF_PYTHON_BUILD", os.path.join(os.path.abspath(self.build_temp), "cmake"))
        ninja = ["-G", "Ninja"] if not os.path.exists(os.path.join(build, "CMakeCache.txt")) else []
        # Read together, the files of a target take the compiler a third of the time.
        subprocess.run(["cmake", *ninja, "-S", str(ROOT), "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                        "-DCMAKE_SKIP_RPATH=ON", "-DTETPROOF_HARNESS=OFF", "-DTETPROOF_TESTS=OFF", "-DDELMESHER_COMMAND=OFF", "-DDELMESHER_INSTALL=OFF",
                        "-DTETPROOF_PYTHON=%s" % target, "-DPython3_EXECUTABLE=%s" % sys.executable,
                        "-Dpybind11_DIR=%s" % pybind11.get_cmake_dir(), *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
                       check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", "2", "--target", "tetproof_core"], check=True)


setup(version=version(), ext_modules=[Extension("tetproof._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
