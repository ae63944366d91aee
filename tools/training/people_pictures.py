# SPDX-License-Identifier: Apache-2.0
"""Pictures of people with their boxes as make_people_data.sh leaves them, and how training varies them.

The variations keep the networks from learning the renderer: light, colours, noise, blur and view differ every time.
"""
import dataclasses
import pathlib

import cv2
import numpy as np

import pictures

WIDTH, HEIGHT = 336, 192  # pixels of the visible detector's input
GREY = 114  # of what the picture does not fill

# drivers/thermal: config.hpp's stretch_percent and min_span_c, in counts of a centikelvin
LOW_SHARE, HIGH_SHARE, LEAST_SPAN = 0.5 / 100, 99.5 / 100, 5.0 / 0.01


def stretch(counts: np.ndarray) -> np.ndarray:
    """Counts of 16 bits -> 8 bits, exactly as thermal::Stretch (drivers/thermal/stretch.cpp) does it."""
    ordered = np.sort(counts, axis=None)

    def percentile(share: float) -> float:
        return float(ordered[max(1, int(np.ceil(share * ordered.size))) - 1])

    low, high = percentile(LOW_SHARE), percentile(HIGH_SHARE)
    span = max(high - low, LEAST_SPAN, 1.0)
    scale = 255 / span
    offset = 0.5 - (low + high - span) / 2 * scale
    return np.clip(counts.astype(np.float64) * scale + offset, 0.0, 255.0).astype(np.uint8)


def letterbox(picture: np.ndarray) -> tuple[np.ndarray, float]:
    """The visible detector's input, as networks::InputTensor makes it, and its pixels per pixel of the picture."""
    height, width = picture.shape[:2]
    scale = min(WIDTH / width, HEIGHT / height)
    size = (int(width * scale), int(height * scale))
    fitted = np.full((HEIGHT, WIDTH, 3), GREY, np.uint8)
    fitted[:size[1], :size[0]] = cv2.resize(picture, size, interpolation=cv2.INTER_LINEAR)
    return fitted, scale


@dataclasses.dataclass
class Example:
    """One picture, its people (rows of left, top, right, bottom, visible share), and how much can be learnt from it."""

    name: str
    picture: np.ndarray  # H×W×3 (BGR) or H×W (thermal)
    people: np.ndarray
    dark: bool  # a visible picture by night: its people are not to be seen


def boxes_of(file: pathlib.Path) -> np.ndarray:
    rows = [[float(value) for value in line.split(",")] for line in file.read_text(encoding="ascii").splitlines()]
    return np.array(rows, np.float32).reshape(-1, 5)


DARK = 30  # of 255: the mean of a picture by day is above, of one by night below


def load(folder: pathlib.Path, kind: str) -> list[Example]:
    """All examples of the kind (camera or thermal), in the order of their names."""
    files = sorted(folder.glob(f"*.{kind}.csv"))
    if not files:
        raise SystemExit(f"{folder}: no pictures; make them with tools/training/make_people_data.sh")
    flag = cv2.IMREAD_COLOR if kind == "camera" else cv2.IMREAD_GRAYSCALE
    examples = []
    for file in files:
        picture = cv2.imread(str(file.with_suffix(".png")), flag)
        dark = kind == "camera" and float(picture[:-8].mean()) < DARK
        examples.append(Example(file.name.removesuffix(f".{kind}.csv"), picture, boxes_of(file), dark))
    return examples


PERSON = 11  # trainId
LEAST_PIXELS, WIDEST = 6, 0.75  # of a piece of a class picture that is one person: pixels, width over height
BESIDE = 0.15  # of a piece's height: pieces that are nearer to each other may be one person


def people_in(classes: np.ndarray) -> np.ndarray:
    """Boxes around the connected pieces of people in a picture of trainIds.

    A piece that is too wide is several people. A piece right beside another one may be a part of the same person behind
    a fence. Both get the visible share 0: nothing is learnt there.
    """
    joined = cv2.morphologyEx((classes == PERSON).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((5, 3), np.uint8))
    _, _, pieces, _ = cv2.connectedComponentsWithStats(joined, connectivity=8)
    rows = [(x, y, x + width, y + height, float(pixels >= LEAST_PIXELS and width <= WIDEST * height))
            for x, y, width, height, pixels in pieces[1:]]
    boxes = np.array(rows, np.float32).reshape(-1, 5)
    for i, (left, top, right, bottom, _) in enumerate(boxes):
        others = np.delete(boxes, i, 0)
        apart = np.maximum(np.maximum(others[:, 0] - right, left - others[:, 2]), 0)
        level = (others[:, 1] < bottom) & (others[:, 3] > top)
        if np.any(level & (apart < BESIDE * (bottom - top))):
            boxes[i, 4] = 0
    return boxes


def load_labelled(folder: pathlib.Path) -> list[Example]:
    """Visible pictures as make_data.sh leaves them. They are stretched, not letterboxed: by 2 % in height."""
    seen, truth, names = pictures.load(folder)
    return [Example(name, picture, people_in(classes), False) for name, picture, classes in zip(names, seen, truth)]


