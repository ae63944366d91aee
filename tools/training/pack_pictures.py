#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Keeps of a simulated run what training needs: the left eye's pictures and their truth, small.

    pack_pictures.py RUN FOLDER NAME

Writes FOLDER/NAME-ROBOT-STAMP.png (BGR) and FOLDER/NAME-ROBOT-STAMP.truth.png (trainIds, 255 = no class).
"""
import pathlib
import sys

import cv2

SIZE = (336, 192)  # width, height in pixels: what the network takes


def pack(robot: pathlib.Path, folder: pathlib.Path, name: str) -> None:
    for picture in sorted((robot / "camera" / "data").glob("*.png")):
        truth = cv2.imread(str(robot / "labels" / picture.name), cv2.IMREAD_GRAYSCALE)
        eyes = cv2.imread(str(picture), cv2.IMREAD_COLOR)
        left = eyes[:, : eyes.shape[1] // 2]
        stem = folder / f"{name}-{robot.name}-{picture.stem}"
        cv2.imwrite(f"{stem}.png", cv2.resize(left, SIZE, interpolation=cv2.INTER_LINEAR))
        cv2.imwrite(f"{stem}.truth.png", cv2.resize(truth, SIZE, interpolation=cv2.INTER_NEAREST))


def main() -> None:
    run, folder, name = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    for robot in sorted(run.glob("robot_*")):
        pack(robot, folder, name)


if __name__ == "__main__":
    main()
