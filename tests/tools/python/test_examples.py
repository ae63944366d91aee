# SPDX-License-Identifier: Apache-2.0
"""The examples do what they say."""
import os
import subprocess
import sys

from simulated import SimulatedTest


class ExamplesTest(SimulatedTest):
    def run_example(self, *arguments):
        name, *rest = arguments
        command = [sys.executable, "-B", os.path.join(os.environ["CAIRN_EXAMPLES"], name), *rest]
        return subprocess.run(command, capture_output=True, text=True)

    def test_read_team_map(self):
        told = self.run_example("read_team_map.py", os.path.join(self.make_run(), "map.cairn"))
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("occupied voxels", told.stdout)
        self.assertIn("wall", told.stdout)

    def test_says_what_is_wrong(self):
        told = self.run_example("read_team_map.py", "/nowhere.cairn")
        self.assertEqual(told.returncode, 1)
        self.assertIn("/nowhere.cairn", told.stderr)
        self.assertNotIn("Traceback", told.stderr)
