# SPDX-License-Identifier: Apache-2.0
"""Maps as arrays, compared with what `cairn map info` says of the same file."""
import os

import cairn
import numpy as np
from simulated import SimulatedTest, run, run_json


class MapTest(SimulatedTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.path = os.path.join(cls.make_run(), "map.cairn")
        cls.map = cairn.load_map(cls.path)
        cls.info = run_json("map", "info", cls.path)

    def test_has_the_voxels_of_map_info(self):
        voxels = self.map.occupied()
        self.assertEqual(self.map.resolution_m, self.info["resolution_m"])
        self.assertEqual(len(voxels), self.info["occupied"])
        self.assertEqual(voxels.xyz.shape, (len(voxels), 3))
        self.assertTrue((voxels.log_odds >= self.map.occupied_log_odds).all())
        self.assertTrue(np.unique(voxels.xyz, axis=0).shape == voxels.xyz.shape)

    def test_has_the_labels_of_map_info(self):
        label = self.map.occupied().label
        counts = {cairn.CLASSES[i]: int((label == i).sum()) for i in np.unique(label) if i != cairn.NO_CLASS}
        self.assertGreater(len(counts), 1)
        self.assertEqual(counts, self.info["classes"])

    def test_leaves_stand_for_all_voxels(self):
        leaves = self.map.leaves()
        voxels = np.rint(leaves.edge_m / self.map.resolution_m) ** 3
        occupied = leaves.log_odds >= self.map.occupied_log_odds
        self.assertEqual(int(voxels[occupied].sum()), self.info["occupied"])
        self.assertEqual(int(voxels[~occupied].sum()), self.info["free"])

    def test_answers_for_points(self):
        voxels = self.map.occupied()
        np.testing.assert_array_equal(self.map.log_odds_at(voxels.xyz), voxels.log_odds)
        np.testing.assert_array_equal(self.map.label_at(voxels.xyz), voxels.label)
        probabilities = self.map.class_probabilities_at(voxels.xyz)
        np.testing.assert_allclose(probabilities.sum(axis=1), 1)
        known = voxels.label != cairn.NO_CLASS
        np.testing.assert_array_equal(probabilities.argmax(axis=1)[known], voxels.label[known])

    def test_knows_nothing_outside(self):
        outside = [[1e9, 0, 0], [float("nan"), 0, 0], [500, 500, 500]]
        self.assertTrue(np.isnan(self.map.log_odds_at(outside)).all())
        self.assertTrue((self.map.label_at(outside) == cairn.NO_CLASS).all())

    def test_wants_points_of_three_numbers(self):
        for points in ([1, 2, 3], [[1, 2]], np.zeros((2, 2, 3))):
            with self.assertRaisesRegex(ValueError, r"\(N, 3\)"):
                self.map.log_odds_at(points)

    def test_reads_octomaps_files(self):
        plain = os.path.join(self.folder, "map.bt")
        run("map", "export", self.path, "--out", plain)
        self.assertEqual(len(cairn.load_map(plain).occupied()), len(self.map.occupied()))

    def test_names_the_file_that_it_cannot_read(self):
        broken = os.path.join(self.folder, "broken.cairn")
        with open(self.path, "rb") as file, open(broken, "wb") as half:
            half.write(file.read()[:1000])
        for path in (broken, "/nowhere.cairn"):
            with self.assertRaisesRegex(cairn.Error, path):
                cairn.load_map(path)
