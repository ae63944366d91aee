# SPDX-License-Identifier: Apache-2.0
"""Recordings and trajectories, compared with what the commands say of them."""
import os
import shutil
from pathlib import Path

import cairn
import numpy as np
from simulated import SimulatedTest, run_json


class RecordingTest(SimulatedTest):
    def setUp(self):
        self.opened = cairn.Recording(self.recording)

    def test_lists_its_sensors(self):
        sensors = {s.id: s for s in self.opened.sensors}
        self.assertEqual(self.opened.robot, "robot_1")
        self.assertEqual(sensors["lidar"].kind, "velodyne")
        self.assertEqual(sensors["lidar"].model, "VLP-16")
        self.assertEqual(sensors["camera"].T_base_sensor.shape, (4, 4))

    def test_gives_every_scan(self):
        scans = self.opened.scans()
        points = [len(scan.xyz) for scan in scans]
        lidar = next(s for s in run_json("inspect", self.recording)["sources"] if s["id"] == "lidar")
        self.assertEqual(len(points), lidar["scans"]["count"])
        self.assertEqual((scans.damaged, scans.messages), (0, []))

    def test_a_scan_has_what_each_point_needs(self):
        scan = next(self.opened.scans("lidar"))
        for array in (scan.intensity, scan.offset_ns, scan.ring):
            self.assertEqual(array.shape, (len(scan.xyz),))
        self.assertEqual(scan.ring.max(), 15)
        self.assertLessEqual(int(scan.offset_ns.max()), scan.end_ns - scan.start_ns)

    def test_gives_pictures_of_every_camera(self):
        forms = {"camera": ((376, 1344, 3), np.uint8), "thermal": (None, np.float32), "depth": (None, np.uint16)}
        for sensor, (shape, kind) in forms.items():
            pictures = list(self.opened.pictures(sensor))
            self.assertGreater(len(pictures), 1, sensor)
            self.assertEqual(pictures[0].pixels.dtype, kind)
            self.assertEqual(pictures[0].pixels.shape, shape or pictures[0].pixels.shape)
            stamps = [p.stamp_ns for p in pictures]
            self.assertEqual(stamps, sorted(stamps))

    def test_a_damaged_picture_is_said_and_the_others_follow(self):
        copy = os.path.join(self.folder, "damaged")
        shutil.copytree(self.recording, copy)
        victim = sorted(Path(copy, "camera").rglob("*.png"))[0]
        victim.write_bytes(b"no picture")
        pictures = cairn.Recording(copy).pictures("camera")
        whole = len(list(self.opened.pictures("camera")))
        self.assertEqual(len(list(pictures)), whole - 1)
        self.assertEqual(pictures.damaged, 1)
        self.assertIn(victim.name, pictures.messages[0])

    def test_names_what_is_not_there(self):
        with self.assertRaisesRegex(cairn.Error, "'lidar' gives pictures"):
            self.opened.pictures("lidar")
        with self.assertRaisesRegex(cairn.Error, "/nowhere"):
            cairn.Recording("/nowhere")

    def test_reads_trajectories(self):
        poses = cairn.load_trajectory(os.path.join(self.recording, "ground_truth.tum"))
        self.assertEqual(poses.xyz.shape, (len(poses), 3))
        np.testing.assert_allclose(np.linalg.norm(poses.quaternion_xyzw, axis=1), 1)
        self.assertTrue((np.diff(poses.stamp_ns) > 0).all())
