#!/usr/bin/python3
"""Every format that delmesher writes, read back by Gmsh and by meshio: counts, coordinates, orientation, volume, labels and their names.

Usage: foreign_readers_test.py DELMESHER SCRATCH-FOLDER. Debian's Python, because its packages hold meshio.
"""
import collections
import os
import shutil
import subprocess
import sys
import unittest

import meshio
import numpy

DELMESHER, SCRATCH = sys.argv[1], sys.argv[2]
# A box whose sides have three names; a third is not a short decimal.
HEIGHT = 1 / 3
BOX = """v 0 0 0
v 1 0 0
v 1 2 0
v 0 2 0
v 0 0 {0}
v 1 0 {0}
v 1 2 {0}
v 0 2 {0}
usemtl bottom wall
f 1 4 3 2
usemtl "top" & <lid>
f 5 6 7 8
usemtl side
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
""".format(HEIGHT)
AREAS = {1: 2, 2: 2, 3: 6 * HEIGHT}
VOLUME = 2 * HEIGHT
NAMES = {1: "bottom wall", 2: '"top" & <lid>', 3: "side"}
SECOND_ORDER = ("mesh", "msh", "vtu", "vtk", "inp", "bdf")
# The corners between which the further nodes of meshio's cells are.
EDGES = {"tetra10": ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)), "triangle6": ((0, 1), (1, 2), (0, 2))}
FORMATS = ("mesh", "msh", "vtu", "vtk", "xdmf", "inp", "bdf", "node", "tet", "stl", "ply", "off")


def path(name):
    return os.path.join(SCRATCH, name)


def mesh_of(extension):
    return meshio.read(path("box." + extension))


def cells(mesh, kind):
    found = [block.data for block in mesh.cells if block.type == kind]
    return numpy.concatenate(found) if found else numpy.zeros((0, 3), int)


def of_cells(mesh, name, kind):
    return numpy.concatenate([data for block, data in zip(mesh.cells, mesh.cell_data[name]) if block.type == kind])


def volumes(points, tetrahedra):
    a, b, c, d = (points[tetrahedra[:, k]] for k in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


def areas(points, triangles, labels):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    sums = collections.defaultdict(float)
    for area, label in zip(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1) / 2, labels):
        sums[int(label)] += area
    return dict(sums)


# The Laplacian between the labels 1 and 2, in the region 4.
GETDP = """
Group { Bottom = Region[1]; Top = Region[2]; Inside = Region[4]; Both = Region[{Bottom, Top}]; Whole = Region[{Inside, Both}]; }
Jacobian { { Name J; Case { { Region Inside; Jacobian Vol; } { Region Both; Jacobian Sur; } } } }
Integration { { Name I; Case { { Type Gauss; Case { { GeoElement Tetrahedron; NumberOfPoints 4; } { GeoElement Triangle; NumberOfPoints 3; } } } } } }
Constraint { { Name C; Case { { Region Bottom; Value 0; } { Region Top; Value 1; } } } }
FunctionSpace { { Name V; Type Form0; BasisFunction { { Name s; NameOfCoef v; Function BF_Node; Support Whole; Entity NodesOf[Whole]; } }
  Constraint { { NameOfCoef v; EntityType NodesOf; NameOfConstraint C; } } } }
Formulation { { Name F; Type FemEquation; Quantity { { Name v; Type Local; NameOfSpace V; } }
  Equation { Galerkin { [Dof{d v}, {d v}]; In Inside; Jacobian J; Integration I; } } } }
Resolution { { Name R; System { { Name A; NameOfFormulation F; } } Operation { Generate[A]; Solve[A]; SaveSolution[A]; } } }
PostProcessing { { Name P; NameOfFormulation F; Quantity {
  { Name volume; Value { Integral { [1]; In Inside; Jacobian J; Integration I; } } }
  { Name energy; Value { Integral { [SquNorm[{d v}]]; In Inside; Jacobian J; Integration I; } } } } } }
PostOperation { { Name O; NameOfPostProcessing P; Operation {
  Print[volume[Inside], OnGlobal, Format Table, File "%s"]; Print[energy[Inside], OnGlobal, Format Table, File > "%s"]; } } }
"""


