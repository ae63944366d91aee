# SPDX-License-Identifier: Apache-2.0
"""A simulated recording and what a run makes of it, once for all tests of a file."""
import json
import os
import subprocess
import tempfile
import unittest

CAIRN = os.path.join(os.environ["CAIRN_BIN"], "cairn")


def run(*arguments):
    return subprocess.run([CAIRN, *arguments], check=True, capture_output=True, text=True).stdout


def run_json(*arguments):
    return json.loads(run(*arguments, "--json"))


class SimulatedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if "simulate" not in run("--help"):
            raise unittest.SkipTest("this build has no simulator")
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        run("simulate", "--scene", "corridor", "--seconds", "1", "--seed", "3", "--sensors", "lidar,camera,thermal,depth",
            "--camera-rate", "5", "--out", os.path.join(cls.folder, "sim"))
        cls.recording = os.path.join(cls.folder, "sim", "robot_1")

    @classmethod
    def make_run(cls):
        out = os.path.join(cls.folder, "out")
        if not os.path.exists(out):
            run("run", "--recording", cls.recording, "--networks", "recorded", "--speed", "max", "--out", out)
        return out
