#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Judges a people detector as Cairn runs it: by OpenCV's DNN module, on one core.

    tools/training/evaluate_people.py KIND MODEL DATA [--threshold T] [--pictures N --out DIR]

Prints tables of Markdown, as the model's card has them, for DATA/validation and DATA/test. Without --threshold it takes
the one with the best F1 on the validation pictures: of the visible detector, on those by day. With --out it also draws
N pictures of the test: the truth in green, what the network says in red.
    tools/training/evaluate_people.py KIND MODEL --recording DIR --threshold T
compares with the boxes that `cairn label DIR --out DIR` left in DIR/boxes.csv.
"""
import argparse
import hashlib
import pathlib
import time

import cv2
import numpy as np

import pack_people
import people_boxes
import people_network
import people_pictures
from people_network import STRIDE

NMS = 0.45
SHOWN = {3: 188, 1: 120}  # rows of the input that the picture fills, by its planes
# Heights in pixels of the input, and how far a whole person of 1.7 m is away then.
FAR = 1e9
HEIGHTS = {
    "camera": [((60, FAR), "to 5 m"), ((30, 60), "5 to 10 m"), ((20, 30), "10 to 15 m"), ((9, 20), "15 to 33 m")],
    "thermal": [((50, FAR), "to 5 m"), ((25, 50), "5 to 10 m"), ((17, 25), "10 to 15 m"), ((6, 17), "15 to 42 m")],
}


class Detector:
    def __init__(self, kind: str, model: pathlib.Path) -> None:
        self.kind = people_network.KINDS[kind]
        self.net = cv2.dnn.readNetFromONNX(str(model))
        self.times_ms: list[float] = []

    def find(self, picture: np.ndarray, threshold: float) -> np.ndarray:
        """Boxes N×5 in pixels of the input, best first, as read_yolox() and select_boxes() make them."""
        blob = cv2.dnn.blobFromImage(picture, people_network.SCALE, None, (people_network.MEAN,) * 3)
        self.net.setInput(blob)
        begin = time.process_time()
        rows = self.net.forward()[0]
        self.times_ms.append(1e3 * (time.process_time() - begin))
        columns = self.kind.width // STRIDE
        cells = np.arange(len(rows))
        centre = (rows[:, :2] + np.stack([cells % columns, cells // columns], 1)) * STRIDE
        half = np.exp(np.minimum(rows[:, 2:4], 12)) * STRIDE / 2
        boxes = np.concatenate([centre - half, centre + half, rows[:, 4:5] * rows[:, 5:6]], 1)
        boxes = boxes[boxes[:, 4] >= threshold]
        boxes[:, 0:4:2] = boxes[:, 0:4:2].clip(0, self.kind.width)
        boxes[:, 1:4:2] = boxes[:, 1:4:2].clip(0, SHOWN[self.kind.planes])
        return people_boxes.suppress(boxes, NMS)


def scene_of(name: str) -> str:
    return name.split("-")[0]


def is_night(name: str) -> bool:
    """By the seed: make_people_data.sh renders nights from 40000, 65000 and 90000."""
    seed = int(name.split("-")[1])
    return 40000 <= seed < 50000 or 65000 <= seed < 70000 or seed >= 90000


def tallies(detector: Detector, kind: str, examples: list, groups: dict) -> dict[str, people_boxes.Tally]:
    """One tally for each group: name -> whether an example belongs to it."""
    result = {name: people_boxes.Tally(people_boxes.LEAST_HEIGHT[kind]) for name in groups}
    for example in examples:
        found = detector.find(example.picture, 0.05)
        for name, belongs in groups.items():
            if belongs(example):
                result[name].add(found, example.people)
    return result


def line(name: str, tally: people_boxes.Tally, threshold: float) -> str:
    figures = tally.precision(threshold), tally.recall(threshold), tally.average_precision()
    said = sum(score >= threshold for score in tally.scores)
    cells = ["–" if np.isnan(figure) else f"{figure:.3f}" for figure in figures]
    return f"| {name} | {tally.people()} | {said} | " + " | ".join(cells) + " |"


def report(split: str, kind: str, found: dict[str, people_boxes.Tally], threshold: float) -> None:
    print(f"\n{split}, threshold {threshold:.2f}:\n\n| pictures | people | boxes | precision | recall | AP50 |")
    print("|---|---|---|---|---|---|")
    for name, tally in found.items():
        print(line(name, tally, threshold))
    print("\n| height in the input | whole person at | recall, day | recall, night |\n|---|---|---|---|")
    for heights, distance in HEIGHTS[kind]:
        bounds = f"from {heights[0]} px" if heights[1] == FAR else f"{heights[0]} to {heights[1]} px"
        recalls = [f"{found[light].recall(threshold, heights):.3f} of {found[light].people(heights)}"
                   for light in ("day", "night")]
        print(f"| {bounds} | {distance} | " + " | ".join(recalls) + " |")
    for light in ("day", "night"):
        tally = found[light]
        print(f"\n{light}, recall of people who are at least half visible: {tally.recall(threshold, least_share=0.5):.3f} of "
              f"{tally.people(least_share=0.5)}")


def judge(args: argparse.Namespace) -> None:
    detector = Detector(args.kind, args.model)
    groups = {"day": lambda e: not is_night(e.name), "night": lambda e: is_night(e.name)}
    known = tallies(detector, args.kind, people_pictures.load(args.data / "validation", args.kind), groups)
    light = known["day"] if args.kind == "camera" else None
    if light is None:
        light = people_boxes.Tally(people_boxes.LEAST_HEIGHT[args.kind])
        for tally in known.values():
            light.scores += tally.scores
            light.right += tally.right
            light.truth += tally.truth
    threshold = args.threshold if args.threshold is not None else light.best_threshold()
    report("validation", args.kind, known, threshold)
    tests = people_pictures.load(args.data / "test", args.kind)
    for scene in sorted({scene_of(e.name) for e in tests}):
        groups[f"{scene}, day"] = lambda e, scene=scene: scene_of(e.name) == scene and not is_night(e.name)
        groups[f"{scene}, night"] = lambda e, scene=scene: scene_of(e.name) == scene and is_night(e.name)
    report("test", args.kind, tallies(detector, args.kind, tests, groups), threshold)
    print(f"\n{np.median(detector.times_ms):.1f} ms a picture, one core")
    draw(detector, tests, threshold, args)


def draw(detector: Detector, examples: list, threshold: float, args: argparse.Namespace) -> None:
    if args.out is None:
        return
    args.out.mkdir(parents=True, exist_ok=True)
    for example in examples[::max(1, len(examples) // max(1, args.pictures))][:args.pictures]:
        picture = example.picture if example.picture.ndim == 3 else cv2.cvtColor(example.picture, cv2.COLOR_GRAY2BGR)
        large = cv2.resize(picture, None, fx=3, fy=3, interpolation=cv2.INTER_NEAREST)
        found = detector.find(example.picture, threshold)
        for boxes, colour in ((example.people, (0, 255, 0)), (found, (0, 0, 255))):
            for box in boxes:
                left, top, right, bottom = (int(3 * value) for value in box[:4])
                cv2.rectangle(large, (left, top), (right - 1, bottom - 1), colour, 1)
                cv2.putText(large, f"{box[4]:.2f}", (left, top + 10), cv2.FONT_HERSHEY_PLAIN, 0.7, colour)
        cv2.imwrite(str(args.out / f"{example.name}.{args.kind}.png"), large)


def compare(args: argparse.Namespace) -> None:
    """Own boxes beside those of `cairn label`, picture by picture."""
    detector = Detector(args.kind, args.model)
    said = pack_people.true_boxes(args.recording / "boxes.csv")
    pictures, most, boxes = 0, 0.0, 0
    for file in sorted((args.recording / args.kind / "data").glob("*.png")):
        if (args.kind, file.stem) not in said:
            continue
        picture = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        if args.kind == "camera":
            picture, scale = people_pictures.letterbox(picture[:, : picture.shape[1] // 2, :3])
        else:
            picture, scale = people_pictures.stretch(picture[:-pack_people.TELEMETRY_ROWS]), 1.0
        own, other = detector.find(picture, args.threshold), np.array(said[args.kind, file.stem]).reshape(-1, 5)
        if len(own) != len(other):
            raise SystemExit(f"{file}: {len(own)} boxes here, {len(other)} in boxes.csv")
        other[:, :4] *= scale
        pictures, boxes = pictures + 1, boxes + len(own)
        most = max([most, *np.abs(own - other).max(1, initial=0)])
    print(f"{pictures} pictures, {boxes} boxes, largest difference {most:.4f} pixels")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=list(people_network.KINDS))
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--threshold", type=float)
    parser.add_argument("--pictures", type=int, default=8)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--recording", type=pathlib.Path)
    args = parser.parse_args()
    cv2.setNumThreads(1)
    if args.recording is not None and args.threshold is not None:
        compare(args)
    elif args.data is not None:
        print(f"{args.model.name}: {args.model.stat().st_size} bytes, sha256 "
              f"{hashlib.sha256(args.model.read_bytes()).hexdigest()}")
        judge(args)
    else:
        parser.error("DATA is needed, or --recording with --threshold")


if __name__ == "__main__":
    main()