class Read(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(SCRATCH, ignore_errors=True)
        os.makedirs(SCRATCH)
        with open(path("box.obj"), "w") as file:
            file.write(BOX)
        outputs = [word for e in FORMATS for word in ("-o", path("box." + e))]
        subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", *outputs], check=True)
        outputs = [word for e in SECOND_ORDER for word in ("-o", path("ten." + e))]
        subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", "--order", "2", *outputs], check=True)
        subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", "--ascii", "-o", path("text.msh"), "-o", path("text.vtu")],
                       check=True)
        cls.expected = mesh_of("mesh")  # which the tests of the writer hold to the bytes
        cls.points = cls.expected.points
        cls.tetrahedra = cells(cls.expected, "tetra")
        cls.triangles = cells(cls.expected, "triangle")
        cls.labels = of_cells(cls.expected, "medit:ref", "triangle")

    def same_areas(self, points, triangles, labels):
        found = areas(points, triangles, labels)
        self.assertEqual(set(found), set(AREAS))
        for label, area in AREAS.items():
            self.assertAlmostEqual(found[label], area, places=12)

    def same_solid(self, mesh, exactly=True):
        """All points and tetrahedra, in the order written, all of them positive."""
        if exactly:
            self.assertTrue(numpy.array_equal(mesh.points, self.points))
        else:
            self.assertLess(numpy.abs(mesh.points - self.points).max(), 1e-13)
        found = cells(mesh, "tetra")
        self.assertTrue(numpy.array_equal(found, self.tetrahedra))
        each = volumes(mesh.points, found)
        self.assertGreater(each.min(), 0)
        self.assertAlmostEqual(each.sum(), VOLUME, places=12)

    def same_triangles(self, mesh, labels):
        by_label = lambda triangles, of: sorted((int(l), *map(int, t)) for t, l in zip(triangles, of))
        self.assertEqual(by_label(cells(mesh, "triangle"), labels), by_label(self.triangles, self.labels))

    def test_the_expected_mesh_is_the_box(self):
        self.assertGreater(len(self.tetrahedra), 50)
        self.same_solid(self.expected)
        self.same_areas(self.points, self.triangles, self.labels)

    def test_gmsh_format(self):
        mesh = mesh_of("msh")
        self.same_solid(mesh)
        self.same_triangles(mesh, of_cells(mesh, "gmsh:physical", "triangle"))
        names = {tuple(tag): name for name, tag in mesh.field_data.items()}
        self.assertEqual(names, {(1, 2): "bottom wall", (2, 2): "'top' & <lid>", (3, 2): "side", (4, 3): "inside"})

    def test_gmsh_2_2(self):
        """The same cells and names as in 4.1; of second order as well."""
        for name, kinds in (("old.msh", ("tetra", "triangle")), ("old_ten.msh", ("tetra10", "triangle6"))):
            order = "2" if "ten" in name else "1"
            subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", "--order", order, "--msh", "2.2", "-o", path(name)],
                           check=True)
            with open(path(name)) as file:
                self.assertEqual(file.read(24), "$MeshFormat\n2.2 0 8\n$End")
            old, new = meshio.read(path(name)), meshio.read(path("ten.msh" if order == "2" else "box.msh"))
            self.assertTrue(numpy.array_equal(old.points, new.points))
            self.assertEqual({n: tuple(t) for n, t in old.field_data.items()}, {n: tuple(t) for n, t in new.field_data.items()})
            for kind in kinds:
                self.assertTrue(numpy.array_equal(cells(old, kind), cells(new, kind)), kind)
                for data in ("gmsh:physical", "gmsh:geometrical"):
                    self.assertTrue(numpy.array_equal(of_cells(old, data, kind), of_cells(new, data, kind)), data)
            done = subprocess.run(["gmsh", "-0", path(name), "-o", path("unused.msh"), "-v", "2"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
            if order == "1":
                self.assertEqual(self.improved(name), self.improved("box.msh"))

    def solved_by_getfem(self, name):
        import getfem  # says so if a file is not as it should be

        getfem.util_trace_level(1)
        mesh = getfem.Mesh("import", "gmsh", path(name))
        space, integration = getfem.MeshFem(mesh, 1), getfem.MeshIm(mesh, 4)
        space.set_classical_fem(1)
        model = getfem.Model("real")
        model.add_fem_variable("u", space)
        model.add_Laplacian_brick(integration, "u", 4)
        model.add_initialized_data("one", [1.0])
        model.add_Dirichlet_condition_with_multipliers(integration, "u", space, 1)
        model.add_Dirichlet_condition_with_multipliers(integration, "u", space, 2, "one")
        model.solve()
        integral = lambda text, region: getfem.asm_generic(integration, 0, text, region, model)
        self.assertEqual(sorted(mesh.regions()), [1, 2, 3, 4])
        for label, area in AREAS.items():
            self.assertAlmostEqual(integral("1", label), area, places=9)
        return integral("1", 4), integral("Grad_u.Grad_u", 4)

    def solved_by_getdp(self, name):
        problem = path("problem.pro")
        with open(problem, "w") as file:
            file.write(GETDP % ((path("energy.txt"),) * 2))
        done = subprocess.run(["getdp", problem, "-msh", path(name), "-solve", "R", "-pos", "O", "-v", "2"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(path("energy.txt")) as file:
            return [float(word) for word in file.read().split()[1::2]]

    def test_solvers_tell_regions_from_labels(self):
        """A potential of 0 at the bottom and 1 at the top: volume, and energy area / height."""
        subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", "--msh", "2.2", "-o", path("solved.msh")], check=True)
        for found in self.solved_by_getfem("solved.msh"), self.solved_by_getdp("solved.msh"):
            self.assertAlmostEqual(found[0], VOLUME, places=8)
            self.assertAlmostEqual(found[1], 2 / HEIGHT, places=8)

    def test_nothing_is_lost_without_a_word(self):
        """Formats x contents: what is not found in a file again, a warning said. A box whose six sides have labels and names, in two regions."""
        def sets(file, kind, data):
            values = of_cells(file, data, kind) if data in file.cell_data else []
            return len(set(numpy.ravel(values)))

        subprocess.run([DELMESHER, "mesh", path("box.obj"), "-q", "--max-edge", "0.5", "--msh", "2.2", "-o", path("parts.msh")], check=True)
        with open(path("parts.msh")) as file:
            lines = file.read().split("\n")
        begin = lines.index("$Elements") + 2
        for i in range(begin, lines.index("$EndElements")):
            words = lines[i].split()
            if words[1] == "4" and int(words[0]) % 2:
                words[3] = words[4] = "5"
                lines[i] = " ".join(words)
        count = lines.index("$PhysicalNames") + 1
        lines[count:count + 1] = ["5", '3 5 "rubber"']
        lines[lines.index('3 4 "inside"')] = '3 4 "steel"'
        with open(path("parts.msh"), "w") as file:
            file.write("\n".join(lines))
        data = {"mesh": "medit:ref", "msh": "gmsh:physical", "vtu": "region", "vtk": "region", "xdmf": "region", "bdf": "nastran:ref"}
        labels = dict(data, vtu="label", vtk="label", xdmf="label", ply="label")
        names = ("rubber", "steel", "bottom", "lid", "side")
        for extension in FORMATS:
            out = path("lost." + extension)
            done = subprocess.run([DELMESHER, "improve", path("parts.msh"), "-o", out], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            warned = [what for what in ("regions", "labels", "names") if "%s has no place for the %s, which are lost" % (out, what) in done.stderr]
            with self.subTest(extension):
                with open(out.replace(".node", ".face"), "rb") as file:
                    text = file.read().decode("latin-1")
                if extension == "node":
                    with open(path("lost.ele")) as file:
                        regions = len({line.split()[-1] for line in file.read().split("\n")[1:] if len(line.split()) > 4})
                    found = {"regions": regions == 2, "labels": len({line.split()[4] for line in text.split("\n")[1:] if line}) == 3}
                elif extension in ("tet", "off"):
                    found = {}
                elif extension == "inp":
                    found = {"regions": text.count("*ELEMENT,") == 2, "labels": text.count("*SURFACE,") == 3}
                elif extension == "stl":
                    found = {"labels": text.count("endsolid") == 3}
                else:
                    file = meshio.read(out)
                    found = {"labels": sets(file, "triangle", labels[extension]) == 3}
                    found["regions"] = extension in data and sets(file, "tetra", data[extension]) == 2
                boundary = extension in ("stl", "ply", "off")
                there = [name for name in names if name in text]
                found["names"] = there == list(names[2:] if boundary else names)
                for what in ("regions", "labels", "names"):
                    if what == "regions" and boundary or what == "names" and "labels" in warned:
                        continue  # a format of the boundary alone; labels that are lost have no names
                    self.assertNotEqual(found.get(what, False), what in warned, what)

    def test_vtu_and_xdmf(self):
        for extension in ("vtu", "xdmf"):
            mesh = mesh_of(extension)
            self.same_solid(mesh)
            self.same_triangles(mesh, of_cells(mesh, "label", "triangle"))
            names = {int(tag[0]): name for name, tag in mesh.field_data.items()}
            self.assertEqual(names, NAMES)

    def test_legacy_vtk(self):
        mesh = mesh_of("vtk")
        self.same_solid(mesh)
        self.same_triangles(mesh, of_cells(mesh, "label", "triangle"))

    def test_nastran(self):
        mesh = mesh_of("bdf")
        self.same_solid(mesh, exactly=False)
        self.same_triangles(mesh, of_cells(mesh, "nastran:ref", "triangle"))
        self.assertEqual(set(of_cells(mesh, "nastran:ref", "tetra")), {4})
        with open(path("box.bdf")) as file:
            names = [line.split('"', 1) for line in file if line.startswith("$HMNAME COMP")]
        self.assertEqual([(int(n[0].split()[-1]), n[1].rstrip('\n')[:-1]) for n in names], [*NAMES.items(), (4, "inside")])

    def test_abaqus(self):
        mesh = mesh_of("inp")
        self.same_solid(mesh)
        sets = {1: "bottom_wall", 2: "_top_____lid_", 3: "side"}
        sets[2] = "set_" + sets[2]
        self.assertEqual(set(mesh.cell_sets), {"inside"})
        self.assertEqual(set(mesh.point_sets), set(sets.values()))
        for label, name in sets.items():
            self.assertEqual(set(mesh.point_sets[name]), set(self.triangles[self.labels == label].flat))
        # Surfaces, which meshio leaves out: the faces of C3D4 as Abaqus numbers them.
        faces = {"S1": (0, 1, 2), "S2": (0, 3, 1), "S3": (1, 3, 2), "S4": (2, 3, 0)}
        surfaces, current = collections.defaultdict(set), None
        with open(path("box.inp")) as file:
            for line in file:
                if line.startswith("*"):
                    current = line.strip().rsplit("NAME=")[-1] if line.startswith("*SURFACE") else None
                elif current:
                    element, face = line.split(", ")
                    corners = self.tetrahedra[int(element) - 1][list(faces[face.strip()])]
                    surfaces[current].add(tuple(sorted(map(int, corners))))
        for label, name in sets.items():
            self.assertEqual(surfaces[name], {tuple(sorted(map(int, t))) for t in self.triangles[self.labels == label]})

    def test_boundaries(self):
        ply = mesh_of("ply")
        triangles = cells(ply, "triangle")
        self.same_areas(ply.points, triangles, of_cells(ply, "label", "triangle"))
        for extension in ("ply", "stl", "off"):
            mesh = mesh_of(extension)
            found = cells(mesh, "triangle")
            self.assertEqual(len(found), len(self.triangles))
            a, b, c = (mesh.points[found[:, k]] for k in range(3))
            outwards = numpy.einsum("ij,ij->i", numpy.cross(a, b), c).sum() / 6  # the volume inside, if they look outwards
            self.assertAlmostEqual(outwards, VOLUME, places=6)  # meshio keeps single precision of an STL
        with open(path("box.stl")) as file:
            self.assertEqual([l[6:].strip() for l in file if l.startswith("solid")], list(NAMES.values()))

    def test_gmsh_opens_them(self):
        for extension, solid in (("mesh", 1), ("msh", 1), ("vtk", 1), ("bdf", 1), ("stl", 0), ("ply", 0)):
            out = path("from_%s.msh" % extension)
            done = subprocess.run(["gmsh", "-0", path("box." + extension), "-o", out, "-save_all", "-v", "2"],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""), extension)
            mesh = meshio.read(out)
            self.assertEqual(len(cells(mesh, "triangle")), len(self.triangles), extension)
            self.assertEqual(len(cells(mesh, "tetra")), len(self.tetrahedra) if solid else 0, extension)
            if solid:
                self.assertAlmostEqual(volumes(mesh.points, cells(mesh, "tetra")).sum(), VOLUME, places=12)

    def straight_elements(self, mesh, triangles=True, exactly=True, same_numbers=True):
        """Ten-node tetrahedra, and six-node triangles if any, on the same corners, with nodes in the middle of their edges."""
        linear = {"tetra10": self.tetrahedra, "triangle6": self.triangles}
        for kind, edges in EDGES.items():
            found = cells(mesh, kind)
            if kind == "triangle6" and not triangles:
                self.assertEqual(len(found), 0)
                continue
            corners = found[:, :-len(edges)]
            self.assertEqual(len(corners), len(linear[kind]))
            if same_numbers:
                self.assertEqual(sorted(map(tuple, corners)), sorted(map(tuple, linear[kind])))
            for node, (i, j) in zip(found[:, -len(edges):].T, edges):
                off = numpy.abs(mesh.points[node] - (mesh.points[found[:, i]] + mesh.points[found[:, j]]) / 2).max()
                self.assertLessEqual(off, 0 if exactly else 1e-13)
        self.assertEqual(len(cells(mesh, "tetra")) + len(cells(mesh, "triangle")), 0)
        self.assertAlmostEqual(volumes(mesh.points, cells(mesh, "tetra10")[:, :4]).sum(), VOLUME, places=12)
        # Each edge has one node, and nothing else is added.
        all_edges = {tuple(sorted(pair)) for i, j in EDGES["tetra10"] for pair in zip(*self.tetrahedra[:, [i, j]].T.tolist())}
        self.assertEqual(len(mesh.points), len(self.points) + len(all_edges))

    def test_second_order(self):
        for extension in ("msh", "vtu", "vtk", "inp", "bdf"):
            mesh = meshio.read(path("ten." + extension))
            with self.subTest(extension):
                self.straight_elements(mesh, triangles=extension != "inp", exactly=extension != "bdf")
        labels = of_cells(meshio.read(path("ten.msh")), "gmsh:physical", "triangle6")
        self.assertEqual(sorted(labels), sorted(self.labels))
        nodes = meshio.read(path("ten.inp"))
        # The nodes of a label are those of its triangles, in the middle of edges as well.
        vtu = meshio.read(path("ten.vtu"))
        label = of_cells(vtu, "label", "triangle6")
        self.assertEqual(set(nodes.point_sets["side"]), set(cells(vtu, "triangle6")[label == 3].flat))

    def test_gmsh_opens_second_order(self):
        for extension in ("mesh", "msh", "vtk", "bdf"):
            out = path("from_ten_%s.msh" % extension)
            done = subprocess.run(["gmsh", "-0", path("ten." + extension), "-o", out, "-save_all", "-v", "2"],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""), extension)
            with self.subTest(extension):
                self.straight_elements(meshio.read(out), exactly=False, same_numbers=False)

    def test_bytes_and_text_are_one_mesh(self):
        for extension in ("msh", "vtu"):
            with open(path("box." + extension), "rb") as file:
                self.assertTrue(b"\n4.1 1 8\n" in file.read(200) if extension == "msh" else b'"Float64" Name="Points" NumberOfComponents="3" format="binary"' in file.read())
            bytes_, text = mesh_of(extension), meshio.read(path("text." + extension))
            self.assertTrue(numpy.array_equal(bytes_.points, text.points))
            for kind in ("tetra", "triangle"):
                self.assertTrue(numpy.array_equal(cells(bytes_, kind), cells(text, kind)))
            self.assertEqual(set(bytes_.cell_data), set(text.cell_data))
            for name, blocks in bytes_.cell_data.items():
                for one, other in zip(blocks, text.cell_data[name]):
                    self.assertTrue(numpy.array_equal(one, other))

    def improved(self, name):
        """The tetrahedra that `improve` makes of a file, as bytes: the same mesh is improved in the same way."""
        out = path("improved.tet")
        done = subprocess.run([DELMESHER, "improve", path(name), "-q", "-o", out], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""), name)
        with open(out, "rb") as file:
            return file.read()

    def test_what_meshio_and_gmsh_write_is_read(self):
        expected = self.improved("box.mesh")
        given = meshio.Mesh(self.points, [("tetra", self.tetrahedra), ("triangle", self.triangles)],
                            cell_data={"label": [numpy.zeros(len(self.tetrahedra), numpy.int32), self.labels.astype(numpy.int32)]})
        for name, options in {"zlib": dict(compression="zlib"), "bytes": dict(compression=None),
                              "wide": dict(compression="zlib", header_type="UInt64")}.items():
            meshio.write(path("theirs.vtu"), given, file_format="vtu", **options)
            with open(path("theirs.vtu"), "rb") as file:
                self.assertEqual(b"vtkZLibDataCompressor" in file.read(), name in ("zlib", "wide"))
            self.assertEqual(self.improved("theirs.vtu"), expected, name)
        # Ten nodes, from meshio and from Gmsh; compressed again, with gzip.
        second = meshio.read(path("ten.vtu"))
        meshio.write(path("ten_theirs.vtu"), second, compression="zlib")
        subprocess.run(["gmsh", "-0", path("ten.msh"), "-o", path("ten_theirs.msh"), "-bin", "-save_all", "-v", "2"], check=True)
        subprocess.run(["gzip", "-kf", path("ten_theirs.vtu")], check=True)
        for name in ("ten.vtu", "ten.mesh", "ten.msh", "ten_theirs.vtu", "ten_theirs.msh", "ten_theirs.vtu.gz"):
            self.assertEqual(self.improved(name), expected, name)

    def test_the_plane(self):
        with open(path("flat.txt"), "w") as file:
            file.write("0 0\n4 0\n1 1\n0 4\n")
        for name, options in (("flat", []), ("flat_text", ["--ascii"])):
            subprocess.run([DELMESHER, "plane", path("flat.txt"), "-q", "--max-edge", "0.5", *options, "-o", path(name + ".msh"),
                            "-o", path(name + ".vtu")], check=True)
        text = meshio.read(path("flat_text.vtu"))
        out = path("flat_gmsh.msh")
        done = subprocess.run(["gmsh", "-0", path("flat.msh"), "-o", out, "-save_all", "-v", "2"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        self.assertAlmostEqual(sum(areas(text.points, cells(text, "triangle"), numpy.zeros(10**6)).values()), 4, places=12)
        opened = meshio.read(out)
        self.assertEqual([len(cells(opened, kind)) for kind in ("triangle", "line")], [len(cells(text, kind)) for kind in ("triangle", "line")])
        for name in ("flat.vtu", "flat.msh", "flat_text.msh"):
            mesh = meshio.read(path(name))
            self.assertTrue(numpy.array_equal(mesh.points, text.points), name)
            for kind in ("triangle", "line"):
                self.assertTrue(numpy.array_equal(cells(mesh, kind), cells(text, kind)), (name, kind))
        self.assertEqual({name: tuple(tag) for name, tag in meshio.read(path("flat.msh")).field_data.items()},
                         {"marker 0": (2, 1), "inside": (1, 2)})
        with open(path("flat.msh"), "rb") as file:
            self.assertIn(b"\n4.1 1 8\n", file.read(200))

    def test_gmsh_knows_what_bounds_the_volume(self):
        geo = path("boundary.geo")
        with open(geo, "w") as file:
            file.write('Merge "box.msh";\ns() = Boundary { Volume{4}; };\nPrintf("bounded by %g", #s());\n'
                       'p() = Physical Surface{:};\nPrintf("groups %g", #p());\n')
        done = subprocess.run(["gmsh", "-0", geo, "-o", path("unused.msh")], capture_output=True, text=True)
        self.assertIn("bounded by 6", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
