"""A package for spack: of its repository, packages/delmesher/package.py.

Tried: the arguments that it gives, with modules that stand in for spack's, and the commands that it leads to by hand for all variants, with
ci/machines/consumer built against the results. Not tried: spack itself.
A release adds `url`, and `sha256` to its version; until then: spack develop --path SOURCES delmesher@VERSION
"""
from spack.package import *
from spack_repo.builtin.build_systems.cmake import CMakePackage


class Delmesher(CMakePackage):
    """Fills a closed triangulated surface with tetrahedra, exactly conforming: a library for C++ and C, and a command line."""

    license("MIT", checked_by="maintainers")

    version("0.1.0")

    variant("command", default=True, description="Build the command line")
    variant("zlib", default=True, description="Read and write compressed files")

    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("cli11", type="build", when="+command")
    depends_on("nlohmann-json", type="build", when="+command")
    depends_on("zlib-api", when="+zlib")

    conflicts("%gcc@:9", msg="C++20 is needed")

    def cmake_args(self):
        return [
            self.define("TETPROOF_HARNESS", False),
            self.define("TETPROOF_TESTS", False),
            self.define_from_variant("DELMESHER_COMMAND", "command"),
            self.define("CMAKE_DISABLE_FIND_PACKAGE_ZLIB", self.spec.satisfies("~zlib")),
        ]
