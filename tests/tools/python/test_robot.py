# SPDX-License-Identifier: Apache-2.0
"""What Python reads of a running core."""
import os
import subprocess
import tempfile
import unittest

import cairn
import numpy as np

ALL = ["pose", "state", "own_map", "scan", "events", "people", "pictures", "wheels", "thermal"]


class RobotTest(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.socket = os.path.join(folder, "robot.sock")
        self.core = subprocess.Popen([os.path.join(os.environ["CAIRN_BIN"], "sample_core"), self.socket],
                                     stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.core.stdout.close)
        self.addCleanup(self.end_core)
        self.core.stdout.readline()  # ready

    def end_core(self):
        if not self.core.stdin.closed:
            self.core.stdin.close()
        self.core.wait()

    def read_all(self):
        robot = cairn.connect(self.socket, ALL)
        self.core.stdin.write(b".")
        self.core.stdin.flush()
        messages = {}
        while "MapChanged" not in messages:
            message = robot.next(timeout=60)
            messages[type(message).__name__] = message
        return robot, messages

    def test_gives_every_kind_of_message(self):
        robot, messages = self.read_all()
        hello, pose, state = messages["Hello"], messages["Pose"], messages["State"]
        self.assertEqual((hello.robot, hello.resolution_m, hello.realtime_offset_ns), ("husky", 0.2, 3_000_000_000))
        np.testing.assert_allclose(hello.T_base_sensor["lidar"][:3, 3], [0.2, 0, 0.6])
        self.assertEqual((pose.stamp_ns, pose.epoch, pose.lost), (1_000_000_000, 2, False))
        np.testing.assert_allclose(pose.xyz, [1, 2, 3])
        np.testing.assert_allclose(pose.quaternion_xyzw, [0, 0, 0.8, 0.6])
        np.testing.assert_allclose(pose.T_odom_base[:3, 3], [1, 2, 3])
        np.testing.assert_allclose(pose.covariance, 0.25 * np.eye(6))
        np.testing.assert_allclose(pose.twist, [1, 0, 0, 0, 0, 0.5])
        self.assertEqual((state.mode, state.cause, state.faults), ("hold", "lidar_silent", ["lidar_silent"]))
        self.assertIsNone(state.T_team_odom)
        np.testing.assert_array_equal(messages["Scan"].xyz, [[1, 2, 3], [4, 5, 6]])
        warm = messages["ThermalCloud"]
        self.assertEqual((warm.stamp_ns, warm.celsius, warm.epoch), (2_000_000_000, True, 2))
        np.testing.assert_array_equal(warm.xyz, [[1, 2, 3], [4, 5, 6]])
        np.testing.assert_array_equal(warm.value, [20.5, 36])
        person = messages["People"].people[0]
        self.assertEqual((person.id, person.sightings, person.seen), (7, 3, True))
        np.testing.assert_allclose(person.velocity, [1, 0])
        camera, picture, wheels = messages["Camera"], messages["Picture"], messages["Wheels"]
        self.assertEqual((camera.name, camera.width, camera.lens), ("front", 3, "radtan"))
        np.testing.assert_allclose(np.diag(camera.K), [5, 6, 1])
        self.assertEqual((picture.sensor, picture.stamp_ns), ("front", 2_000_000_000))
        np.testing.assert_array_equal(picture.pixels, [[0, 10, 20], [30, 40, 50]])
        self.assertEqual((wheels.v, wheels.wheels[0].place, wheels.wheels[0].travel_m), (0.5, "left", 3))
        self.assertEqual((messages["Event"].what, messages["Event"].count), ("lost", 2))
        self.assertEqual(robot.lost, 0)

    def test_messages_say_what_they_hold(self):
        _, messages = self.read_all()
        told = {name: repr(message) for name, message in messages.items()}
        self.assertEqual(told["Pose"], "cairn.Pose(stamp_ns=1000000000, xyz=[1.0, 2.0, 3.0], epoch=2, predicted=False, "
                                       "lost=False)")
        self.assertEqual(told["MapChanged"], "cairn.MapChanged(map='own', tiles=1, caught_up=True)")
        self.assertIn("people=[cairn.Person(id=7, ", told["People"])
        for name, text in told.items():
            self.assertTrue(text.startswith(f"cairn.{name}("), text)
            self.assertNotIn(" at 0x", text)

    def test_a_costmap_needs_a_pose(self):
        robot = cairn.connect(self.socket, ALL)
        with self.assertRaisesRegex(cairn.Error, "no map or no pose yet"):
            robot.costmap(size_m=4)

    def test_mirrors_the_map(self):
        robot, messages = self.read_all()
        self.assertEqual((messages["MapChanged"].map, messages["MapChanged"].tiles), ("own", 1))
        self.assertTrue(messages["MapChanged"].caught_up)
        voxels = robot.own_map.occupied()
        self.assertEqual(len(voxels), 7)
        np.testing.assert_allclose(np.sort(voxels.xyz[:, 2]), np.arange(1, 8) * 0.2 + 0.1, atol=1e-6)
        with self.assertRaisesRegex(cairn.Error, "team_map.*ask for this stream"):
            robot.team_map

    def test_makes_a_costmap_of_map_and_pose(self):
        robot, _ = self.read_all()
        costmap = robot.costmap(size_m=4)
        self.assertEqual(costmap.cost.shape, (20, 20))
        self.assertEqual(costmap.ground_m.shape, (20, 20))
        self.assertEqual(costmap.resolution_m, 0.2)
        self.assertLessEqual(costmap.x_m, 1)
        with self.assertRaises(ValueError):
            robot.costmap(size_m=1e9)

    def test_ends_with_the_core(self):
        robot, _ = self.read_all()
        self.core.stdin.close()
        self.assertEqual(list(robot), [])

    def test_gives_none_when_nothing_came(self):
        robot, _ = self.read_all()
        self.assertIsNone(robot.next(timeout=0))


class ConnectTest(unittest.TestCase):
    def test_says_that_no_core_is_there(self):
        with self.assertRaisesRegex(cairn.Error, "/nowhere.*no core"):
            cairn.connect("/nowhere")

    def test_names_the_streams_for_one_that_does_not_exist(self):
        with self.assertRaisesRegex(ValueError, "poses.*pose, state, own_map"):
            cairn.connect("/nowhere", ["poses"])

    def test_refuses_rates_that_cannot_be(self):
        for rates in ({"pose_hz": 201}, {"pose_hz": float("nan")}, {"scan_hz": -1}):
            with self.assertRaises(ValueError):
                cairn.connect("/nowhere", **rates)
