#!/usr/bin/env python3
"""Every rule of tree.py must catch a tree that breaks it, and pass one that does not."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tree  # noqa: E402

GOOD = {
    "LICENSE": "MIT License",
    "ci/packages": "# package  section\nlibone-dev  build\nlibtwo-dev  tests\n",
    "ci/install": "Debian: libone-dev; /usr/share/doc/libone-dev /usr/share/doc/libtwo-dev\n",
    "mesher/delmesher.h": "#pragma once\n#include <vector>\n#include \"delmesher/surface.h\"\n",
    "mesher/delmesher/run.h": "#pragma once\n#include <cstdint>\n",
    "mesher/delmesher/surface.h": "#pragma once\n#include \"run.h\"\n",
    "mesher/run/session.h": "#pragma once\n#include \"mesher/delmesher.h\"\n",
    "mesher/base/ids.h": "#pragma once\n#include <cstdint>\n",
    "mesher/refine/refine.h": "#pragma once\n#include <array>\n#include \"mesher/base/ids.h\"\n",
    "mesher/refine/refine_test.cpp": "#include <gtest/gtest.h>\n#include \"mesher/cdt/cdt.h\"\n",
    "mesher/cdt/cdt.h": "#pragma once\n#include \"mesher/delmesher/run.h\"\n",
    "mesher/base/mine.cpp": "namespace delmesher::base {\nnamespace {\nstruct Mine {\n};\n}  // namespace\n}  // namespace delmesher::base\n",
    "mesher/base/ours.h": "#pragma once\nnamespace delmesher::base {\nclass Ours {\n  struct Part;\n};\n}  // namespace delmesher::base\n",
    "mesher/base/ours.cpp": "namespace delmesher::base {\nstruct Ours::Part {\n};\n}  // namespace delmesher::base\n",
    "mesher/run/plane_session.h": "#pragma once\nnamespace delmesher::plane {\n}  // namespace delmesher::plane\n",
    "oracles/base/mine.h": "#pragma once\nnamespace oracles {\nclass Box {\n};\n}  // namespace oracles\n",
    "mesher/assembly.h": "#pragma once\n#include \"mesher/refine/refine.h\"\n",
    "mesher/cdt/plain_reference.h": "#pragma once\n#include <gmpxx.h>\n",
    "mesher/cdt/test_models.h": "#pragma once\n#include \"mesher/refine/refine.h\"\n",
    "mesher/cdt/plain_test.cpp": "#include \"mesher/cdt/plain_reference.h\"\n#include \"mesher/cdt/test_models.h\"\n",
    "mesher/pipeline.cpp": "#include \"mesher/assembly.h\"\n#include \"mesher/refine/refine.h\"\n#include \"mesher/cdt/cdt.h\"\n",
    "mesher/cli/main.cpp": "#include <CLI/CLI.hpp>\n",
    "mesher/io/inflate.cpp": "#include <zlib.h>\n",
    "oracles/report.h": "#pragma once\n#include <gmpxx.h>\n#include \"mesher/delmesher.h\"\n",
    "property_tests/laws_test.cpp": "#include \"oracles/report.h\"\n#include \"mesher/refine/refine.h\"\n",
    "mesher/delmesher/option_table.h": "#pragma once\n",
    "python/bindings.cpp": "#include <pybind11/stl.h>\n#include \"mesher/delmesher.h\"\n#include \"mesher/delmesher/option_table.h\"\n",
    "corpus/peers/tetgen/adapter.cpp": "#include <tetgen.h>\n",
    "corpus/peers/tetgen/LICENSE.md": "Links TetGen, which is under the AGPL.\n",
}

# What is changed, and what the complaint must contain.
BAD = {
    "stage includes stage": ({"mesher/refine/a.cpp": '#include "mesher/cdt/cdt.h"\n'}, "mesher/refine must not"),
    "stage includes the pipeline": ({"mesher/refine/a.cpp": '#include "mesher/assembly.h"\n'}, "only mesher headers"),
    "stage includes a header of the root": ({"mesher/refine/a.cpp": '#include "mesher/delmesher.h"\n'}, "a header of the root"),
    "mesher uses a test's reference": ({"mesher/cdt/a.cpp": '#include "mesher/cdt/plain_reference.h"\n'}, "for tests"),
    "mesher uses a test's models": ({"mesher/cdt/a.cpp": '#include "mesher/cdt/test_models.h"\n'}, "for tests"),
    "base includes stage": ({"mesher/base/a.cpp": '#include "mesher/cdt/cdt.h"\n'}, "mesher/base must not"),
    "mesher uses boost": ({"mesher/cdt/a.cpp": "#include <boost/any.hpp>\n"}, "standard library only"),
    "mesher uses gmp": ({"mesher/cdt/a.cpp": "#include <gmp.h>\n"}, "standard library only"),
    "mesher uses json outside cli": ({"mesher/io/a.cpp": "#include <nlohmann/json.hpp>\n"}, "standard library"),
    "test uses zlib outside io": ({"mesher/cli/a_test.cpp": "#include <zlib.h>\n"}, "standard library"),
    "mesher uses zlib outside io": ({"mesher/cli/a.cpp": "#include <zlib.h>\n"}, "standard library"),
    "mesher includes oracle": ({"mesher/cdt/a.cpp": '#include "oracles/report.h"\n'}, "only mesher headers"),
    "mesher uses CGAL": ({"mesher/cdt/a_test.cpp": "#include <CGAL/Epeck.h>\n"}, "must not build on GPL"),
    "public header uses gmp": ({"mesher/delmesher.h": "#pragma once\n#include <gmp.h>\n"}, "public header"),
    "public header includes a stage": ({"mesher/delmesher/run.h": '#pragma once\n#include "../base/ids.h"\n'},
                                       "no other than public headers"),
    "public header includes nothing": ({"mesher/delmesher/run.h": '#pragma once\n#include "gone.h"\n'}, "no such file"),
    "oracle includes stage": ({"oracles/a.cpp": '#include "mesher/base/ids.h"\n'}, "no stage of the mesher"),
    "package includes stage": ({"python/bindings.cpp": '#include "mesher/base/ids.h"\n'}, "no stage of the mesher"),
    "oracle includes corpus": ({"oracles/a.cpp": '#include "corpus/x.h"\n', "corpus/x.h": "#pragma once\n"},
                               "oracles must not"),
    "room includes a later one": ({"oracles/mesh/a.cpp": '#include "oracles/record/b.h"\n', "oracles/record/b.h": "#pragma once\n"},
                                  "oracles/mesh must not include oracles/record/b.h"),
    "room includes the whole": ({"oracles/mesh/a.cpp": '#include "oracles/report.h"\n'}, "oracles/mesh must not include oracles/report.h"),
    "oracle sneaks in with angles": ({"oracles/a.cpp": "#include <mesher/base/ids.h>\n"}, "installed headers"),
    "relative include": ({"oracles/a.cpp": '#include "report.h"\n'}, "oracles must not"),
    "missing file": ({"oracles/a.cpp": '#include "oracles/none.h"\n'}, "no such file"),
    "no pragma once": ({"oracles/b.h": "int x;\n"}, "pragma once"),
    "class of a source for all to see": ({"oracles/box.cpp": "namespace oracles {\nstruct Box final {\n};\n}  // namespace oracles\n"},
                                         "oracles::Box is defined in a source file outside"),
    "folder in another namespace": ({"mesher/cdt/a.cpp": "namespace delmesher::refine {\n}  // namespace delmesher::refine\n"},
                                    "a file of mesher/cdt opens namespace delmesher::cdt"),
    "internals in the public namespace": ({"mesher/cdt/a.h": "#pragma once\nnamespace delmesher {\n}  // namespace delmesher\n"},
                                          "a file of mesher/cdt opens namespace delmesher::cdt"),
    "machine path": ({"ci/x.sh": "cd /" + "home/someone\n"}, "path of one machine"),
    "packages listed twice": ({"ci/x.sh": "apt-get install libone-dev libtwo-dev\n"}, "lists packages"),
    "version forgotten": ({"CMakeLists.txt": "project(tetproof VERSION 1.2.0)\n", "ci/packaging/vcpkg/vcpkg.json": '{"version-semver": "1.1.0"}'},
                          "vcpkg.json:1: CMakeLists.txt has version 1.2.0, here is 1.1.0"),
    "licence missing": ({"LICENSE": ""}, "licence of the project"),
    "AGPL unsaid": ({"corpus/peers/tetgen/LICENSE.md": "free\n"}, "uses AGPL code"),
    "GPL unsaid": ({"oracles/c.cpp": "#include <CGAL/Epeck.h>\n"}, "uses GPL code"),
}


def violations(files):
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            os.makedirs(os.path.dirname(os.path.join(root, path)) or root, exist_ok=True)
            with open(os.path.join(root, path), "w", encoding="utf-8") as stream:
                stream.write(text)
        return ["%s:%d: %s" % v for v in tree.check_tree(root)]


class CheckTreeTest(unittest.TestCase):
    def test_good_tree_passes(self):
        self.assertEqual(violations(GOOD), [])

    def test_every_damage_is_caught_alone(self):
        for name, (change, expected) in BAD.items():
            with self.subTest(name):
                found = violations({**GOOD, **change})
                self.assertTrue(found)
                self.assertIn(expected, "\n".join(found))


if __name__ == "__main__":
    unittest.main()
