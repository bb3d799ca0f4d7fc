"""Builds the modules of the Python package with CMake; everything else is in pyproject.toml."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import pybind11
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

TARGETS = {"tetproof._core": "tetproof_core", "tetproof._oracles": "tetproof_python_oracles"}
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
        # What a wheel takes along lies beside the modules, which look there for libraries.
        along = os.environ.get("TETPROOF_PYTHON_ALONG")
        if along:
            shutil.copytree(along, target / "along", dirs_exist_ok=True)
        # Read together, the files of a target take the compiler a third of the time.
        # What CMake found of another Python is forgotten.
        subprocess.run(["cmake", *ninja, "-S", str(ROOT), "-B", build, "-U_Python3*", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
                        "-DTETPROOF_HARNESS=OFF", "-DTETPROOF_SECOND_OPINIONS=OFF", "-DTETPROOF_TESTS=OFF", "-DDELMESHER_COMMAND=OFF", "-DDELMESHER_INSTALL=OFF",
                        "-DTETPROOF_PYTHON=%s" % target, "-DTETPROOF_PYTHON_ALONG=%s" % ("ON" if along else "OFF"),
                        "-DPython3_EXECUTABLE=%s" % sys.executable,
                        "-Dpybind11_DIR=%s" % pybind11.get_cmake_dir(), *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
                       check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", "2", "--target", TARGETS[extension.name]], check=True)


setup(version=version(), ext_modules=[Extension(name, sources=[]) for name in TARGETS], cmdclass={"build_ext": CMakeBuild})
