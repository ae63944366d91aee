#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Judges an ONNX segmentation network as Cairn runs it: by OpenCV's DNN module, on one core.

    tools/training/evaluate_segmentation.py MODEL DATA [--split test] [--pictures N --out DIR]

Prints the figures as lines of Markdown, as the model's card has them. With --out it also draws N pictures: what the
camera saw, the truth, and what the network says.
    tools/training/evaluate_segmentation.py MODEL --look PICTURE… --out DIR
draws the network's labels beside pictures that have no truth.
"""
import argparse
import hashlib
import pathlib
import time

import cv2
import numpy as np

import figures
import network
import pictures

COLOURS = np.array([(128, 64, 128), (244, 35, 232), (70, 70, 70), (102, 102, 156), (190, 153, 153), (153, 153, 153),
                    (250, 170, 30), (220, 220, 0), (107, 142, 35), (152, 251, 152), (70, 130, 180), (220, 20, 60),
                    (255, 0, 0), (0, 0, 142), (0, 0, 70), (0, 60, 100), (0, 80, 100), (0, 0, 230), (119, 11, 32)])


def painted(classes: np.ndarray) -> np.ndarray:
    """trainIds -> BGR; white where there is no class."""
    table = np.full((256, 3), 255, np.uint8)
    table[:len(COLOURS)] = COLOURS[:, ::-1]
    return table[classes]


class Network:
    def __init__(self, path: pathlib.Path) -> None:
        self.net = cv2.dnn.readNetFromONNX(str(path))
        self.times_ms: list[float] = []

    def classes(self, picture: np.ndarray) -> np.ndarray:
        """The class of each pixel, at the resolution of the input."""
        blob = cv2.dnn.blobFromImage(picture, network.SCALE, (network.WIDTH, network.HEIGHT), (network.MEAN,) * 3)
        self.net.setInput(blob)
        begin = time.monotonic()
        logits = self.net.forward()[0]
        self.times_ms.append(1e3 * (time.monotonic() - begin))
        said = logits.argmax(0).astype(np.uint8)
        return cv2.resize(said, (network.WIDTH, network.HEIGHT), interpolation=cv2.INTER_NEAREST)


def table(counts: np.ndarray) -> str:
    lines = ["| class | IoU | share of pixels |", "|---|---|---|"]
    shares = counts.sum(1) / max(1, counts.sum())
    for name, value, share in zip(figures.NAMES, figures.iou(counts), shares):
        lines.append(f"| {name} | {'–' if np.isnan(value) else f'{value:.3f}'} | {100 * share:.2f} % |")
    return "\n".join(lines)


def report(counts: np.ndarray, by_scene: dict[str, np.ndarray]) -> None:
    present = int(np.count_nonzero(counts.sum(1)))
    print(f"accuracy {figures.accuracy(counts):.4f}, mIoU {figures.mean_iou(counts):.4f} over {present} classes\n")
    print(table(counts))
    print("\n| scene | accuracy | mIoU |\n|---|---|---|")
    for scene, own in sorted(by_scene.items()):
        print(f"| {scene} | {figures.accuracy(own):.4f} | {figures.mean_iou(own):.4f} |")
    print("\nwhat is taken for what most often (share of the true class's pixels):")
    for truth, said, share in figures.worst_confusions(counts):
        print(f"- {truth} → {said}: {100 * share:.1f} %")


def judge(net: Network, folder: pathlib.Path, out: pathlib.Path | None, most: int) -> None:
    seen, truth, names = pictures.load(folder)
    total, by_scene = np.zeros((19, 19), np.int64), {}
    for i, name in enumerate(names):
        said = net.classes(seen[i])
        counts = figures.confusion(truth[i], said)
        total += counts
        scene = name.split("-")[0]
        by_scene[scene] = by_scene.get(scene, 0) + counts
        if out is not None and i % max(1, len(names) // most) == 0:
            cv2.imwrite(str(out / f"{name}.png"), np.hstack([seen[i], painted(truth[i]), painted(said)]))
    print(f"{len(names)} pictures, {np.median(net.times_ms):.1f} ms each (median, one core)")
    report(total, by_scene)


def look(net: Network, files: list[pathlib.Path], out: pathlib.Path) -> None:
    for file in files:
        picture = cv2.imread(str(file), cv2.IMREAD_COLOR)
        labels = cv2.resize(painted(net.classes(picture)), picture.shape[1::-1], interpolation=cv2.INTER_NEAREST)
        cv2.imwrite(str(out / f"{file.stem}.png"), np.vstack([picture, labels, cv2.addWeighted(picture, 0.5, labels, 0.5, 0)]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--split", default="test")
    parser.add_argument("--pictures", type=int, default=12)
    parser.add_argument("--look", type=pathlib.Path, nargs="+", default=[])
    parser.add_argument("--out", type=pathlib.Path)
    args = parser.parse_args()
    cv2.setNumThreads(1)
    if args.out is not None:
        args.out.mkdir(parents=True, exist_ok=True)
    print(f"{args.model.name}: sha256 {hashlib.sha256(args.model.read_bytes()).hexdigest()}")
    net = Network(args.model)
    if args.data is not None:
        judge(net, args.data / args.split, args.out, args.pictures)
    if args.look and args.out is not None:
        look(net, args.look, args.out)


if __name__ == "__main__":
    main()
