# SPDX-License-Identifier: Apache-2.0
"""Pictures with truth as make_data.sh leaves them, and how training varies them.

The variations keep the network from learning the renderer: light, colours, noise, blur and view differ every time.
"""
import dataclasses
import pathlib

import cv2
import numpy as np

IGNORED = 255


@dataclasses.dataclass(frozen=True)
class View:
    """What part of a picture is learnt from at once: its size in pixels after zooming."""

    width: int
    height: int
    zoom: tuple[float, float]


# Most epochs learn from small parts: four of them cost what one whole picture costs, and they differ more.
PART = View(176, 96, (0.5, 1.3))
WHOLE = View(336, 192, (0.9, 1.5))


def load(folder: pathlib.Path) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """All pictures N×H×W×3 (BGR), their truth N×H×W (trainIds) and their names, in the order of the names."""
    truths = sorted(folder.glob("*.truth.png"))
    if not truths:
        raise SystemExit(f"{folder}: no pictures; make them with tools/training/make_data.sh")
    names = [path.name.removesuffix(".truth.png") for path in truths]
    pictures = [cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_COLOR) for name in names]
    return np.stack(pictures), np.stack([cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in truths]), names


def vary_view(picture: np.ndarray, truth: np.ndarray, random: np.random.Generator,
              view: View) -> tuple[np.ndarray, np.ndarray]:
    """Mirrors, turns, zooms and shifts."""
    height, width = truth.shape
    zoom = random.uniform(*view.zoom)
    seen_size = np.array([view.width, view.height]) / zoom  # in pixels of the picture
    slack = np.abs(np.array([width, height]) - seen_size) / 2
    centre = np.array([width, height]) / 2 + random.uniform(-slack, slack)
    turn = cv2.getRotationMatrix2D((float(centre[0]), float(centre[1])), random.normal(0, 3.0), zoom)
    turn[:, 2] += np.array([view.width, view.height]) / 2 - centre
    if random.random() < 0.5:
        turn = turn @ np.array([[-1, 0, width - 1], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    size = (view.width, view.height)
    seen = cv2.warpAffine(picture, turn, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT_101)
    known = cv2.warpAffine(truth, turn, size, flags=cv2.INTER_NEAREST, borderMode=cv2.BORDER_CONSTANT,
                           borderValue=IGNORED)
    return seen, known


def vary_colours(picture: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Turns the hues, changes the saturation, mixes channels a little."""
    angle, saturation = random.normal(0, 0.25), random.uniform(0.4, 1.5)
    grey = np.full((3, 3), 1.0 / 3.0)
    axis = np.array([[0, -1, 1], [1, 0, -1], [-1, 1, 0]]) / np.sqrt(3.0)
    turned = grey + saturation * (np.cos(angle) * (np.eye(3) - grey) + np.sin(angle) * axis)
    return cv2.transform(picture, turned)


def vary_light(picture: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Exposure, gamma, contrast and a cast of each channel, by one table."""
    steps = np.arange(256) / 255.0
    gamma, gain, lift = np.exp(random.normal(0, 0.3)), np.exp(random.normal(0, 0.3)), random.normal(0, 0.03)
    casts = np.exp(random.normal(0, 0.08, 3))
    table = np.clip(gain * casts * steps[:, None] ** gamma + lift, 0, 1) * 255
    return cv2.LUT(picture, np.round(table).astype(np.uint8)[:, None, :])


def vary_camera(picture: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Blur, noise and compression."""
    if random.random() < 0.3:
        picture = cv2.GaussianBlur(picture, (0, 0), random.uniform(0.3, 1.3))
    if random.random() < 0.6:
        noise = np.empty(picture.shape, np.int16)
        cv2.setRNGSeed(int(random.integers(1 << 30)))
        cv2.randn(noise, 0, random.uniform(0.5, 9.0))
        picture = cv2.add(picture, noise, dtype=cv2.CV_8U)
    if random.random() < 0.2:
        _, packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, int(random.integers(25, 90))])
        picture = cv2.imdecode(packed, cv2.IMREAD_COLOR)
    return picture


def vary(picture: np.ndarray, truth: np.ndarray, random: np.random.Generator,
         view: View) -> tuple[np.ndarray, np.ndarray]:
    picture, truth = vary_view(picture, truth, random, view)
    if random.random() < 0.8:
        picture = vary_colours(picture, random)
    if random.random() < 0.9:
        picture = vary_light(picture, random)
    return vary_camera(picture, random), truth
