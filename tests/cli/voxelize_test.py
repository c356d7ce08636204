"""voxelize_test.py PROGRAM: `gfxrepro voxelize`, read by numpy and by what the formats say, against a box that it knows."""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not here")
    sys.exit(77)

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
LOW, HIGH = np.array([500000.0, 4500000.0, 10.0]), np.array([500004.0, 4500002.0, 13.0])  # far away, as surveys are
RED, BLUE = (255, 0, 0), (0, 0, 255)  # of the sides towards −x and +x


def box():
    """An OBJ of a closed box, with colours of vertices."""
    lines = []
    for i in range(8):
        corner = [(HIGH if i >> axis & 1 else LOW)[axis] for axis in range(3)]
        lines.append("v {} {} {} {} {} {}".format(*corner, *[c / 255 for c in (BLUE if i & 1 else RED)]))
    faces = ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
    return "\n".join(lines + ["f " + face for face in faces]) + "\n"


class Voxelize(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.kept.name)
        (cls.folder / "box.obj").write_text(box())

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def voxelize(self, name, *arguments, model="box.obj"):
        """Standard output; the files are in the folder."""
        command = [PROGRAM, "voxelize", self.folder / model, "--out", self.folder / name, "--device", "software", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def facts(self):
        return json.loads((self.folder / "m.json").read_text())

    def mask(self, *arguments):
        self.voxelize("m.npy", "--resolution", "64", *arguments)
        return np.load(self.folder / "m.npy")

    def centres(self, mask):
        facts = self.facts()
        return np.array(facts["origin"]) + (np.argwhere(mask) + 0.5) * facts["voxel_size"]

    def test_surface_lies_on_the_box(self):
        m = self.mask()
        facts = self.facts()
        size = facts["voxel_size"]
        self.assertEqual(m.dtype, bool)
        self.assertEqual(list(m.shape), facts["shape"])
        self.assertEqual(max(m.shape), 64)
        self.assertEqual(int(m.sum()), facts["voxels"])
        self.assertEqual(facts["model"], "box.obj")
        self.assertAlmostEqual(size, 4 / 62, delta=1e-6)  # a free voxel at both ends
        centres = self.centres(m)
        inside = np.minimum(centres - LOW, HIGH - centres).min(axis=1)  # below 0 where it is outside
        self.assertLess(np.abs(inside).max(), 0.5 * size + 1e-4)
        for low, high, side in zip(centres.min(axis=0), centres.max(axis=0), zip(LOW, HIGH)):
            self.assertAlmostEqual(low, side[0], delta=0.5 * size + 1e-4)
            self.assertAlmostEqual(high, side[1], delta=0.5 * size + 1e-4)

    def test_attributes_follow_the_mask(self):
        m = self.mask()
        normals, colors = np.load(self.folder / "m.normals.npy"), np.load(self.folder / "m.colors.npy")
        self.assertEqual((normals.dtype, colors.dtype), (np.float32, np.uint8))
        self.assertEqual((normals.shape, colors.shape), ((m.sum(), 3), (m.sum(), 3)))
        dense = np.zeros(m.shape + (3,), np.uint8)
        dense[m] = colors
        self.assertTrue((dense[~m] == 0).all())
        centres = self.centres(m)
        size = self.facts()["voxel_size"]
        for side, (x, normal, color) in enumerate(((LOW[0], -1, RED), (HIGH[0], 1, BLUE))):
            of = np.abs(centres[:, 0] - x) < 0.6 * size
            middle = of & (np.abs(centres - (LOW + HIGH) / 2)[:, 1:] < 0.5).all(axis=1)
            self.assertGreater(middle.sum(), 100, side)
            self.assertTrue(np.allclose(normals[middle], (normal, 0, 0)), side)
            self.assertTrue((colors[middle] == color).all(), side)
        self.assertTrue(np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5))

    def test_solid_has_the_volume(self):
        m = self.mask("--fill", "solid")
        inner = (np.load(self.folder / "m.normals.npy") == 0).all(axis=1)
        centres, size = self.centres(m), self.facts()["voxel_size"]
        distances = np.minimum(centres - LOW, HIGH - centres).min(axis=1)
        self.assertTrue((distances[inner] > size).all() and (distances[~inner] < 1.1 * size).all())
        self.assertAlmostEqual(m.sum() * self.facts()["voxel_size"] ** 3, 24, delta=1)

    def test_a_mesh_with_a_hole_is_said(self):
        closed = self.mask("--fill", "solid")
        (self.folder / "open.obj").write_text(box().rsplit("f ", 1)[0])  # without the side towards +x
        said = {fill: self.voxelize("m.npy", "--resolution", "64", "--fill", fill, model="open.obj") for fill in ("surface", "solid")}
        open_lines = closed.any(axis=0).sum()
        self.assertIn(f"\nwarning    {open_lines} scan lines end inside the model, as its mesh is not closed", said["solid"])
        self.assertTrue((np.load(self.folder / "m.npy") == closed).all())  # the other two axes know
        for text in (said["surface"], self.voxelize("m.npy", "--fill", "solid")):
            self.assertNotIn("scan lines", text)

    def test_viewers_get_the_same_voxels(self):
        m = self.mask()
        facts = self.facts()
        self.voxelize("m.binvox", "--resolution", "64")
        head, data = (self.folder / "m.binvox").read_bytes().split(b"\ndata\n", 1)
        lines = head.decode().splitlines()
        self.assertEqual(lines[:2], ["#binvox 1", "dim 64 64 64"])
        self.assertEqual([float(x) for x in lines[2].split()[1:]], facts["origin"])
        self.assertAlmostEqual(float(lines[3].split()[1]), 64 * facts["voxel_size"])
        runs = np.frombuffer(data, np.uint8).reshape(-1, 2)
        cube = np.repeat(runs[:, 0], runs[:, 1]).reshape(64, 64, 64).transpose(0, 2, 1)
        self.assertTrue((np.argwhere(cube) == np.argwhere(m)).all())

        self.voxelize("m.vox", "--resolution", "64")
        vox = (self.folder / "m.vox").read_bytes()
        self.assertEqual(vox[:8], b"VOX " + struct.pack("<i", 150))
        at = vox.index(b"SIZE")
        self.assertEqual(struct.unpack_from("<3i", vox, at + 12), (m.shape[0], m.shape[2], m.shape[1]))
        at = vox.index(b"XYZI")
        x, y, z, _ = np.frombuffer(vox, np.uint8, 4 * int(m.sum()), at + 16).reshape(-1, 4).astype(int).T
        turned = np.zeros(m.shape, bool)
        turned[x, z, m.shape[2] - 1 - y] = True
        self.assertTrue((turned == m).all())

    def test_files_are_replaced_and_named(self):
        (self.folder / "m.npy").write_text("old")
        said = self.voxelize("m.npy", "--resolution", "32").splitlines()
        np.load(self.folder / "m.npy")
        self.assertTrue(said[0].startswith("warning    its coordinates lie far from the origin"), said)
        self.assertEqual([line.split()[0] for line in said[1:]], ["voxels"] + 4 * ["written"])
        names = [pathlib.Path(line.split(maxsplit=1)[1]).name for line in said[2:]]
        self.assertEqual(names, ["m.npy", "m.normals.npy", "m.colors.npy", "m.json"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
