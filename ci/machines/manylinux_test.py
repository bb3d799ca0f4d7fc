#!/usr/bin/env python3
"""Tests of manylinux.py: on modules that the compiler makes here, and on what readelf prints of others."""
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import manylinux  # noqa: E402

X86 = "  Machine:                           Advanced Micro Devices X86-64\n"
ARM = "  Machine:                           AArch64\n"


def needed(*libraries):
    return "".join(" 0x01 (NEEDED)             Shared library: [%s]\n" % name for name in libraries)


def needs(library, *versions):
    return "Version needs section '.gnu.version_r' contains 1 entry:\n  0x0: Version: 1  File: %s  Cnt: 1\n%s" % (
        library, "".join("  0x10:   Name: %s  Flags: none  Version: 2\n" % version for version in versions))


class Rules(unittest.TestCase):
    def test_the_newest_version_of_the_c_library_decides(self):
        self.assertEqual(manylinux.tag(X86, needed("libc.so.6"), needs("libc.so.6", "GLIBC_2.2.5", "GLIBC_2.34", "GLIBC_2.9")),
                         "manylinux_2_34_x86_64")
        self.assertEqual(manylinux.tag(ARM, needed("libm.so.6", "libc.so.6"), needs("libm.so.6", "GLIBC_2.17") + needs("libc.so.6", "GLIBC_2.29")),
                         "manylinux_2_29_aarch64")

    def test_none_is_older_than_what_the_rules_are_for(self):
        self.assertEqual(manylinux.tag(X86, needed("libc.so.6"), needs("libc.so.6", "GLIBC_2.2.5")), "manylinux_2_17_x86_64")

    def test_what_the_module_defines_is_not_needed(self):
        defines = "Version definition section '.gnu.version_d' contains 1 entry:\n  0x0: Rev: 1  Flags: none  Name: OURS_9\n"
        self.assertEqual(manylinux.tag(X86, needed(), needs("libc.so.6", "GLIBC_2.18") + defines), "manylinux_2_18_x86_64")

    def test_zlib_and_libgcc_of_long_ago(self):
        self.assertEqual(manylinux.tag(X86, needed("libz.so.1"), needs("libz.so.1", "ZLIB_1.2.3.4")), "manylinux_2_17_x86_64")
        self.assertEqual(manylinux.tag(ARM, needed("libgcc_s.so.1"), needs("libgcc_s.so.1", "GCC_3.0", "GCC_4.2.0")), "manylinux_2_17_aarch64")
        with self.assertRaisesRegex(manylinux.NotPortable, "GCC_13.0.0 of libgcc_s.so.1"):
            manylinux.tag(ARM, needed("libgcc_s.so.1"), needs("libgcc_s.so.1", "GCC_13.0.0"))
        self.assertEqual(manylinux.tag(X86, needed("libz.so.1"), needs("libz.so.1", "ZLIB_1.2.9", "ZLIB_1.2.0")), "manylinux_2_28_x86_64")
        with self.assertRaisesRegex(manylinux.NotPortable, "ZLIB_1.2.12 of libz.so.1"):
            manylinux.tag(X86, needed("libz.so.1"), needs("libz.so.1", "ZLIB_1.2.12"))

    def test_a_library_that_is_taken_along(self):
        versions = needs("libc.so.6", "GLIBC_2.20")
        module = needed("libc.so.6", "libgmp.so.10") + " 0x1d (RUNPATH)            Library runpath: [$ORIGIN/along]\n"
        self.assertEqual(manylinux.tag(X86, module, versions, {"libgmp.so.10"}), "manylinux_2_20_x86_64")
        with self.assertRaisesRegex(manylinux.NotPortable, "libgmp"):
            manylinux.tag(X86, module, versions, {"libmpfr.so.6"})

    def test_what_is_not_portable(self):
        for message, header, dynamic, versions in (
                ("libgmp.so.10", X86, needed("libc.so.6", "libgmp.so.10"), ""),
                ("libstdc.*so.6", X86, needed("libstdc++.so.6"), needs("libstdc++.so.6", "GLIBCXX_3.4.30")),
                ("CXXABI_1.3", X86, needed("libc.so.6"), needs("libc.so.6", "CXXABI_1.3")),
                ("GLIBC_PRIVATE", X86, needed("libc.so.6"), needs("libc.so.6", "GLIBC_PRIVATE")),
                ("folders", X86, needed("libc.so.6") + " 0x1d (RUNPATH)            Library runpath: [/opt]\n", ""),
                ("RISC-V", "  Machine:   RISC-V\n", needed("libc.so.6"), "")):
            with self.assertRaisesRegex(manylinux.NotPortable, message):
                manylinux.tag(header, dynamic, versions)


class Compiled(unittest.TestCase):
    def module(self, text, *options):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "module.so")
        subprocess.run(["c++", "-shared", "-fPIC", "-x", "c++", "-", "-o", path, *options], input=text, text=True, check=True)
        return path

    def test_a_module_of_c_alone(self):
        self.assertRegex(manylinux.tag_of(self.module('extern "C" int f() { return 1; }', "-nodefaultlibs", "-lc")), r"^manylinux_2_\d+_")

    def test_the_c_library_of_a_symbol(self):
        # getentropy came with 2.25, so no older tag may be given, whatever machine this is.
        path = self.module('#include <unistd.h>\nextern "C" int f(char* p) { return getentropy(p, 4); }', "-nodefaultlibs", "-lc")
        self.assertGreaterEqual(manylinux.numbers(".".join(manylinux.tag_of(path).split("_")[1:3])), (2, 25))

    def test_the_library_of_the_compiler(self):
        text = "#include <iostream>\nvoid f() { std::cout << 1; }"
        with self.assertRaisesRegex(manylinux.NotPortable, "libstdc"):
            manylinux.tag_of(self.module(text))
        manylinux.tag_of(self.module(text, "-static-libstdc++", "-static-libgcc"))


if __name__ == "__main__":
    unittest.main()
