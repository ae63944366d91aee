# SPDX-License-Identifier: Apache-2.0
"""Tells what a map holds:  read_team_map.py MAP.cairn | SOCKET

MAP.cairn: a file. SOCKET: robot.sock of a running core, of which the team's map is read."""
import stat
import sys
from pathlib import Path

import cairn
import numpy as np


def read_core(socket):
    """The team's map, as soon as the core has sent all of it."""
    robot = cairn.connect(socket, ["team_map"])
    for message in robot:
        if isinstance(message, cairn.MapChanged) and message.caught_up:
            return robot.team_map
    raise cairn.Error(f"{socket}: the core ended before it had sent its map")


def show(m):
    voxels = m.occupied()
    print(f"{len(voxels)} occupied voxels of {m.resolution_m} m")
    if len(voxels) == 0:
        return
    low, high = voxels.xyz.min(axis=0), voxels.xyz.max(axis=0)
    print("from {:.1f} {:.1f} {:.1f} m".format(*low), "to {:.1f} {:.1f} {:.1f} m".format(*high))
    for label, count in zip(*np.unique(voxels.label, return_counts=True)):
        name = "no class" if label == cairn.NO_CLASS else cairn.CLASSES[label]
        print(f"  {name:15} {count}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    try:
        is_socket = path.exists() and stat.S_ISSOCK(path.stat().st_mode)
        show(read_core(path) if is_socket else cairn.load_map(path))
    except cairn.Error as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