def moved(people: np.ndarray, turn: np.ndarray, width: int, height: int) -> np.ndarray:
    """The boxes after the affine map, clipped. The share becomes smaller by what leaves the picture."""
    if len(people) == 0:
        return people
    left, top, right, bottom = people[:, :4].T
    corners = np.stack([np.stack([x, y, np.ones_like(x)]) for x in (left, right) for y in (top, bottom)])
    x, y = np.einsum("ij,kjn->ikn", turn.astype(np.float32), corners)
    boxes = np.stack([x.min(0), y.min(0), x.max(0), y.max(0)], 1)
    kept = boxes.copy()
    kept[:, 0::2] = kept[:, 0::2].clip(0, width)
    kept[:, 1::2] = kept[:, 1::2].clip(0, height)
    area = np.prod(boxes[:, 2:] - boxes[:, :2], axis=1)
    inside = np.prod(kept[:, 2:] - kept[:, :2], axis=1) / np.maximum(area, 1e-6)
    return np.concatenate([kept, people[:, 4:] * inside[:, None]], 1)[inside > 0.05].astype(np.float32)


@dataclasses.dataclass(frozen=True)
class View:
    """What part of a picture is learnt from at once: its size in pixels after zooming."""

    width: int
    height: int
    zoom: tuple[float, float]


PART = {"camera": View(224, 128, (0.55, 1.5)), "thermal": View(160, 120, (0.7, 1.5))}
WHOLE = {"camera": View(336, 192, (0.9, 1.3)), "thermal": View(160, 120, (0.9, 1.2))}


def vary_view(picture: np.ndarray, people: np.ndarray, random: np.random.Generator,
              view: View) -> tuple[np.ndarray, np.ndarray]:
    """Mirrors, turns a little, zooms and shifts. Some parts are chosen so that a person is in them."""
    height, width = picture.shape[:2]
    zoom = random.uniform(*view.zoom)
    seen_size = np.array([view.width, view.height]) / zoom  # in pixels of the picture
    slack = np.abs(np.array([width, height]) - seen_size) / 2
    middle = np.array([width, height]) / 2
    centre = middle + random.uniform(-slack, slack)
    if len(people) > 0 and random.random() < 0.6:
        person = people[random.integers(len(people))]
        aim = np.array([person[0] + person[2], person[1] + person[3]]) / 2
        centre = np.clip(aim + random.normal(0, 0.2, 2) * seen_size, middle - slack, middle + slack)
    turn = cv2.getRotationMatrix2D((float(centre[0]), float(centre[1])), random.normal(0, 2.0), zoom)
    turn[:, 2] += np.array([view.width, view.height]) / 2 - centre
    if random.random() < 0.5:
        turn = turn @ np.array([[-1, 0, width], [0, 1, 0], [0, 0, 1]], dtype=np.float64)
    border = GREY if picture.ndim == 3 else int(picture.mean())
    centres = turn.copy()  # OpenCV counts from the centre of the first pixel, boxes from its corner
    centres[:, 2] += turn[:, :2] @ [0.5, 0.5] - 0.5
    seen = cv2.warpAffine(picture, centres, (view.width, view.height), flags=cv2.INTER_LINEAR,
                          borderMode=cv2.BORDER_CONSTANT, borderValue=(border,) * 3)
    return seen, moved(people, turn, view.width, view.height)


def vary_heat(picture: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Contrast, offset and gamma of a thermal picture. Warm stays bright."""
    steps = np.arange(256) / 255.0
    table = np.exp(random.normal(0, 0.25)) * (steps ** np.exp(random.normal(0, 0.25)) - 0.5) + 0.5
    table = np.clip(table + random.normal(0, 0.08), 0, 1) * 255
    return cv2.LUT(picture, np.round(table).astype(np.uint8))


def vary_sensor(picture: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Blur, noise of pixels, and noise of columns as a microbolometer has it."""
    if random.random() < 0.3:
        picture = cv2.GaussianBlur(picture, (0, 0), random.uniform(0.3, 0.9))
    noise = np.zeros(picture.shape, np.float32)
    if random.random() < 0.7:
        noise += random.normal(0, random.uniform(0.5, 8.0), picture.shape)
    if random.random() < 0.3:
        noise += random.normal(0, random.uniform(0.5, 4.0), (1, picture.shape[1]))
    return np.clip(picture + noise + 0.5, 0, 255).astype(np.uint8)


def vary(example: Example, random: np.random.Generator, view: View) -> tuple[np.ndarray, np.ndarray]:
    """A picture of the view's size and the people on it."""
    picture, people = vary_view(example.picture, example.people, random, view)
    if picture.ndim == 2:
        if random.random() < 0.8:
            picture = vary_heat(picture, random)
        return vary_sensor(picture, random), people
    if random.random() < 0.8:
        picture = pictures.vary_colours(picture, random)
    if random.random() < 0.9 and not example.dark:
        picture = pictures.vary_light(picture, random)
    return pictures.vary_camera(picture, random), people
