#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Keeps of a simulated run what the people detectors learn from: their input pictures and the true boxes in them.

    pack_people.py RUN FOLDER NAME

Writes FOLDER/NAME-ROBOT-STAMP.KIND.png and .csv for KIND camera and thermal. A line of the CSV is one person:
left, top, right, bottom in pixels of the picture, and the visible share.
"""
import pathlib
import sys

import cv2
import numpy as np

import people_pictures

TELEMETRY_ROWS = 2  # of a Lepton 3, behind its picture


def true_boxes(file: pathlib.Path) -> dict[tuple[str, str], list[list[float]]]:
    """(camera, stamp) -> rows of left, top, right, bottom, share in pixels of the camera's picture."""
    boxes: dict[tuple[str, str], list[list[float]]] = {}
    for line in file.read_text(encoding="ascii").splitlines():
        if line.startswith("#"):
            continue
        stamp, camera, *numbers = line.split(",")
        people = boxes.setdefault((camera, stamp), [])
        if numbers:
            x, y, width, height, _, share = map(float, numbers)
            people.append([x, y, x + width, y + height, share])
    return boxes


def write(stem: pathlib.Path, kind: str, picture: np.ndarray, people: list[list[float]], scale: float) -> None:
    cv2.imwrite(f"{stem}.{kind}.png", picture)
    rows = [",".join(f"{value:.2f}" for value in [*(scale * v for v in box[:4]), box[4]]) for box in people]
    pathlib.Path(f"{stem}.{kind}.csv").write_text("".join(row + "\n" for row in rows), encoding="ascii")


def pack(robot: pathlib.Path, folder: pathlib.Path, name: str) -> None:
    boxes = true_boxes(robot / "true_boxes.csv")
    for file in sorted((robot / "camera" / "data").glob("*.png")):
        eyes = cv2.imread(str(file), cv2.IMREAD_COLOR)
        left = eyes[:, : eyes.shape[1] // 2]
        seen, scale = people_pictures.letterbox(left)
        write(folder / f"{name}-{robot.name}-{file.stem}", "camera", seen, boxes["camera", file.stem], scale)
    for file in sorted((robot / "thermal" / "data").glob("*.png")):
        counts = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)[:-TELEMETRY_ROWS]
        seen = people_pictures.stretch(counts)
        write(folder / f"{name}-{robot.name}-{file.stem}", "thermal", seen, boxes["thermal", file.stem], 1.0)


def main() -> None:
    run, folder, name = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    for robot in sorted(run.glob("robot_*")):
        pack(robot, folder, name)


if __name__ == "__main__":
    main()
